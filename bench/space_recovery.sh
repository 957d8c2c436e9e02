#!/usr/bin/env bash
# Throws vehicles in space at any attitude and writes bench/results/space_recovery.md. A minute.
set -euo pipefail
cd -P "$(dirname "${BASH_SOURCE[0]}")/.."

./dev build --target bench_space_recovery >&2
mkdir -p bench/results
build/bench/bench_space_recovery problems/robots/snu_f550_arm2.yaml "$@" >bench/results/space_recovery.md.new
mv bench/results/space_recovery.md.new bench/results/space_recovery.md
bench/bars.sh --write
cat bench/results/space_recovery.md
