#!/usr/bin/env python3
"""Compares touching a surface on purpose with hovering near it: power, energy, failures in worlds.

Usage: bench/contact.py [downwash] [--seeds N] [--runs N] >bench/results/contact.md
Searches run one after the other, on two threads; plans are flown by `downwash validate`.
"""

import argparse
import csv
import pathlib
import statistics
import subprocess
import tempfile

from program import run

TREE = pathlib.Path(__file__).resolve().parent.parent
HOLD_S = 5
# Name, shipped problem, and its goal instead of the touch.
CASES = [
    ("frame on a deck, 5 N", "deck_with_frame", None),
    ("frame on a deck, 15 N", "deck_with_frame", "{contact: {obstacle: deck, force_n: 15}, hold_s: 5}"),
    ("hover, frame 0.15 m below it", "deck_with_frame", "{configuration: {z_m: 9.74, tolerance_m: 0.05}, hold_s: 5}"),
    ("hover, frame 0.30 m below it", "deck_with_frame", "{configuration: {z_m: 9.59, tolerance_m: 0.1}, hold_s: 5}"),
    ("hover, frame 1 m below it", "deck_with_frame", "{configuration: {z_m: 8.89, tolerance_m: 0.1}, hold_s: 5}"),
    ("arm on a pier, 5 N", "pier_with_arm", None),
    ("hover, end of the arm 0.15 m before it", "pier_with_arm",
     "{end_effector: {x_m: 3.82, z_m: 6, direction_deg: 0, tolerance_m: 0.1}, hold_s: 5}"),
]


def problem_file(folder, name, goal):
    """A copy of a shipped problem with another goal."""
    text = (TREE / "problems/contact" / f"{name}.yaml").read_text()
    text = text.replace("../robots", str(TREE / "problems/robots"))
    if goal is not None:
        text = text[: text.index("\ngoal:")] + f"\ngoal: {goal}\n"
    file = folder / f"{name}.yaml"
    file.write_text(text)
    return file


def hold_power_w(solution, out):
    """Mean power over the hold."""
    contact = solution["execution"].get("contact")
    if contact:
        return contact["power_w"]
    with open(out / "trajectory.csv", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    end_s = float(rows[-1]["t_s"])
    return statistics.fmean(float(row["power_w"]) for row in rows if float(row["t_s"]) > end_s - HOLD_S)


def measured(program, case, options, folder):
    """A row of the page."""
    name, problem, goal = case
    file = problem_file(folder, problem, goal)
    certified, failures, runs, powers, errors = 0, 0, 0, [], []
    for seed in range(1, options.seeds + 1):
        out = folder / problem
        solution = run(program, "solve", file, "--seed", seed, "--time-limit", options.time_limit, "--threads", 2,
                       "--quiet", "--json", "--out", out)
        certified += solution["status"] == "solved"
        if solution["execution"] is None or solution["execution"]["outcome"] != "ok":
            continue
        powers.append(hold_power_w(solution, out))
        contact = solution["execution"].get("contact")
        if contact:
            errors.append(contact["force_error_n"])
        flown = run(program, "validate", "--plan", out, file, "--runs", options.runs, "--threads", 2, "--json")
        failures += flown["failures"]
        runs += options.runs
    power = f"{statistics.fmean(powers):.0f}" if powers else "-"
    error = f"{max(errors):.2f}" if errors else ""
    share = f"{failures} of {runs}" if runs else "-"
    return f"| {name} | {power} | {error} | {certified} of {options.seeds} | {share} |"


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program", nargs="?", default=str(TREE / "build/downwash"))
    parser.add_argument("--seeds", type=int, default=4)
    parser.add_argument("--runs", type=int, default=250)
    parser.add_argument("--time-limit", type=float, default=10)
    options = parser.parse_args()
    print("# Touching on purpose, and hovering near\n")
    commit = subprocess.run([f"{TREE}/bench/source_commit.sh"], capture_output=True, text=True, check=True).stdout.strip()
    print(f"Commit {commit}. `bench/contact.py --seeds {options.seeds} --runs {options.runs} --time-limit {options.time_limit:g}` plans "
          "the problems of `problems/contact/` with their\nuncertainty, and the same scenes with a hover instead of the "
          f"touch. Power is the mean over the {HOLD_S} s of the hold, in\nthe nominal world. The error is the worst mean force "
          "of a second of all plans, in the nominal world. Flights in worlds are those of\n`downwash validate`, over all plans "
          "that fly well in the nominal world, certified or not.\n")
    print("| | power W | force error N | certified | failed in worlds |")
    print("| --- | --- | --- | --- | --- |")
    with tempfile.TemporaryDirectory() as folder:
        for case in CASES:
            print(measured(options.program, case, options, pathlib.Path(folder)), flush=True)


if __name__ == "__main__":
    main()
