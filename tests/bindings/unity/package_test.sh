#!/bin/sh
# Every file and folder of the Unity package as it is installed has a .meta file with an identity of its own: without one
# Unity leaves out what lies in a package that it cannot write to, and scenes lose their components at each update.
set -eu
cd "$(dirname "$0")/../../.."
package=bindings/unity failed=0
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cp -r "$package" "$scratch/package"
cp bindings/csharp/*.cs "$scratch/package/Runtime"
touch "$scratch/package/LICENSE" "$scratch/package/Runtime/Plugins/x86_64/libdance_adapter.so"
cd "$scratch/package"
find . -mindepth 1 ! -name '*.meta' >"$scratch/things"
while read -r thing; do
  [ -e "$thing.meta" ] || { echo "FAILED: $thing has no .meta"; failed=1; }
done <"$scratch/things"
find . -name '*.meta' >"$scratch/metas"
while read -r meta; do
  [ -e "${meta%.meta}" ] || { echo "FAILED: $meta belongs to nothing"; failed=1; }
  grep -qxE 'guid: [0-9a-f]{32}' "$meta" || { echo "FAILED: $meta has no guid"; failed=1; }
  sed -n 's/^guid: //p' "$meta" >>"$scratch/guids"
done <"$scratch/metas"
[ -z "$(sort "$scratch/guids" | uniq -d)" ] || { echo "FAILED: two have one guid"; failed=1; }
grep -A4 'Standalone: Linux64' Runtime/Plugins/x86_64/libdance_adapter.so.meta | grep -q 'enabled: 1' ||
  { echo "FAILED: the library is not for Linux"; failed=1; }
[ "$failed" = 0 ] && echo "$(wc -l <"$scratch/guids") parts of the package have their .meta"
exit $failed
