#!/bin/sh
# docs_commands.sh BIN: every `dance …` or `./dance …` line in a ```sh block of README.md, CONTRIBUTING.md, docs/, logs/ and examples/ names a
# program and options that the programs in BIN have; a line that ends in `# runs in CI` is run, in a private network,
# and must exit 0.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
bin=$(cd "${1:?give the folder of the built programs}" && pwd)
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cd "$root"

# file:line:command, with continued lines joined.
for file in README.md CONTRIBUTING.md docs/*.md logs/README.md examples/README.md; do
  [ -f "$file" ] || continue
  awk -v file="$file" '
    /^```/ { inside = ($0 == "```sh"); next }
    inside {
      if (joined == "") first = FNR
      joined = joined $0
      if (sub(/\\$/, "", joined)) next
      if (joined ~ /^(\.\/)?dance /) { sub(/^(\.\/)?dance +/, "", joined); print file ":" first ":" joined }
      joined = ""
    }' "$file"
done >"$scratch/commands"

checked=0 ran=0 failed=0
wrong() { echo "$1"; failed=1; }

# Every program is a command that `dance help` lists.
"$bin/dance" help >"$scratch/listed"
for program in "$bin"/dance-*; do
  name=$(basename "$program" | sed 's/^dance-//')
  tr - ' ' <"$scratch/listed" | grep -qE "^  $(echo "$name" | tr - ' ') " ||
    wrong "apps/front/front_main.cpp: dance help does not list dance-$name"
done

while IFS= read -r entry <&3; do
  file=${entry%%:*}
  rest=${entry#*:}
  place=$file:${rest%%:*}
  command=${rest#*:}
  checked=$((checked + 1))
  words=$(printf '%s\n' "$command" | sed 's/ *#.*//; s/"[^"]*"/QUOTED/g; s/ *[|>&].*//')
  set -f
  # shellcheck disable=SC2086
  set -- $words
  set +f
  program=$1
  shift
  case $program in
    test | setup) continue ;;  # the script ./dance does these itself
  esac
  # `dance bench path` is dance-bench-path, `dance capture solve eval` dance-capture-solve-eval.
  if [ $# -gt 1 ] && [ -x "$bin/dance-$program-$1-$2" ]; then
    program=$program-$1-$2
    shift 2
  elif [ $# -gt 0 ] && [ -x "$bin/dance-$program-$1" ]; then
    program=$program-$1
    shift
  fi
  if [ ! -x "$bin/dance-$program" ]; then
    wrong "$place: there is no program dance-$program"
    continue
  fi
  subcommand=""
  case ${1:-} in
    *[!a-z-]*) ;;  # a file
    [a-z]*) "$bin/dance-$program" --help 2>/dev/null | grep -qE "^  $1( |\$)" && subcommand=$1 ;;
  esac
  # shellcheck disable=SC2086
  if ! "$bin/dance" $(echo "$program" | tr - ' ') $subcommand --help >"$scratch/help" 2>&1 </dev/null; then
    wrong "$place: dance-$program $subcommand --help fails"
    continue
  fi
  for word in "$@"; do
    case $word in
      --*) grep -qE -- "(^|[ ,])${word%%=*}([^a-z-]|\$)" "$scratch/help" ||
        wrong "$place: dance $program $subcommand has no option ${word%%=*}" ;;
    esac
  done
  case $command in
    *"# runs in CI"*)
      ran=$((ran + 1))
      mkdir -p "$scratch/run"
      # The recordings that come with the tree, as a reader in its folder has them.
      [ -d "$scratch/run/logs" ] || cp -r "$root/logs" "$scratch/run/"
      if ! (cd "$scratch/run" && PATH="$bin:$PATH" timeout 300 "$root/tests/private_network.sh" \
        sh -c "dance ${command%%#*}") >"$scratch/output" 2>&1 </dev/null; then
        wrong "$place: exits with an error: dance $command"
        tail -n 20 "$scratch/output"
      elif grep -qF '[  SKIPPED ] no network' "$scratch/output"; then
        echo "$place: not run, as no network namespace can be made here"
      fi
      ;;
  esac
done 3<"$scratch/commands"

[ "$checked" -gt 0 ] || wrong "no command found in the documents: the check itself is broken"
echo "$checked commands checked, $ran of them run"
exit $failed
