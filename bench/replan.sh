#!/usr/bin/env bash
# Changes scenes in the middle of flights, and writes bench/results/replan.md. Some twenty minutes.
set -euo pipefail
cd -P "$(dirname "${BASH_SOURCE[0]}")/.."

./dev build --target bench_replan >&2
mkdir -p bench/results
{
    printf '# Changes in the middle of a flight\n\n'
    printf 'Commit %s, %s, 2 threads. Made by `bench/replan.sh`.\n\n' "$(bench/source_commit.sh)" \
        "$(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -1)"
    build/bench/bench_replan problems/bridge_inspection.yaml "$@"
} >bench/results/replan.md.new
mv bench/results/replan.md.new bench/results/replan.md
cat bench/results/replan.md
