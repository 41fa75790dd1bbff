#!/usr/bin/env bash
# Fetches the npm packages that tests use as independent readers (package.json) into build/clients. Where they lie already
# it does nothing and needs no network. Exit 0: all are there; 1: they are not, and a line says why.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
folder=$(cd "$here/../.." && pwd)/build/clients
sum=$(sha256sum <"$here/package.json")
[ "$(cat "$folder/fetched" 2>/dev/null)" = "$sum" ] && exit 0
fail() {
  printf 'fetch_clients: %s\n' "$*" >&2
  exit 1
}
command -v npm >/dev/null || fail "npm is missing; install it with: apt-get install npm"
mkdir -p "$folder"
cp "$here/package.json" "$folder/"
# A silent network is no reason to wait for minutes. No package may run a script of its own here.
(cd "$folder" && timeout 300 npm install --ignore-scripts --no-audit --no-fund --omit=optional --loglevel error \
  --fetch-retries 1 --fetch-timeout 20000 >log 2>&1) ||
  fail "the npm packages cannot be fetched: $(grep -m 1 -E 'code|network|ERR' "$folder/log" || echo "no answer")"
echo "$sum" >"$folder/fetched"
