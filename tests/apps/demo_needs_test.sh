#!/usr/bin/env bash
# demo_needs_test.sh BUILD: `dance demo` where only those programs are that ./dance builds for it, in a network of its own:
# all that it offers runs, and nothing is missing.
set -euo pipefail
source_tree=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
build=$(cd "${1:?give the build folder}" && pwd)
if [ "${2:-}" != --inside ]; then
  exec "$source_tree/tests/private_network.sh" "${BASH_SOURCE[0]}" "$build" --inside
fi
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
mkdir -p "$scratch/bin" "$scratch/share"
targets=$(sed -n 's/^demo //p' "$build/share/dancegraph/commands.txt")
# Programs find each other beside the file that runs: copies, not links.
for target in ${targets//dance-front/dance}; do cp "$build/bin/$target" "$scratch/bin"; done
cp -r "$build/share/dancegraph" "$scratch/share/dancegraph"
cd "$scratch"
failed=0
demo() { # NAME OPTION…
  local name=$1
  shift
  if ! bin/dance demo --headless --seconds 2 --json --out "$name" "$@" >"$name.json" 2>"$name.log" ||
    ! grep -q '"restarts": *0' "$name.json"; then
    echo "dance demo $*:"
    cat "$name.json" "$name.log"
    tail -n 3 "$name"/programs/*.txt || true
    failed=1
  fi
  if [ -e bin/dance-view ] && [ ! -s "$name/stage-0001.png" ]; then
    echo "dance demo $*: no picture"
    failed=1
  fi
}
started() { # NAME PROGRAM…: these said something of themselves, or could have
  local name=$1 program
  shift
  for program in "$@"; do
    [ -e "$name/programs/$program.txt" ] || { echo "$name: $program was not started"; failed=1; }
  done
}
demo plain
started plain server house-a house-b record alice bob
[ ! -e "$build/bin/dance-music" ] || started plain music-a music-b
[ ! -e "$build/bin/dance-view" ] || started plain view
takes=$source_tree/tests/formats/bvh/data/biped.bvh
demo takes --motion "$takes,$takes" --link "delay=20ms" --music none
started takes line
exit $failed
