#!/usr/bin/env bash
# Builds everything and runs every test; `./dance test` comes here when all packages are there.
#   tests/run.sh                 the ci build: unit, flow, golden, fuzz corpora, source checks
#   tests/run.sh --sanitizers    the same, then a build without all that may be left out, the tests under
#                                address+undefined sanitizers, what has threads under the thread sanitizer, and ten
#                                seconds of each fuzz target
# A flow test that fails beside others gets one more try, alone; its name is printed. Not after a sanitizer's report.
# Last line: "N passed, N failed" (", N skipped" where there were any). Exit 1 when anything failed.
set -euo pipefail
cd "$(dirname "$0")/.."
sanitizers=no
only=()
while [ $# -gt 0 ]; do
  case "$1" in
    --sanitizers) sanitizers=yes ;;
    -R | -L | -E | -LE) only+=("$1" "${2:?$1 takes an expression}"); shift ;;
    -h | --help) sed -n '2,8s/^# \{0,1\}//p' "$0"; exit 0 ;;
    *) echo "dance test: there is no option '$1'; --help lists them" >&2; exit 2 ;;
  esac
  shift
done

passed=0 failed=0 skipped=0
jobs=$(nproc)

# What `bare` compiles as `ci` did is taken from there, from a cache inside of the tree. Other builds have nothing in common.
export CCACHE_DIR=${CCACHE_DIR:-$PWD/build/ccache} CCACHE_BASEDIR=${CCACHE_BASEDIR:-$PWD} CCACHE_NOHASHDIR=1 CCACHE_MAXSIZE=2G
launcher_of() { # PRESET: words for cmake
  case $1 in ci | bare) ;; *) return 0 ;; esac
  [ "$sanitizers" = yes ] && command -v ccache >/dev/null || return 0
  printf '%s' "-DCMAKE_CXX_COMPILER_LAUNCHER=ccache -DCMAKE_C_COMPILER_LAUNCHER=ccache"
}

build() { # PRESET [TARGET…]
  local preset=$1 log="build/$1.log"
  shift
  echo "== building ($preset), minute $((SECONDS / 60))"
  mkdir -p build
  local launcher
  launcher=$(launcher_of "$preset")
  cmake --preset "$preset" $launcher >"$log" 2>&1 || { cat "$log"; return 1; }
  cmake --build --preset "$preset" ${1:+--target "$@"} >>"$log" 2>&1 || { tail -n 60 "$log"; return 1; }
}

count_of() { # ATTRIBUTE FILE
  sed -n "s/.*<testsuite .*$1=\"\([0-9]*\)\".*/\1/p; s/^[[:space:]]*$1=\"\([0-9]*\)\".*/\1/p" "$2" | head -n 1
}

# pass_alone PRESET NUMBER: the names of the tests that failed, if all of them are flow tests (programs that wait for each
# other, on a machine that others load too), at most three, without a sanitizer's report, and pass when nothing else runs.
pass_alone() {
  local folder="build/$1" again="$PWD/build/$1.again.xml" names
  [ "$2" -le 3 ] || return 1
  ! grep -qE '(Address|Leak|Thread)Sanitizer|runtime error:' "build/$1.tests.log" || return 1
  ! compgen -G "build/$1-report.*" >/dev/null || return 1
  names=$(cut -d: -f2- "$folder/Testing/Temporary/LastTestsFailed.log" | sed 's/[][().*+?^$\\|/]/\\&/g' | paste -sd'|')
  [ "$(ctest --test-dir "$folder" -N -L flow -R "^($names)\$" | grep -c ' Test *#')" = "$2" ] || return 1
  ctest --test-dir "$folder" -R "^($names)\$" --output-on-failure --no-tests=error --output-junit "$again" \
    >"build/$1.again.log" 2>&1 || return 1
  [ "$(count_of tests "$again")" = "$2" ] && [ "$(count_of skipped "$again")" = 0 ] || return 1
  printf '%s' "$names"
}

# What a graphics driver keeps until it is unloaded counts as lost in each program that a test lets draw: no line of a
# source is in such a report.
forget_drivers_leaks() { # PRESET
  local report
  for report in build/"$1"-report.*; do
    [ -f "$report" ] && grep -q 'ERROR: LeakSanitizer' "$report" || continue
    grep -qE '^ *#[0-9]+ .*\.(cpp|cxx|cc|c|h):[0-9]+|runtime error:|ERROR: (Address|Thread)Sanitizer' "$report" || rm "$report"
  done
}

