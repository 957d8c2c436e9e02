#!/usr/bin/env bash
# Changes scenes in the middle of flights, and writes bench/results/replan.md. Some twenty minutes.
set -euo pipefail
cd -P "$(dirname "${BASH_SOURCE[0]}")/.."

./dev build --target bench_replan >&2
bench/page.sh replan 'Changes in the middle of a flight' '2 threads' \
    build/bench/bench_replan problems/bridge_inspection.yaml "$@"
