#!/usr/bin/env bash
# Lowers a deck in the middle of a flight, and writes bench/results/replan_in_space.md. Some two minutes.
set -euo pipefail
cd -P "$(dirname "${BASH_SOURCE[0]}")/.."

./dev build --target bench_replan_in_space >&2
mkdir -p bench/results
{
    printf '# A deck that turns out lower in the middle of a flight in space\n\n'
    printf 'Commit %s, %s, one thread. Made by %sbench/replan_in_space.sh%s.\n\n' "$(bench/source_commit.sh)" \
        "$(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -1)" '`' '`'
    build/bench/bench_replan_in_space problems/space/girder_bay.yaml deck "$@"
} >bench/results/replan_in_space.md.new
mv bench/results/replan_in_space.md.new bench/results/replan_in_space.md
cat bench/results/replan_in_space.md
