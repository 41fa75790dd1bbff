#!/usr/bin/env bash
# producers/camera/fetch_pose_models.sh with a package registry of the test's own: an npm that packs what the test lays out. The script is
# the tree's but for the sums, which are those of small files.
set -euo pipefail
source_tree=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
failed=0
unset DANCE_POSE_MODELS

tree=$scratch/tree package=$scratch/registry/package bin=$scratch/bin models=$scratch/tree/models/pose
script=$tree/producers/camera/fetch_pose_models.sh
mkdir -p "$tree/producers/camera" "$package" "$bin"

# Only what the script may use is there to be used.
for tool in bash cat chmod dirname grep gzip head id mkdir mktemp mv readlink rm sha256sum tail tar timeout; do
  ln -s "$(command -v "$tool")" "$bin/$tool"
done
cat >"$bin/npm" <<END
#!$(command -v bash)
echo "\$@" >>"$scratch/npm_calls"
[ "\$1" = pack ] || exit 64
while [ \$# -gt 1 ]; do
  [ "\$1" = --pack-destination ] && to=\$2
  shift
done
case \$1 in
  @mediapipe/holistic@*)
    [ -e "$scratch/npm_has_no_hands" ] && { echo "npm ERR! code E404" >&2; exit 1; }
    tar -czf "\$to/mediapipe-holistic.tgz" -C "$scratch/hands_registry" package
    exit
    ;;
esac
[ -e "$scratch/npm_fails" ] && { echo "npm ERR! code ENOTFOUND" >&2; exit 1; }
[ -e "$scratch/npm_sends_rubbish" ] && { echo rubbish >"\$to/rubbish.tgz"; exit 0; }
[ -e "$scratch/npm_sends_nothing" ] && exit 0
tar -czf "\$to/mediapipe-pose.tgz" -C "$scratch/registry" package
END
chmod +x "$bin/npm"

sources=(pose_solution_packed_assets.data pose_landmark_lite.tflite pose_landmark_full.tflite pose_landmark_heavy.tflite)
names=(pose_detection.tflite pose_landmark_lite.tflite pose_landmark_full.tflite pose_landmark_heavy.tflite)
hand_names=(hand_recrop.tflite hand_landmark_full.tflite face_detection_short_range.tflite face_landmark.tflite)
hand_package=$scratch/hands_registry/package
mkdir -p "$hand_package"
lay_out_package() {
  local source
  # Four parts of one file, with a byte before each.
  printf '.%s' "${hand_names[@]}" >"$hand_package/holistic_solution_packed_assets.data"
  for source in "${sources[@]}"; do
    printf 'the network in %s\n' "$source" >"$package/$source"
    chmod 600 "$package/$source" # as careless as a package may be
  done
}
lay_out_package
cp "$source_tree/producers/camera/fetch_pose_models.sh" "$script"
for source in "${sources[@]}"; do
  sum=$(sha256sum <"$package/$source")
  sed -i -E "s/^[0-9a-f]{64} (\S+) $source\$/${sum%% *} \1 $source/" "$script"
