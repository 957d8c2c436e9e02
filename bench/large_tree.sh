#!/usr/bin/env bash
# Grows a tree of 100,000 nodes and writes bench/results/large_tree.md. Some five minutes.
set -euo pipefail
cd -P "$(dirname "${BASH_SOURCE[0]}")/.."

./dev build --target bench_large_tree >&2
mkdir -p bench/results
build/bench/bench_large_tree problems/bridge_inspection.yaml "$@" >bench/results/large_tree.md.new
mv bench/results/large_tree.md.new bench/results/large_tree.md
bench/bars.sh --write
cat bench/results/large_tree.md
