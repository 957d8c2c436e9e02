#!/usr/bin/env bash
# Flies dynobench's problems of the planar rotor and random scenes of their kind, runs OMPL's RRT and SST beside, and writes
# bench/results/dynobench.md. An hour on two cores, of which each search has one; close everything else first.
set -euo pipefail
cd -P "$(dirname "${BASH_SOURCE[0]}")/.."

./dev build --target programs --target bench_dynobench_ompl >&2
work=build/dynobench
rm -rf "$work"
mkdir -p "$work" bench/results
bench/dynobench/measure.py ours "$work/ours.jsonl" --seeds 5 --limits 1 10 60
bench/dynobench/random_scenes.py "$work/scenes"
bench/dynobench/measure.py ours "$work/random.jsonl" --seeds 1 --limits 10 --problems "$work"/scenes/*.yaml
for problem in empty_0 empty_1 fall_through quad_bugtrap quad_obs_column; do
    for planner in rrt sst; do # two at a time, as ours
        build/bench/bench_dynobench_ompl "bench/dynobench/$problem.yaml" "$planner" >"$work/ompl.$problem.$planner.jsonl" &
    done
    wait -n # the failure of either ends the script
    wait -n
done
cat "$work"/ompl.*.jsonl >"$work/ompl.jsonl"
bench/dynobench/measure.py page "$work/ours.jsonl" "$work/random.jsonl" "$work/ompl.jsonl" >bench/results/dynobench.md.new
mv bench/results/dynobench.md.new bench/results/dynobench.md
bench/bars.sh --write
cat bench/results/dynobench.md
