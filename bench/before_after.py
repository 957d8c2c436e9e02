#!/usr/bin/env python3
"""Plans the shipped problems with two builds of the program, on equal seeds, and writes a page of what changed.

Usage: bench/before_after.py BEFORE AFTER [--seeds N] [--time-limit S] >bench/results/before_after.md
BEFORE and AFTER are source trees with the program in build/. Both run at the same time, one search each.
"""

import argparse
import json
import pathlib
import statistics
import subprocess
import tempfile
from concurrent.futures import ThreadPoolExecutor


def solved(tree, problem, seed, limit_s):
    """What a search says of itself, or None without a plan."""
    with tempfile.TemporaryDirectory() as work:
        command = [tree / "build/downwash", "solve", tree / "problems" / problem, "--seed", str(seed)]
        command += ["--time-limit", str(limit_s), "--threads", "1", "--quiet", "--json", "--out", work + "/run"]
        out = subprocess.run(command, capture_output=True, text=True, check=False).stdout
    try:
        return json.loads(out)
    except json.JSONDecodeError:
        return None


def is_certified(run):
    return run is not None and run["status"] == "solved" and run["certificate"]["given"]


def median(values):
    return statistics.median(values) if values else None


def cell(value, form):
    return "-" if value is None else form.format(value)


def version(tree):
    command = ["git", "-C", tree, "describe", "--always", "--dirty"]
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout.strip()


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("before", type=pathlib.Path)
    parser.add_argument("after", type=pathlib.Path)
    parser.add_argument("--seeds", type=int, default=8)
    parser.add_argument("--time-limit", type=float, default=10)
    given = parser.parse_args()
    trees = [given.before.resolve(), given.after.resolve()]
    seeds = range(1, given.seeds + 1)

    print("# Plans before and after a change")
    print()  # say here what the change is
    print(
        f"The shipped problems as they are, MP-ARM-ADA, seeds 1 to {given.seeds}, {given.time_limit:g} s and one thread each; "
        f"before: commit {version(trees[0])}, after: {version(trees[1])}."
    )
    print("`flown`: cost of the reported plan's flight. `cheaper`: seeds on which one of the two flown plans is cheaper by more than 1 %.")
    print("Made by `bench/before_after.py`.")
    print()
    print("| problem | certified before | after | flown before, median | after | cheaper before | after | first certified before, median | after |")
    print("| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |")
    for problem in sorted(path.name for path in (trees[1] / "problems").glob("*.yaml")):
        def runs_of(tree, name=problem):
            return [solved(tree, name, seed, given.time_limit) for seed in seeds]

        with ThreadPoolExecutor(2) as pool:
            runs = list(pool.map(runs_of, trees))
        cells = [problem.removesuffix(".yaml")]
        cells += [f"{sum(is_certified(run) for run in of_tree)}/{len(seeds)}" for of_tree in runs]
        costs = [
            {seed: run["execution"]["cost"] for seed, run in zip(seeds, of_tree) if is_certified(run)} for of_tree in runs
        ]
        cells += [cell(median(list(of_tree.values())), "{:.0f}") for of_tree in costs]
        both = costs[0].keys() & costs[1].keys()
        cells += [str(sum(costs[i][s] < 0.99 * costs[1 - i][s] for s in both)) for i in (0, 1)]
        times = [
            [run["planning"]["first_certified_wall_s"] for run in of_tree if is_certified(run)] for of_tree in runs
        ]
        cells += [cell(median([t for t in of_tree if t is not None]), "{:.2f} s") for of_tree in times]
        print("| " + " | ".join(cells) + " |", flush=True)


if __name__ == "__main__":
    main()
