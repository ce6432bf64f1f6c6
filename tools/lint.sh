#!/usr/bin/env bash
# All that is checked of the sources without running them: tools/check_tree.sh, then clang-tidy over
# every source file of the build folder's compile_commands.json.
#   bash tools/lint.sh [FILE.cpp...]
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

bash tools/check_tree.sh
build=${BUILD_DIR:-build}
[[ -f $build/compile_commands.json ]] || cmake -S . -B "$build" -G Ninja >/dev/null
if (($#)); then
  files=("$@")
else
  mapfile -t files < <(grep -o '"file": "[^"]*"' "$build/compile_commands.json" | cut -d'"' -f4 | sort -u)
fi
printf '%s\0' "${files[@]}" | xargs -0 -n 1 -P "$(nproc)" clang-tidy -p "$build" --quiet
echo "${#files[@]} files linted"
