#!/bin/sh
# Every relative link in the documents leads to a file, and its #anchor to a heading there (GitHub's rule for the names
# of anchors); every file of the tree that a document or a comment names exists.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
cd "$here/../.."
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
folders='apps|bench|bindings|cmake|consumers|core|data|docs|examples|formats|haptics|house|lcmtypes|logs|manager|packaging|producers|research|sessions|testing|tests|transformers|tunnel|viewer|voice'
"$here/sources.sh" .md >"$scratch/documents"

# FILE#ANCHOR for each heading: lower case, no punctuation but - and _, blanks to -, and -1, -2 where one comes again.
xargs -r awk '
  FNR == 1 { split("", times); fenced = 0 }
  /^```/ { fenced = !fenced }
  fenced || !/^#+ / { next }
  {
    sub(/^#+ +/, "")
    while (match($0, /\]\([^)]*\)/)) $0 = substr($0, 1, RSTART - 1) substr($0, RSTART + RLENGTH)
    gsub(/[!-,.\/:-@[-^`{-~]|–|—|…|·|’|“|”|→|×/, "")
    gsub(/ /, "-")
    anchor = tolower($0)
    suffix = times[anchor]++ ? "-" (times[anchor] - 1) : ""
    print FILENAME "#" anchor suffix
  }' <"$scratch/documents" >"$scratch/anchors"

anchored() { # anchored FILE#ANCHOR
  grep -qxF -- "$1" "$scratch/anchors"
}

while IFS= read -r file; do
  # Links: [text](target), but what goes to the web.
  { grep -oE '\]\([^)]+\)' "$file" || true; } | sed 's/^](//; s/)$//' |
    { grep -vE '^[a-z]+:' || true; } | while IFS= read -r target; do
      path=${target%%#*}
      place=$file
      [ -z "$path" ] || place=$(dirname "$file")/$path
      if [ ! -e "$place" ]; then
        echo "$file: links to $path, which does not exist"
        continue
      fi
      case $target in
        *#*)
          # a/../b is b, as headings are listed by their path from the root.
          place=$(realpath -m --relative-to=. "$place")
          anchored "$place#${target#*#}" || echo "$file: links to $target, but $place has no such heading"
          ;;
      esac
    done
  # `folder/file`; patterns with <name> or * do not match. x.h/.cpp is a pair.
  { grep -oE "\`($folders)/[A-Za-z0-9_./-]+\`" "$file" || true; } | tr -d '`' | sed 's|\.h/\.cpp$|.h|' |
    while IFS= read -r target; do
      [ -e "$target" ] || echo "$file: names $target, which does not exist"
    done
done <"$scratch/documents" >"$scratch/found"

# Comments: // or #, and in them folder/file.ending, of a page with its #anchor. self_test.sh has invented ones.
"$here/sources.sh" .h .cpp .lcm .sh .cmake .toml .service CMakeLists.txt | { grep -v 'checks/self_test.sh$' || true; } |
  xargs -r grep -HoE "(//|# ).*[^A-Za-z0-9_./<-]($folders)/[A-Za-z0-9_/-]+\.(h|cpp|md|sh|txt|toml)(#[a-z0-9_-]+)?\b.*" |
  awk -v folders="$folders" '
  {
    file = $0
    sub(/:.*/, "", file)
    text = substr($0, length(file) + 2)
    pattern = "[^A-Za-z0-9_./<-](" folders ")/[A-Za-z0-9_/-]+[.](h|cpp|md|sh|txt|toml)(#[a-z0-9_-]+)?"
    while (match(text, pattern)) {
      print file, substr(text, RSTART + 1, RLENGTH - 1)
      text = substr(text, RSTART + RLENGTH)
    }
  }' | sort -u | while read -r file target; do
  if [ ! -e "${target%%#*}" ]; then
    echo "$file: names ${target%%#*}, which does not exist"
  else
    case $target in
      *#*) anchored "$target" || echo "$file: names $target, but there is no such heading" ;;
    esac
  fi
done >>"$scratch/found"
cat "$scratch/found"
[ ! -s "$scratch/found" ]
