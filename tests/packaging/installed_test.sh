#!/usr/bin/env bash
# installed_test.sh BUILD: makes packages of what BUILD has built, unpacks them, and uses them as a stranger does, in a
# network of its own, while source tree and build are hidden behind empty folders: programs, pages, completion, unit, and
# examples/ built against the CMake package and danced with.
set -euo pipefail

if [ "${1:-}" != --hidden ]; then
  source_tree=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
  build=$(cd "${1:?give the build folder}" && pwd)
  scratch=$(mktemp -d)
  trap 'rm -rf "$scratch"' EXIT
  root=$scratch/root
  mkdir "$root"
  has_all() { for tool in "$@"; do command -v "$tool" >/dev/null || return 1; done; }
  if has_all cpack dpkg dpkg-shlibdeps file; then
    (cd "$scratch" && cpack --config "$build/CPackConfig.cmake" -B "$scratch/packages" \
      -D CPACK_DEBIAN_COMPRESSION_TYPE=gzip >"$scratch/cpack.log" 2>&1) || { cat "$scratch/cpack.log"; exit 1; }
    for package in "$scratch"/packages/*.deb; do
      dpkg -x "$package" "$root"
      dpkg -f "$package" >"$scratch/$(dpkg -f "$package" Package).control"
      echo "$(basename "$package"): $(stat -c %s "$package") bytes"
    done
    # Every package that they depend on can be had here, where apt knows any.
    if has_all apt-get apt-cache && [ -n "$(apt-cache madison libssl3 2>/dev/null)" ]; then
      apt-get install --simulate "$scratch"/packages/*.deb >"$scratch/apt.log" 2>&1 || { cat "$scratch/apt.log"; exit 1; }
    else
      echo "apt has no lists here: whether the packages' dependencies exist is not tested"
    fi
  else
    echo "no dpkg here: installed without packages"
    cmake --install "$build" --prefix "$root/usr" >"$scratch/install.log" || { cat "$scratch/install.log"; exit 1; }
  fi
  cp "$source_tree/tests/private_network.sh" "${BASH_SOURCE[0]}" "$scratch"
  cd "$scratch"
  ./private_network.sh unshare -m ./installed_test.sh --hidden "$scratch" "$source_tree" "$build"
  exit
fi

scratch=$2
mount -t tmpfs none "$3"
[ ! -e "$4" ] || mount -t tmpfs none "$4"
[ ! -e "$3/core" ] && [ ! -e "$4/bin" ] || { echo "source tree and build are not hidden"; exit 1; }
usr=$scratch/root/usr dance=$scratch/root/usr/bin/dance
export HOME=$scratch/home XDG_DATA_HOME=$scratch/home/data XDG_CONFIG_HOME=$scratch/home/config
unset DANCE_POSE_MODELS DANCE_BUS_URL LCM_DEFAULT_URL
failed=0
wrong() { echo "FAILED: $*"; failed=1; }
expect() { # TEXT IN WHAT: the file IN holds TEXT
  grep -qF -- "$1" "$2" || { wrong "$3: does not say: $1"; tail -n 20 "$2"; }
}

# Programs are hardened, and do not name the folder that they were built in (docs/security.md).
if command -v readelf >/dev/null; then
  for program in "$usr"/bin/* "$usr"/lib/dancegraph/*.so; do
    readelf -h "$program" >elf.txt 2>/dev/null || continue
    grep -q 'Type: *DYN' elf.txt || wrong "$program is not position independent"
    readelf -dW "$program" | grep -q 'FLAGS.*NOW' || wrong "$program binds symbols late (no -z now)"
    readelf -lW "$program" | grep -q 'GNU_RELRO' || wrong "$program has no RELRO"
    readelf -sW --dyn-syms "$program" >symbols.txt
    grep -q '__stack_chk_fail' symbols.txt || wrong "$program has no stack protector"
    ! grep -qaF "$3" "$program" || wrong "$program names the folder $3"
  done
fi

# What the packages say of themselves.
if [ -e dancegraph.control ]; then
  for library in libssl3 libc6; do expect "$library" dancegraph.control "Depends"; done
  for package in liblcm-dev libeigen3-dev libexpected-dev; do expect "$package" dancegraph-dev.control "Depends"; done
  # Nothing but the module needs FFmpeg, or what of OpenCV brings a hundred packages.
  sed -n '/^Depends:/,/^[^ D]/p' dancegraph.control >depends
  ! grep -E 'libav|libsw|imgcodecs|videoio' depends || wrong "dancegraph depends on FFmpeg, or on OpenCV's formats"
  ! grep fluidsynth depends || wrong "dancegraph depends on FluidSynth"
  if [ -e "$usr/lib/dancegraph/libdance_band.so" ]; then
    for package in libfluidsynth timgm6mb-soundfont 'dancegraph (= '; do
      expect "$package" dancegraph-band.control "Depends"
    done
    expect dancegraph-band dancegraph.control "Suggests"
  fi
  if [ -e "$usr/lib/dancegraph/libdance_media.so" ]; then
    for library in libavformat libavcodec libavutil libswresample libswscale 'dancegraph (= '; do
      expect "$library" dancegraph-media.control "Depends"
    done
    expect dancegraph-media dancegraph.control "Suggests"
  fi
fi

# Every command that is listed is there, explains itself, and has its page; what needs the source tree is not listed.
"$dance" help >help
expect "  demo " help "dance help"
! grep -q bench help || wrong "dance help lists what is not installed"
for command in $(sed -n '/^First/q; s/^  \([a-z-]*\) .*/\1/p' help); do
  "$dance" "$command" --help >"$command.help" 2>&1 || wrong "dance $command --help fails"
