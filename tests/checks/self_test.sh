#!/bin/sh
# The checks must be able to fail: a small tree with one fault of each kind, and what each check says about it.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
tree=$(mktemp -d)
trap 'rm -rf "$tree"' EXIT
mkdir -p "$tree/tests/checks" "$tree/core/base" "$tree/core/pose" "$tree/transformers" "$tree/producers" "$tree/consumers" \
  "$tree/docs" "$tree/logs" "$tree/bin"
cp "$here"/*.sh "$here"/*.py "$here"/layers.txt "$tree/tests/checks"
cp "$here/../private_network.sh" "$tree/tests"
failed=0

expect() { # expect CHECK TEXT: the check fails and its output holds the text
  if output=$("$tree/tests/checks/$1" ${3:+"$3"} 2>&1); then
    echo "$1 passed where it should say: $2"
    failed=1
  elif ! printf '%s\n' "$output" | grep -qF -- "$2"; then
    echo "$1 does not say: $2"
    printf '%s\n' "$output"
    failed=1
  fi
}
expect_fine() {
  output=$("$tree/tests/checks/$1" ${2:+"$2"} 2>&1) || { echo "$1 fails on a good tree:"; printf '%s\n' "$output"; failed=1; }
}
good_header() { printf '// A thing.\n#pragma once\n'; }

mkdir "$tree/core/program"
printf 'int pid = fork();\n' >"$tree/core/program/child_process.cpp"
good_header >"$tree/core/base/thing.h"
printf '#include "core/base/thing.h"\n#include <vector>\n' >"$tree/core/pose/thing.cpp"
printf '```sh\ndance thing --good 3   # runs in CI\n```\n' >"$tree/docs/tour.md"
printf '#!/bin/sh\n[ "$1" = --help ] && echo "  --good N   a number"\nexit 0\n' >"$tree/bin/dance-thing"
printf '#!/bin/sh\n[ "$1" = help ] && { echo "  thing   does things"; exit 0; }\np=$1; shift; exec "$(dirname "$0")/dance-$p" "$@"\n' >"$tree/bin/dance"
chmod +x "$tree/bin/dance" "$tree/bin/dance-thing"
for check in layers.sh files.sh format.sh docs_links.sh; do expect_fine $check; done
expect_fine docs_commands.sh "$tree/bin"

fault() { printf '%b' "$2" >"$tree/$1"; }
fault core/base/up.cpp '#include "core/pose/pose.h"\n'
expect layers.sh 'core/base may not include core/pose/pose.h'
fault core/base/up.cpp '#include "thing.h"\n'
expect layers.sh 'must be written from the root'
fault core/base/up.cpp '#include "core/base/nothing.h"\n'
expect layers.sh 'core/base/nothing.h does not exist'
fault core/base/up.cpp '#include <thread>\n'
expect layers.sh 'not <thread>'
rm "$tree/core/base/up.cpp"
good_header >"$tree/producers/thing.h"
fault consumers/peer.cpp '#include "producers/thing.h"\n'
expect layers.sh 'consumers may not include producers/thing.h'
fault consumers/peer.cpp '#include <sys/socket.h>\n'
expect layers.sh '<sys/socket.h> is only for'
fault consumers/peer.cpp '  #  include <lcm/lcm.h>\n'
expect layers.sh '<lcm/lcm.h> is only for'
rm "$tree/consumers/peer.cpp"
expect_fine layers.sh

mkdir -p "$tree/apps/show" "$tree/house"
printf 'dance_program(show\n  SOURCES show/show_main.cpp show/show_run.cpp\n  NEEDS dance-thing)\n' >"$tree/apps/CMakeLists.txt"
printf 'dance_program(join SOURCES join_main.cpp LIBS dance::house NEEDS dance-thing)\n' >"$tree/house/CMakeLists.txt"
printf 'a = program_folder() + "/dance-thing"; add("dance-lossy");\n' >"$tree/apps/show/show_run.cpp"
printf 'a = program_folder() + "/dance-thing";\n' >"$tree/house/house_thing.cpp"
printf 'show dance-front dance-show dance-thing\njoin dance-front dance-join dance-thing\nthing dance-front dance-thing\n' >"$tree/list"
expect_fine programs.sh "$tree/list" # dance-lossy is left out of that build
printf 'lossy dance-front dance-lossy\n' >>"$tree/list"
expect programs.sh 'apps/show/show_run.cpp: starts dance-lossy' "$tree/list"
sed '/^join/s/ dance-thing//' "$tree/list" >"$tree/list.join"
expect programs.sh 'house/house_thing.cpp: starts dance-thing, which is not among the NEEDS of dance_program(join' "$tree/list.join"
rm -r "$tree/apps" "$tree/house"
expect programs.sh 'the check itself is broken' "$tree/list"

fault core/base/pose_utils.cpp 'int x;\n'
expect files.sh 'core/base/pose_utils.cpp: the name says nothing'
rm "$tree/core/base/pose_utils.cpp"
cp "$tree/tests/checks/layers.txt" "$tree/layers.kept"
echo 'may core/base:  core/pose' >>"$tree/tests/checks/layers.txt"
expect layers.sh 'a second rule: may core/base:'
mv "$tree/layers.kept" "$tree/tests/checks/layers.txt"
mkdir "$tree/core/net"
i=0
while [ $i -lt 31 ]; do echo 'int x;' >"$tree/core/net/thing$i.cpp"; i=$((i + 1)); done
expect files.sh 'core/net: more than 30 sources'
rm -r "$tree/core/net"
fault core/base/wide.cpp "// $(printf '%098d' 0)\n"
expect files.sh 'core/base/wide.cpp:1: 101 columns; at most 100'
fault core/base/wide.cpp "// $(printf '%096d' 0)é\n"
rm "$tree/core/base/wide.cpp"
fault core/base/bad.cpp 'int\tx;\nint y; \n'
expect files.sh 'core/base/bad.cpp:1: a tab'
expect files.sh 'core/base/bad.cpp:2: a space at the end'
i=0
: >"$tree/core/base/bad.cpp"
while [ $i -lt 401 ]; do echo 'int x;'; i=$((i + 1)); done >>"$tree/core/base/bad.cpp"
expect files.sh '401 lines'
rm "$tree/core/base/bad.cpp"
fault core/base/bad.h '#pragma once\n'
expect files.sh 'a header begins with a comment'
rm "$tree/core/base/bad.h"
for call in '::kill(child, 9)' 'if (kill (-1, 9) != 0)' 'pid_t p = fork()' 'x = forkpty(&a, b, c, d)' 'posix_spawnp(&p)'; do
  fault core/base/bad.cpp "void f() { $call; }\n"
  expect files.sh 'core/base/bad.cpp:1: only core/program/child_process.cpp forks and sends signals'
done
fault core/base/bad.cpp 'void f() { server.kill(); overkill(1); }  // kill(1, 2)\n'
expect_fine files.sh
rm "$tree/core/base/bad.cpp"

fault core/base/one.h '// One.\nnamespace dance {\nstruct Same : Base {\n};\n}\n'
fault core/base/other.cpp 'namespace dance {\nnamespace {\nstruct Same {};\n}\nnamespace x { struct Same {}; }\nvoid f() { struct Same {}; }\n}\n'
expect_fine one_definition.py
fault core/base/other.cpp 'namespace dance {\nclass alignas(8) Same final {};\n}\n'
expect one_definition.py 'dance::Same: defined in core/base/one.h and core/base/other.cpp'
fault core/base/other.cpp 'namespace dance {\nenum class Same : int { kOne };\n}\n'
expect one_definition.py 'dance::Same: defined in core/base/one.h and core/base/other.cpp'
rm "$tree/core/base/one.h" "$tree/core/base/other.cpp"

fault docs/tour.md '# X\nSee [this](gone.md), [that](../docs/tour.md#x) and [the web](https://example.org).\n'
expect docs_links.sh 'docs/tour.md: links to gone.md, which does not exist'
fault docs/tour.md '# A tour\n## `One`, two: *3*\n## One two 3\n[a](#one-two-3), [b](../docs/tour.md#one-two-3-1)\n'
expect_fine docs_links.sh
fault docs/tour.md '# A tour\n```sh\n# code\n```\n[a](#code)\n'
expect docs_links.sh 'docs/tour.md: links to #code, but docs/tour.md has no such heading'
fault docs/tour.md '# A tour\n[a](../docs/tour.md#one)\n'
expect docs_links.sh 'docs/tour.md: links to ../docs/tour.md#one, but docs/tour.md has no such heading'
fault docs/tour.md '# A tour\n'
fault core/base/refers.cpp '// See docs/tour.md#a-tour and core/base/thing.h.\nint x;  // docs/tour.md#gone, core/base/gone.h\n'
expect docs_links.sh 'core/base/refers.cpp: names docs/tour.md#gone, but there is no such heading'
expect docs_links.sh 'core/base/refers.cpp: names core/base/gone.h, which does not exist'
fault core/base/refers.cpp '// See docs/tour.md#a-tour and core/base/thing.h.\n'
expect_fine docs_links.sh
rm "$tree/core/base/refers.cpp"
fault docs/tour.md 'Look into `core/base/gone.h`, `core/base/<name>.h` and `core/base/thing.h/.cpp`.\n'
expect docs_links.sh 'docs/tour.md: names core/base/gone.h, which does not exist'
fault docs/tour.md '```sh\n./dance nothing\n```\n'
expect docs_commands.sh 'docs/tour.md:2: there is no program dance-nothing' "$tree/bin"
fault docs/tour.md '```sh\n./dance thing \\\n  --goo 4\n```\n'
expect docs_commands.sh 'docs/tour.md:2: dance thing  has no option --goo' "$tree/bin"
fault docs/tour.md 'nothing\n'
expect docs_commands.sh 'no command found' "$tree/bin"
cp "$tree/bin/dance-thing" "$tree/bin/dance-lost"
expect docs_commands.sh 'dance help does not list dance-lost' "$tree/bin"
rm "$tree/bin/dance-lost"
fault docs/tour.md '```sh\ndance thing   # runs in CI\n```\n'
case $("$tree/tests/private_network.sh" echo can) in
  can) ;;
  *) echo "no network namespace here: running documented commands is not tested"; exit $failed ;;
esac
printf '#!/bin/sh\n[ "$1" = --help ]\n' >"$tree/bin/dance-thing"
expect docs_commands.sh 'exits with an error' "$tree/bin"

exit $failed
