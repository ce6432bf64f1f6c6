#!/usr/bin/env bash
# No library of ours, nor the program, may offer Eigen's own functions to the dynamic linker: they would
# replace those inside Debian's MRPT, built with other alignment rules, and crash under -march=native or ASan.
#   visibility_test.sh BINARY...
set -euo pipefail
export LC_ALL=C

# The Eigen names that a binary offers; a function of paloc's with an Eigen argument is not one of them.
offered() { nm -D --defined-only "$1" | awk '{ print $NF }' | grep -E '^_Z(T[ISV])?NK?5Eigen' | c++filt || true; }

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# That the check can fail: the same code with visible symbols.
cat >"$work/visible.cpp" <<'CODE'
namespace Eigen { template <int> int twice(int i) { return 2 * i; } }
int use(int i) { return Eigen::twice<3>(i); }
CODE
${CXX:-c++} -shared -fPIC "$work/visible.cpp" -o "$work/visible.so"
[[ -n $(offered "$work/visible.so") ]] || { echo "the check sees nothing in a library that shows all"; exit 1; }

failed=0
for binary in "$@"; do
  symbols=$(offered "$binary")
  [[ -z $symbols ]] && continue
  echo "$binary offers $(wc -l <<<"$symbols") functions of Eigen, such as:"
  head -3 <<<"$symbols"
  failed=1
done
(($#)) && ((failed == 0)) && echo "$# binaries offer none of Eigen's functions"
exit $failed
