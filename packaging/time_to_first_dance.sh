#!/usr/bin/env bash
# How long it takes from a Debian package to the dance.
#   sudo packaging/time_to_first_dance.sh dancegraph_*.deb          on this machine: installs it where it is not installed
#   sudo packaging/time_to_first_dance.sh --fresh dancegraph_*.deb  in a fresh Debian of this machine's release, made with
#                                                                   mmdebstrap (not counted) in a folder and removed again;
#                                                                   its packages are fetched
#   … --fresh dancegraph_*.deb --with PACKAGE,…                     the same where these are there before, as libgl1-mesa-dri,libpulse0
#                                                                   or task-xfce-desktop on a desktop
# Prints the seconds of each step: apt-get's lists, fetching and setting up the package with all that it depends on, from `dance demo` to two dancers
# on one stage (one of them through the tunnel), and to the first picture of them, drawn without a display.
set -euo pipefail
main() {
  case "${1:-}" in
    --fresh)
      case $#:${3:-} in
        2:) in_fresh_debian "$2" "" ;;
        4:--with) in_fresh_debian "$2" "$4" ;;
        *) echo "wrong use; see: $0 --help" >&2; exit 2 ;;
      esac ;;
    --inside) measure "$2" ;;
    "" | -*) sed -n '2,10s/^# \{0,1\}//p' "$0"; [ "${1:-}" = --help ] || exit 2 ;;
    *) measure "$1" ;;
  esac
}

seconds_since() { # TIME: of `now`
  awk -v begin="$1" -v end="$(now)" 'BEGIN { printf "%.1f", end - begin }'
}
now() { date +%s.%N; }
print_row() { printf '%-44s %6s s\n' "$1" "$2"; }

in_fresh_debian() { # PACKAGE THOSE-THAT-ARE-THERE
  command -v mmdebstrap >/dev/null || { echo "mmdebstrap is missing; install it with: apt-get install mmdebstrap" >&2; exit 1; }
  [ "$(id -u)" = 0 ] || { echo "--fresh makes a system in a folder, which only root may" >&2; exit 1; }
  local package release sources=/etc/apt/sources.list.d/debian.sources
  package=$(realpath "$1")
  root=$(mktemp -d) # not local: the trap comes after this function
  # Its mounts are in a namespace of their own, and gone with it.
  trap 'rm -rf --one-file-system "$root"' EXIT
  [ -e "$sources" ] || sources=/etc/apt/sources.list
  # A package is for the release that it was made on.
  release=$(. /etc/os-release && echo "${VERSION_CODENAME:?this is no Debian}")
  echo "making a Debian $release (not counted)" >&2
  mmdebstrap --quiet --variant=apt ${2:+--include="$2"} "$release" "$root/debian" "$sources"
  # As on a machine that was just installed: the lists of packages are not there yet.
  rm -rf "$root"/debian/var/lib/apt/lists/*
  cp "$package" "$root/debian/root/dancegraph.deb"
  cp "${BASH_SOURCE[0]}" "$root/debian/root/time.sh"
  cp -L /etc/resolv.conf "$root/debian/etc/resolv.conf" 2>/dev/null || true
  unshare --mount --pid --fork sh -euc '
    mount --make-rprivate /
    mount -t proc proc "$0/proc"
    mount --rbind /dev "$0/dev"
    mount --rbind /sys "$0/sys"
    exec chroot "$0" env HOME=/root LC_ALL=C bash /root/time.sh --inside /root/dancegraph.deb' "$root/debian"
}

measure() { # PACKAGE
  local package begin first out
  package=$(realpath "$1")
  first=$(now)
  if [ "$(dpkg-query -W -f '${db:Status-Status}' dancegraph 2>/dev/null)" != installed ]; then
    out=$(mktemp)
    begin=$(now)
    apt-get update >"$out" 2>&1 || { cat "$out" >&2; exit 1; }
    print_row "apt-get update" "$(seconds_since "$begin")"
    # In two steps, as the first depends on the network alone.
    begin=$(now)
    apt-get install -y --download-only "$package" >"$out" 2>&1 || { tail -n 20 "$out" >&2; exit 1; }
    print_row "apt-get install, $(grep -c '^Get:' "$out") files fetched" "$(seconds_since "$begin")"
    begin=$(now)
    DEBIAN_FRONTEND=noninteractive apt-get install -y "$package" >"$out" 2>&1 || { tail -n 20 "$out" >&2; exit 1; }
    print_row "apt-get install, $(grep -c '^Setting up' "$out") packages set up" "$(seconds_since "$begin")"
    rm "$out"
  fi
  time_demo "$first"
}

# time_demo TIME: from the start of `dance demo`, and from TIME on.
time_demo() {
  local out begin program stage="" picture="" give_up
  out=$(mktemp -d)
  begin=$(now)
  dance demo --headless --seconds 6 --out "$out" >"$out/summary" 2>&1 &
  program=$!
  give_up=$((SECONDS + 120))
  while kill -0 "$program" 2>/dev/null && { [ -z "$stage" ] || [ -z "$picture" ]; } && ((SECONDS < give_up)); do
    # House A records its bus: both dancers' poses on its stage.
    if [ -z "$stage" ] && grep -qsa POSE/stage/alice "$out/demo.lcm" && grep -qsa POSE/stage/bob "$out/demo.lcm"; then
      stage="$(seconds_since "$begin") $(seconds_since "$1")"
    fi
    if [ -z "$picture" ] && tail -c 12 "$out/stage-0001.png" 2>/dev/null | grep -qa IEND; then
      picture="$(seconds_since "$begin") $(seconds_since "$1")"
    fi
    sleep 0.05
  done
  wait "$program" || { cat "$out/summary" >&2; exit 1; }
  [ -n "$stage" ] && [ -n "$picture" ] || { echo "no two dancers, or no picture of them:" >&2; cat "$out/summary" >&2; exit 1; }
  print_row "dance demo, until two dancers are on a stage" "${stage% *}"
  print_row "dance demo, until its first picture" "${picture% *}"
  print_row "in all, until two dancers are on a stage" "${stage#* }"
  print_row "in all, until the first picture" "${picture#* }"
  rm -rf "$out"
}

main "$@"
