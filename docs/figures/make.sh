#!/usr/bin/env bash
# Draws every figure of README.md, docs/aeromap.md and docs/hold.md anew, and writes the tables between the marks in aeromap.md.
# Usage: docs/figures/make.sh [downwash]   (./dev figures builds the program first)
set -euo pipefail

downwash=$(realpath "${1:-build/downwash}")
cd -P "$(dirname "${BASH_SOURCE[0]}")"
bridge=../../problems/bridge_inspection.yaml
data=../../effects/measurements/surface_effect_measurements.csv

plot() { # FILE arguments...
    local file=$1
    shift
    "$downwash" aeromap plot "$@" --quiet -o "$file"
}

# Curves over z/R, with the measurements that the project holds.
plot figure_2_2.svg --flow --z-over-r 1.5
plot figure_2_9.svg --model cheeseman-bennett he hayden li --data "$data" --surface ground --z-over-r 0.3 4
plot figure_2_12.svg --model cheeseman-bennett multirotor-images multirotor-body --rotor-spacing 2.5 \
    --data "$data" --surface ground --z-over-r 0.3 4
plot figure_2_15.svg --model sanchez-cuevas momentum-theory fairing-cfd --data "$data" --surface ceiling --z-over-r 0.2 4

# Maps over the plane of motion.
for scene in figure_5_5_box figure_5_5_pipe figure_5_7 figure_5_8 figure_5_9; do
    plot "$scene.svg" "$scene.yaml" --lateral 0
done
plot figure_c_5.svg "$bridge"

# The whole vehicle.
plot hold_bridge.svg "$bridge" --what hold --arm-deg 90
plot force_bridge.svg "$bridge" --what force
plot torque_bridge.svg "$bridge" --what torque

# Runs: what geometry alone plans, and what the aware planner does.
runs=$(mktemp -d)
trap 'rm -rf "$runs"' EXIT
for variant in mp-arm mp-arm-ada; do
    code=0
    "$downwash" solve "$bridge" --variant "$variant" --max-iterations 1000 --quiet --out "$runs" >/dev/null || code=$?
    if [[ $variant == mp-arm && $code != 3 || $variant == mp-arm-ada && $code != 0 ]]; then
        echo "make.sh: $variant ended with $code: README.md would not say the truth of it" >&2
        exit 1
    fi
    "$downwash" report "$runs" --svg --width 900 >/dev/null
    mv "$runs/flight.svg" "flight_${variant//-/_}.svg"
done

# Tables: what stands between <!-- NAME --> and <!-- /NAME --> in the page is replaced.
replace() { # NAME, new text on standard input
    local text page
    text=$(mktemp)
    page=$(mktemp)
    cat >"$text"
    awk -v name="$1" -v text="$text" '
        $0 == "<!-- /" name " -->" { inside = 0 }
        !inside { print }
        $0 == "<!-- " name " -->" { inside = 1; while ((getline line < text) > 0) print line }' ../aeromap.md >"$page"
    cat "$page" >../aeromap.md
    rm -f "$text" "$page"
}
"$downwash" aeromap compare "$data" --rotor-spacing 2.5 --markdown | replace comparison
