#!/usr/bin/env python3
"""Thirty targets in any order: what first answers cost beside the best of many long searches.

Usage: bench/thirty_targets.py [--program downwash] [--seeds N] [--iterations N] >bench/results/thirty_targets.md
Limits are iterations, so that the load of the machine does not matter. bench/thirty_targets.sh builds the program first.
"""

import argparse
import math
import pathlib
import statistics
import tempfile

from program import print_bound, run

TREE = pathlib.Path(__file__).resolve().parent.parent
PROBLEM = TREE / "problems/space/girder_bay_survey.yaml"
ALLOWED = 1.05  # of the cost of the best long search


def searched(program, seed, *limits):
    """The cost of a flight through all targets and back [J], None where none was found, and the order of the targets."""
    with tempfile.TemporaryDirectory() as folder:
        record = run(program, "solve", PROBLEM, "--seed", seed, "--certify", "false", *limits, "--threads", 1, "--no-cache",
                     "--quiet", "--json", "--out", pathlib.Path(folder) / "out")
    flight = record["execution"]
    is_good = record["status"] == "solved" and flight and flight["outcome"] == "ok" and not record["order"]["left_out"]
    return (flight["cost"] if is_good else None), tuple(visit["target"] for visit in record["order"]["visits"])


def shown(cost, best):
    return "none" if cost is None else f"{cost:.0f} ({cost / best:.3f})"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--program", default=str(TREE / "build" / "downwash"))
    parser.add_argument("--seeds", type=int, default=20)
    parser.add_argument("--iterations", type=int, default=3000)
    given = parser.parse_args()
    limit = ("--max-iterations", given.iterations)
    seeds = range(1, given.seeds + 1)
    first = [searched(given.program, seed, *limit, "--stop-at-first") for seed in seeds]
    whole = [searched(given.program, seed, *limit) for seed in seeds]
    best = min(cost for cost, _ in whole if cost is not None)
    ratios = [math.inf if cost is None else cost / best for cost, _ in first]

    print(f"[{PROBLEM.name}](../../problems/space/{PROBLEM.name}): thirty gussets of a girder bay, each from its own direction, and "
          "the way back. Costs are energies\nof executed flights, hovers at the targets included, in the nominal world, without "
          f"certificates; in brackets beside the best of {given.seeds} long\nsearches. A first answer is that of a search which stops "
          f"at its first flight, a long one has {given.iterations} iterations.\n")
    print("| seed | first answer [J] | long search [J] | orders |\n| --- | ---: | ---: | --- |")
    for seed, (at_first, order), (at_last, later) in zip(seeds, first, whole):
        print(f"| {seed} | {shown(at_first, best)} | {shown(at_last, best)} | {'the same' if order == later else 'two'} |")
    print(f"\n{len(set(order for _, order in first + whole))} different orders in {2 * given.seeds} searches.\n")
    print("## Bounds\n\n| bound | found | |\n| --- | --- | --- |")
    median = statistics.median(ratios)
    print_bound(f"the first answer to thirty targets costs at most {ALLOWED} of the best of {given.seeds} long searches",
                f"median {median:.3f}, least {min(ratios):.3f}; {sum(map(math.isfinite, ratios))} of {given.seeds} have one",
                median <= ALLOWED)


if __name__ == "__main__":
    main()
