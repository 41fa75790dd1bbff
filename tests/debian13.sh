#!/usr/bin/env bash
# debian13.sh [FOLDER] [TEST_OPTION…]: tries the README's commands on Debian 13, before a release: makes a fresh system in
# FOLDER (default: build/debian13, kept for the next run), clones this tree's HEAD into it, and runs ./dance demo --headless and
# ./dance test there. Needs root, mmdebstrap and some 8 GB; takes most of an hour. Fails when the tests fail, or when an
# optional part is left out although ./dance has installed its packages.
set -euo pipefail
tree=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
if [ "${1:-}" != --inside ]; then
  case "${1:-}" in -h | --help) sed -n '2,5s/^# \{0,1\}//p' "$0"; exit 0 ;; esac
  folder=$tree/build/debian13
  case "${1:-}" in "" | -*) ;; *) folder=$(realpath -m "$1"); shift ;; esac
  [ "$(id -u)" = 0 ] || { echo "debian13.sh: run it as root: it makes a system in a folder" >&2; exit 1; }
  command -v mmdebstrap >/dev/null || { echo "debian13.sh: apt-get install mmdebstrap" >&2; exit 1; }
  # The mounts of the new system end with the process that has them.
  exec unshare --mount --pid --fork --kill-child "$0" --inside "$folder" "$@"
fi
folder=$2
shift 2
[ -x "$folder/usr/bin/apt-get" ] || mmdebstrap --variant=apt trixie "$folder"
for file in resolv.conf hosts; do cp "/etc/$file" "$folder/etc/$file"; done
mount -t proc proc "$folder/proc"
mount -t sysfs sysfs "$folder/sys"
mount -t tmpfs tmpfs "$folder/dev/shm"
mount -t devpts -o newinstance,ptmxmode=0666 devpts "$folder/dev/pts"
[ -e "$folder/dev/ptmx" ] || ln -s pts/ptmx "$folder/dev/ptmx"
in_there() { chroot "$folder" env -i HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin LANG=C.UTF-8 "$@"; }
# An earlier build there is kept: only what has changed since is built again.
clone=$folder/root/dancegraph
[ -d "$clone" ] || git clone -q "$tree" "$clone"
git -C "$clone" fetch -q "$tree" HEAD
git -C "$clone" checkout -q --force FETCH_HEAD
in_there sh -c 'cd /root/dancegraph && ./dance demo --headless --seconds 5 --out /root/demo && ls -l /root/demo'
code=0
in_there sh -c 'cd /root/dancegraph && exec ./dance test "$@"' sh "$@" || code=$?
# The packages of these three are not among those of ./dance test.
left_out=$(sed -n 's/^-- *\(.*[^ ]\) *missing .*/\1/p' "$clone/build/release.configure.log" |
  grep -vxE 'Benchmarks|ENet to compare with|Types for lcm-spy' | paste -sd, || true)
[ -z "$left_out" ] || { echo "debian13.sh: left out on Debian 13: $left_out" >&2; code=1; }
exit $code
