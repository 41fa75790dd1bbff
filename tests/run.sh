#!/usr/bin/env bash
# Builds and runs the tests; `./dance test` starts it when all packages are there.
#   tests/run.sh             the tests that take minutes: unit, golden, fuzz corpora, checks, short flow tests
#   tests/run.sh --long      also the tests labelled `long`: clients of others, evaluations, packages, documented commands
#   tests/run.sh --all       everything: --long, a build without any optional part, the tests without --long under
#                            address+undefined sanitizers, those with threads under the thread sanitizer, ten seconds of each
#                            fuzz target
#   tests/run.sh --strict    warnings are errors, and a short test must not use much processor time; CI sets it
#   -R -E -L -LE EXPRESSION  select tests by name or label, as in ctest; names are Suite.Test
# Last line: "N passed, N failed" (", N skipped" where there were any). Exit 1 when anything failed.
set -euo pipefail
cd "$(dirname "$0")/.."
all=no long=no strict=no
only=() left_out=""
while [ $# -gt 0 ]; do
  case "$1" in
    --all) all=yes long=yes ;;
    --long) long=yes ;;
    --strict) strict=yes ;;
    -R | -E) only+=("$1" "${2:?$1 takes an expression}"); export DANCE_EACH_TEST=1; shift ;;
    -L) only+=("$1" "${2:?$1 takes an expression}"); shift ;;
    # CTest leaves a test out only if every -LE matches it, so several are joined into one.
    -LE) left_out+="|${2:?$1 takes an expression}"; shift ;;
    -h | --help) sed -n '2,12s/^# \{0,1\}//p' "$0"; exit 0 ;;
    *) echo "dance test: there is no option '$1'; --help lists them" >&2; exit 2 ;;
  esac
  shift
