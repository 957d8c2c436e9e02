#!/usr/bin/env bash
# How often targets in any order get a certified flight beside the same targets as a list, and writes
# bench/results/order_certified.md. Three and a half hours at most; close everything else first. Options go to the program:
# --first ends each search with the first plan that counts, which takes a fraction of the time and tells all but the final
# costs; --scenes 5 --times 10,30, and --file PROBLEM for another problem with targets in any order.
set -euo pipefail
cd -P "$(dirname "${BASH_SOURCE[0]}")/.."

./dev build --target bench_order_certified >&2
mkdir -p bench/results
build/bench/bench_order_certified problems/open_air.yaml "$@" >bench/results/order_certified.md.new
mv bench/results/order_certified.md.new bench/results/order_certified.md
cat bench/results/order_certified.md
