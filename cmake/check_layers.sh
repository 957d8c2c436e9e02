#!/usr/bin/env bash
# Checks the layering: a module includes headers only from the modules below it, and the headers that are
# installed show neither Eigen, OMPL, FCL nor any other library of ours.
# Usage: cmake/check_layers.sh [root of the tree]
set -euo pipefail

cd "${1:-$(dirname "${BASH_SOURCE[0]}")/..}"

# Who may use whom, itself aside, by the names under which headers are included: the last part of a folder. `*` knows
# everything.
layers='
base:
logs:                  base
scene:                 base
dynamics:              base
aeromap/effects:       base
aeromap/grids:         base scene
aeromap:               base scene effects grids
aeromap/fitting:       base effects
controllers:           base dynamics
simulation:            base scene dynamics effects grids aeromap controllers
identification:        base logs scene dynamics effects grids aeromap controllers simulation
problems:              base scene dynamics effects grids aeromap controllers simulation
problems/thrust_stand: base
problems/robot_import: base scene dynamics effects grids aeromap controllers simulation problems
planner/search:        base scene dynamics effects grids aeromap controllers simulation problems
planner/ompl_planners: base scene dynamics effects grids aeromap controllers simulation problems search
planner:               base scene dynamics effects grids aeromap controllers simulation problems search ompl_planners
planner/ompl:          base scene dynamics effects grids aeromap controllers simulation problems search ompl_planners planner
results:               base scene dynamics effects grids aeromap controllers simulation problems search planner
results/mavlink:       base
results/comparison:    base logs scene dynamics effects grids aeromap controllers simulation problems
results/exports:       base scene dynamics effects grids aeromap controllers simulation problems search planner results mavlink
judge:                 base scene dynamics effects grids aeromap controllers simulation problems results
apps/report:           base scene dynamics effects grids aeromap controllers simulation problems search planner results
bench/studies:         base scene dynamics effects grids aeromap controllers simulation problems search planner results report
apps/python:           base scene dynamics effects grids aeromap controllers simulation problems search planner results judge fitting exports report studies
apps/cli:              *
bench:                 *
docs:                  *
tests:                 *
'

# These modules are parts of one library and share their private headers.
one_library='search ompl_planners planner ompl'

# The judge looks at plans independently. Of what computes flights it may use parameters, types, the formulas of surface effects
# and the random numbers of worlds, and nothing else.
judge_may='aeromap/aero_settings.hpp aeromap/direct_effect.hpp controllers/plan.hpp controllers/configuration.hpp controllers/reference_point.hpp controllers/space_axes.hpp controllers/space_reference.hpp
dynamics/plant.hpp dynamics/plant_model.hpp effects/effect_models.hpp effects/rotor_layout.hpp scene/planar_pose.hpp scene/plane_of_motion.hpp scene/shapes.hpp simulation/flight_model.hpp
simulation/contact_goal.hpp simulation/goal.hpp simulation/noise.hpp simulation/robot.hpp simulation/space_goal.hpp simulation/space_robot.hpp simulation/space_touch.hpp simulation/space_world_description.hpp simulation/space_world_parameters.hpp simulation/uncertainty.hpp simulation/world.hpp simulation/world_parameters.hpp results/claims.hpp'

# The headers that a module keeps to itself stand behind PRIVATE_HEADERS in its CMakeLists.txt.
private_headers() {
    local list
    for list in */CMakeLists.txt */*/CMakeLists.txt; do
        awk -v module="$(basename "${list%/*}")" '
            { sub(/#.*/, ""); gsub(/[()]/, " & ") }
            {
                for (i = 1; i <= NF; ++i) {
                    if ($i == "PRIVATE_HEADERS") inside = 1
                    else if ($i == ")" || $i ~ /^[A-Z_]+$/) inside = 0
                    else if (inside) print module "/" $i
                }
            }' "$list"
    done
}

mapfile -t files < <(find ./*/ -name 'build*' -prune -o \
    -type f \( -name '*.hpp' -o -name '*.cpp' -o -name '*.h' -o -name '*.inc' -o -name '*.ipp' \) -print |
    sed 's|^\./||; s|//|/|' | grep -v '^build' | LC_ALL=C sort || true)
if [[ ${#files[@]} -eq 0 ]]; then
    echo "check_layers: no source files below $PWD" >&2
    exit 2
fi

awk -v layers="$layers" -v one_library="$one_library" -v private_list="$(private_headers)" -v judge_may="$judge_may" '
    function error(text) { print FILENAME ":" FNR ": " text; ++errors }
    BEGIN {
        n = split(layers, lines, "\n")
        for (i = 1; i <= n; ++i) {
            if (split(lines[i], pair, ":") < 2) continue
            known[pair[1]] = 1
            m = split(pair[2], words, " ")
            for (j = 1; j <= m; ++j) may[pair[1], words[j]] = 1
        }
        n = split(private_list, words, "\n")
        for (i = 1; i <= n; ++i) kept[words[i]] = 1
        n = split(judge_may, words, " ")
        for (i = 1; i <= n; ++i) shared[words[i]] = 1
        n = split(one_library, words, " ")
        for (i = 1; i <= n; ++i) together[words[i]] = 1
    }
    FNR == 1 {
        folder = FILENAME
        while (sub(/\/[^\/]*$/, "", folder) && !(folder in known)) {}
        if (!(folder in known)) error("the folder \"" folder "\" has no place in the layering; give it one in cmake/check_layers.sh")
        module = folder
        sub(/.*\//, "", module)
        everything = (folder, "*") in may
        knows_inside = module == "tests" || FILENAME ~ /^bench\/(nearest_places|space_oracle)\// # which measures what users do not see
        included_as = module substr(FILENAME, length(folder) + 1)
        shown = FILENAME ~ /\.hpp$/ && !(included_as in kept) && !everything && module != "python" # which installs no header
    }
    /^[ \t]*#[ \t]*include[ \t]*[<"]/ {
        header = $0
        sub(/^[^<"]*[<"]/, "", header)
        sub(/[>"].*/, "", header)
        if (header ~ /^downwash\//) {
            target = header
            sub(/^downwash\//, "", target)
            if (target == "standard_library.hpp") next # written by cmake/standard_library.cmake
            used = target
            sub(/\/.*/, "", used)
            if (used != module && !everything && !((folder, used) in may))
                error(folder "/ may not use " used "/ (" header ")")
            if (module == "judge" && used != "judge" && used != "base" && used != "problems" && !(target in shared))
                error("the judge shares no " header " with what it judges")
            if (target in kept && used != module && !knows_inside && !(used in together && module in together))
                error(header " is private to " used "/")
            if (shown && target in kept)
                error("an installed header includes " header ", which is not installed")
        } else if ($0 ~ /include[ \t]*"/ && !everything) {
            error("write \"downwash/module/header.hpp\" instead of \"" header "\"")
        } else if (shown && header ~ /\// && header !~ /^sys\// && !(module == "ompl" && header ~ /^ompl\//)) {
            error("an installed header shows <" header ">; only the standard library may be seen from outside")
        }
    }
    END {
        if (errors) { print errors " error(s) in the layering"; exit 1 }
        print "layering holds in " ARGC - 1 " files"
    }' "${files[@]}"
