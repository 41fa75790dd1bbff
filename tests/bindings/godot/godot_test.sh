#!/bin/sh
# godot_test.sh PROJECT: runs godot_test.gd in a copy of the built project with a real Godot.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
command -v godot3-server >/dev/null || {
  echo "[  SKIPPED ] godot3-server is not here: apt-get install godot3-server"
  exit 0
}
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cp -r "$1" "$scratch/project"
cp "$here/godot_test.gd" "$scratch/project"
HOME=$scratch LANG=en_US.UTF-8 timeout 60 godot3-server --path "$scratch/project" -s godot_test.gd >"$scratch/out" 2>&1 ||
  { cat "$scratch/out"; exit 1; }
cat "$scratch/out"
[ "$(grep -cx passed "$scratch/out")" = 1 ]
! grep -q 'SCRIPT ERROR' "$scratch/out"
