#!/usr/bin/env bash
# Checks that the house stands: a folder includes headers only from the folders below it, and the headers that are
# installed show neither Eigen, OMPL, FCL nor any other library of ours.
# Usage: cmake/check_layers.sh [root of the tree]
set -euo pipefail

cd "${1:-$(dirname "${BASH_SOURCE[0]}")/..}"

# Who may use whom, itself aside. `*` knows everything.
layers='
base:
scene:       base
dynamics:    base
effects:     base
grids:       base scene
aeromap:     base scene effects grids
controllers: base dynamics
simulation:  base scene dynamics effects grids aeromap controllers
planner:     base scene dynamics effects grids aeromap controllers simulation
problems:    base scene dynamics effects grids aeromap controllers simulation planner
exports:     base scene dynamics effects grids aeromap controllers simulation planner problems
report:      base scene dynamics effects grids aeromap controllers simulation planner problems
cli:         *
bench:       *
docs:        *
tests:       *
examples:    *
'

# The headers that a room keeps to itself stand behind PRIVATE_HEADERS in its CMakeLists.txt.
private_headers() {
    local list
    for list in */CMakeLists.txt; do
        awk -v room="${list%%/*}" '
            { sub(/#.*/, ""); gsub(/[()]/, " & ") }
            {
                for (i = 1; i <= NF; ++i) {
                    if ($i == "PRIVATE_HEADERS") inside = 1
                    else if ($i == ")" || $i ~ /^[A-Z_]+$/) inside = 0
                    else if (inside) print room "/" $i
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

awk -v layers="$layers" -v private_list="$(private_headers)" '
    function fault(text) { print FILENAME ":" FNR ": " text; ++faults }
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
    }
    FNR == 1 {
        room = FILENAME
        sub(/\/.*/, "", room)
        everything = (room, "*") in may
        shown = FILENAME ~ /\.hpp$/ && !(FILENAME in kept) && !everything
        if (!(room in known)) fault("the folder \"" room "\" has no place in the house; give it one in cmake/check_layers.sh")
    }
    /^[ \t]*#[ \t]*include[ \t]*[<"]/ {
        header = $0
        sub(/^[^<"]*[<"]/, "", header)
        sub(/[>"].*/, "", header)
        if (header ~ /^downwash\//) {
            target = header
            sub(/^downwash\//, "", target)
            used = target
            sub(/\/.*/, "", used)
            if (used != room && !everything && !((room, used) in may))
                fault(room "/ may not use " used "/ (" header ")")
            if (target in kept && used != room && room != "tests")
                fault(header " is private to " used "/")
            if (shown && target in kept)
                fault("an installed header includes " header ", which is not installed")
        } else if ($0 ~ /include[ \t]*"/ && !everything) {
            fault("write \"downwash/room/header.hpp\" instead of \"" header "\"")
        } else if (shown && header ~ /\// && header !~ /^sys\//) {
            fault("an installed header shows <" header ">; only the standard library may be seen from outside")
        }
    }
    END {
        if (faults) { print faults " fault(s) in the layering"; exit 1 }
        print "layering holds in " ARGC - 1 " files"
    }' "${files[@]}"
