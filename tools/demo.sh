#!/usr/bin/env bash
# From nothing to a judged trajectory: installs what is missing, builds, simulates a recording with
# its survey map, replays it, evaluates the result against the truth, and says where all of it lies.
#   bash tools/demo.sh
# Environment: DEMO_DIR (out/demo), DEMO_SENSOR (os1-128), DEMO_DURATION_S (60), DEMO_SEED (1)
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
dir=${DEMO_DIR:-out/demo}
sensor=${DEMO_SENSOR:-os1-128}
duration_s=${DEMO_DURATION_S:-60}
seed=${DEMO_SEED:-1}

step() { printf '\n== %s\n' "$*"; }

# Runs a command, shown as a user would type it.
run() {
  printf '$ %s\n' "${*/#build\/bin\//}"
  "$@"
}

step "Packages and build"
bash tools/install_packages.sh build
cmake -S . -B build -G Ninja -DCMAKE_BUILD_TYPE=Release >/dev/null
cmake --build build --target paloc

step "A recording of $duration_s s with a $sensor, a survey map, and the truth"
run build/bin/paloc synth --scene building --sensor "$sensor" --duration "$duration_s" --seed "$seed" \
  -o "$dir" --overwrite

step "The trajectory"
# 1 says that part of the result is flagged: the figures below still belong to it.
code=0
run build/bin/paloc replay "$dir/recording.rawlog" --map "$dir/map.ply" --config "$sensor" \
  --init-tum "$dir/truth.tum" -o "$dir/result" --overwrite || code=$?
((code <= 1)) || exit $code

step "Against the truth, without alignment"
run build/bin/paloc eval traj "$dir/truth.tum" "$dir/result/trajectory.tum" --align none

step "Results"
place=$(realpath "$dir")
echo "trajectory  $place/result/trajectory.tum"
echo "report      $place/result/report.html"
echo "recording   $place/recording.rawlog, map.ply, truth.tum"
exit $code
