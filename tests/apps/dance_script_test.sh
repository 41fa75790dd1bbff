#!/usr/bin/env bash
# The script ./dance on machines of the test's own: what it installs, fetches, builds and starts, with an apt, a cmake and a
# package list that only write down what they are asked.
set -euo pipefail
source_tree=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
failed=0
unset DEBIAN_FRONTEND
tree=$scratch/tree bin=$scratch/bin calls=$scratch/calls

# Only what the script may use is there to be used.
mkdir -p "$bin"
for tool in bash cat chmod dirname env grep mkdir mktemp rm tail; do ln -s "$(command -v "$tool")" "$bin/$tool"; done
fake() { # NAME: a program whose text comes on stdin
  { printf '#!%s\nscratch=%q calls=%q tree=%q\n' "$(command -v bash)" "$scratch" "$calls" "$tree"; cat; } >"$bin/$1"
  chmod +x "$bin/$1"
}
fake dpkg-query <<'END'
grep -qx "${@: -1}" "$scratch/installed" && printf installed
END
fake id <<'END'
[ -e "$scratch/is_no_root" ] && echo 1000 || echo 0
END
fake apt-get <<'END'
echo "apt-get $*" >>"$calls"
[ "$1" = update ] && exit 0
[ "${DEBIAN_FRONTEND:-}" = noninteractive ] || { echo "which keyboard?"; exit 100; }
[ -e "$scratch/apt_fails" ] && { echo "E: Unable to locate package"; exit 100; }
for word in "$@"; do
  case $word in -* | install) ;; *)
    [ -e "$scratch/apt_lacks" ] && grep -qx "$word" "$scratch/apt_lacks" && { echo "E: no $word"; exit 100; }
    echo "$word" >>"$scratch/installed" ;;
  esac
done
END
# Configures into build.ninja; what it builds says how it was started.
fake cmake <<'END'
echo "cmake $*" >>"$calls"
if [ "$1" = --build ]; then
  [ -e "$scratch/building_fails" ] && { echo "error: no such thing"; exit 1; }
  mkdir -p "$tree/build/release/bin"
  printf '#!%s\necho "dance $*"\nexit 7\n' "$(command -v bash)" >"$tree/build/release/bin/dance"
  chmod +x "$tree/build/release/bin/dance"
  echo >"$tree/build/release/bin/dance-capture"
else
  [ -e "$scratch/configuring_fails" ] && { echo "no compiler"; exit 1; }
  mkdir -p "$tree/build/release"
  echo >"$tree/build/release/build.ninja"
fi
END
fake ninja <<'END'
[ -e "$tree/build/release/bin/dance" ] && echo "ninja: no work to do."
END
fake flock <<'END'
[ -e "$scratch/is_taken" ] || exit 0
echo "flock $*" >>"$calls"
[ "$1" != -n ]
END

