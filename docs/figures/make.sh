#!/usr/bin/env bash
# Draws every figure of README.md and docs/*.md, and writes the tables between the marks in aeromap.md and control.md.
# Usage: docs/figures/make.sh [downwash]   (./dev figures builds the program first)
set -euo pipefail

downwash=$(realpath "${1:-build/downwash}")
cd -P "$(dirname "${BASH_SOURCE[0]}")"
problems=$(realpath ../../problems)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
# The bridge as the ideal robot flies it, in the nominal world: what the variants know makes the difference there.
bridge=$work/bridge_inspection.yaml
sed "s#robots/ars_lrm#$problems/robots/ars_lrm_ideal#; s/^uncertainty: {}/uncertainty: none/" \
    "$problems/bridge_inspection.yaml" >"$bridge"
data=../../aeromap/effects/measurements/surface_effect_measurements.csv

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
tilted=../../aeromap/effects/measurements/tilted_rotors_ground.csv
walls=../../aeromap/effects/measurements/walls/wall_effect.csv
plot figure_2_20.svg --model cheeseman-bennett --tilt-deg 0 10 30 --data "$tilted" --z-over-r 0.5 4
plot figure_2_15.svg --model sanchez-cuevas momentum-theory fairing-cfd --data "$data" --surface ceiling --z-over-r 0.2 4

# Maps over the plane of motion.
for scene in figure_5_5_box figure_5_5_pipe figure_5_6 figure_5_7 figure_5_8 figure_5_9; do
    plot "$scene.svg" "$scene.yaml" --lateral 0
done
plot figure_c_5.svg "$bridge"

# The whole vehicle.
plot hold_bridge.svg "$bridge" --what hold --arm-deg 90
plot force_bridge.svg "$bridge" --what force
plot torque_bridge.svg "$bridge" --what torque

# Concepts, on the problem that `downwash init` writes.
"$downwash" init "$work/my_problem.yaml" >/dev/null
plot concepts_factor.svg --model cheeseman-bennett sanchez-cuevas --z-over-r 0.2 4 --width 900
plot concepts_map.svg "$work/my_problem.yaml" --width 900
plot concepts_hold.svg "$work/my_problem.yaml" --what hold --arm-deg 0 --width 900

# Runs of the three variants, as they are without the check of their execution.
run() { # VARIANT ITERATIONS EXIT-CODE: the picture of a flight, left in the folder work/run too
    local code=0
    "$downwash" solve "$bridge" --variant "$1" --max-iterations "$2" --check-execution false --quiet --out "$work/run" >/dev/null || code=$?
    if [[ $code != "$3" ]]; then
        echo "make.sh: $1 ended with $code instead of $3, so the captions in README.md and concepts.md would be wrong" >&2
        exit 1
    fi
    "$downwash" report "$work/run" --svg --width 900 >/dev/null
    cp "$work/run/flight.svg" "flight_${1//-/_}.svg"
}
run mp-arm 1000 3
run mp-arm-da 3000 3
cp "$work/run/plots.svg" plots_mp_arm_da.svg
run mp-arm-ada 3000 0

# A flight in space, in three views.
girder=$problems/space/around_a_girder
"$downwash" execute "$girder.yaml" --plan "$girder.json" --quiet --out "$work/in_space" >/dev/null
"$downwash" report "$work/in_space" --svg --width 900 >/dev/null
cp "$work/in_space/flight.svg" flight_in_space.svg

# The shipped problems in space before planning, in three views.
for name in girder_bay pipe_rack culvert tank_shell box_girder_chamber tunnel_crown window around_a_pier girder_bay_survey girder_survey; do
    "$downwash" check "$problems/space/$name.yaml" --picture "problem_$name.svg" >/dev/null
done

# The flight of the tutorial, by the files that stand in it.
tutorial=$work/tutorial
page=$(realpath ../tutorial.md)
mkdir "$tutorial"
ln -s "$problems" "$tutorial/problems"
(
    cd "$tutorial"
    awk '/^```yaml file / { file = $3; printf "" >file; copies = 1; next }
        /^```yaml add/ { copies = 1; next }
        /^```/ { copies = 0 }
        copies { print >file }' "$page"
    "$downwash" margins inspector.yaml --design --translation-rad-s 1.2 >gains
    cat gains >>inspector.yaml
    "$downwash" solve bay.yaml --max-iterations 400 --stop-at-first --quiet --out flight >/dev/null
    "$downwash" report flight --svg --width 900 >/dev/null
)
cp "$tutorial/flight/flight.svg" tutorial_flight.svg

# Block diagrams.
./blocks.py blocks.txt .

# Tables: replaces the text between <!-- NAME --> and <!-- /NAME --> in a page.
replace() { # NAME PAGE, new text on standard input
    local text page
    text=$(mktemp)
    page=$(mktemp)
    cat >"$text"
    awk -v name="$1" -v text="$text" '
        $0 == "<!-- /" name " -->" { inside = 0 }
        !inside { print }
        $0 == "<!-- " name " -->" { inside = 1; while ((getline line < text) > 0) print line }' "../$2" >"$page"
    cat "$page" >"../$2"
    rm -f "$text" "$page"
}

# The thesis' experiments: findings, and some of the figures.
for study in partial-ground-effect disturbance-test-bench ceiling-envelope ceiling-contact; do
    "$downwash" study "$study" --quiet --out "$work/$study"
    awk '/^\| \| thesis/ { inside = 1 } /^$/ { inside = 0 } inside' "$work/$study/study.md" | replace "$study" control.md
done
cp "$work"/partial-ground-effect/figure_3_1[56].svg "$work"/disturbance-test-bench/figure_3_18_to_3_20.svg \
    "$work"/ceiling-envelope/figure_4_9.svg "$work"/ceiling-contact/figure_4_1[567].svg .

"$downwash" aeromap compare "$data" "$tilted" --rotor-spacing 2.5 --markdown | replace comparison aeromap.md
{ echo "\`\`\`"; "$downwash" aeromap fit "$tilted" --tilt-loss; echo "\`\`\`"; } | replace tilt aeromap.md
{ echo "\`\`\`"; "$downwash" aeromap fit "$walls" --walls; echo "\`\`\`"; } | replace walls aeromap.md
