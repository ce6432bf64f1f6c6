#!/usr/bin/env bash
# Shows that tools/check_tree.sh can fail: a clean small tree passes, and each offence planted in it
# is found, alone.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
tree=$(mktemp -d)
trap 'rm -rf "$tree"' EXIT
failed=0

make_clean_tree() {
  rm -rf "${tree:?}"/*
  mkdir -p "$tree"/{core,map,config,tools}/src
  cp "$root/.clang-format" "$tree/"
  printf '// exit() in a comment is fine\nint one();\n' >"$tree/core/src/one.cpp"
  printf '#include "paloc/core/one.h"\n' >"$tree/map/src/two.cpp"
}

# expect_found SENTENCE FILE LINE...: with these lines added to the file, the check names the offence.
expect_found() {
  local sentence=$1 file=$tree/$2 output
  shift 2
  make_clean_tree
  printf '%s\n' "$@" >>"$file"
  if output=$(bash "$root/tools/check_tree.sh" "$tree") || ! grep -qF "$sentence" <<<"$output" ||
    ! grep -q '^1 offences$' <<<"$output"; then
    echo "not found as the only offence: $sentence; the check said: $output"
    failed=1
  fi
}

make_clean_tree
bash "$root/tools/check_tree.sh" "$tree" || failed=1

mapfile -t many < <(for i in {1..401}; do echo "int f$i();"; done)
expect_found "not formatted (clang-format -i): core/src/one.cpp" core/src/one.cpp 'int  two( );'
expect_found "map/src/long.cpp: 401 lines, at most 400" map/src/long.cpp "${many[@]}"
expect_found "core/src/imu_factor.cpp: 151 lines, at most 150" core/src/imu_factor.cpp "${many[@]:0:151}"
expect_found "includes from the right: core/src/one.cpp:3" core/src/one.cpp '#include "paloc/map/two.h"'
expect_found "includes from the right: config/src/a.cpp:1" config/src/a.cpp '#include "paloc/tools/a.h"'
expect_found "includes by a relative path" map/src/a.cpp '#include "../secret.h"'
expect_found "CLI11 in a header" tools/src/a.h '#include <CLI/CLI.hpp>'
expect_found "files or the console in core" core/src/one.cpp '#include <fstream>'
expect_found "sensor messages in core" core/src/one.cpp '#include <mrpt/obs/CObservationIMU.h>'
expect_found "a library that prints" map/src/two.cpp 'void f() { std::cout << 1; }'
expect_found "a library that prints" core/src/one.cpp 'void f() { exit(1); }'
exit $failed
