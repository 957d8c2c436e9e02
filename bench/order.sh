#!/usr/bin/env bash
# Compares the order of targets that the planner chooses with others, and writes bench/results/order.md. Ten minutes;
# close everything else first.
set -euo pipefail
cd -P "$(dirname "${BASH_SOURCE[0]}")/.."

./dev build --target bench_order >&2
mkdir -p bench/results
build/bench/bench_order problems/open_air.yaml "$@" >bench/results/order.md.new
mv bench/results/order.md.new bench/results/order.md
cat bench/results/order.md
