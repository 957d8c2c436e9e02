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


def without_flyable_area(problem, work):
    """A copy of a problem whose flyable area ends next to the surfaces: there, its models are beyond what they were fitted to."""
    text = problem.read_text(encoding="utf-8")
    robot = next(line.split(":", 1)[1].strip() for line in text.splitlines() if line.startswith("robot:"))
    text = text.replace(f"robot: {robot}", f"robot: {(problem.parent / robot).resolve()}", 1)
    copy = work / f"{problem.stem}.yaml"
    copy.write_text(text + "aero: {min_distance_radii: 0.03}\n", encoding="utf-8")
    return copy


def failures(problem, plan, runs):
    """The share of worlds in which a plan fails by the judge, or why there is none."""
    command = [ROOT / "build/downwash", "validate", problem, "--plan", plan, "--runs", str(runs), "--seed", str(WORLDS_SEED)]
    done = subprocess.run([*command, "--threads", "1", "--quiet", "--json"], capture_output=True, text=True, check=False)
    try:
        found = json.loads(done.stdout)
    except json.JSONDecodeError:
        return None, done.stderr.strip().splitlines()[-1]
    return found["failures"] / found["runs"], None


def flown(problem, plan, runs, work):
    """Both shares of a plan, and how long it takes."""
    share, why = failures(problem, plan, runs)
    free_share, _ = failures(without_flyable_area(problem, work), plan, runs)
    file = plan / "solution.json" if plan.is_dir() else plan
    duration_s = json.loads(file.read_text(encoding="utf-8"))["plan"]["reference"][-1]["t_s"]
    return {"share": share, "free_share": free_share, "why": why, "duration_s": duration_s}


def tracked(problem, seed, runs, work):
    command = [ROOT / "build/bench/bench_track_paths", problem, "--seed", str(seed)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        return {"share": None, "why": "no path"}
    plan = work / "path.json"
    plan.write_text(done.stdout, encoding="utf-8")
    return flown(problem, plan, runs, work)


def certified(problem, seed, runs, limit_s, work):
    run = work / "run"
    found = solve(problem, run, seed, limit_s)
    if found["status"] != "solved":
        return {"share": None, "why": "no certified plan"}
    return flown(problem, run, runs, work)


def made(folder):
    folder.mkdir()
    return folder


def cells_of(lines):
    good = [line for line in lines if line["share"] is not None]
    shares = [line["share"] for line in good]
    free = [line["free_share"] for line in good if line["free_share"] is not None]
    return [
        f"{len(good)}/{len(lines)}",
        number(sum(shares) / len(shares) if shares else None, "{:.3f}"),
        number(max(shares, default=None), "{:.3f}"),
        number(sum(free) / len(free) if free else None, "{:.3f}"),
        number(median([line["duration_s"] for line in good]), "{:.1f}"),
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
    print("| problem | planner | plans flown | mean share of worlds that fail | worst plan | mean without flyable area | duration s |")
    print("| --- | --- | --: | --: | --: | --: | --: |")
    notes = []
    for problem in given.problems:
        with tempfile.TemporaryDirectory() as folder:
            work = pathlib.Path(folder)
            seeds = range(1, given.seeds + 1)
            rows = {
                "RRT-Connect, tracked": [tracked(problem, seed, given.runs, work) for seed in seeds],
                "ours, certified": [certified(problem, seed, given.runs, given.time_limit, made(work / str(seed))) for seed in seeds],
            }
        for name, lines in rows.items():
            print(f"| {problem.stem} | {name} | " + " | ".join(cells_of(lines)) + " |", flush=True)
            notes += [f"- {problem.stem}, {name}, seed {s}: {line['why']}" for s, line in zip(seeds, lines) if line["why"]]
    print("\n## Without a plan\n\n" + ("\n".join(notes) or "None."))


if __name__ == "__main__":
    sys.exit(main())
