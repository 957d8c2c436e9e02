#!/usr/bin/env python3
"""Flies dynobench's problems of the planar rotor and writes what came of it. bench/dynobench.sh calls it.

Usage: bench/dynobench/measure.py ours FILE [--seeds N] [--limits S...] [--jobs N] [--problems PROBLEM.yaml...]
       bench/dynobench/measure.py page OURS RANDOM OMPL >bench/results/dynobench.md
The first adds a line of JSON for each search to FILE, the second makes the page of such files: the five problems, random
scenes, and the lines of bench_dynobench_ompl.
"""

import argparse
import json
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor

import judge

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
PROBLEMS = ("empty_0", "empty_1", "fall_through", "quad_bugtrap", "quad_obs_column")

# Wall time of the first solution, its cost, the final cost [s]. Table of iDb-A* (Ortiz-Haro et al., T-RO 2024: 20 runs, 120 s);
# iDb-RRT from box plots (2024).
PUBLISHED = {
    "iDb-A*": {
        "empty_0": (0.1, 1.0, 1.0),
        "empty_1": (0.1, 1.4, 1.4),
        "fall_through": (4.8, 3.5, 3.2),
        "quad_bugtrap": (6.6, 5.2, 5.1),
        "quad_obs_column": (0.6, 3.5, 3.3),
    },
    "RRT*+TO": {
        "empty_0": (0.1, 1.0, 1.0),
        "empty_1": (0.1, 1.4, 1.4),
        "fall_through": (9.1, 6.0, 2.4),
        "quad_bugtrap": (3.1, 18.2, 8.7),
        "quad_obs_column": (3.3, 9.0, 4.3),
    },
    "SST*": {
        "empty_0": (0.2, 1.7, 1.1),
        "empty_1": (0.4, 3.7, 1.3),
        "fall_through": (43, 12.2, 7.5),
        "quad_bugtrap": (9.8, 12.6, 8.2),
        "quad_obs_column": (5.3, 8.5, 7.2),
    },
    "iDb-RRT": {"fall_through": (0.44, 10.8, None), "quad_bugtrap": (0.53, 10.4, None)},
}


def search(problem, seed, limit_s, stops_at_first=False):
    """One search, judged: first solution, cost and why it is refused, each None where there is none."""
    with tempfile.TemporaryDirectory() as work:
        run = pathlib.Path(work) / "run"
        command = [ROOT / "build/downwash", "solve", problem, "--seed", str(seed), "--threads", "1", "--quiet"]
        command += ["--time-limit", str(limit_s), "--out", run] + (["--stop-at-first"] if stops_at_first else [])
        planner = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        _, status, used = os.wait4(planner.pid, 0)
        planner.returncode = os.waitstatus_to_exitcode(status)
        solution = json.loads((run / "solution.json").read_text(encoding="utf-8"))
        line = {
            "problem": pathlib.Path(problem).stem,
            "seed": seed,
            "limit_s": None if stops_at_first else limit_s,
            "status": solution["status"],
            "first_s": solution["planning"]["first_solution_wall_s"],
            "cpu_s": used.ru_utime + used.ru_stime,
            "cost_s": None,
            "refused": None,
        }
        if solution["status"] == "solved":
            try:
                line["cost_s"] = judge.judge(judge.read_problem(problem), *judge.read_flight(run))
            except judge.Refused as why:
                line["refused"] = str(why)
        return line


def search_all(given):
    problems = given.problems or [HERE / f"{name}.yaml" for name in PROBLEMS]
    searches = []
    for seed in range(1, given.seeds + 1):
        for problem in problems:
            searches += [(problem, seed, limit_s) for limit_s in given.limits] + [(problem, seed, max(given.limits), True)]
    with open(given.file, "a", encoding="utf-8") as file, ThreadPoolExecutor(given.jobs) as pool:
        for line in pool.map(lambda each: search(*each), searches):
            print(json.dumps(line), file=file, flush=True)


def read_lines(path):
    with open(path, encoding="utf-8") as file:
        return [json.loads(line) for line in file]


def number(value, form="{:.2f}"):
    return "-" if value is None else form.format(value)


def median(values):
    """Of all attempts, None counting as infinite; None where that is what it is."""
    middle = statistics.median_high([float("inf") if value is None else value for value in values]) if values else None
    return None if middle in (None, float("inf")) else middle


def of(lines, problem, limit_s):
    return [line for line in lines if line["problem"] == problem and line["limit_s"] == limit_s]


def first_of(lines, problem):
    """Median wall time of the first solution over all searches, and the cost of what a search finds that stops there."""
    times = [line["first_s"] for line in lines if line["problem"] == problem and line["limit_s"] is None]
    return median(times), median([line["cost_s"] for line in of(lines, problem, None)])


def published_table():
    print("| problem | " + " | ".join(PUBLISHED) + " |\n| --- |" + " --: |" * len(PUBLISHED))
    for problem in PROBLEMS:
        cells = []
        for column in PUBLISHED.values():
            found = column.get(problem)
            cells.append(" / ".join(number(value, "{:g}") for value in found) if found else "")
        print(f"| {problem} | " + " | ".join(cells) + " |")


