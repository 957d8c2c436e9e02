#!/usr/bin/env bash
# Do two builds plan the same flights? Solves every shipped problem with three variants and seeds 1 to 5 by both, and compares
# trajectory.csv byte by byte, and cost, certificate and safe stops of solution.json. A change that is to change no result passes
# with no difference.
# Usage: bench/same_bytes.sh OTHER_BUILD/downwash [iterations, default 600] [seeds, default 5] [folder of the problems]
# An older build may know keys only by their former names: give it the problems of its own version, which both read.
set -euo pipefail
cd -P "$(dirname "${BASH_SOURCE[0]}")/.."

other=${1:?usage: bench/same_bytes.sh OTHER_BUILD/downwash [iterations] [seeds] [problems]}
iterations=${2:-600}
seeds=${3:-5}
problems=${4:-problems}
here=build/downwash
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

# hash PROGRAM PROBLEM VARIANT SEED: of the flight and what is said of it; exit codes 1 and 3 are results too.
hash() {
    local out="$folder/$3-$4" code=0
    rm -rf "$out"
    XDG_CACHE_HOME="$folder/cache" "$1" solve "$2" --variant "$3" --seed "$4" --max-iterations "$iterations" --quiet --out "$out" \
        >"$folder/log" 2>&1 || code=$?
    if [[ $code -eq 2 || $code -gt 3 ]]; then
        cat "$folder/log" >&2
        return 1
    fi
    if [[ ! -e $out/trajectory.csv ]]; then
        echo "no plan"
        return
    fi
    {
        cat "$out/trajectory.csv"
        python3 -c 'import json, sys; said = json.load(sys.stdin); print([said[key] for key in ("cost", "certificate", "stops")])' \
            <"$out/solution.json"
    } | sha256sum | cut -c1-16
}

different=0
printf '| problem | variant | seed | %s | %s |\n| --- | --- | --- | --- | --- |\n' "$here" "$other"
for problem in "$problems"/*.yaml; do
    for variant in mp-arm mp-arm-da mp-arm-ada; do
        for ((seed = 1; seed <= seeds; ++seed)); do
            new=$(hash "$here" "$problem" "$variant" "$seed")
            old=$(hash "$other" "$problem" "$variant" "$seed")
            mark=same
            if [[ $new != "$old" ]]; then
                mark=DIFFERENT
                different=$((different + 1))
            fi
            printf '| %s | %s | %d | %s | %s |\n' "$(basename "$problem" .yaml)" "$variant" "$seed" "$new" "$mark"
        done
    done
done
printf '\n%d different\n' "$different"
[[ $different -eq 0 ]]
