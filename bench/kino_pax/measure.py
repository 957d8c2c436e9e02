#!/usr/bin/env python3
"""Flies Kino-PAX's worlds of its quadrotor, judges the flights and makes the page. bench/kino_pax.sh calls it.

Usage: bench/kino_pax/measure.py PROBLEMS [--seeds N] >bench/results/kino_pax.md
"""

import argparse
import csv
import math
import pathlib
import sys
import tempfile

import yaml

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parent), str(HERE.parent / "dynobench")]
from measure import median, number, processor, shell  # noqa: E402
from process_time import solve  # noqa: E402

PUBLISHED_S = 0.025  # every environment, RTX 4090
MAX_THRUST_N = 30
MAX_TORQUE_NM = math.pi
MAX_SPEED_M_S = 30
LEVER_M = 0.2094
GOAL_RADIUS_M = 5
ROUNDING = 1e-6


def flight(folder):
    with open(pathlib.Path(folder) / "trajectory.csv", newline="", encoding="utf-8") as file:
        return [{name: float(value) for name, value in row.items() if value} for row in csv.DictReader(file)]


def turned_back(row, vector):
    """A vector of the world in body axes."""
    w, x, y, z = (row[name] for name in ("qw", "qx", "qy", "qz"))
    a, b, c = vector
    rows = (
        (1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)),
        (2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)),
        (2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)),
    )
    return tuple(r[0] * a + r[1] * b + r[2] * c for r in rows)


def fault(problem, rows):
    """Why a flight breaks the rules of Kino-PAX, None where it does not, and when it is within 5 m of the goal."""
    goal = problem["goal"]["configuration"]
    bounds = problem["environment"]["bounds"]
    boxes = [(o["box"]["center_m"], o["box"]["size_m"]) for o in problem["environment"]["obstacles"]]
    passes_s = None
    for row in rows:
        place = [row[f"{axis}_m"] for axis in "xyz"]
        if passes_s is None and math.dist(place, [goal[f"{axis}_m"] for axis in "xyz"]) <= GOAL_RADIUS_M:
            passes_s = row["t_s"]
        if any(not low <= p <= high for p, (low, high) in zip(place, (bounds[f"{axis}_m"] for axis in "xyz"))):
            return f"leaves the cube at {row['t_s']:.2f} s", passes_s
        for center, size in boxes:
            if all(abs(p - c) < s / 2 for p, c, s in zip(place, center, size)):
                return f"is in a box at {row['t_s']:.2f} s", passes_s
        f1, f2, f3, f4 = (row[f"rotor_{i}_cmd_n"] for i in (1, 2, 3, 4))
        torques = (-f1 - f2 + f3 + f4, -f1 + f2 + f3 - f4, -f1 + f2 - f3 + f4)
        if not -ROUNDING <= f1 + f2 + f3 + f4 <= MAX_THRUST_N + ROUNDING or max(map(abs, torques)) * LEVER_M > MAX_TORQUE_NM + ROUNDING:
            return f"has a control beyond its limits at {row['t_s']:.2f} s", passes_s
        velocity = turned_back(row, [row[f"v{axis}_m_s"] for axis in "xyz"])
        if max(map(abs, velocity)) > MAX_SPEED_M_S:
            return f"is too fast at {row['t_s']:.2f} s", passes_s
    return (None if passes_s is not None else "misses the goal"), passes_s


def search(path, seed):
    with tempfile.TemporaryDirectory() as work:
        run = pathlib.Path(work) / "run"
        line = {"seed": seed, "fault": "no plan", "passes_s": None, "rests_s": None}
        line.update(solve(path, run, seed, None))
        if line["status"] == "solved":
            rows = flight(run)
            line["fault"], line["passes_s"] = fault(yaml.safe_load(path.read_text(encoding="utf-8")), rows)
            line["rests_s"] = rows[-1]["t_s"]
        return line


def print_pump(seeds):
    """The first plan with a certificate in PUMP's world."""
    runs = []
    for seed in range(1, seeds + 1):
        with tempfile.TemporaryDirectory() as work:
            runs.append(solve(HERE / "pump.yaml", pathlib.Path(work) / "run", seed, None))
    times = [run["cpu_s"] if run["status"] == "solved" else None for run in runs]
    print("\n## PUMP\n\n| certified | process until the certificate s, median | longest s |\n| --- | --: | --: |")
    solved = [time_s for time_s in times if time_s is not None]
    print(f"| {len(solved)}/{len(runs)} | {number(median(times))} | {number(max(solved, default=None))} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("problems")
    parser.add_argument("--seeds", type=int, default=50)
    given = parser.parse_args()
    text = (HERE / "page.md").read_text(encoding="utf-8").replace("@COMMIT@", shell("bench/source_commit.sh"))
    before, after = text.replace("@CPU@", processor()).replace("@SEEDS@", str(given.seeds)).split("<!-- results -->")
    lines = {}
    for path in sorted(pathlib.Path(given.problems).glob("*.yaml")):
        lines[path.stem] = [search(path, seed) for seed in range(1, given.seeds + 1)]
    kept = {
        name: median([line["first_s"] if not line["fault"] else None for line in of]) for name, of in lines.items()
    }
    print(before.rstrip() + "\n\n## Result\n\n| bound | found | |\n| --- | --- | --- |")
    for name, first_s in kept.items():
        is_kept = first_s is not None and first_s <= PUBLISHED_S
        print(f"| {name}: first solution (search) within 25 ms | {number(first_s and 1000 * first_s, '{:.1f}')} ms | {'kept' if is_kept else '**not kept**'} |")
    print("\nMedians:\n\n| world | solved | search ms | process ms | within 5 m s | end at rest s |\n| --- | --: | --: | --: | --: | --: |")
    for name, of in lines.items():
        good = [line for line in of if not line["fault"]]
        cells = [f"{len(good)}/{len(of)}", number(kept[name] and 1000 * kept[name], "{:.1f}")]
        cells.append(number(1000 * median([line["cpu_s"] for line in of]), "{:.0f}"))
        cells += [number(median([line[key] for line in of])) for key in ("passes_s", "rests_s")]
        print(f"| {name} | " + " | ".join(cells) + " |")
    print_pump(given.seeds)
    faults = [f"- {name}, seed {line['seed']}: {line['fault']}" for name, of in lines.items() for line in of if line["fault"]]
    print("\n## Failures\n\n" + ("\n".join(faults) or "None.") + "\n\n" + after.strip())


if __name__ == "__main__":
    sys.exit(main())