run() { # PRESET [CTEST OPTION…]
  local preset=$1 report="$PWD/build/$1.xml" total bad left_out
  shift
  echo "== testing ($preset), minute $((SECONDS / 60))"
  rm -f "$report" build/"$preset"-report.*
  ctest --test-dir "build/$preset" -j "$jobs" --output-on-failure --no-tests=error --output-junit "$report" "$@" \
    >"build/$preset.tests.log" 2>&1 || true
  forget_drivers_leaks "$preset"
  grep -E '\*\*\*|tests passed|SKIPPED \]' "build/$preset.tests.log" | sort -u | head -n 80 || true
  if [ ! -f "$report" ]; then
    tail -n 40 "build/$preset.tests.log"
    failed=$((failed + 1))
    return
  fi
  total=$(count_of tests "$report") bad=$(count_of failures "$report") left_out=$(count_of skipped "$report")
  if [ "${bad:-0}" != 0 ]; then
    grep -B2 -A40 -E '\*\*\*(Failed|Timeout|Exception)' "build/$preset.tests.log" | head -n 400 || true
    find build -maxdepth 1 -name "$preset-report.*" | head -n 3 | xargs -r head -n 60 || true
  fi
  if [ "${bad:-0}" != 0 ] && alone=$(pass_alone "$preset" "$bad"); then
    echo "== passed only when nothing else ran (flow tests, $preset): $alone"
    bad=0
  fi
  # No test at all, where nobody asked for some of them, is a build that lost its tests.
  if [ "${total:-0}" = 0 ] && [ ${#only[@]} = 0 ]; then
    echo "there are no tests in the build '$preset'"
    failed=$((failed + 1))
  fi
  failed=$((failed + ${bad:-0}))
  skipped=$((skipped + ${left_out:-0}))
  passed=$((passed + ${total:-0} - ${bad:-0} - ${left_out:-0}))
}

# What tests that wait leave of the processors builds what comes next, at the lowest priority; step() finishes it, and says
# what was wrong.
ahead=""
build_ahead() { # PRESET [TARGET…]
  local preset=$1
  shift
  mkdir -p build
  echo "== building ($preset) beside the tests that follow, minute $((SECONDS / 60))"
  # Below the tests of units, which have the lowest priority of their own.
  { chrt --idle 0 cmake --preset "$preset" && chrt --idle 0 cmake --build --preset "$preset" ${1:+--target "$@"}; } \
    >"build/$preset.ahead.log" 2>&1 &
  ahead=$!
}
await_build() {
  [ -z "$ahead" ] || wait "$ahead" || true
  ahead=""
}

step() { # PRESET [TARGET…]: a build that fails is a failed test.
  build "$@" || { failed=$((failed + 1)); return 1; }
}

# More at a time than there are processors: programs that dance for seconds wait for most of them.
if step ci; then
  # `./dance test` installs programs of others beside the build.
  [ ! -f build/clients.lock ] || { flock build/clients.lock grep -v 'dance: installing: ' build/clients.log || true; }
  [ "$sanitizers" = no ] || build_ahead asan
  jobs=$((jobs + 2)) run ci "${only[@]}"
  await_build
fi
if [ "$sanitizers" = yes ]; then
  # What may be left out is never needed: without any of it everything else compiles and links.
  [ ${#only[@]} != 0 ] || ! step bare || passed=$((passed + 1))
  # Reports of programs that tests start are kept too. Where the thread-local memory of a library lies that was loaded later,
  # clang 14 reads from what glibc 2.36 no longer writes there: its search for leaks ended by a signal, beside a graphics
  # driver.
  export ASAN_OPTIONS=detect_leaks=1:strict_string_checks=1:intercept_tls_get_addr=0:log_path=$PWD/build/asan-report
  export UBSAN_OPTIONS=print_stacktrace=1:log_path=$PWD/build/asan-report
  export LSAN_OPTIONS=suppressions=$PWD/tests/lsan_suppressions.txt:print_suppressions=0
  export TSAN_OPTIONS=suppressions=$PWD/tests/tsan_suppressions.txt:log_path=$PWD/build/tsan-report
  # Drawing in software is ten times slower here, and memory that a graphics driver keeps until it is unloaded counts as
  # lost: the viewer's own tests draw under sanitizers.
  draws='Demo\.(DrawsAFilm|PlaysTheSong|ShowsADancer)|Convert\.WritesALogThatTheViewerShows|LobbyWindowTest|TwoWindowsTest|DancePictureTest|HeadsetShowTest|HouseHeadsetTest\.JoiningWithOne'
  # One build of clang's for the sanitizers and the fuzz targets; libFuzzer has the corpora.
  asan_is_built=no
  if step asan; then
    asan_is_built=yes
    # The quality of results on whole songs and takes takes minutes here, and runs no code that smaller tests leave out.
    quality='^BeatSongs|Takes\.|BeatTracker\.(FindsEachTempo|WorksAtEachSampleRate|TracksSalsa|FindsTheNextSong|FollowsATempo)'
    quality+='|BeatTracker\.(IsOnTheNewTempo|TurnsToTheLevel|NeverUsesTheFuture)|MusicEval\.(SaysByGenre|TakesSeveral|HearsASong)'
    quality+='|BeatTracker\.(DoesNotHangOnLoudness|TakesTheLevel|KeepsTheBeat|CountsOn|NumbersEach)|MusicEval\.SeesRealCouples|RhythmNetFit\.Learns'
    quality+='|RoundTrip\.(NoiseAlone|FindsItInNoise)|RowCheckTest\.Settles|Chessboard\.AViewOfABent|Stylize\.(TheOverview|Gains)'
    quality+='|StereoDepth|SeveralEval|TouchEval\.LimitsOf|Holistic\.'
    [ ${#only[@]} != 0 ] || build_ahead tsan thread_targets flow_targets
    jobs=$((jobs + 2)) run asan -LE 'check|soak|docs|fuzz' -E "$quality|$draws" "${only[@]}"
  fi
  # What these start has no threads that others do not have; and a camera that is preloaded comes before the sanitizer.
  no_threads="$draws|MusicRoom|MusicPrograms|Bench|ACameraThatWasUnplugged|SeeTwoDancersBefore|LookThroughASecond|Holistic"
  await_build
  step tsan thread_targets flow_targets && tsan_is_built=yes || tsan_is_built=no
  # Fuzzing fills the processors, at the lowest priority, while programs dance under the thread sanitizer and wait.
  fuzz_one() { # TARGET
    ASAN_OPTIONS=detect_leaks=1:strict_string_checks=1 UBSAN_OPTIONS=print_stacktrace=1 \
      "$1" -max_total_time=10 -rss_limit_mb=1024 -timeout=20 -print_final_stats=0 -artifact_prefix=build/ \
      "build/asan/fuzz/corpus_$(basename "$1")" >"build/$(basename "$1").log" 2>&1 && touch "build/$(basename "$1").passed"
  }
  export -f fuzz_one
  rm -f build/fuzz_*.passed
  fuzz_targets=""
  [ "$asan_is_built" = no ] || fuzz_targets=$(find build/asan/fuzz -maxdepth 1 -type f -name 'fuzz_*' | sort)
  echo "== fuzzing, minute $((SECONDS / 60)) ($(wc -w <<<"$fuzz_targets") targets, 10 s each), beside the tests that follow"
  printf '%s\n' $fuzz_targets | nice -n 19 xargs -r -P "$jobs" -I{} bash -c 'fuzz_one {}' &
  fuzzing=$!
  [ "$tsan_is_built" = no ] || jobs=$((jobs + 2)) run tsan -L 'threads|flow' -E "$no_threads" "${only[@]}"
  wait "$fuzzing" || true
  for target in $fuzz_targets; do
    name=$(basename "$target")
    if [ -e "build/$name.passed" ]; then
      passed=$((passed + 1))
    else
      echo "$name failed:" && tail -n 30 "build/$name.log"
      failed=$((failed + 1))
    fi
  done
fi
summary="$passed passed, $failed failed"
[ "$skipped" = 0 ] || summary="$summary, $skipped skipped"
echo "$summary"
[ "$failed" = 0 ]