done
from=1
for name in "${hand_names[@]}"; do
  sum=$(printf '%s' "$name" | sha256sum)
  sed -i -E "s/^[0-9a-f]{64} $name (\S+) [0-9]+ [0-9]+\$/${sum%% *} $name \1 $from ${#name}/" "$script"
  from=$((from + ${#name} + 1))
done
[ "$(diff "$source_tree/producers/camera/fetch_pose_models.sh" "$script" | grep -c '^>')" = 8 ] || {
  echo "the sums of the script are not where this test looks for them"
  exit 1
}

fetch() { # WORD…: exit code in $code, what it said in $said
  code=0
  said=$(PATH="$bin" "$script" "$@" 2>&1) || code=$?
}
wrong() {
  printf '%s: %s\n  exit %s, said: %s\n' "$case" "$*" "$code" "$said"
  failed=1
}
expect_code() { [ "$code" = "$1" ] || wrong "exits with something else than $1"; }
expect_said() { [[ "$said" == *"$1"* ]] || wrong "does not say: $1"; }
expect_calls() { # N
  local calls=0
  [ ! -f "$scratch/npm_calls" ] || calls=$(wc -l <"$scratch/npm_calls")
  [ "$calls" = "$1" ] || wrong "npm was asked $calls times, not $1"
}
expect_all_there() {
  local i
  for i in "${!names[@]}"; do
    printf 'the network in %s\n' "${sources[$i]}" | cmp -s - "$models/${names[$i]}" || wrong "${names[$i]} is not what was fetched"
    [ "$(stat -c %a "$models/${names[$i]}")" = 644 ] || wrong "${names[$i]} cannot be read by everybody"
  done
  for name in "${hand_names[@]}"; do
    [ "$(cat "$models/$name")" = "$name" ] || wrong "$name is not what was fetched"
  done
  [ "$(ls -A "$models" | wc -l)" = 8 ] || wrong "more lies there than was fetched: $(ls -A "$models")"
}
expect_only_the_body() {
  [ "$(ls -A "$models" | wc -l)" = 4 ] && [ -f "$models/pose_landmark_full.tflite" ] || wrong "lies there: $(ls -A "$models")"
}
expect_nothing_there() { [ -z "$(ls -A "$models" 2>/dev/null)" ] || wrong "lies there: $(ls -A "$models")"; }
begin() { # CASE: an empty folder and a good registry
  case=$1
  rm -rf "$models" "$scratch"/npm_*
  lay_out_package
}

begin "nothing there, and only asked"
fetch --there
expect_code 1
expect_calls 0
expect_nothing_there

begin "a good package"
fetch
expect_code 0
expect_said "@mediapipe/pose@"
expect_said "@mediapipe/holistic@"
expect_calls 2
expect_all_there
grep -q -- '@mediapipe/pose@[0-9]' "$scratch/npm_calls" || wrong "the package has no fixed version"

case="a second time"
fetch
expect_code 0
expect_calls 2
fetch --there
expect_code 0

case="one of them was damaged since"
echo damage >>"$models/pose_landmark_full.tflite"
fetch --there
expect_code 1
fetch
expect_code 0
expect_calls 3
expect_all_there

case="a network of the hands was damaged since"
echo damage >>"$models/hand_recrop.tflite"
fetch --there
expect_code 0
fetch
expect_code 0
expect_calls 4
expect_all_there

begin "no package of hands"
touch "$scratch/npm_has_no_hands"
fetch
expect_code 0
expect_said "@mediapipe/holistic"
expect_said "E404"
expect_said "hands and face stay unseen"
expect_only_the_body

begin "another file under the name of the hands'"
echo "shorter" >"$hand_package/holistic_solution_packed_assets.data"
fetch
expect_code 0
expect_said "sha256"
expect_said "hands and face stay unseen"
expect_only_the_body

for i in "${!sources[@]}"; do
  begin "another file under the name of ${sources[$i]}"
  echo "another network" >"$package/${sources[$i]}"
  fetch
  expect_code 1
  expect_said "${sources[$i]} of @mediapipe/pose"
  expect_said "sha256"
  expect_nothing_there

  begin "a package without ${sources[$i]}"
  rm "$package/${sources[$i]}"
  fetch
  expect_code 1
  expect_said "has no ${sources[$i]}"
  expect_nothing_there
done

case="a wrong package where good files lie"
begin "$case"
fetch
echo damage >>"$models/pose_landmark_heavy.tflite"
rm "$package/pose_landmark_lite.tflite"
fetch
expect_code 1
[ "$(cat "$models/pose_landmark_full.tflite")" = 'the network in pose_landmark_full.tflite' ] || wrong "what was good is gone"

begin "no network"
touch "$scratch/npm_fails"
fetch
expect_code 1
expect_said "ENOTFOUND"
expect_said "look at the network"
expect_nothing_there

for how in rubbish nothing; do
  begin "npm brings $how"
  touch "$scratch/npm_sends_$how"
  fetch
  expect_code 1
  expect_said "no archive"
  expect_nothing_there
done

begin "no npm"
mv "$bin/npm" "$scratch/npm"
fetch
expect_code 1
expect_said "apt-get install npm"
expect_nothing_there
mv "$scratch/npm" "$bin/npm"

begin "another folder"
export DANCE_POSE_MODELS=$scratch/elsewhere
models=$DANCE_POSE_MODELS
fetch
expect_code 0
expect_all_there

begin "installed"
unset DANCE_POSE_MODELS
mkdir -p "$scratch/usr/bin"
cp "$script" "$scratch/usr/bin/dance-fetch-models"
printf '#!/bin/sh\necho 1000\n' >"$scratch/id"
chmod +x "$scratch/id"
mv "$scratch/id" "$bin/id"
script=$scratch/usr/bin/dance-fetch-models
export XDG_DATA_HOME=$scratch/data
models=$XDG_DATA_HOME/dancegraph/pose
fetch
expect_code 0
expect_all_there
fetch --help
expect_code 0
expect_said "Usage: dance fetch-models"
fetch --thre
expect_code 2

exit $failed
