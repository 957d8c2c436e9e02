#!/usr/bin/env python3
"""Paths of RRT-Connect that the closed loop tracks, beside certified plans: how often do they fail in worlds?

Usage: bench/track_paths.py fly FILE PROBLEM.yaml... [--seeds N] [--runs N] [--time-limit S]
       bench/track_paths.py page FILE >bench/results/track_paths.md
The first adds a line of JSON for each plan to FILE, the second makes the page. bench/track_paths.sh calls it. The judge flies both in the same worlds of a seed of its own.
"""

import argparse
import json
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT / "bench"), str(ROOT / "bench/dynobench")]
from measure import median, number, processor, read_lines, shell  # noqa: E402
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
        return {"share": None, "free_share": None, "duration_s": None, "why": done.stderr.strip().splitlines()[-1]}
    plan = work / "path.json"
    plan.write_text(done.stdout, encoding="utf-8")
    return flown(problem, plan, runs, work)


def certified(problem, seed, runs, limit_s, work):
    run = work / "run"
    found = solve(problem, run, seed, limit_s)
    if found["status"] != "solved":
        return {"share": None, "free_share": None, "duration_s": None, "why": "no certified plan"}
    return flown(problem, run, runs, work)


def made(folder):
    folder.mkdir()
    return folder


def fly_all(given):
    """Adds a line of JSON for each plan to the file."""
    with open(given.file, "a", encoding="utf-8") as file:
        for problem in given.problems:
            for seed in range(1, given.seeds + 1):
                with tempfile.TemporaryDirectory() as folder:
                    work = pathlib.Path(folder)
                    plans = {
                        "RRT-Connect, tracked": tracked(problem, seed, given.runs, made(work / "theirs")),
                        "ours, certified": certified(problem, seed, given.runs, given.time_limit, made(work / "ours")),
                    }
                for planner, plan in plans.items():
                    line = {"problem": problem.stem, "planner": planner, "seed": seed, "runs": given.runs, "limit_s": given.time_limit}
                    print(json.dumps({**line, **plan}), file=file, flush=True)


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


def page(given):
    lines = read_lines(given.file)
    text = (ROOT / "bench/ompl_space/track_paths.md").read_text(encoding="utf-8")
    for name, value in (
        ("COMMIT", shell("bench/source_commit.sh")),
        ("CPU", processor()),
        ("SEEDS", max(line["seed"] for line in lines)),
        ("RUNS", lines[0]["runs"]),
        ("LIMIT", f"{lines[0]['limit_s']:g}"),
    ):
        text = text.replace(f"@{name}@", str(value))
    print(text.strip() + "\n")
    print("| problem | planner | plans flown | mean share of worlds that fail | worst plan | mean without flyable area | duration s |")
    print("| --- | --- | --: | --: | --: | --: | --: |")
    for problem in dict.fromkeys(line["problem"] for line in lines):
        for planner in dict.fromkeys(line["planner"] for line in lines):
            of = [line for line in lines if (line["problem"], line["planner"]) == (problem, planner)]
            print(f"| {problem} | {planner} | " + " | ".join(cells_of(of)) + " |")
    notes = [f"- {line['problem']}, {line['planner']}, seed {line['seed']}: {line['why']}" for line in lines if line["why"]]
    print("\n## Without a plan\n\n" + ("\n".join(notes) or "None."))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    commands = parser.add_subparsers(required=True)
    fly = commands.add_parser("fly")
    fly.add_argument("file")
    fly.add_argument("problems", nargs="+", type=pathlib.Path)
    fly.add_argument("--seeds", type=int, default=20)
    fly.add_argument("--runs", type=int, default=512)
    fly.add_argument("--time-limit", type=float, default=20.0, help="CPU time of our search [s]")
    fly.set_defaults(run=fly_all)
    written = commands.add_parser("page")
    written.add_argument("file")
    written.set_defaults(run=page)
    given = parser.parse_args()
    given.run(given)


if __name__ == "__main__":
    sys.exit(main())
