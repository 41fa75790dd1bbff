#!/usr/bin/env bash
# odr_link.sh [BUILD_FOLDER]: checks that no program has two types of one name, as the linker sees them. Compiles all libraries without
# optimisation, joins them in one object, programs' mains left out, and fails at any report of GCC's -Wodr.
# check.one_definition, which reads the sources, finds the same in seconds; this also sees what macros and options make.
set -euo pipefail
cd "$(dirname "$0")/.."
case "${1:-}" in -h | --help) sed -n '2,4s/^# \{0,1\}//p' "$0"; exit 0 ;; esac
build=${1:-build/odr}
mkdir -p "$build"
cmake --preset odr -B "$build" >"$build.configure.log" 2>&1 || { cat "$build.configure.log"; exit 1; }
# Only libraries: programs would be linked one by one, each with all of its libraries.
mapfile -t archives < <(ninja -C "$build" -t targets all | sed -n 's/^\(.*\/lib[^/]*\.a\): .*/\1/p' | sort)
[ ${#archives[@]} -gt 50 ] || { echo "odr_link.sh: only ${#archives[@]} libraries in $build" >&2; exit 1; }
ninja -C "$build" "${archives[@]}" >"$build.log" 2>&1 || { tail -n 40 "$build.log"; exit 1; }
cd "$build"
# The linker must see each object of each library once.
g++ -r -nostdlib -O0 -flto=auto -flinker-output=rel -Wodr -Wl,--whole-archive "${archives[@]}" -Wl,--no-whole-archive \
  -o all_libraries.o >odr.txt 2>&1 || { cat odr.txt; exit 1; }
rm -f all_libraries.o
if [ -s odr.txt ]; then
  cat odr.txt
  echo "odr_link.sh: one name has two definitions; rename one of them"
  exit 1
fi
echo "${#archives[@]} libraries joined, no type is defined twice"
