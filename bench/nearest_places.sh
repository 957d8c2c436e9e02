#!/usr/bin/env bash
# Measures queries for nearest neighbours and writes bench/results/nearest_places.md. Some seconds.
set -euo pipefail
cd -P "$(dirname "${BASH_SOURCE[0]}")/.."

./dev build --target bench_nearest_places >&2
mkdir -p bench/results
build/bench/bench_nearest_places problems/bridge_inspection.yaml >bench/results/nearest_places.md.new
mv bench/results/nearest_places.md.new bench/results/nearest_places.md
cat bench/results/nearest_places.md
