#!/usr/bin/env bash
# Flies dynobench's problems of its two quadrotors, runs OMPL's RRT, SST and KPIECE on them and on the girder bay, and writes
# bench/results/dynobench_space.md. SEEDS (of first solutions and searches of 1 s), LONG_SEEDS (of 10 s) and OMPL_LIMIT change how
# many searches there are, and the CPU time of OMPL's: with SEEDS=50 LONG_SEEDS=10 OMPL_LIMIT=60, an hour and a quarter of one core.
set -euo pipefail
cd -P "$(dirname "${BASH_SOURCE[0]}")/.."

./dev build --target programs --target bench_ompl_space >&2
work=build/dynobench_space
rm -rf "$work"
mkdir -p "$work" bench/results
bench/dynobench/space_problems.py "$work/problems"
bench/dynobench/measure_in_space.py ours "$work/problems" "$work/ours.jsonl" --seeds "${SEEDS:-5}" --limits first 1
bench/dynobench/measure_in_space.py ours "$work/problems" "$work/ours.jsonl" --seeds "${LONG_SEEDS:-1}" --limits 10
for planner in rrt sst kpiece; do
    build/bench/bench_ompl_space problems/space/girder_bay.yaml "$planner" --seeds 3 --time-limit "${OMPL_LIMIT:-60}" >>"$work/ompl.jsonl"
    for problem in v0_empty_0_easy v0_recovery v1_window; do
        build/bench/bench_ompl_space "$work/problems/$problem.yaml" "$planner" --seeds 1 --time-limit "${OMPL_LIMIT:-60}" >>"$work/ompl.jsonl"
    done
done
bench/dynobench/measure_in_space.py page "$work/ours.jsonl" "$work/ompl.jsonl" >bench/results/dynobench_space.md.new
mv bench/results/dynobench_space.md.new bench/results/dynobench_space.md
bench/bars.sh --write
cat bench/results/dynobench_space.md
