#!/usr/bin/env bash
# Flies paths of RRT-Connect and certified plans in worlds, and writes bench/results/track_paths.md. SEEDS, RUNS and LIMIT change
# how many plans, worlds of each, and the CPU time of our searches.
set -euo pipefail
cd -P "$(dirname "${BASH_SOURCE[0]}")/.."

./dev build --target programs --target bench_track_paths >&2
work=build/track_paths
rm -rf "$work"
problems=(problems/space/girder_bay.yaml problems/space/pipe_rack.yaml problems/space/window.yaml)
for seed in 1 2 3 4 5; do
    mkdir -p "$work/$seed"
    python3 problems/make_space_problems.py --seed "$seed" "$work/$seed"
    for problem in "$work/$seed"/space/*.yaml; do
        problems+=("$problem")
    done
done
bench/track_paths.py fly "$work/plans.jsonl" "${problems[@]}" --seeds "${SEEDS:-3}" --runs "${RUNS:-64}" --time-limit "${LIMIT:-20}"
bench/track_paths.py page "$work/plans.jsonl" >bench/results/track_paths.md.new
mv bench/results/track_paths.md.new bench/results/track_paths.md
cat bench/results/track_paths.md
