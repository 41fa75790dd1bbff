#!/bin/sh
# blender_test.sh LIBRARY: runs rig_test.py in a real Blender, without a window.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
command -v blender >/dev/null || {
  echo "[  SKIPPED ] Blender is not here: apt-get install blender"
  exit 0
}
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
export HOME="$scratch" PYTHONDONTWRITEBYTECODE=1
export PYTHONPATH="$here/../../../bindings/python:$here/../../../bindings/blender"
blender -b --factory-startup -noaudio --python-use-system-env --python-exit-code 3 --python "$here/rig_test.py" -- "$1" \
  >"$scratch/out" 2>&1 || { cat "$scratch/out"; exit 1; }
cat "$scratch/out"
grep -qx passed "$scratch/out"
