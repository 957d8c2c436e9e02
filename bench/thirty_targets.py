#!/usr/bin/env python3
"""Thirty targets in any order: what answers cost beside the best of many long searches, and their order beside others.

Usage: bench/thirty_targets.py [--program downwash] [--legs-program bench_legs_in_space] [--legs TABLE] [--seeds N]
                               [--iterations N] [--leg-iterations N] >bench/results/thirty_targets.md
Limits are iterations, so that the load of the machine does not matter. bench/thirty_targets.sh builds the programs first.
"""

import argparse
import math
import pathlib
import random
import statistics
import subprocess
import tempfile

from program import print_bound, run

TREE = pathlib.Path(__file__).resolve().parent.parent
PROBLEM = TREE / "problems/space/girder_bay_survey.yaml"
ALLOWED = 1.05  # of the cost of the best long search, and of the best order


def searched(program, seed, *limits):
    """The cost of a flight through all targets and back [J], None where none was found, and the order of the targets."""
    with tempfile.TemporaryDirectory() as folder:
        record = run(program, "solve", PROBLEM, "--seed", seed, "--certify", "false", *limits, "--threads", 1, "--no-cache",
                     "--quiet", "--json", "--out", pathlib.Path(folder) / "out")
    flight = record["execution"]
    is_good = record["status"] == "solved" and flight and flight["outcome"] == "ok" and not record["order"]["left_out"]
    return (flight["cost"] if is_good else None), tuple(visit["target"] - 1 for visit in record["order"]["visits"])


class Legs:
    """Costs of all legs, each planned as a problem of its own [J]."""

    def __init__(self, table):
        self.rows = [[float(cost) for cost in line.split()] for line in table.splitlines()]
        self.targets = len(self.rows) - 1  # beside them the start

    def cost(self, order):
        stations = [-1, *order, self.targets]
        return sum(self.rows[begin][end] for begin, end in zip(stations, stations[1:]))

    def improved(self, order):
        """The order after moves and reversals of sections, until none helps (Or-opt and 2-opt)."""
        least, is_better = self.cost(order), True
        while is_better:
            is_better = False
            for begin in range(len(order)):
                for end in range(begin + 1, len(order) + 1):
                    section, rest = order[begin:end], order[:begin] + order[end:]
                    places = range(len(rest) + 1) if len(section) <= 3 else [begin]
                    for changed in (rest[:at] + part + rest[at:] for at in places for part in (section, section[::-1])):
                        cost = self.cost(changed)
                        if cost < least - 1e-6:
                            order, least, is_better = changed, cost, True
                            break
        return order

    def best(self, starts):
        """The best order of local searches from some orders and from random ones."""
        dice = random.Random(1)
        starts = [list(start) for start in starts] + [dice.sample(range(self.targets), self.targets) for _ in range(40)]
        return min((self.improved(start) for start in starts), key=self.cost)


def shown(cost, best):
    return "none" if cost is None else f"{cost:.0f} ({cost / best:.3f})"


def print_answers(first, whole):
    """@return the ratios of first answers and of long searches to the best long search"""
    best = min(cost for cost, _ in whole if cost is not None)
    print("| seed | first answer [J] | long search [J] | orders |\n| --- | ---: | ---: | --- |")
    for seed, ((at_first, order), (at_last, later)) in enumerate(zip(first, whole), 1):
        print(f"| {seed} | {shown(at_first, best)} | {shown(at_last, best)} | {'the same' if order == later else 'two'} |")
    print(f"\n{len(set(order for _, order in first + whole))} different orders in {len(first) + len(whole)} searches.\n")
    return [[math.inf if cost is None else cost / best for cost, _ in some] for some in (first, whole)]


def print_orders(legs, orders):
    """@return the ratios of the costs of orders to that of the best one, by legs"""
    best = legs.best(set(orders))
    costs = [legs.cost(order) / legs.cost(best) for order in orders]
    dice = random.Random(2)
    chance = [legs.cost(dice.sample(range(legs.targets), legs.targets)) / legs.cost(best) for _ in range(1000)]
    print("## Orders by legs\n")
    print(f"Each of the {legs.targets * legs.targets + legs.targets + 1} legs is planned as a problem of its own, by two searches "
          "(by more where these find none), of which the cheapest\nflight counts. The planner does not see these flights. The best order "
          "by their costs is that of local searches from 40 random orders and from the planner's.\n")
    print(f"Best order: {', '.join(str(target + 1) for target in best)}, {legs.cost(best):.0f} J. The orders of first answers cost "
          f"{min(costs):.3f} to {max(costs):.3f} of that; random\norders {min(chance):.3f} to {max(chance):.3f}, in the median "
          f"{statistics.median(chance):.3f}.\n")
    return costs


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--program", default=str(TREE / "build" / "downwash"))
    parser.add_argument("--legs-program", default=str(TREE / "build/bench/bench_legs_in_space"))
    parser.add_argument("--legs", type=pathlib.Path, help="a table that bench_legs_in_space has printed before")
    parser.add_argument("--seeds", type=int, default=20)
    parser.add_argument("--iterations", type=int, default=3000)
    parser.add_argument("--leg-iterations", type=int, default=80)
    given = parser.parse_args()
    limit = ("--max-iterations", given.iterations)
    seeds = range(1, given.seeds + 1)
    first = [searched(given.program, seed, *limit, "--stop-at-first") for seed in seeds]
    whole = [searched(given.program, seed, *limit) for seed in seeds]
    table = given.legs.read_text() if given.legs else subprocess.run(
        [given.legs_program, PROBLEM, "--iterations", str(given.leg_iterations)], check=True, text=True,
        stdout=subprocess.PIPE).stdout

    print(f"[{PROBLEM.name}](../../problems/space/{PROBLEM.name}): thirty gussets of a girder bay, each from its own direction, and "
          "the way back. Costs are energies\nof executed flights, hovers at the targets included, in the nominal world, without "
          f"certificates; in brackets beside the best of {given.seeds} long\nsearches. A first answer is that of a search which stops "
          f"at its first flight, a long one has {given.iterations} iterations.\n")
    at_first, at_last = print_answers(first, whole)
    orders = print_orders(Legs(table), [order for cost, order in first if cost is not None])
    print("## Bounds\n\n| bound | found | |\n| --- | --- | --- |")
    for name, ratios in (("the first answer to thirty targets", at_first), ("a long search for thirty targets", at_last)):
        print_bound(f"{name} costs at most {ALLOWED} of the best of {given.seeds} long searches",
                    f"median {statistics.median(ratios):.3f}, least {min(ratios):.3f}; {sum(map(math.isfinite, ratios))} of "
                    f"{given.seeds} have one", statistics.median(ratios) <= ALLOWED)
    print_bound(f"the order of a first answer costs at most {ALLOWED} of the best order, by legs", f"at most {max(orders):.3f}",
                max(orders) <= ALLOWED)


if __name__ == "__main__":
    main()