done
for program in "$usr"/bin/*; do
  page=$usr/share/man/man1/$(basename "$program").1.gz
  [ -e "$page" ] || { wrong "no manual page of $program"; continue; }
  if command -v groff >/dev/null; then
    gzip -dc "$page" | groff -man -k -Tutf8 -ww >page 2>page.warnings || wrong "$page: groff fails"
    [ -s page ] && [ ! -s page.warnings ] || { wrong "$page: groff warns"; cat page.warnings; }
  fi
done
gzip -dc "$usr/share/man/man1/dance-salsa.1.gz" >page
for text in '.SH SYNOPSIS' '.B \-\-tempo FLOAT:60 to 240' '.SH EXAMPLES' 'dance salsa \-\-guest bob'; do
  expect "$text" page "dance-salsa.1"
done

# Completion, as bash calls it.
complete_words() { # WORD…: what the last may become
  PATH="$usr/bin:$PATH" bash -c 'source "$0"; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _dance; echo "${COMPREPLY[*]}"' \
    "$usr/share/bash-completion/completions/dance" "$@"
}
completes() { # WANTED WORD…
  local wanted=$1 got
  shift
  got=$(complete_words "$@")
  [ "$got" = "$wanted" ] || wrong "'$*' completes to '$got' and not to '$wanted'"
}
completes "demo" dance de
completes "demo doctor" dance d
completes "doctor" dance help do
completes "--tempo" dance salsa --te
completes "lead follow" dance salsa --role ""

# Links of invitations: the entry that registers them, its icon, and the program that it starts, which tells a broken link.
entry=$usr/share/applications/dance-invitation.desktop icon=$usr/share/icons/hicolor/scalable/apps/dancegraph.svg
expect 'MimeType=x-scheme-handler/dance;' "$entry" "the desktop entry"
expect 'Icon=dancegraph' "$entry" "the desktop entry"
[ "$(head -n 2 "$icon" | grep -c '<?xml')" = 1 ] && expect '<svg xmlns="http://www.w3.org/2000/svg"' "$icon" "the icon"
if command -v desktop-file-validate >/dev/null; then
  desktop-file-validate "$entry" >desktop.said 2>&1 && [ ! -s desktop.said ] || { wrong "the desktop entry is none"; cat desktop.said; }
fi
opens=$(sed -n 's/^Exec=\(dance [a-z]*\) %u$/\1/p' "$entry")
[ -n "$opens" ] || wrong "the desktop entry starts no command of dance with a link"
! env -u DISPLAY -u WAYLAND_DISPLAY PATH="$usr/bin:$PATH" $opens 'dance://dance.example.org/salsa?v=2' >link.log 2>&1 || wrong "$opens opens a broken link"
expect "the invitation names no guest" link.log "$opens"
"$dance" server --invite alice --address dance.example.org --room salsa >invited 2>/dev/null || wrong "dance server --invite fails"
expect "dance://dance.example.org/salsa?v=2&guest=alice&server=" invited "dance server --invite"

# The unit, alone and in a cluster, with the installed program in its place.
if command -v systemd-analyze >/dev/null; then
  sed "s|^ExecStart=dance |ExecStart=$dance |" "$usr/lib/systemd/system/dance-server.service" >dance-server.service
  systemd-analyze verify --man=no ./dance-server.service >verified 2>&1 || wrong "systemd refuses the unit"
  ! grep dance-server.service: verified || wrong "systemd complains of the unit"
  mkdir -p dance-server.service.d
  sed "s|^ExecStart=dance |ExecStart=$dance |" "$usr/share/dancegraph/systemd/dance-server.service.d/cluster.conf" \
    >dance-server.service.d/cluster.conf
  systemd-analyze verify --man=no ./dance-server.service >verified 2>&1 || wrong "systemd refuses the unit in a cluster"
  ! grep -E "dance-server.service(.d/cluster.conf)?:" verified || wrong "systemd complains of the unit in a cluster"
fi

# The main job, as where dancegraph-media is not installed. What needs it says so, and finds it once it is there.
module=$usr/lib/dancegraph/libdance_media.so
echo "no song" >song.m4a
if [ -e "$module" ]; then
  mv "$module" module.away
  ! "$dance" music song.m4a >music.log 2>&1 || wrong "dance music plays what is no song"
  expect "install the package dancegraph-media" music.log "dance music"
fi
"$dance" demo --headless --seconds 3 --out demo >demo.log 2>&1 || { wrong "dance demo fails"; cat demo.log; }
[ -s demo/stage-0001.png ] || [ ! -e "$usr/bin/dance-view" ] || wrong "dance demo drew nothing"

if [ -e module.away ]; then
  mv module.away "$module"
  ! "$dance" music song.m4a >music.log 2>&1 || wrong "dance music plays what is no song"
  expect "no music that can be read" music.log "dance music"
fi

# A camera says how the networks that it needs come here.
if [ -e "$usr/bin/dance-capture" ]; then
  ! "$dance" fetch-models --there || wrong "networks are there that nobody fetched"
  ! "$dance" capture demo/stage-0001.png >capture.log 2>&1 || wrong "dance capture sees without its networks"
  expect "$XDG_DATA_HOME/dancegraph/pose/" capture.log "dance capture"
  expect '`dance fetch-models` fetches it' capture.log "dance capture"
  mkdir -p "$XDG_DATA_HOME/dancegraph/pose"
  echo damage >"$XDG_DATA_HOME/dancegraph/pose/pose_detection.tflite"
  ! "$dance" capture demo/stage-0001.png >capture.log 2>&1 || wrong "dance capture sees with a damaged network"
  expect '`dance fetch-models` fetches it again' capture.log "dance capture"
fi

# The examples, built as their README says.
examples=$usr/share/doc/dancegraph-dev/examples
for language in cpp c; do
  { cmake -S "$examples/$language" -B "$language" -DCMAKE_PREFIX_PATH="$usr" && cmake --build "$language"; } \
    >"$language.log" 2>&1 || { cat "$language.log"; wrong "the examples in $language cannot be built"; }
done
lcm-gen --python --ppath types "$usr"/share/dancegraph/lcmtypes/*.lcm
[ "$failed" = 0 ] || exit 1
cpp/height_consumer --where capture --seconds 4 >cpp.heard &
"$dance" listen --to engine --where capture --seconds 5 2>/dev/null &
c/adapter_reader stage 4 >engine.heard &
c/hips_consumer 'POSE/capture/.*' 4 >c.heard &
PYTHONPATH=types python3 "$examples/python/listen.py" POSE/capture/ 4 >python.heard &
sleep 1
cpp/wave_producer --seconds 2 &
"$dance" salsa --seconds 2 2>/dev/null &
wait
for language in cpp c python engine; do
  for guest in waver alice; do
    heard=$(grep -c "$guest" "$language.heard" || true)
    echo "$language heard $heard poses of $guest"
    [ "$heard" -ge 60 ] || wrong "the consumer in $language heard too few poses of $guest"
  done
done
# The hand goes up and down above the shoulders; the hips stand still.
awk '$1 == "waver" { if (!n++ || $3 < low) low = $3; if ($3 > high) high = $3 }
  END { print "the waving hand is " low " to " high " m high"; exit !(low > 1.4 && high < 2.3 && high - low > 0.1) }' cpp.heard ||
  wrong "that is no waving hand"
# The same library through pkg-config, and without a house.
PKG_CONFIG_PATH=$(dirname "$(find "$usr" -name dance-adapter.pc)")
export PKG_CONFIG_PATH
cc "$examples/c/adapter_reader.c" $(pkg-config --cflags --libs dance-adapter) -o adapter_reader
LD_LIBRARY_PATH=$(pkg-config --variable=libdir dance-adapter) ./adapter_reader nobody 0.2 2>engine.alone ||
  wrong "adapter_reader fails without a house"
expect "no house of that name" engine.alone "adapter_reader"
awk '$1 == "waver" { ++n; if ($4 < 0.9 || $4 > 1.0 || $6 < 1.3 || $6 > 1.8) exit 1 } END { exit !n }' engine.heard ||
  wrong "an engine sees the dancer elsewhere than she is"
for language in c python; do
  awk '/waver/ { ++n; if ($3 != 0 || $4 < 0.9 || $4 > 1.0 || $5 != 0) exit 1 } END { exit !n }' "$language.heard" ||
    wrong "the consumer in $language says the hips elsewhere than they are"
done
exit $failed
