#!/bin/sh
# A house changes its network while it is in a room: the session goes on from the new address, at once and unasked.
# Called within a network namespace of its own (tests/private_network.sh): roaming_test.sh FOLDER_OF_PROGRAMS
set -eu
bin=$1
if [ "${2:-}" != house ]; then
  work=$(mktemp -d)
  trap 'kill $server 2>/dev/null || true; rm -rf "$work"' EXIT
  export XDG_CONFIG_HOME="$work/config"
  server=
  unshare -n true 2>/dev/null || { echo "[  SKIPPED ] no second network namespace can be made here"; exit 0; }
  "$bin/dance-server" --new-guest alice --address 10.9.0.1 >"$work/line"
  XDG_CONFIG_HOME="$work/house" "$bin/dance-key" <"$work/line" 2>"$work/key.log"
  ip link add server-end type veth peer name house-end
  ip addr add 10.9.0.1/24 dev server-end
  ip link set server-end up
  "$bin/dance-server" --bind 10.9.0.1 --json >"$work/server.json" 2>"$work/server.log" &
  server=$!
  mkfifo "$work/apart" "$work/ready"
  XDG_CONFIG_HOME="$work/house" unshare -n "$0" "$bin" house "$work" &
  house=$!
  # Not before it has a namespace of its own.
  read -r _ <"$work/apart"
  ip link set house-end netns "$house"
  echo go >"$work/ready"
  wait "$house" || { cat "$work"/*.log; exit 1; }
  kill -INT "$server"
  wait "$server" || true
  for part in '"sessions_begun":1,' '"sessions_timed_out":0,' '"handshakes":1,' '"moves":1,' '"goodbyes":1,'; do
    grep -q "$part" "$work/server.json" ||
      { echo "the server's summary has no $part"; cat "$work/server.json" "$work"/*.log; exit 1; }
  done
  grep -q '"lapses":0,' "$work/link.json" || { echo "the link lapsed"; cat "$work/link.json"; exit 1; }
  echo "moved without a lapse"
  exit 0
fi

work=$3
echo apart >"$work/apart"
read -r _ <"$work/ready"
ip link set lo up
ip addr add 10.9.0.2/24 dev house-end
ip link set house-end up
ip route add 224.0.0.0/4 dev lo
ip link set lo multicast on
"$bin/dance-link" --server 10.9.0.1 --guest alice --json >"$work/link.json" 2>"$work/link.log" &
link=$!
tries=0
until grep -q "in room 'dance'" "$work/link.log"; do
  tries=$((tries + 1))
  [ $tries -lt 600 ] || { echo "the link does not come in"; kill "$link"; exit 1; }
  sleep 0.1
done
sleep 0.5
# One message to the kernel's watchers each: the new address first, so that there is always one.
ip addr add 10.9.0.77/24 dev house-end
ip addr change 10.9.0.77/24 dev house-end
sysctl -qw net.ipv4.conf.house-end.promote_secondaries=1 2>/dev/null || echo 1 >/proc/sys/net/ipv4/conf/house-end/promote_secondaries
ip addr del 10.9.0.2/24 dev house-end
sleep 2
kill -INT "$link"
wait "$link"
