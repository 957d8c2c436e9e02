#!/usr/bin/env bash
# Checks what files reach through others: there is no circle of includes, and the judge sees nothing that computes flights.
# A header and the source beside it (x.hpp, x.cpp) count as one: x may not need what needs x.
# Usage: cmake/check_includes.sh [root of the tree]
set -euo pipefail

cd "${1:-$(dirname "${BASH_SOURCE[0]}")/..}"

# What judge/ may reach, through however many headers, of the modules that compute flights: descriptions, which compute nothing,
# and the random numbers of worlds.
judge_may='controllers/actuation controllers/aided_law controllers/aids controllers/axes controllers/cascaded_pid
controllers/configuration controllers/control_law controllers/model_inversion controllers/plan controllers/planar_lyapunov
controllers/reference_point controllers/reference_segment controllers/rest controllers/space_axes controllers/space_law controllers/space_limits
controllers/space_reference controllers/space_segment controllers/yaw_mode dynamics/lane_vector
dynamics/plant dynamics/plant_model dynamics/slipstreams dynamics/space_model dynamics/space_plant dynamics/plant_state simulation/contact_goal simulation/flight_memory simulation/flight_model simulation/flight_sums simulation/goal simulation/noise
simulation/pose simulation/robot simulation/robot_uncertainty simulation/space_carry simulation/space_goal simulation/space_robot simulation/space_touch
simulation/space_world_description simulation/space_world_parameters simulation/tick_model simulation/uncertainty
simulation/vehicle_state simulation/world simulation/world_numbers simulation/world_parameters'

# The folders of modules: headers are included by the last part of their names.
modules=$(grep -l 'downwash_module(' ./*/CMakeLists.txt ./*/*/CMakeLists.txt | sed 's|^\./||; s|/CMakeLists.txt||')

mapfile -t files < <(find ./*/ -name 'build*' -prune -o \
    -type f \( -name '*.hpp' -o -name '*.cpp' -o -name '*.h' -o -name '*.inc' -o -name '*.ipp' \) -print |
    sed 's|^\./||; s|//|/|' | grep -v '^build' | LC_ALL=C sort || true)
if [[ ${#files[@]} -eq 0 ]]; then
    echo "check_includes: no source files below $PWD" >&2
    exit 2
fi

awk -v judge_may="$judge_may" -v modules="$modules" '
    function concept(file) { sub(/\.[a-z]+$/, "", file); return file }
    # The name of a file as it is included, or its path outside of modules.
    function included_as(file,    folder) {
        folder = file
        while (sub(/\/[^\/]*$/, "", folder)) {
            if (!(folder in is_module)) continue
            file = substr(file, length(folder) + 1)
            sub(/.*\//, "", folder)
            return folder file
        }
        return file
    }
    # Depth first: a concept that is met again before all that it needs is done closes a circle.
    function visit(node,    list, count, i) {
        state[node] = 1
        path[++depth] = node
        count = split(needs[node], list, " ")
        for (i = 1; i <= count; ++i) {
            if (state[list[i]] == 1) report(list[i])
            else if (!state[list[i]]) visit(list[i])
        }
        --depth
        state[node] = 2
    }
    function report(first,    text, i) {
        for (i = depth; path[i] != first; --i) text = " -> " path[i] text
        print "circle of includes: " first text " -> " first
        ++errors
    }
    # Notes what the judge reaches, and through what.
    function reach(node, from,    list, count, i, module) {
        if (node in from_of) return
        from_of[node] = from
        module = node
        sub(/\/.*/, "", module)
        if ((module == "dynamics" || module == "controllers" || module == "simulation") && !(node in allowed)) {
            print "the judge reaches " node " through " from
            ++errors
        }
        count = split(header_needs[node], list, " ")
        for (i = 1; i <= count; ++i) reach(list[i], node)
    }
    BEGIN {
        count = split(judge_may, words, " ")
        for (i = 1; i <= count; ++i) allowed[words[i]] = 1
        count = split(modules, words, "\n")
        for (i = 1; i <= count; ++i) is_module[words[i]] = 1
    }
    FNR == 1 {
        folder = included_as(FILENAME)
        own = concept(folder)
        sub(/[^\/]*$/, "", folder)
        is_header = FILENAME !~ /\.cpp$/
        known[own] = 1
    }
    /^[ \t]*#[ \t]*include[ \t]*[<"]/ {
        header = $0
        sub(/^[^<"]*[<"]/, "", header)
        sub(/[>"].*/, "", header)
        if (header ~ /^downwash\//) sub(/^downwash\//, "", header)
        else if ($0 ~ /include[ \t]*"/) {
            header = folder header
            while (sub(/[^\/]+\/\.\.\//, "", header)) {}
        } else next
        target = concept(header)
        if (target == own) next
        needs[own] = needs[own] " " target
        if (is_header || own ~ /^judge\//) header_needs[own] = header_needs[own] " " target
    }
    END {
        for (node in known) if (!state[node]) visit(node)
        for (node in known) if (node ~ /^judge\//) reach(node, "itself")
        if (errors) { print errors " error(s) in what is included"; exit 1 }
        print "no circle of includes in " ARGC - 1 " files, and the judge sees no tick"
    }' "${files[@]}"
