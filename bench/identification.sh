#!/usr/bin/env bash
# Identifies random vehicles from flights of the judge, plans for some of them, and writes bench/results/identification.md.
# Half an hour of one processor.
# Usage: bench/identification.sh [VEHICLES]
set -euo pipefail
cd -P "$(dirname "${BASH_SOURCE[0]}")/.."

./dev build --target bench_identification >&2
measure() {
    build/bench/bench_identification problems/robots/ars_lrm_space.yaml "$@"
}
export -f measure
# shellcheck disable=SC2016 # the other bash expands it
bench/page.sh identification "Vehicles identified from their flights" "1 thread" bash -c '
    measure --vehicles "$1" --held-back 100
    measure --vehicles 6 --flights 5 --length 8 --seed 7 --problem problems/space/window.yaml --iterations 150' bash "${1:-200}"
