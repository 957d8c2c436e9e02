#!/usr/bin/env bash
# Measures queries and searches with our own collision checker and with FCL's, and writes bench/results/collision_checkers.md.
# About ten minutes. Figures are processor times, so other programs on the machine disturb them little.
set -euo pipefail
cd -P "$(dirname "${BASH_SOURCE[0]}")/.."

./dev build --target bench_collision_checkers >&2
mkdir -p bench/results
build/bench/bench_collision_checkers problems/*.yaml "$@" >bench/results/collision_checkers.md.new
mv bench/results/collision_checkers.md.new bench/results/collision_checkers.md
cat bench/results/collision_checkers.md
