#!/usr/bin/env bash
# Finds how near to a wide ceiling and to a wide floor each control law can hover, and writes bench/results/law_limits.md.
# A minute.
set -euo pipefail
cd -P "$(dirname "${BASH_SOURCE[0]}")/.."

./dev build --target bench_law_limits >&2
mkdir -p bench/results
build/bench/bench_law_limits problems/bridge_inspection.yaml --robot problems/robots/ars_lrm.yaml problems/robots/ars_lrm_ideal.yaml "$@" >bench/results/law_limits.md.new
mv bench/results/law_limits.md.new bench/results/law_limits.md
cat bench/results/law_limits.md
