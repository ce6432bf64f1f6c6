#!/usr/bin/env bash
# Checks what holds for every file of the tree: its format, its length, the direction of its
# includes, and that libraries neither print nor exit. Prints each offence; fails if there is one.
#   bash tools/check_tree.sh [ROOT]
set -euo pipefail
shopt -s nullglob globstar
cd "${1:-$(dirname "${BASH_SOURCE[0]}")/..}"

offences=0
offend() {
  echo "$*"
  offences=$((offences + 1))
}

folders=(core map frontends config tools)  # an #include may only point to the left
files=({core,map,frontends,config,tools,test}/**/*.{h,cpp})
((${#files[@]})) || { echo "no source file below $PWD"; exit 1; }

check_format() {
  local output
  # shellcheck disable=SC2046
  output=$(clang-format --dry-run -Werror "${files[@]}" 2>&1) ||
    offend "not formatted (clang-format -i):" $(grep -oE '^[^ :]+:[0-9]+:[0-9]+: error' <<<"$output" |
      cut -d: -f1 | sort -u)
}

check_length() {
  local file lines limit
  for file in "${files[@]}"; do
    limit=400
    [[ $file == core/*factor* ]] && limit=150
    lines=$(wc -l <"$file")
    ((lines <= limit)) || offend "$file: $lines lines, at most $limit"
  done
}

check_includes() {
  local i right
  for i in "${!folders[@]}"; do
    for right in "${folders[@]:i+1}"; do
      forbid "includes from the right" "#include [<\"]paloc/$right/" "${folders[i]}"/**/*.{h,cpp}
    done
  done
  forbid "includes by a relative path" '#include "\.\.?/' "${files[@]}"
  forbid "CLI11 in a header" '#include <CLI/' tools/**/*.h
  forbid "files or the console in core" '#include <(iostream|fstream|filesystem|cstdio)>' core/**/*.{h,cpp}
  forbid "sensor messages in core" '#include <mrpt/(obs|maps)/' core/**/*.{h,cpp}
}

check_libraries() {
  forbid "a library that prints, exits or sleeps" \
    '(std::(cout|cerr|clog)|\b(printf|fprintf|puts|abort|_?exit|sleep_for|sleep_until|usleep) ?\()' \
    {core,map,frontends,config}/**/*.{h,cpp}
}

# forbid WHAT REGEX FILE...: an offence for each line that matches, comments apart.
forbid() {
  local what=$1 regex=$2 hit
  shift 2
  (($#)) || return 0
  while IFS= read -r hit; do
    offend "$what: $hit"
  done < <(grep -nHE "$regex" "$@" | grep -vE '^[^:]*:[0-9]+: *//' || true)
}

check_format
check_length
check_includes
check_libraries
((offences == 0)) || { echo "$offences offences"; exit 1; }
echo "${#files[@]} files checked"