done
is_selected=no
[ ${#only[@]} = 0 ] && [ -z "$left_out" ] || is_selected=yes
source cmake/progress.sh
mkdir -p build
passed=0 failed=0 skipped=0
# Places for tests: a test that computes takes three, a flow test, which mostly waits, takes one.
jobs=$((3 * $(nproc) + 6))
# A short test may use this much processor time; above the first it is printed, above the second it fails under --strict.
printed_over_s=10 failed_over_s=20

: >build/stages.txt
# stage NAME COMMAND…: runs a shell function and writes its minutes and processor time down.
stage() {
  local name=$1 code=0 TIMEFORMAT='%R %U %S'
  shift
  echo "== $name, minute $((SECONDS / 60))"
  exec {console}>&1
  { time "$@" >&"$console" 2>&1 || code=$?; } 2>build/stage.time
  exec {console}>&-
  echo "$(tail -n 1 build/stage.time) $name" >>build/stages.txt
  return $code
}

# The build without optional parts compiles nine in ten sources with the same command as the release build: in CI both use a
# cache inside the tree.
launcher=""
if [ $all = yes ] && [ $strict = yes ] && command -v ccache >/dev/null; then
  launcher="env;CCACHE_DIR=$PWD/build/ccache;CCACHE_BASEDIR=$PWD;CCACHE_DEPEND=1;CCACHE_NOHASHDIR=1;ccache"
fi
configure() { # PRESET OPTION…
  local use=""
  case $1 in release | ci | bare) use=$launcher ;; esac
  cmake --preset "$@" "-DCMAKE_CXX_COMPILER_LAUNCHER=$use" "-DCMAKE_C_COMPILER_LAUNCHER=$use" >"build/$1.configure.log" 2>&1 || { cat "build/$1.configure.log"; return 1; }
}
build() { # PRESET TARGET…
  local preset=$1 log="build/$1.log"
  shift
  build_watched "build/$preset" "$log" "$@" || { grep -v '^step ' "$log" | tail -n 60; return 1; }
}

# The next builds use the processor time that the tests leave, at the lowest priority.
ahead=""
build_one_ahead() { # PRESET TARGET…
  local preset=$1 TIMEFORMAT="%R %U %S build $1, ahead"
  shift
  { time { configure "$preset" && chrt --idle 0 ninja -C "build/$preset" "$@"; } >"build/$preset.ahead.log" 2>&1 || true; } 2>>build/stages.txt
  touch "build/$preset.ahead.ended"
}
build_ahead() {
  echo "== building (asan, then tsan) beside the tests that follow, minute $((SECONDS / 60))"
  rm -f build/*.ahead.ended
  { build_one_ahead asan test_targets; build_one_ahead tsan thread_targets flow_targets; } &
  ahead=$!
}
await_build() { # PRESET
  while [ -n "$ahead" ] && [ ! -e "build/$1.ahead.ended" ] && kill -0 "$ahead" 2>/dev/null; do sleep 1; done
}

stop_ahead() {
  local children
  [ -n "$ahead" ] || return 0
  children=$(pgrep -P "$ahead" || true)
  kill "$ahead" $children 2>/dev/null || true
}

# Graphics drivers keep memory until they are unloaded, which LeakSanitizer reports in each program that draws. Such a report
# has no line of a source.
drop_driver_leaks() { # PRESET
  local report
  for report in build/"$1"-report.*; do
    [ -f "$report" ] && grep -q 'ERROR: LeakSanitizer' "$report" || continue
    grep -qE '^ *#[0-9]+ .*\.(cpp|cxx|cc|c|h):[0-9]+|runtime error:|ERROR: (Address|Thread)Sanitizer' "$report" || rm "$report"
  done
}

run() { # PRESET LABELS_LEFT_OUT CTEST_OPTION…
  local preset=$1 without="$2$left_out" tests="build/$1/Testing/Temporary/LastTest.log" log="build/$1.tests.log" code=0
  local now_passed now_failed now_skipped
  shift 2
  without=${without#|}
  rm -f "$tests" build/"$preset"-report.*
  ctest --test-dir "build/$preset" -j "$jobs" --output-on-failure ${without:+-LE "$without"} "${only[@]}" "$@" >"$log" 2>&1 ||
    code=$?
  drop_driver_leaks "$preset"
  if grep -q '^No tests were found' "$log" && [ $is_selected = yes ]; then
    return 0 # an expression may match nothing in one build and something in another
  fi
  if ! tests/report.py "$tests" >"build/$preset.report" ||
    ! read -r _ now_passed now_failed now_skipped < <(grep '^counts:' "build/$preset.report"); then
    tail -n 40 "$log"
    echo "FAILED: the results of the build '$preset' cannot be read"
    failed=$((failed + 1))
    return
  fi
  cp "$tests" "build/$preset.last_test.log"
  grep -v '^counts:' "build/$preset.report" || true
  if [ "$now_failed" = 0 ] && { [ $code != 0 ] || [ $((now_passed + now_skipped)) = 0 ]; }; then
    echo "FAILED: ctest of the build '$preset' ended with $code, and names no failed test"
    tail -n 40 "$log"
    now_failed=1
  elif [ "$now_failed" != 0 ]; then
    grep -A60 -E '\*\*\*(Failed|Timeout|Exception|Not Run)' "$log" | sed -n '1,400p' || true
    find build -maxdepth 1 -name "$preset-report.*" | sed -n '1,3p' | xargs -r head -n 60 || true
  fi
  # A test may not notice that a program which it started ended with a report.
  if [ "$now_failed" = 0 ] && compgen -G "build/$preset-report.*" >/dev/null; then
    echo "FAILED: a program that a test started left a sanitizer's report"
    find build -maxdepth 1 -name "$preset-report.*" | sed -n '1,3p' | xargs -r head -n 60 || true
    now_failed=1
  fi
  passed=$((passed + now_passed)) failed=$((failed + now_failed)) skipped=$((skipped + now_skipped))
}

# over LOG SECONDS: the short tests in a log that used more processor time: entry, test, seconds.
over() {
  tests/report.py "$1" --over "$2" | awk 'NR == FNR { long[$1]; next } !($1 in long)' build/long_entries.txt -
}

# Short tests that use much processor time are printed; one that does so in two runs fails.
check_processor_time() {
  local log=build/release.last_test.log entry test used names
  [ -f "$log" ] || return 0
  # The file gets an extra first line: awk recognises the first file by its line numbers, and it may be empty.
  { echo "-"; ctest --test-dir build/release -N -L long 2>/dev/null | sed -n 's/^ *Test *#[0-9]*: //p'; } >build/long_entries.txt
  over "$log" $printed_over_s >build/slow.txt
  [ -s build/slow.txt ] || return 0
  echo "short tests with more than $printed_over_s s of processor time (entry, test, seconds):"
  sed 's/^/  /' build/slow.txt
  names=$(over "$log" $failed_over_s | awk '{ print $1 }' | sort -u | sed 's/[][().*+?^$\\|/]/\\&/g' | paste -sd'|')
  [ -n "$names" ] && [ $strict = yes ] || return 0
  over "$log" $failed_over_s | awk '{ print $1, $2 }' >build/slow_once.txt
  ctest --test-dir build/release -R "^($names)\$" >build/slow.log 2>&1 || true
  while read -r entry test used; do
    grep -qxF "$entry $test" build/slow_once.txt || continue
    echo "FAILED $test: $used s of processor time in a second run too; the limit is $failed_over_s s, or the label long"
    failed=$((failed + 1))
  done < <(over build/release/Testing/Temporary/LastTest.log $failed_over_s)
}

# CI ends a run after 90 minutes. On a day when its machine is slow the last stages are left out; that is printed, and counted
# as skipped.
left_out_late=""
is_late() { # MINUTE WHAT
  [ $strict = yes ] && ((SECONDS / 60 >= $1)) || return 1
  echo "LEFT OUT at minute $((SECONDS / 60)), as CI ends a run after 90: $2"
  left_out_late+="${left_out_late:+; }$2"
  skipped=$((skipped + 1))
}

step() { # PRESET TARGET…: a build that fails is a failed test.
  { [ "$1" = release ] || configure "$1"; } && stage "build $1" build "$@" || { failed=$((failed + 1)); return 1; }
}

print_statistics() {
  tests/report.py build/release.last_test.log --slowest 20 | sed -n '/^the 20 tests/,$p' | grep -v '^counts:'
  echo "the slowest steps of building (release):"
  awk -F'\t' '!/^#/ && NF > 4 { took[$4] = ($2 - $1) / 1000 } END { for (i in took) printf "  %7.1f s  %s\n", took[i], i }' \
    build/release/.ninja_log | sort -rn | sed -n '1,20p'
  echo "stages: minutes by the clock, processor time in s (user, system)"
  awk '{ wall_s = $1; user_s = $2; system_s = $3; $1 = $2 = $3 = ""
         printf "  %6.1f %8.0f %7.0f %s\n", wall_s / 60, user_s, system_s, $0 }' build/stages.txt
}

finish() {
  local summary="$passed passed, $failed failed" minutes=$((SECONDS / 60))
  [ "$skipped" = 0 ] || summary="$summary, $skipped skipped"
  if [ $all = yes ]; then
    print_statistics || true
    ((minutes <= 75)) || echo "WARNING: $minutes minutes; CI ends a run after 90${left_out_late:+; left out: $left_out_late}"
  elif [ $long = yes ]; then
    echo "left out: sanitizers, fuzzing, a build without optional parts. ./dance test --all runs them."
  else
    echo "left out: tests labelled long (clients, packages, evaluations, films), sanitizers, fuzzing. ./dance test --all runs them."
  fi
  if [ $((passed + failed + skipped)) = 0 ]; then
    echo "no test matches; tests labelled long run with --long only"
    failed=1
  fi
  echo "$summary"
  [ "$failed" = 0 ]
}

# Both presets build in build/release.
preset=release targets=(test_targets)
[ $strict = no ] || preset=ci
[ $long = no ] || targets=(all everything)
configure $preset || exit 1
is_built=no
! step release "${targets[@]}" || is_built=yes
exec 9>&- # another ./dance may build now
if [ $is_built = yes ]; then
  # `./dance test --long` installs programs of others beside the build.
  [ ! -f build/clients.lock ] || { flock build/clients.lock grep -v 'dance: installing: ' build/clients.log || true; }
  [ $all = no ] || [ $is_selected = yes ] || build_ahead
  if [ $long = yes ]; then
    stage "test release" run release ""
  else
    stage "test release" run release "|long"
  fi
  [ $is_selected = yes ] || check_processor_time
  await_build asan
fi
[ $all = yes ] || { finish; exit; }

# Without its optional parts everything else compiles and links.
if [ $is_selected = no ]; then
  ! step bare all || passed=$((passed + 1))
fi

# Reports of programs that tests start are kept too. clang 14 reads thread-local memory of libraries that were loaded later
# from a place that glibc 2.36 no longer fills: beside a graphics driver its leak check ended by a signal.
export ASAN_OPTIONS=detect_leaks=1:strict_string_checks=1:intercept_tls_get_addr=0:suppressions=$PWD/tests/asan_suppressions.txt:log_path=$PWD/build/asan-report
export UBSAN_OPTIONS=print_stacktrace=1:log_path=$PWD/build/asan-report
export LSAN_OPTIONS=suppressions=$PWD/tests/lsan_suppressions.txt:print_suppressions=0
export TSAN_OPTIONS=suppressions=$PWD/tests/tsan_suppressions.txt:log_path=$PWD/build/tsan-report
# One build of clang's has the sanitizers and the fuzz targets.
asan_is_built=no tsan_is_built=no
if ! is_late 76 "address sanitizer" && step asan test_targets; then
  asan_is_built=yes
  not_under_asan="|long|check|soak|docs|fuzz"
  ! is_late 66 "flow tests under the address sanitizer" || not_under_asan+="|flow"
  stage "test asan" run asan "$not_under_asan"
fi
if is_late 78 "thread sanitizer and fuzzing"; then
  asan_is_built=no
  stop_ahead
else
  await_build tsan
  ! step tsan thread_targets flow_targets || tsan_is_built=yes
fi
# Fuzzing fills the processors, at the lowest priority, while programs dance under the thread sanitizer and wait.
fuzz_one() { # PROGRAM TARGET
  ASAN_OPTIONS=detect_leaks=1:strict_string_checks=1 UBSAN_OPTIONS=print_stacktrace=1 DANCE_FUZZ_TARGET=$2 \
    "build/asan/fuzz/$1" -max_total_time=10 -rss_limit_mb=1024 -timeout=20 -print_final_stats=0 -artifact_prefix=build/ \
    "build/asan/fuzz/corpus_$2" >"build/fuzz_$2.log" 2>&1 && touch "build/fuzz_$2.passed"
}
export -f fuzz_one
rm -f build/fuzz_*.passed
fuzz_all() { nice -n 19 xargs -r -P $(($(nproc) + 2)) -L 1 bash -c 'fuzz_one "$0" "$1"' <build/asan/fuzz/targets.txt || true; }
if [ $asan_is_built = yes ] && [ $is_selected = no ]; then
  echo "== fuzzing, minute $((SECONDS / 60)) ($(wc -l <build/asan/fuzz/targets.txt) targets, 10 s each), beside the tests that follow"
  { TIMEFORMAT='%R %U %S fuzz'; time fuzz_all; } 2>>build/stages.txt &
  fuzzing=$!
fi
[ $tsan_is_built = no ] || stage "test tsan" run tsan "" -L 'threads|flow'
if [ -n "${fuzzing:-}" ]; then
  wait "$fuzzing" || true
  while read -r _ target; do
    if [ -e "build/fuzz_$target.passed" ]; then
      passed=$((passed + 1))
    else
      echo "FAILED fuzz target $target:" && tail -n 30 "build/fuzz_$target.log"
      failed=$((failed + 1))
    fi
  done <build/asan/fuzz/targets.txt
fi
finish
