#!/bin/sh
# Lists the tree's own files whose names end as the arguments say (.h .cpp …), one a line, from the root: what git tracks,
# or, where the tree is no clone, what lies outside build and out.
set -eu
cd "$(dirname "$0")/../.."
pattern=$(printf '%s\n' "$@" | sed 's/\./\\./g; s/$/$/' | paste -sd '|')
if git rev-parse --is-inside-work-tree >/dev/null 2>&1; then
  git ls-files
else
  find . \( -path ./build -o -path ./out -o -path ./.git \) -prune -o -type f -print | sed 's|^\./||'
fi | while IFS= read -r file; do
  # Tracked, but deleted in the work tree: nothing to check.
  if [ -f "$file" ]; then printf '%s\n' "$file"; fi
done | grep -E "$pattern"
