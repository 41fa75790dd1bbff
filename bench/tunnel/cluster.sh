#!/bin/sh
# cluster.sh BIN [OPTIONS OF dance crowd]: the same crowd at one server, and at three servers that three NATS servers join, one after
# the other on this machine, and what the second costs beside the first. Poses of a crowd need processor time when they are due: with
# RUN="chrt -f 10" servers and crowd have it before what else runs here (not the NATS servers, which would take all).
# SERVER="--share-ms 4" is for each dance server; ONLY=three leaves out the one, where a room is too large for it.
set -eu
[ $# -ge 1 ] || { echo "usage: $0 BIN [--guests 90 --rooms 10]" >&2; exit 2; }
bin=$1
shift
[ $# -gt 0 ] || set -- --guests 90 --rooms 10
nats=$(command -v nats-server || echo /usr/sbin/nats-server)
[ -x "$nats" ] || { echo "nats-server is missing: apt-get install nats-server" >&2; exit 1; }
here=$(mktemp -d)
export XDG_RUNTIME_DIR="$here"
started=
end() {
  for process in $started; do kill "$process" 2>/dev/null || true; done
  wait
  rm -rf "$here"
}
trap end EXIT
trap 'exit 1' INT TERM

cluster= routes=
for i in 1 2 3; do
  cluster=$cluster${cluster:+,}nats://127.0.0.1:2522$i
  routes=$routes${routes:+,}nats://127.0.0.1:2622$i
done
for i in 1 2 3; do
  "$nats" -js -sd "$here/nats-$i" -a 127.0.0.1 -p "2522$i" -n "nats-$i" --cluster_name dance \
    --cluster "nats://127.0.0.1:2622$i" --routes "$routes" -l "$here/nats-$i.log" &
  started="$started $!"
done
sleep 2
${RUN:-} "$bin/dance-server" --port 25400 --max-sessions 512 ${SERVER:-} 2>>"$here/talk" &
started="$started $!"
one="--server 127.0.0.1:25400 --cpu-of $!"
three=
for i in 1 2 3; do
  ${RUN:-} "$bin/dance-server" --port "2540$i" --max-sessions 512 ${SERVER:-} --cluster "$cluster" \
    --cluster-address "127.0.0.1:2540$i" 2>>"$here/talk" &
  started="$started $!"
  three="$three --server 127.0.0.1:2540$i --cpu-of $!"
done
sleep 4

number() { sed -n "s/.*\"summary\":true.*\"$2\":\([0-9.]*\).*/\1/p" "$1"; }
measure() {
  name=$1 servers=$2
  shift 2
  # Unquoted: several words.
  ${RUN:-} "$bin/dance-crowd" $servers --decode 1 --seconds 8 --join-rate 100 --json "$@" >"$here/$name" || {
    tail -n 5 "$here/talk" >&2
    exit 1
  }
  printf '%-6s %11s %10s %8s %8s %12s\n' "$name" "$(number "$here/$name" delivered)" "$(number "$here/$name" missed)" \
    "$(number "$here/$name" p50_us)" "$(number "$here/$name" p99_us)" "$(number "$here/$name" server_us_per_delivered_pose)"
}
echo "dance crowd $*, 8 s"
printf '%-6s %11s %10s %8s %8s %12s\n' servers delivered missed 'p50 µs' 'p99 µs' 'µs a delivery'
[ "${ONLY:-}" = three ] || measure one "$one" "$@"
measure three "$three" "$@"
[ "${ONLY:-}" = three ] || awk -v one="$(number "$here/one" server_us_per_delivered_pose)" -v three="$(number "$here/three" server_us_per_delivered_pose)" \
  -v p50="$(number "$here/one" p50_us)" -v after="$(number "$here/three" p50_us)" \
  'BEGIN { printf "three beside one: %.2f of the processor time a delivery, %+.0f µs at the median\n", three / one, after - p50 }'
