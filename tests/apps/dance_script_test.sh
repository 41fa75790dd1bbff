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
for tool in bash cat cp dirname env grep mkdir mktemp rm tail; do ln -s "$(command -v "$tool")" "$bin/$tool"; done
fake() { # NAME: a program whose text comes on stdin
  { printf '#!%s\nscratch=%q calls=%q tree=%q\n' "$(command -v bash)" "$scratch" "$calls" "$tree"; cat; } >"$bin/$1"
  chmod +x "$bin/$1"
}
fake dpkg-query <<'END'
while read -r package; do
  case " $* " in *" $package "*) echo "$package installed" ;; esac
done <"$scratch/installed"
END
fake id <<'END'
[ -e "$scratch/is_no_root" ] && echo 1000 || echo 0
END
fake apt-get <<'END'
echo "apt-get $*" >>"$calls"
[ "$1" = update ] && exit 0
[ "${DEBIAN_FRONTEND:-}" = noninteractive ] || { echo "which keyboard?"; exit 100; }
[ -e "$scratch/apt_fails" ] && { echo "E: Unable to locate package"; exit 100; }
lacked=""
[ ! -e "$scratch/apt_lacks" ] || read -r lacked <"$scratch/apt_lacks"
for word in "$@"; do
  case $word in
    -* | install) ;;
    "$lacked") echo "E: no $word"; exit 100 ;;
    *) echo "$word" >>"$scratch/installed" ;;
  esac
done
END
# Configures into build.ninja and the list of commands; a camera is one only with its packages.
fake cmake <<'END'
echo "cmake $*" >>"$calls"
[ -e "$scratch/configuring_fails" ] && { echo "no compiler"; exit 1; }
mkdir -p "$tree/build/release/share/dancegraph"
echo >"$tree/build/release/build.ninja"
{ echo "demo dance-front dance-demo dance-server"
  echo "salsa dance-front dance-salsa"
  echo "voice dance-front dance-voice"
  echo "voice-set dance-front dance-voice-set"
  ! grep -qx libopencv-core-dev "$scratch/installed" || printf '%s\n' "capture dance-front dance-capture" "fetch-models dance-front"
} >"$tree/build/release/share/dancegraph/commands.txt"
END
# What it builds are files; dance says how it was started.
fake ninja <<'END'
shift 2
dry=no
[ "$1" != -n ] || { dry=yes; shift; }
[ "$*" != build.ninja ] || exit 0
bin=$tree/build/release/bin
left=()
for target in "$@"; do
  file=$bin/$target
  [ "$target" != dance-front ] || file=$bin/dance
  [ -e "$file" ] || left+=("$file")
