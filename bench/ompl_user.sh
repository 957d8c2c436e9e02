#!/usr/bin/env bash
# Times first solutions of a typical OMPL set-up beside ours, and writes bench/results/ompl_user.md. Half an
# hour; close everything else first.
set -euo pipefail
cd -P "$(dirname "${BASH_SOURCE[0]}")/.."

./dev build --target bench_ompl_user >&2
mkdir -p bench/results
build/bench/bench_ompl_user problems/bridge_inspection.yaml "$@" >bench/results/ompl_user.md.new
mv bench/results/ompl_user.md.new bench/results/ompl_user.md
bench/bars.sh --write
cat bench/results/ompl_user.md
