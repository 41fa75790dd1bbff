#!/usr/bin/env bash
# Fetches the networks that see a dancer's pose: MediaPipe Pose (BlazePose) of Google, Apache-2.0, from the npm package
# @mediapipe/pose. Where they lie already it does nothing and needs no network; each file is checked against its sum before
# it takes its place. In the source tree that is models/pose; installed this is `dance fetch-models`, and puts them where
# producers/camera/estimator/model_files.h looks. Exit 0: all are there; 1: they are not, and a line says why.
set -euo pipefail
package=@mediapipe/pose@0.5.1675469404
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

# sum, name here, name in the package
files() {
  cat <<'END'
a63c614bef30d35947f13be361820b1e4e3bec9cfeebf4d11216a18373108e85 pose_detection.tflite pose_solution_packed_assets.data
f17bfbecadb61c3be1baa8b8d851cc6619c870a87167b32848ad20db306b9d61 pose_landmark_lite.tflite pose_landmark_lite.tflite
e9a5c5cb17f736fafd4c2ec1da3b3d331d6edbe8a0d32395855aeb2cdfd64b9f pose_landmark_full.tflite pose_landmark_full.tflite
59e42d71bcd44cbdbabc419f0ff76686595fd265419566bd4009ef703ea8e1fe pose_landmark_heavy.tflite pose_landmark_heavy.tflite
END
}

fail() {
  printf 'fetch_pose_models: %s\n' "$*" >&2
  exit 1
}

has_sum() { # SUM FILE
  [ -f "$2" ] && printf '%s  %s\n' "$1" "$2" | sha256sum --check --status -
}

all_there() {
  local sum name source
  while read -r sum name source; do
    has_sum "$sum" "$folder/$name" || return 1
  done < <(files)
}

case "${1:-}" in
  "") ;;
  --there)
    all_there
    exit
    ;;
  -h | --help)
    cat <<END
Fetches the networks that dance capture sees a dancer with: MediaPipe Pose, Apache-2.0, 41 MB, with npm.
Usage: dance fetch-models [OPTIONS]

Options:
  -h,--help                   print this and exit
  --there                     fetches nothing: exit 0 where all are there, else 1

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
all_there && exit 0
command -v npm >/dev/null || fail "npm is missing, which fetches $package; install it with: apt-get install npm"
mkdir -p "$folder"
# In the same file system, so that taking its place is one step.
scratch=$(mktemp -d "$folder/.fetch.XXXXXX")
trap 'rm -rf "$scratch"' EXIT
# A silent network is no reason to wait for minutes.
timeout 180 npm pack --loglevel error --fetch-retries 1 --fetch-timeout 20000 --pack-destination "$scratch" "$package" >/dev/null 2>"$scratch/log" ||
  fail "$package cannot be fetched: $(grep -m 1 -E 'code|network|ERR' "$scratch/log" || echo "no answer"); look at the network and run this again"
tar -xzf "$scratch"/*.tgz -C "$scratch" || fail "what came of $package is no archive; run this again"
# All of them before the first takes its place: whoever looks finds what was there, or what is known.
while read -r sum name source; do
  [ -f "$scratch/package/$source" ] || fail "$package has no $source in it; run this again"
  has_sum "$sum" "$scratch/package/$source" || fail "$source of $package is not the file that is known (its sha256 is another)"
done < <(files)
while read -r sum name source; do
  chmod 644 "$scratch/package/$source"
  mv -f "$scratch/package/$source" "$folder/$name"
done < <(files)
printf 'fetch_pose_models: the networks of %s (Apache-2.0) lie in %s\n' "$package" "$folder" >&2