begin() { # CASE: a fresh machine
  case=$1
  rm -rf "$tree" "$calls" "$scratch"/is_no_root "$scratch"/is_taken "$scratch"/apt_* "$scratch"/*_fails "$scratch"/has_models
  mkdir -p "$tree/producers/camera" "$tree/tests"
  : >"$scratch/installed"
  : >"$calls"
  cp "$source_tree/dance" "$tree/dance"
  { printf '#!%s\nscratch=%q calls=%q\n' "$(command -v bash)" "$scratch" "$calls"
    printf 'echo "run.sh $*" >>"$calls"\n'; } >"$tree/tests/run.sh"
  { printf '#!%s\nscratch=%q calls=%q\n' "$(command -v bash)" "$scratch" "$calls"
    cat <<'END'
[ -e "$scratch/has_models" ] && exit 0
[ "${1:-}" = --there ] && exit 1
echo "fetch" >>"$calls"
[ -e "$scratch/fetch_fails" ] && { echo "fetch_pose_models: no answer" >&2; exit 1; }
echo >"$scratch/has_models"
END
  } >"$tree/producers/camera/fetch_pose_models.sh"
  chmod +x "$tree/tests/run.sh" "$tree/producers/camera/fetch_pose_models.sh"
}
dance() { # WORD…
  code=0
  : >"$calls"
  said=$(cd "$scratch" && PATH="$bin" "$tree/dance" "$@" 2>&1) || code=$?
}
wrong() {
  printf '%s: %s\n  exit %s, said: %s\n  asked: %s\n' "$case" "$*" "$code" "$said" "$(cat "$calls")"
  failed=1
}
expect_code() { [ "$code" = "$1" ] || wrong "exits with something else than $1"; }
expect_said() { [[ "$said" == *"$1"* ]] || wrong "does not say: $1"; }
expect_call() { grep -qF -- "$1" "$calls" || wrong "does not ask for: $1"; }
expect_no_call() { ! grep -qF -- "$1" "$calls" || wrong "asks for: $1"; }

for word in "" help --help; do
  begin "a fresh machine, asked for help: '$word'"
  dance $word
  expect_code 0
  expect_said "usage: ./dance COMMAND"
  [ ! -s "$calls" ] || wrong "does anything but say so"
done

begin "a fresh machine"
dance demo --guests 3
expect_code 7 # what was started says how it ended
expect_said "dance demo --guests 3"
expect_call "apt-get update"
expect_call "liblcm-dev"
expect_call "--no-install-recommends"
expect_call "cmake --preset release"
expect_call "cmake --build --preset release"
expect_no_call "libopencv-core-dev" # only a camera needs it
expect_no_call "libgtest-dev"
expect_no_call "fetch"

case="a second time"
dance demo
expect_code 7
[ ! -s "$calls" ] || wrong "does anything but start"

case="help of what is built"
dance help
expect_code 7
expect_said "dance help"

case="another one builds"
touch "$scratch/is_taken"
dance demo
expect_code 7
expect_said "another ./dance installs or builds here"
expect_call "flock 9" # waits for it
rm "$scratch/is_taken"

case="one package is gone"
grep -vx libssl-dev "$scratch/installed" >"$scratch/left" || true
mv "$scratch/left" "$scratch/installed"
dance demo
expect_code 7
expect_call "apt-get install -y --no-install-recommends libssl-dev"
expect_no_call "liblcm-dev"
expect_call "cmake --preset release" # what came may be a feature

begin "apt-get fails"
touch "$scratch/apt_fails"
dance demo
expect_code 1
expect_said "E: Unable to locate package"
expect_said "apt-get failed"
expect_no_call "cmake --"

begin "neither root nor sudo"
touch "$scratch/is_no_root"
dance demo
expect_code 1
expect_said "run as root: apt-get install g++"
expect_no_call "apt-get"

begin "sudo"
touch "$scratch/is_no_root"
fake sudo <<'END'
echo "sudo $*" >>"$calls"
exec env -i PATH="$PATH" "$@"
END
dance demo
expect_code 7
expect_call "sudo apt-get update"
rm "$bin/sudo"

begin "configuring fails"
touch "$scratch/configuring_fails"
dance demo
expect_code 1
expect_said "no compiler"
expect_said "configuring failed"

begin "building fails"
touch "$scratch/building_fails"
dance demo
expect_code 1
expect_said "error: no such thing"
expect_said "building failed"

begin "a camera"
dance capture
expect_code 7
expect_call "npm" # which fetches the networks
expect_call "libopencv-core-dev"
expect_call "fetch"
case="a camera again"
dance capture
expect_code 7
[ ! -s "$calls" ] || wrong "does anything but start"

begin "the networks alone"
dance fetch-models
expect_code 7
expect_call "libopencv-core-dev"
expect_call "fetch"

for word in --list --help; do
  begin "capture $word"
  dance capture $word
  expect_code 7
  expect_no_call "fetch"
done

begin "a camera without the networks"
touch "$scratch/fetch_fails"
dance capture
expect_code 1
expect_said "no answer"

begin "setup where no camera's packages are to be had"
echo libopencv-core-dev >"$scratch/apt_lacks"
touch "$scratch/fetch_fails"
dance setup
expect_code 0
expect_said "a camera sees no dancer without them; all else works"
expect_call "cmake --build"

begin "a house with a camera"
dance join sessions/alice.toml --camera auto
expect_code 7
expect_call "libopencv-core-dev"
expect_call "fetch"
begin "a house without"
dance join sessions/alice.toml
expect_code 7
expect_no_call "libopencv-core-dev"
expect_no_call "fetch"

begin "tests"
dance test -L unit
expect_code 0
expect_call "libgtest-dev"
expect_call "fetch"
expect_call "run.sh -L unit"
begin "tests without the networks"
touch "$scratch/fetch_fails"
dance test
expect_code 0
expect_said "are skipped"
expect_call "run.sh"

begin "no Debian"
mv "$bin/dpkg-query" "$scratch/dpkg-query"
dance demo
expect_code 7
expect_said "this is no Debian"
expect_no_call "apt-get"
mv "$scratch/dpkg-query" "$bin/dpkg-query"

exit $failed
