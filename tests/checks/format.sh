#!/bin/sh
# format.sh [tests|product]: every source file is as clang-format leaves it: all, those of tests/, or all others. Another version
# formats differently: then the check is skipped, and the output says so.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
cd "$here/../.."
formatter=$(command -v clang-format-14 || command -v clang-format || true)
case $("${formatter:-false}" --version 2>/dev/null || true) in
  *"version 14."*) ;;
  *) echo "[  SKIPPED ] clang-format 14 is not here: apt-get install clang-format"; exit 0 ;;
esac
case "${1:-}" in
  tests) only='^tests/' ;;
  product) only='-v ^tests/' ;;
  "") only=. ;;
  *) echo "format.sh takes tests, product or nothing" >&2; exit 2 ;;
esac
"$here/sources.sh" .h .cpp | grep $only | xargs "$formatter" --dry-run -Werror
