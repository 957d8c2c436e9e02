#!/usr/bin/env python3
"""Paths of RRT-Connect that the closed loop tracks, beside certified plans: how often do they fail in worlds?

Usage: bench/track_paths.py PROBLEM.yaml... [--seeds N] [--runs N] [--time-limit S] >bench/results/track_paths.md
bench/track_paths.sh calls it. The judge flies both in the same worlds of a seed of its own.
"""

import argparse
import json
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT / "bench"), str(ROOT / "bench/dynobench")]
from measure import median, number, processor, shell  # noqa: E402
from process_time import solve  # noqa: E402

WORLDS_SEED = 20240917  # of the worlds; fixed before any result was seen


def failures(problem, plan, runs):
    """In the nominal world and over worlds: of a plan by the judge, and how most of them ended."""
    command = [ROOT / "build/downwash", "validate", problem, "--plan", plan, "--runs", str(runs), "--seed", str(WORLDS_SEED)]
    done = subprocess.run([*command, "--threads", "1", "--quiet", "--json"], capture_output=True, text=True, check=False)
    try:
        found = json.loads(done.stdout)
    except json.JSONDecodeError:
        return None, done.stderr.strip().splitlines()[-1]
    worlds = found.get("worlds") or found
    return worlds["failures"] / worlds["runs"], None


def tracked(problem, seed, runs, work):
    command = [ROOT / "build/bench/bench_track_paths", problem, "--seed", str(seed)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        return {"share": None, "why": "no path"}
    plan = work / "path.json"
    plan.write_text(done.stdout, encoding="utf-8")
    share, why = failures(problem, plan, runs)
    duration_s = json.loads(done.stdout)["plan"]["reference"][-1]["t_s"]
    return {"share": share, "why": why, "duration_s": duration_s}


def certified(problem, seed, runs, limit_s, work):
    run = work / "run"
    found = solve(problem, run, seed, limit_s)
    if found["status"] != "solved":
        return {"share": None, "why": "no certified plan"}
    share, why = failures(problem, run, runs)
    solution = json.loads((run / "solution.json").read_text(encoding="utf-8"))
    return {"share": share, "why": why, "duration_s": solution["plan"]["reference"][-1]["t_s"]}


def cells_of(lines):
    flown = [line["share"] for line in lines if line["share"] is not None]
    mean = sum(flown) / len(flown) if flown else None
    return [
        f"{len(flown)}/{len(lines)}",
        number(mean, "{:.3f}"),
        number(max(flown, default=None), "{:.3f}"),
        f"{sum(share <= 0.01 for share in flown)}/{len(flown)}",
        number(median([line["duration_s"] for line in lines if line["share"] is not None] or [None]), "{:.1f}"),
    ]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("problems", nargs="+", type=pathlib.Path)
    parser.add_argument("--seeds", type=int, default=20)
    parser.add_argument("--runs", type=int, default=512)
    parser.add_argument("--time-limit", type=float, default=20.0, help="CPU time of our search [s]")
    given = parser.parse_args()
    text = (ROOT / "bench/ompl_space/track_paths.md").read_text(encoding="utf-8")
    for name, value in (
        ("COMMIT", shell("bench/source_commit.sh")),
        ("CPU", processor()),
        ("SEEDS", given.seeds),
        ("RUNS", given.runs),
        ("LIMIT", f"{given.time_limit:g}"),
    ):
        text = text.replace(f"@{name}@", str(value))
    print(text.strip() + "\n")
    print("| problem | planner | plans flown | mean share of worlds that fail | worst plan | at most 1 % fail | duration s |")
    print("| --- | --- | --: | --: | --: | --: | --: |")
    notes = []
    for problem in given.problems:
        with tempfile.TemporaryDirectory() as folder:
            work = pathlib.Path(folder)
            seeds = range(1, given.seeds + 1)
            rows = {
                "RRT-Connect, tracked": [tracked(problem, seed, given.runs, work) for seed in seeds],
                "ours, certified": [certified(problem, seed, given.runs, given.time_limit, work / str(seed)) for seed in seeds],
            }
        for name, lines in rows.items():
            print(f"| {problem.stem} | {name} | " + " | ".join(cells_of(lines)) + " |", flush=True)
            notes += [f"- {problem.stem}, {name}, seed {s}: {line['why']}" for s, line in zip(seeds, lines) if line["why"]]
    print("\n## Without a plan\n\n" + ("\n".join(notes) or "None."))


if __name__ == "__main__":
    sys.exit(main())
