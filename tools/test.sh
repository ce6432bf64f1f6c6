#!/usr/bin/env bash
# Installs what is missing, builds, runs the tests, and prints ctest's closing lines.
#   bash tools/test.sh [--sanitize] [--long]
#     --sanitize  instead: the unit tests with the address and undefined-behaviour sanitizers
#     --long      besides: clang-tidy over everything (tools/lint.sh), every reader fuzzed for 60 s
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
cd "$root"

sanitize=0 long=0
for option in "$@"; do
  case $option in
    --sanitize) sanitize=1 ;;
    --long) long=1 ;;
    *) sed -n '2,5s/^# \{0,1\}//p' "$0" >&2; exit 2 ;;
  esac
done

bash tools/install_packages.sh build test
if ((sanitize)); then
  build=build-asan
  # -O1: the sanitizers' reports keep their lines, and the tests stay quick.
  cmake -S . -B $build -G Ninja -DCMAKE_BUILD_TYPE=RelWithDebInfo -DPALOC_SANITIZE=ON \
    -DCMAKE_CXX_FLAGS_RELWITHDEBINFO="-O1 -g1" >/dev/null
  # MRPT and Embree keep objects until the process ends; they are not ours to free.
  export ASAN_OPTIONS=detect_leaks=0:strict_string_checks=1 UBSAN_OPTIONS=print_stacktrace=1
  parts=(core map frontends config tools)
  targets=(--target "${parts[@]/%/_tests}")
  filter=(--label-regex "^($(IFS='|'; echo "${parts[*]}"))$")
else
  build=build
  cmake -S . -B $build -G Ninja -DCMAKE_BUILD_TYPE=Release >/dev/null
  targets=() filter=()
fi
cmake --build $build "${targets[@]}"
ctest --test-dir $build --output-on-failure -j "$(nproc)" "${filter[@]}"
if ((long)); then
  bash tools/install_packages.sh lint
  bash tools/lint.sh
  bash tools/install_packages.sh fuzz
  bash tools/fuzz.sh 60
fi
