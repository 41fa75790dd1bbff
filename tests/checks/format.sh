#!/bin/sh
# Every source file as clang-format leaves it. Another version formats differently: then the check is skipped, and says so.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
cd "$here/../.."
formatter=$(command -v clang-format-14 || command -v clang-format || true)
case $("${formatter:-false}" --version 2>/dev/null || true) in
  *"version 14."*) ;;
  *) echo "[  SKIPPED ] clang-format 14 is not here: apt-get install clang-format"; exit 0 ;;
esac
"$here/sources.sh" .h .cpp | xargs "$formatter" --dry-run -Werror
