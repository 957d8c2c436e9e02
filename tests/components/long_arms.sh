#!/usr/bin/env bash
# Builds arms of up to six joints, which the default build leaves out, and flies them: side by side and alone in tests/simulation, and
# with the program, the robot neo11_arm5 that we ship.
# Usage: tests/components/long_arms.sh [BUILD]
#   BUILD   folder to build in; by default a new one, which is removed in the end
# Environment: JOBS, parallel jobs of the build (default 1)
set -euo pipefail

root=$(cd -P "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
build=${1:-$work/build}

cmake -S "$root" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DDOWNWASH_UNITY=ON -DDOWNWASH_MAX_JOINTS=6 \
    -DDOWNWASH_BUILD_TESTS=ON -DDOWNWASH_BUILD_BENCH=OFF >"$work/log" 2>&1 || {
    cat "$work/log"
    exit 1
}
cmake --build "$build" --parallel "${JOBS:-1}" --target downwash test_simulation
"$build/tests/test_simulation" '*with any arm*,*space side by side*'

# 6 dB and 30 degrees at every loop, as designed gains leave them to the robots that every build flies.
"$build/downwash" margins "$root/problems/robots/neo11_arm5.yaml" --json >"$work/margins.json"
python3 - "$work/margins.json" <<'EOF'
import json
import sys

for row in json.load(open(sys.argv[1]))["margins"]:
    if (row["gain_margin_db"] or 99) < 6 or (row["phase_margin_deg"] or 360) < 30:
        sys.exit(f"neo11_arm5 has too little margin: {row}")
EOF

cat >"$work/problem.yaml" <<EOF
schema: downwash/problem/v1
name: five_joints
description: Look at a post from the side with an arm of five joints.
robot: $root/problems/robots/neo11_arm5.yaml
environment:
  bounds: {x_m: [-3, 3], y_m: [-3, 3], z_m: [0.5, 4]}
  obstacles:
    - {name: ground, box: {size_m: [20, 20, 1], center_m: [0, 0, -0.5]}}
    - {name: post, box: {size_m: [0.3, 0.3, 3], center_m: [0, 0, 1.5]}}
aero:
  ground: {model: cheeseman-bennett}
start: {x_m: -2, y_m: 0, z_m: 1.5, yaw_deg: 0}
goal:
  end_effector: {position_m: [0, 1, 1.5], tolerance_m: 0.1, direction: [0, -1, 0], direction_tolerance_deg: 20}
EOF
"$build/downwash" check "$work/problem.yaml"
"$build/downwash" solve "$work/problem.yaml" --seed 1 --max-iterations 200 --stop-at-first --no-cache --quiet --out "$work/run"
"$build/downwash" execute "$work/problem.yaml" --plan "$work/run" --quiet --out "$work/again"
cmp "$work/run/trajectory.csv" "$work/again/trajectory.csv"
head -n 1 "$work/run/trajectory.csv" | grep -q joint_5_rad
echo "arms of five and six joints fly"