def ours_table(lines):
    limits = sorted({line["limit_s"] for line in lines} - {None})
    print("| problem | solved | first solution s | CPU time of that run s | its cost s | " + " | ".join(f"cost after {t:g} s" for t in limits), end="")
    print(" | after 10 s, over iDb-A*'s final |\n| --- | --: | --: | --: | --: |" + " --: |" * (len(limits) + 1))
    for problem in PROBLEMS:
        first_s, first_cost_s = first_of(lines, problem)
        cpu_s = median([line.get("cpu_s") for line in of(lines, problem, None)])
        costs = [median([line["cost_s"] for line in of(lines, problem, limit_s)]) for limit_s in limits]
        longest = [line for line in lines if line["problem"] == problem and line["limit_s"] is not None]
        solved = sum(line["cost_s"] is not None for line in longest)
        after_10 = median([line["cost_s"] for line in of(lines, problem, 10)])
        ratio = after_10 / PUBLISHED["iDb-A*"][problem][2] if after_10 is not None else None
        cells = [f"{solved}/{len(longest)}", number(first_s, "{:.3f}"), number(cpu_s, "{:.3f}"), number(first_cost_s)]
        cells += [number(cost) for cost in costs] + [number(ratio)]
        print(f"| {problem} | " + " | ".join(cells) + " |")


def bounds_table(lines):
    firsts = []
    ratios = []
    for problem in PROBLEMS:
        first_s, _ = first_of(lines, problem)
        soonest_s = min(column[problem][0] for column in PUBLISHED.values() if problem in column)
        firsts.append(first_s is not None and first_s < soonest_s)
        after_10 = median([line["cost_s"] for line in of(lines, problem, 10)])
        ratios.append(after_10 is not None and after_10 <= 1.15 * PUBLISHED["iDb-A*"][problem][2])
    plans = [line for line in lines if line["status"] == "solved"]
    refused = [line for line in plans if line["refused"]]
    rows = [
        ("our first solution is sooner than every published one on all five problems", f"{sum(firsts)} of 5", all(firsts)),
        ("our cost after 10 s is at most 1.15 of iDb-A*'s final cost on at least four", f"{sum(ratios)} of 5", sum(ratios) >= 4),
        ("dynobench's rules accept every plan", f"{len(plans) - len(refused)} of {len(plans)}", not refused),
    ]
    print("| bound | found | |\n| --- | --- | --- |")
    for bound, found, is_kept in rows:
        print(f"| {bound} | {found} | {'kept' if is_kept else '**not kept**'} |")


def random_table(lines):
    limits = sorted({line["limit_s"] for line in lines} - {None})
    print("| scene | first solution s | its cost s | " + " | ".join(f"cost after {t:g} s" for t in limits) + " |")
    print("| --- | --: | --: |" + " --: |" * len(limits))
    for problem in sorted({line["problem"] for line in lines}):
        first_s, first_cost_s = first_of(lines, problem)
        costs = [median([line["cost_s"] for line in of(lines, problem, limit_s)]) for limit_s in limits]
        cells = [number(first_s, "{:.3f}"), number(first_cost_s)] + [number(cost) for cost in costs]
        print(f"| {problem} | " + " | ".join(cells) + " |")


def ompl_table(lines):
    print("| problem | planner | goal to within | solved | first solution s | its cost s | cost at the end s | nearest without |")
    print("| --- | --- | --: | --: | --: | --: | --: | --: |")
    for problem in PROBLEMS:
        for planner in ("rrt", "sst"):
            for error in sorted({line["goal_error"] for line in lines}):
                runs = [
                    line
                    for line in lines
                    if (line["problem"], line["planner"], line["goal_error"]) == (problem, planner, error)
                ]
                if not runs:
                    continue
                found = [run["solutions"] for run in runs]
                near = [run["nearest"] for run in runs if not run["solutions"] and run["nearest"] >= 0]
                cells = [f"{sum(map(bool, found))}/{len(runs)}"]
                cells.append(number(median([s[0][0] if s else None for s in found])))
                cells.append(number(median([s[0][1] if s else None for s in found])))
                cells.append(number(median([s[-1][1] if s else None for s in found])))
                cells.append(number(min(near) if near else None))
                print(f"| {problem} | {planner.upper()} | {error:g} | " + " | ".join(cells) + " |")


def shell(*command):
    return subprocess.run(command, capture_output=True, text=True, check=True, cwd=ROOT).stdout.strip()


def processor():
    for line in pathlib.Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines():
        if line.startswith("model name"):
            return line.split(":", 1)[1].strip()
    return "unknown processor"


def page(given):
    ours, random_scenes, ompl = (read_lines(path) for path in (given.ours, given.random, given.ompl))
    text = (HERE / "page.md").read_text(encoding="utf-8")
    print(text.split("<!-- results -->")[0].rstrip().replace("@COMMIT@", shell("bench/source_commit.sh")).replace("@CPU@", processor()))
    print("\n## Result\n")
    bounds_table(ours)
    print("\nOurs, medians:\n")
    ours_table(ours)
    print("\nPublished: first solution / its cost / final cost, in seconds:\n")
    published_table()
    print("\n## OMPL's own planners\n")
    print(text.split("<!-- results -->")[1].strip() + "\n")
    ompl_table(ompl)
    print("\n## Random scenes\n")
    print(text.split("<!-- results -->")[2].strip() + "\n")
    random_table(random_scenes)
    print("\n" + text.split("<!-- results -->")[3].strip())


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    commands = parser.add_subparsers(required=True)
    ours = commands.add_parser("ours")
    ours.add_argument("file")
    ours.add_argument("--problems", nargs="+")
    ours.add_argument("--seeds", type=int, default=5)
    ours.add_argument("--limits", type=float, nargs="+", default=[1.0, 10.0, 60.0])
    ours.add_argument("--jobs", type=int, default=2, help="searches at a time, of one thread each")
    ours.set_defaults(run=search_all)
    made = commands.add_parser("page")
    for name in ("ours", "random", "ompl"):
        made.add_argument(name)
    made.set_defaults(run=page)
    given = parser.parse_args()
    given.run(given)


if __name__ == "__main__":
    sys.exit(main())
