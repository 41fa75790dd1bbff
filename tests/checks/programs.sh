#!/bin/sh
# programs.sh COMMANDS: each program that a source starts (its name beside a call of program_folder() in the folder) is among
# those that ./dance builds for the command: COMMANDS is share/dancegraph/commands.txt of a build, which the NEEDS of
# dance_program make. Whose source it is, the folder's CMakeLists.txt says.
set -eu
root=$(cd "$(dirname "$0")/../.." && pwd)
commands=$(realpath "${1:?give the list of commands of a build}")
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cd "$root"

# PROGRAM FOLDER SOURCE of each dance_program(…), and FOLDER SOURCE of what starts programs.
for list in $(find apps bench house producers consumers viewer voice haptics tunnel lobby research -name CMakeLists.txt 2>/dev/null | sort); do
  awk -v folder="$(dirname "$list")" '
    { sub(/#.*/, "") }
    match($0, /dance_program\([^ )]+/) { program = substr($0, RSTART + 14, RLENGTH - 14); inside = 1 }
    inside {
      line = $0
      if (match(line, /(LIBS|NEEDS)/)) { line = substr(line, 1, RSTART - 1); last = 1 }
      count = split(line, words, /[ ()]+/)
      for (i = 1; i <= count; ++i) if (words[i] ~ /\.cpp$/) print program, folder, folder "/" words[i]
      if (last || $0 ~ /\)[ ]*$/) inside = last = 0
    }' "$list"
done >"$scratch/programs"
grep -rl --include='*.cpp' 'program_folder()' apps bench house producers consumers viewer voice haptics tunnel lobby research 2>/dev/null |
  xargs -r -n 1 dirname | sort -u >"$scratch/folders"

checked=0 failed=0
while IFS= read -r folder <&3; do
  for source in "$folder"/*.cpp; do
    started=$(sed 's|^ *//.*||' "$source" | grep -oE '"/?dance-[a-z-]+"' | tr -d '"/' | sort -u) || continue
    # Those whose own source it is; else all that are made where it is, in its folder or the next above that has any.
    owners=$(awk -v source="$source" '$3 == source { print $1 }' "$scratch/programs" | sort -u)
    above=$folder
    while [ -z "$owners" ] && [ "$above" != . ]; do
      owners=$(awk -v above="$above/" '{ file = $3; sub(/[^\/]*$/, "", file) } file == above || $2 "/" == above { print $1 }' "$scratch/programs" | sort -u)
      above=$(dirname "$above")
    done
    for program in $started; do
      # What this build leaves out is built for nobody.
      grep -q "^${program#dance-} " "$commands" || continue
      checked=$((checked + 1))
      [ -n "$owners" ] || { echo "$source: no program's CMakeLists.txt is above it"; failed=1; }
      for owner in $owners; do
        grep -q "^$owner " "$commands" || continue
        grep -qE "^$owner( .*)? $program( |\$)" "$commands" && continue
        echo "$source: starts $program, which is not among the NEEDS of dance_program($owner …): ./dance does not build it"
        failed=1
      done
    done
  done
done 3<"$scratch/folders"
[ "$checked" -gt 0 ] || { echo "no source starts a program: the check itself is broken"; failed=1; }
echo "$checked programs that sources start"
exit $failed