done
[ -d "$bin" ] || [ $dry = yes ] || mkdir -p "$bin"
[ $dry = yes ] || [ ${#left[@]} = 0 ] || echo "ninja $*" >>"$calls"
for file in "${left[@]}"; do
  echo "${NINJA_STATUS}Linking CXX executable $file"
  [ $dry = no ] || continue
  [ -e "$scratch/building_fails" ] && { echo "error: no such thing"; exit 1; }
  cp "$scratch/built_program" "$file"
done
[ ${#left[@]} != 0 ] || echo "ninja: no work to do."
END
{ printf '#!%s\n' "$(command -v bash)"
  printf '%s\n' 'echo "dance $*"' 'exit 7'; } >"$scratch/built_program"
chmod +x "$scratch/built_program"
fake flock <<'END'
[ -e "$scratch/is_taken" ] || exit 0
echo "flock $*" >>"$calls"
[ "$1" != -n ]
END

# The part of the source tree that each machine begins with.
fresh=$scratch/fresh
mkdir -p "$fresh/producers/camera" "$fresh/tests" "$fresh/cmake"
cp "$source_tree/dance" "$fresh/dance"
cp "$source_tree/cmake/progress.sh" "$fresh/cmake/progress.sh"
{ printf '#!%s\nscratch=%q calls=%q\n' "$(command -v bash)" "$scratch" "$calls"
  printf 'echo "run.sh $*" >>"$calls"\n'; } >"$fresh/tests/run.sh"
{ printf '#!%s\nscratch=%q calls=%q\n' "$(command -v bash)" "$scratch" "$calls"
  cat <<'END'
[ -e "$scratch/has_models" ] && exit 0
[ "${1:-}" = --there ] && exit 1
echo "fetch" >>"$calls"
[ -e "$scratch/fetch_fails" ] && { echo "fetch_pose_models: no answer" >&2; exit 1; }
echo >"$scratch/has_models"
END
} >"$fresh/producers/camera/fetch_pose_models.sh"
chmod +x "$fresh/tests/run.sh" "$fresh/producers/camera/fetch_pose_models.sh"

begin() { # CASE: a fresh machine
  case=$1
  rm -rf "$tree" "$scratch"/is_no_root "$scratch"/is_taken "$scratch"/apt_* "$scratch"/*_fails "$scratch"/has_models
  cp -r "$fresh" "$tree"
  : >"$scratch/installed"
  : >"$calls"
}
fake_client_fetch() {
  mkdir -p "$tree/tests/clients"
  printf '#!%s\necho "clients fetched"\n' "$(command -v bash)" >"$tree/tests/clients/fetch_clients.sh"
  chmod +x "$tree/tests/clients/fetch_clients.sh"
}
dance() { # WORD…
  code=0
  : >"$calls"
  said=$(cd "$scratch" && PATH="$bin" exec "$tree/dance" "$@" 2>&1) || code=$?
}
read_calls() { IFS= read -r -d '' asked <"$calls" || true; }
wrong() {
  read_calls
  printf '%s: %s\n  exit %s, said: %s\n  asked: %s\n' "$case" "$*" "$code" "$said" "$asked"
  failed=1
}
expect_code() { [ "$code" = "$1" ] || wrong "exits with something else than $1"; }
expect_said() { [[ "$said" == *"$1"* ]] || wrong "does not say: $1"; }
expect_call() { read_calls; [[ "$asked" == *"$1"* ]] || wrong "does not ask for: $1"; }
expect_no_call() { read_calls; [[ "$asked" != *"$1"* ]] || wrong "asks for: $1"; }

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
expect_call "ninja dance-front dance-demo dance-server" # and nothing else
expect_said "building 1 of 3"
expect_no_call "libopencv-core-dev" # only a camera needs it
expect_no_call "libgtest-dev"
expect_no_call "fetch"

case="a second time"
dance demo
expect_code 7
[ ! -s "$calls" ] || wrong "does anything but start"

case="another command in a tree with the demo"
dance salsa --seconds 2
expect_code 7
expect_said "dance salsa --seconds 2"
expect_call "ninja dance-front dance-salsa"
expect_no_call "cmake --preset"
case="of several words the longest command"
dance voice set --mute
expect_code 7
expect_call "ninja dance-front dance-voice-set"
case="help of one command, which its program knows"
dance help voice
expect_code 7
expect_said "dance help voice"
expect_call "ninja dance-front dance-voice"
case="no command"
dance nonsense
expect_code 7 # dance says that there is none
expect_said "dance nonsense"
expect_no_call "ninja"

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

case="everything"
dance setup
expect_code 0
expect_call "ninja all"
expect_no_call "libbenchmark-dev"
touch "$tree/build/release/bin/all"
dance setup --everything
expect_code 2
expect_said "setup takes --all or nothing"
dance setup --all
expect_code 0
expect_call "libbenchmark-dev"
expect_call "ninja all everything"

case="a tree that was configured before there was a list of commands"
rm "$tree/build/release/share/dancegraph/commands.txt"
dance demo
expect_code 7
expect_call "cmake --preset release"

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
expect_no_call "cmake --preset"

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

begin "a camera in a tree with the demo"
dance demo
dance capture
expect_code 7
expect_call "cmake --preset release"
expect_call "ninja dance-front dance-capture"
begin "a camera whose packages came otherwise"
dance demo
bash -c 'source <(sed -n "/^camera_packages=(/,/)/p" "$1"); printf "%s\n" "${camera_packages[@]}"' _ "$tree/dance" >>"$scratch/installed"
dance capture
expect_code 7
expect_call "cmake --preset release"
expect_call "ninja dance-front dance-capture"

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
expect_call "ninja all"

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

expect_client_log() { # TEXT: what is installed beside the build ends on its own
  local i
  for ((i = 0; i < 100; i++)); do
    [[ ! -e "$tree/build/clients.log" || "$(<"$tree/build/clients.log")" != *"$1"* ]] || return 0
    sleep 0.1
  done
  wrong "build/clients.log does not say: $1"
}
begin "tests"
dance test -L unit
expect_code 0
expect_call "libgtest-dev"
expect_no_call "libbenchmark-dev"
expect_no_call "blender"
expect_no_call "fetch" # npm is missing, and would bring hundreds of packages
expect_call "run.sh -L unit"
begin "tests that take long"
dance test --long -L unit
expect_code 0
expect_call "libbenchmark-dev"
expect_call "fetch"
expect_call "run.sh --long -L unit"
expect_client_log "are skipped"
begin "all tests, and programs of others that cannot be had"
echo blender >"$scratch/apt_lacks"
dance test --all
expect_code 0
expect_call "run.sh --all"
expect_client_log "without them the tests with programs of others are skipped"
begin "all tests on a machine with an npm that is not Debian's"
fake npm </dev/null
fake_client_fetch
dance test --all
expect_client_log "clients fetched"
expect_call "blender"
! grep -qx npm "$scratch/installed" || wrong "installs Debian's npm"
begin "tests on a machine with npm"
dance test
expect_call "fetch"
expect_no_call "blender"
rm "$bin/npm"

begin "all tests without the networks"
touch "$scratch/fetch_fails"
dance test --all
expect_code 0
expect_said "are skipped"
expect_call "run.sh"
expect_client_log "are skipped"

begin "no Debian"
mv "$bin/dpkg-query" "$scratch/dpkg-query"
dance demo
expect_code 7
expect_said "this is no Debian"
expect_no_call "apt-get"
mv "$scratch/dpkg-query" "$bin/dpkg-query"

# The line of progress, by what apt-get and ninja say.
case="progress" code=0 said=""
: >"$calls"
said=$(
  source "$source_tree/cmake/progress.sh"
  show_progress() { echo "$1"; }
  packages_of() { printf '%s\n' "$@" | while IFS= read -r line; do watch_packages "$line"; done; }
  packages_of "Reading package lists..." "1 upgraded, 2 newly installed, 0 to remove and 3 not upgraded." "Get:1 a" "Get:2 b"
  packages_of "1 upgraded, 2 newly installed, 0 to remove and 3 not upgraded." "Unpacking a (1) ..." "Setting up a (1) ..."
  for seconds in 1 10 61 125 3599; do
    words_of_seconds $seconds
    echo "left: $words"
  done
  # Half of the weight in twenty seconds, the first three of which do not count.
  steps=4 weight_all=10000
  weigh() { weight=2500; }
  SECONDS=0 build_began=0
  for SECONDS in 3 13 23; do watch_build "step Building CXX object x.o"; done
  watch_build "a warning that the compiler prints"
  watch_build "step Building CXX object x.o"
)
expect_line() { [[ $'\n'$said$'\n' == *$'\n'"$1"$'\n'* ]] || wrong "does not say: $1"; }
for line in "installing: apt-get reads its lists" "installing: 2 of 3 packages fetched" "installing: 1 of 3 packages unpacked" \
  "installing: 1 of 3 packages set up, the last step" "left: 10 s" "left: 1 min 10 s" "left: 2 min 10 s" "left: 60 min" \
  "building 1 of 4" "building 2 of 4, about 20 s left" "building 3 of 4, about 10 s left" "building 4 of 4"; do
  expect_line "$line"
done
# Lines that come in pieces, a step that fails.
said=$(
  source "$source_tree/cmake/progress.sh"
  heard() { [ -z "$1" ] || echo "heard $1"; }
  halting() { printf 'one '; sleep 1.5; printf 'line\nand another\n'; return 3; }
  run_watched heard "$scratch/watched.log" halting && echo "ends well" || echo "ends with $?"
)
grep -qx "one line" "$scratch/watched.log" || wrong "a line that came in pieces is not in the log"
expect_line "ends with 3"

exit $failed
