#!/usr/bin/env bash
# Builds the libFuzzer targets with clang and runs each, from its seeds. Fails at the first finding,
# which is then in build-fuzz/findings/.
#   bash tools/fuzz.sh [SECONDS_EACH] [FORMAT...]
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
seconds=${1:-60}
shift || true
formats=("$@")
((${#formats[@]})) || for source in test/fuzz/*_fuzz.cpp; do
  formats+=("$(basename "$source" _fuzz.cpp)")
done

cmake -S . -B build-fuzz -G Ninja -DCMAKE_CXX_COMPILER=clang++ -DCMAKE_BUILD_TYPE=RelWithDebInfo \
  -DPALOC_BUILD_TESTS=OFF -DPALOC_FUZZ=ON >/dev/null
cmake --build build-fuzz --target fuzzers
mkdir -p build-fuzz/findings
for format in "${formats[@]}"; do
  corpus=build-fuzz/corpus/$format
  mkdir -p "$corpus"
  log=build-fuzz/$format.log
  if ! "build-fuzz/bin/${format}_fuzz" -max_total_time="$seconds" -timeout=10 -rss_limit_mb=1024 \
    -max_len=65536 -artifact_prefix="build-fuzz/findings/$format-" "$corpus" "test/fuzz/seeds/$format" \
    >"$log" 2>&1; then
    tail -40 "$log"
    echo "fuzz $format: a finding, see build-fuzz/findings/ and $log"
    exit 1
  fi
  echo "fuzz $format: nothing found, $(grep -oE 'Done [0-9]+ runs in [0-9]+ second' "$log")s"
done
