#!/usr/bin/env bash
# Measures what the aero map costs and writes bench/results/aero_map.md. A few minutes; close everything else.
set -euo pipefail
cd -P "$(dirname "${BASH_SOURCE[0]}")/.."

./dev build --target bench_aero_map >&2
mkdir -p bench/results
build/bench/bench_aero_map bench/aero_map/girder_deck.yaml problems/*.yaml "$@" \
    >bench/results/aero_map.md.new
mv bench/results/aero_map.md.new bench/results/aero_map.md
bench/bars.sh --write
cat bench/results/aero_map.md
