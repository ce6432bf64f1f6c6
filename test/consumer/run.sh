#!/usr/bin/env bash
# Installs paloc from a build folder to a temporary prefix, builds the consumer against what was
# installed, and runs it on a recording that the installed program makes.
set -euo pipefail
build=$1
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

cmake --install "$build" --prefix "$work/first" >"$work/log" || { cat "$work/log"; exit 1; }
# An installation may be moved: nothing in it may name the prefix it was made for, or this tree.
mv "$work/first" "$work/prefix"
cp "$here/CMakeLists.txt" "$here/main.cpp" "$work/"
cmake -G Ninja -S "$work" -B "$work/build" -DCMAKE_PREFIX_PATH="$work/prefix" -DCMAKE_BUILD_TYPE=Release \
  >"$work/log" 2>&1 || { cat "$work/log"; exit 1; }
cmake --build "$work/build" >"$work/log" 2>&1 || { cat "$work/log"; exit 1; }

"$work/prefix/bin/paloc" synth --scene building --sensor vlp-16 --duration 3 -o "$work/data" \
  >"$work/log" 2>&1 || { cat "$work/log"; exit 1; }
"$work/build/consumer" "$work"/data/{recording.rawlog,map.ply,truth.tum}

# The example of a front-end as a plugin, built from what was installed.
cmake -G Ninja -S "$work/prefix/share/paloc/example" -B "$work/example" \
  -DCMAKE_PREFIX_PATH="$work/prefix" -DCMAKE_BUILD_TYPE=Release >"$work/log" 2>&1 || { cat "$work/log"; exit 1; }
cmake --build "$work/example" >"$work/log" 2>&1 || { cat "$work/log"; exit 1; }
"$work/prefix/bin/paloc" replay "$work/data/recording.rawlog" --map "$work/data/map.ply" --no-side-file \
  --init-tum "$work/data/truth.tum" --plugin "$work/example/libscan_to_scan.so" --frontend scan_to_scan \
  -o "$work/result" >"$work/log" 2>&1 || { cat "$work/log"; exit 1; }

"$work/prefix/bin/paloc" --version
# The preset by its name alone: found in the prefix, not in the build folder.
(cd / && "$work/prefix/bin/paloc" config dump --config vlp-16 | grep "max_range_m: 100$" >/dev/null)  # not -q: it would break the pipe
if grep -rlI -e "$build" "$work/prefix"; then
  echo "these installed files name the build folder"
  exit 1
fi
for binary in "$work"/prefix/bin/paloc "$work"/prefix/lib*/libpaloc_*.so "$work"/prefix/lib/*/libpaloc_*.so; do
  [[ -e $binary ]] || continue
  if ldd "$binary" | grep -E "not found|$build"; then
    echo "$binary does not find its libraries within the prefix"
    exit 1
  fi
done
