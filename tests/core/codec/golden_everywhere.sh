#!/usr/bin/env bash
# Builds the decoder of the lattice codec with several compilers and flags and compares what it makes of the golden
# packets, bit by bit.   usage: golden_everywhere.sh SOURCE_DIR WORK_DIR MODEL_SOURCE EIGEN_INCLUDE EXPECTED_INCLUDE
set -euo pipefail
source=$1 work=$2 model_source=$3 # the model, embedded by CMake
shift 3
cd "$source"
mkdir -p "$work"
files="tests/core/codec/lattice_golden_main.cpp core/codec/lattice/body_lattice.cpp core/codec/lattice/body_predictor.cpp
  $model_source core/codec/lattice/lattice_decoder.cpp core/codec/lattice/lattice_frame.cpp core/codec/lattice/pose_model.cpp core/codec/coding/symbol_distribution.cpp core/pose/pose.cpp core/pose/skeleton.cpp"
includes=()
for include in "$@"; do includes+=(-isystem "$include"); done
# All in one file: its headers are read once.
for file in $files; do echo "#include \"$file\""; done >"$work/all.cpp"
golden=tests/core/codec/golden/lattice_v1.bin
expected=$(cat tests/core/codec/golden/lattice_v1.txt)
bad=0 count=0
while read -r name compiler flags; do
  if ! command -v "$compiler" >/dev/null; then
    echo "$name: SKIPPED, there is no $compiler here"
    continue
  fi
  # shellcheck disable=SC2086
  "$compiler" -std=c++20 -ffp-contract=off $flags -DDANCE_DECODE_ONLY -I. \
    "${includes[@]}" "$work/all.cpp" -o "$work/$name"
  got=$("$work/$name" "$golden")
  count=$((count + 1))
  echo "$name: $got"
  [ "$got" = "$expected" ] || bad=$((bad + 1))
done <<'VARIANTS'
gcc-O0 g++ -O0
gcc-native g++ -O3 -march=native -fno-tree-vectorize
clang-O2 clang++ -O2
VARIANTS
echo "$count builds, $bad differ from '$expected'"
[ "$bad" = 0 ]
