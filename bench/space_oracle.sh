#!/usr/bin/env bash
# Flies the shipped planar robot along plans of the shipped planar problems in the plane and in space, and writes
# bench/results/space_oracle.md. A minute.
set -euo pipefail
cd -P "$(dirname "${BASH_SOURCE[0]}")/.."

./dev build --target bench_space_oracle >&2
mkdir -p bench/results
build/bench/bench_space_oracle problems/robots/ars_lrm_space.yaml problems/*.yaml "$@" >bench/results/space_oracle.md.new
mv bench/results/space_oracle.md.new bench/results/space_oracle.md
bench/bars.sh --write
cat bench/results/space_oracle.md
