#!/usr/bin/env bash
# Identifies random vehicles from flights of the judge, and writes bench/results/identification.md. Half an hour of one processor.
# Usage: bench/identification.sh [VEHICLES]
set -euo pipefail
cd -P "$(dirname "${BASH_SOURCE[0]}")/.."

./dev build --target bench_identification >&2
bench/page.sh identification "Vehicles identified from their flights" "1 thread" \
    build/bench/bench_identification problems/robots/ars_lrm_space.yaml --vehicles "${1:-200}" --held-back 100
