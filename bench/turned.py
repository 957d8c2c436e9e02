#!/usr/bin/env python3
"""The same problem turned about the vertical, shifted, and a planar one written in space: what plans cost.

Usage: bench/turned.py [--program downwash] [--seeds N] [--iterations N] >bench/results/turned.md
Limits are iterations, so that the load of the machine does not matter. bench/turned.sh builds the program first.
"""

import argparse
import copy
import math
import pathlib
import statistics
import tempfile

import yaml
from program import print_bound, run

TREE = pathlib.Path(__file__).resolve().parent.parent
PROBLEMS = TREE / "problems"
TURNED = ("space/around_a_girder", "space/girder_bay")
ANGLES_DEG = (17, 45, 90, 133)
SHIFT_M = (103.7, -57.3, 12.9)
PLANAR = ("bridge_inspection", "open_air", "window")
BESIDE_PLANE_M = 3.0  # how far the vehicle may leave the plane to each side
ALIKE = 0.05  # p below this: the costs differ


def read(name):
    """A problem whose robot is found from anywhere, without an uncertainty: costs are those of the nominal world."""
    file = PROBLEMS / f"{name}.yaml"
    problem = yaml.safe_load(file.read_text(encoding="utf-8"))
    problem["robot"] = str((file.parent / problem["robot"]).resolve())
    problem.pop("uncertainty", None)
    return problem


def moved(problem, angle_deg, shift_m):
    """The problem turned about the vertical through the origin, then shifted.

    Bounds do not turn. So those of the problem at any angle, and of the unturned one too, are the square around all of them.
    """
    problem = copy.deepcopy(problem)
    angle = math.radians(angle_deg)
    cosine, sine = math.cos(angle), math.sin(angle)

    def direction(at):
        return [cosine * at[0] - sine * at[1], sine * at[0] + cosine * at[1], at[2]]

    def place(at):
        return [a + b for a, b in zip(direction(at), shift_m)]

    environment = problem["environment"]
    for obstacle in environment["obstacles"]:
        for shape in obstacle.values():
            if isinstance(shape, dict):
                shape["center_m"] = place(shape.get("center_m", [0, 0, 0]))
                roll, pitch, yaw = shape.get("rpy_deg", [0, 0, 0])
                shape["rpy_deg"] = [roll, pitch, yaw + angle_deg]
    bounds = environment["bounds"]
    half_m = math.hypot(max(map(abs, bounds["x_m"])), max(map(abs, bounds["y_m"])))
    for axis, by_m in zip(("x_m", "y_m"), shift_m):
        bounds[axis] = [by_m - half_m, by_m + half_m]
    bounds["z_m"] = [z_m + shift_m[2] for z_m in bounds["z_m"]]
    start = problem["start"]
    start["x_m"], start["y_m"], start["z_m"] = place([start["x_m"], start["y_m"], start["z_m"]])
    start["yaw_deg"] = start.get("yaw_deg", 0) + angle_deg
    tool = problem["goal"]["end_effector"]
    tool["position_m"] = place(tool["position_m"])
    tool["direction"] = direction(tool["direction"])
    return problem


def in_space(problem):
    """A planar problem, in the plane y = 0 with heading 0, written as one in space: y is free."""
    problem = copy.deepcopy(problem)
    environment = problem["environment"]
    environment.pop("plane", None)
    environment["bounds"]["y_m"] = [-BESIDE_PLANE_M, BESIDE_PLANE_M]
    problem["robot"] = str(PROBLEMS / "robots" / "ars_lrm_space.yaml")
    start = problem["start"]
    start.update({"y_m": 0, "yaw_deg": 0, "joints_deg": [start.pop("arm_deg")]})
    goal = problem["goal"]
    if "configuration" in goal:
        at = goal["configuration"]
        at.update({"y_m": 0, "yaw_deg": 0, "joints_deg": [at.pop("arm_deg")]})
    else:
        tool = goal["end_effector"]
        tool["position_m"] = [tool.pop("x_m"), 0, tool.pop("z_m")]
    return problem


def costs_of(program, problem, folder, seeds, iterations):
    """The costs of the executed plans by seed; None where there is no plan that flies."""
    file = folder / "problem.yaml"
    file.write_text(yaml.safe_dump(problem, sort_keys=False), encoding="utf-8")
    costs = []
    for seed in range(1, seeds + 1):
        record = run(program, "solve", file, "--seed", seed, "--max-iterations", iterations, "--threads", 1, "--no-cache",
                     "--quiet", "--json", "--out", folder / "out")
        flight = record["execution"]
        is_good = record["status"] == "solved" and flight and flight["outcome"] == "ok"
        costs.append(flight["cost"] if is_good else None)
    return costs


