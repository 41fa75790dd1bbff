#!/usr/bin/env bash
# tidy.sh [--seconds N] [--newest COMMITS | FILE…]: clang-tidy with the checks of .clang-tidy over the sources of the newest
# commits, over the given files, or, without either, over the whole tree, which takes hours.
#   --seconds N   no file is begun after N seconds; the number of files that are left out is printed
# A header is checked with the source of the same name. Needs clang and clang-tidy. Fails if a file has a finding.
set -euo pipefail
cd "$(dirname "$0")/.."
seconds=86400 files=()
while [ $# -gt 0 ]; do
  case "$1" in
    -h | --help) sed -n '2,6s/^# \{0,1\}//p' "$0"; exit 0 ;;
    --seconds) seconds=${2:?--seconds takes a number}; shift ;;
    --newest)
      # The newest first, each once.
      mapfile -t files < <(git log --format= --name-only --no-renames -n "${2:?--newest takes a number of commits}" -- '*.cpp' |
        awk '!seen[$0]++' | while read -r file; do [ ! -f "$file" ] || echo "$file"; done)
      [ ${#files[@]} -gt 0 ] || { echo "tidy.sh: no source changed in $2 commits"; exit 0; }
      shift
      ;;
    -*) echo "tidy.sh: there is no option '$1'; --help lists them" >&2; exit 2 ;;
    *) files+=("$1") ;;
  esac
  shift
done
command -v clang-tidy >/dev/null || { echo "tidy.sh: apt-get install clang-tidy" >&2; exit 1; }
[ ${#files[@]} -gt 0 ] || mapfile -t files < <(git ls-files '*.cpp')
build=build/tidy
mkdir -p $build
# The dev preset makes no unity files, so each source is checked by itself.
cmake --preset dev -B $build -DCMAKE_CXX_COMPILER=clang++ -DCMAKE_C_COMPILER=clang >$build.configure.log 2>&1 ||
  { tail -n 30 $build.configure.log; exit 1; }
mapfile -t generated < <(ninja -C $build -t targets all | sed -n 's/^\([^ ]*\.\(h\|hpp\)\): CUSTOM_COMMAND$/\1/p')
ninja -C $build "${generated[@]}" >$build.log 2>&1 || { tail -n 30 $build.log; exit 1; }
rm -rf $build/findings && mkdir -p $build/findings
tidy_one() { # DEADLINE BUILD FILE
  local log=$2/findings/${3//\//,}
  (($(date +%s) <= $1)) || { touch "$log.left_out"; return 0; }
  grep -qF "\"file\": \"$PWD/$3\"" "$2/compile_commands.json" || return 0 # of a part that is not built here
  clang-tidy --quiet -p "$2" --header-filter="/${3%.cpp}\\.h\$" "$3" >"$log" 2>&1 && rm "$log" || true
}
export -f tidy_one
deadline=$(($(date +%s) + seconds))
printf '%s\n' "${files[@]}" | xargs -r -P "$(nproc)" -I{} bash -c 'tidy_one "$0" "$1" "$2"' "$deadline" $build {}
left_out=$(find $build/findings -name '*.left_out' | wc -l)
rm -f $build/findings/*.left_out
[ "$left_out" = 0 ] || echo "tidy.sh: $left_out of ${#files[@]} files were left out after $seconds s"
if [ -n "$(ls $build/findings)" ]; then
  sed '/warnings generated\.$/d' $build/findings/*
  exit 1
fi
echo "tidy.sh: $((${#files[@]} - left_out)) files without a finding"
