#!/bin/sh
# Every relative link in the documents, and every file that they name in one of the tree's folders, exists.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
cd "$here/../.."
found=$(mktemp)
trap 'rm -f "$found"' EXIT
folders='core|lcmtypes|producers|consumers|transformers|manager|tunnel|viewer|tools|tests|bench|docs|cmake'

"$here/sources.sh" .md | while IFS= read -r file; do
  # Links: [text](target), but what goes to the web or stays on the page.
  { grep -oE '\]\([^)]+\)' "$file" || true; } | sed 's/^](//; s/)$//; s/#.*//' |
    { grep -vE '^([a-z]+:|$)' || true; } | while IFS= read -r target; do
      [ -e "$(dirname "$file")/$target" ] || echo "$file: links to $target, which does not exist"
    done
  # `folder/file`; patterns with <name> or * do not match. x.h/.cpp is a pair.
  { grep -oE "\`($folders)/[A-Za-z0-9_./-]+\`" "$file" || true; } | tr -d '`' | sed 's|\.h/\.cpp$|.h|' |
    while IFS= read -r target; do
      [ -e "$target" ] || echo "$file: names $target, which does not exist"
    done
done >"$found"
cat "$found"
[ ! -s "$found" ]