def rank_test(ours, others):
    """Mann-Whitney: two-sided p that two samples are of one distribution, by the normal approximation, ties included."""
    both = sorted(ours + others)
    rank = {value: (both.index(value) + 1 + len(both) - both[::-1].index(value)) / 2 for value in set(both)}
    n, m = len(ours), len(others)
    u = sum(rank[value] for value in ours) - n * (n + 1) / 2
    ties = sum(both.count(value) ** 3 - both.count(value) for value in set(both))
    spread = math.sqrt(n * m / 12 * (n + m + 1 - ties / ((n + m) * (n + m - 1))))
    return 1.0 if spread == 0 else math.erfc(abs(u - n * m / 2) / spread / math.sqrt(2))


def filled(costs):
    """No plan is worse than any plan."""
    return [math.inf if cost is None else cost for cost in costs]


class Table:
    """How variants of a problem cost beside the first of them."""

    def __init__(self, title):
        self.title = title
        self.reference = None
        self.ratios = []
        self.p_values = []
        print(f"### {title}\n\n| | solved | median [J] | range [J] | median over the first | p |")
        print("| --- | ---: | ---: | ---: | ---: | ---: |", flush=True)

    def add(self, name, costs):
        found = [cost for cost in costs if cost is not None]
        median = statistics.median(filled(costs))
        beside = "| |"
        if self.reference is None:
            self.reference = costs
        else:
            self.ratios.append(median / statistics.median(filled(self.reference)))
            self.p_values.append(rank_test(filled(costs), filled(self.reference)))
            beside = f"{self.ratios[-1]:.3f} | {self.p_values[-1]:.3f} |"
        span = f"{min(found):.0f} to {max(found):.0f}" if found else ""
        print(f"| {name} | {len(found)} of {len(costs)} | {median:.0f} | {span} | {beside}", flush=True)


def print_bounds(turned, planar):
    """Where a bound has several tests, each has its share of the 5 % by which they may fail by chance."""
    print("## Bounds\n\n| bound | found | |\n| --- | --- | --- |")
    p_values = [p for table in turned for p in table.p_values]
    print_bound("turned about the vertical or shifted, costs are the same within the spread of seeds",
                f"least p of {len(p_values)}: {min(p_values):.3f}", min(p_values) >= ALIKE / len(p_values))
    costs_more = [table.ratios[0] > 1 and table.p_values[0] < ALIKE / len(planar) for table in planar]
    print_bound("a planar problem written in space costs no more than in the plane",
                ", ".join(f"{table.title} {table.ratios[0]:.3f} (p {table.p_values[0]:.3f})" for table in planar),
                not any(costs_more))


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--program", default=str(TREE / "build" / "downwash"))
    parser.add_argument("--seeds", type=int, default=20)
    parser.add_argument("--iterations", type=int, default=100)
    parser.add_argument("--planar-iterations", type=int, default=300)
    given = parser.parse_args()

    def measured(problem, iterations):
        with tempfile.TemporaryDirectory() as folder:
            return costs_of(given.program, problem, pathlib.Path(folder), given.seeds, iterations)

    print(f"Costs are energies of executed flights, in the nominal world. {given.seeds} seeds each. p: two-sided rank test "
          "(Mann-Whitney) of the\nvariant against the first row of its table; among equals, one p in twenty is below 0.05.\n")
    print(f"## Turned about the vertical, and shifted\n\n{given.iterations} iterations. Bounds do not turn with the scene: "
          "they are a square that contains\nthe problem at every angle. The shift is by "
          f"({', '.join(f'{at:g}' for at in SHIFT_M)}) m.\n")
    turned = []
    for name in TURNED:
        problem = read(name)
        variants = {"as it is": moved(problem, 0, (0, 0, 0))}
        variants |= {f"turned by {angle} degrees": moved(problem, angle, (0, 0, 0)) for angle in ANGLES_DEG}
        variants["shifted"] = moved(problem, 0, SHIFT_M)
        table = Table(problem["name"])
        for title, variant in variants.items():
            table.add(title, measured(variant, given.iterations))
        turned.append(table)
        print()
    print(f"## Planar problems written in space\n\n{given.planar_iterations} iterations. The robot is `ars_lrm` in the plane and "
          f"`ars_lrm_space` in space, where it may fly {BESIDE_PLANE_M:g} m to\neither side of the plane.\n")
    planar = []
    for name in PLANAR:
        problem = read(name)
        table = Table(problem["name"])
        table.add("in the plane", measured(problem, given.planar_iterations))
        table.add("in space", measured(in_space(problem), given.planar_iterations))
        planar.append(table)
        print()
    print_bounds(turned, planar)


if __name__ == "__main__":
    main()
