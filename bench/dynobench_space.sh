#!/usr/bin/env bash
# Flies dynobench's problems of its two quadrotors, runs OMPL's RRT, SST and KPIECE on them and on the girder bay, and writes
# bench/results/dynobench_space.md. SEEDS, OMPL_SEEDS and OMPL_LIMIT change
# how many searches there are, and the CPU time of OMPL's: with 50 seeds, three hours of one core for ours.
set -euo pipefail
cd -P "$(dirname "${BASH_SOURCE[0]}")/.."

./dev build --target programs --target bench_ompl_space >&2
work=build/dynobench_space
rm -rf "$work"
mkdir -p "$work" bench/results
bench/dynobench/space_problems.py "$work/problems"
bench/dynobench/measure_in_space.py ours "$work/problems" "$work/ours.jsonl" --seeds "${SEEDS:-5}"
for problem in "$work"/problems/*.yaml problems/space/girder_bay.yaml; do
    for planner in rrt sst kpiece; do
        build/bench/bench_ompl_space "$problem" "$planner" --seeds "${OMPL_SEEDS:-3}" --time-limit "${OMPL_LIMIT:-60}" >>"$work/ompl.jsonl"
    done
done
bench/dynobench/measure_in_space.py page "$work/ours.jsonl" "$work/ompl.jsonl" >bench/results/dynobench_space.md.new
mv bench/results/dynobench_space.md.new bench/results/dynobench_space.md
bench/bars.sh --write
cat bench/results/dynobench_space.md
