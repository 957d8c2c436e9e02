#!/usr/bin/env bash
# Flies what the hover analysis has a verdict on, and writes bench/results/hover_flights.md. Some minutes.
set -euo pipefail
cd -P "$(dirname "${BASH_SOURCE[0]}")/.."

./dev build --target bench_hover_flights >&2
problems=(problems/bridge_inspection.yaml)  # first: its bounds hold the random scenes
for file in problems/*.yaml; do
    # In open air there is nothing to be unstable about.
    [[ $file == */bridge_inspection.yaml || $file == */open_air.yaml ]] || problems+=("$file")
done
mkdir -p bench/results
build/bench/bench_hover_flights "${problems[@]}" "$@" >bench/results/hover_flights.md.new
mv bench/results/hover_flights.md.new bench/results/hover_flights.md
cat bench/results/hover_flights.md
