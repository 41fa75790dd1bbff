#!/usr/bin/env bash
# Fetches the networks that see a dancer, of Google, Apache-2.0, from npm packages: the body's of @mediapipe/pose (BlazePose),
# without which nothing is seen, and those of hands and face of @mediapipe/holistic. Where they lie already it does nothing and
# needs no network; each file is checked against its sum before it takes its place. In the source tree that is models/pose;
# installed this is `dance fetch-models`, and puts them where producers/camera/estimator/model_files.h looks. Exit 0: those of
# the body are there; 1: they are not, and a line says why. A line also says where those of hands and face are missing.
set -euo pipefail
body=@mediapipe/pose@0.5.1675469404
hands=@mediapipe/holistic@0.5.1675471629
script=$(readlink -f "${BASH_SOURCE[0]}")
if [ -n "${DANCE_POSE_MODELS:-}" ]; then
  folder=$DANCE_POSE_MODELS
elif tree=${script%/producers/camera/*} && [ "$tree" != "$script" ]; then
  folder=$tree/models/pose
elif [ "$(id -u)" = 0 ]; then
  folder=/var/lib/dancegraph/pose
else
  folder=${XDG_DATA_HOME:-$HOME/.local/share}/dancegraph/pose
fi

# sum, name here, name in the package; of a part of a file, where it begins and how many bytes it has
files() { # PACKAGE
  case $1 in
    "$body") cat <<'END' ;;
a63c614bef30d35947f13be361820b1e4e3bec9cfeebf4d11216a18373108e85 pose_detection.tflite pose_solution_packed_assets.data
f17bfbecadb61c3be1baa8b8d851cc6619c870a87167b32848ad20db306b9d61 pose_landmark_lite.tflite pose_landmark_lite.tflite
e9a5c5cb17f736fafd4c2ec1da3b3d331d6edbe8a0d32395855aeb2cdfd64b9f pose_landmark_full.tflite pose_landmark_full.tflite
59e42d71bcd44cbdbabc419f0ff76686595fd265419566bd4009ef703ea8e1fe pose_landmark_heavy.tflite pose_landmark_heavy.tflite
END
    "$hands") cat <<'END' ;;
67d996ce96f9d36fe17d2693022c6da93168026ab2f028f9e2365398d8ac7d5d hand_recrop.tflite holistic_solution_packed_assets.data 9464955 123792
8c026882c9ec059ce0f8e75266bee5a9a23c341a40e0000df755374d3d1b9b68 hand_landmark_full.tflite holistic_solution_packed_assets.data 3986256 5478688
3bc182eb9f33925d9e58b5c8d59308a760f4adea8f282370e428c51212c26633 face_detection_short_range.tflite holistic_solution_packed_assets.data 0 229032
c603fa6149219a3e9487dc9abd7a0c24474c77263273d24868378cdf40aa26d1 face_landmark.tflite holistic_solution_packed_assets.data 248408 1241896
END
  esac
}

fail() {
  printf 'fetch_pose_models: %s\n' "$*" >&2
  exit 1
}

has_sum() { # SUM FILE
  [ -f "$2" ] && printf '%s  %s\n' "$1" "$2" | sha256sum --check --status -
}

all_there() { # PACKAGE
  local sum name rest
  while read -r sum name rest; do
    has_sum "$sum" "$folder/$name" || return 1
  done < <(files "$1")
}

# In a shell of its own, so that one package's failure is not the other's.
fetch() ( # PACKAGE
  package=$1
  mkdir -p "$folder" || exit 1
  # In the same file system, so that taking its place is one step.
  scratch=$(mktemp -d "$folder/.fetch.XXXXXX") || exit 1
  trap 'rm -rf "$scratch"' EXIT
  # A silent network is no reason to wait for minutes.
  timeout 180 npm pack --loglevel error --fetch-retries 1 --fetch-timeout 20000 --pack-destination "$scratch" "$package" >/dev/null 2>"$scratch/log" ||
    fail "$package cannot be fetched: $(grep -m 1 -E 'code|network|ERR' "$scratch/log" || echo "no answer"); look at the network and run this again"
  tar -xzf "$scratch"/*.tgz -C "$scratch" || fail "what came of $package is no archive; run this again"
  # All of them are checked before the first is installed: a reader finds the old files or the new ones.
  while read -r sum name source from size; do
    [ -f "$scratch/package/$source" ] || fail "$package has no $source in it; run this again"
    if [ -n "$from" ]; then
      tail -c "+$((from + 1))" "$scratch/package/$source" | head -c "$size" >"$scratch/$name" || true # head ends tail
    else
      mv "$scratch/package/$source" "$scratch/$name"
    fi
    has_sum "$sum" "$scratch/$name" || fail "$source of $package is not the file that is known (its sha256 is another)"
  done < <(files "$package")
  while read -r sum name source; do
    chmod 644 "$scratch/$name" && mv -f "$scratch/$name" "$folder/$name" || exit 1
  done < <(files "$package")
  printf 'fetch_pose_models: the networks of %s (Apache-2.0) lie in %s\n' "$package" "$folder" >&2
)

case "${1:-}" in
  "") ;;
  --there)
    all_there "$body"
    exit
    ;;
  -h | --help)
    cat <<END
Fetches the networks that dance capture sees a dancer with: MediaPipe Pose, and MediaPipe Holistic for hands and face,
Apache-2.0, 41 MB and 53 MB, with npm.
Usage: dance fetch-models [OPTIONS]

Options:
  -h,--help                   print this and exit
  --there                     fetches nothing: exit 0 where those of the body are there, else 1

Examples:
  dance fetch-models                            for this user: into ~/.local/share/dancegraph/pose
  sudo dance fetch-models                       for all users of this machine: into /var/lib/dancegraph/pose
  DANCE_POSE_MODELS=nets dance fetch-models     into another folder; dance capture reads the same variable
END
    exit 0
    ;;
  *)
    echo "dance fetch-models: there is no option '$1'; --help lists them" >&2
    exit 2
    ;;
esac
all_there "$body" && all_there "$hands" && exit 0
command -v npm >/dev/null || {
  all_there "$body" || fail "npm is missing, which fetches $body; install it with: apt-get install npm"
  echo "fetch_pose_models: hands and face stay unseen: npm is missing, which fetches $hands; install it with: apt-get install npm" >&2
  exit 0
}
all_there "$body" || fetch "$body"
all_there "$hands" || fetch "$hands" ||
  echo "fetch_pose_models: hands and face stay unseen, the body is seen without them" >&2
