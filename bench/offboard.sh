#!/usr/bin/env bash
# Flies missions of docs/examples/offboard whose link has faults, and writes bench/results/offboard.md. Some minutes.
set -euo pipefail
cd -P "$(dirname "${BASH_SOURCE[0]}")/.."

./dev build --target bench_offboard >&2
bench/page.sh offboard 'Missions over a link with faults' '2 threads' \
    build/bench/bench_offboard docs/examples/offboard/girder.yaml bottom_flange "$@"
