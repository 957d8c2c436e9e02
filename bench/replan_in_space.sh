#!/usr/bin/env bash
# Lowers a deck in the middle of a flight in space, and writes bench/results/replan_in_space.md. Some two minutes.
set -euo pipefail
cd -P "$(dirname "${BASH_SOURCE[0]}")/.."

./dev build --target bench_replan_in_space >&2
bench/page.sh replan_in_space 'A deck that turns out lower in the middle of a flight in space' 'one thread' \
    build/bench/bench_replan_in_space problems/space/girder_bay.yaml deck "$@"
