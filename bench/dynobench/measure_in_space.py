#!/usr/bin/env python3
"""Flies dynobench's problems of its quadrotors and writes what came of it. bench/dynobench_space.sh calls it.

Usage: bench/dynobench/measure_in_space.py ours PROBLEMS FILE [--seeds N] [--limits first|S...] [--jobs N]
       bench/dynobench/measure_in_space.py page OURS OMPL >bench/results/dynobench_space.md
The first adds a line of JSON for each search to FILE, the second makes the page of such files and of the lines of
bench_ompl_space. PROBLEMS is a folder that space_problems.py wrote. Searches are limited by the CPU time of their process.
"""

import argparse
import json
import pathlib
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor

import judge
import judge_in_space
from measure import HERE, median, number, processor, read_lines, shell

sys.path.insert(0, str(HERE.parent))
from process_time import solve  # noqa: E402

# iDb-RRT's table (Ortiz-Haro et al., IROS 2024, arXiv 2403.10745): seconds to the first solution, its cost, whether less than half
# of the runs found one. Medians of 20 runs.
PUBLISHED = {
    "v0_recovery": {"iDb-RRT-F": (0.83, 5.61), "iDb-RRT-C": (0.71, 5.25), "Geo-RRT-TO": (1.12, 2.53), "iDb-A*": (1.32, 5.57)},
    "v0_recovery_with_obs": {
        "iDb-RRT-F": (1.29, 6.41),
        "iDb-RRT-C": (1.37, 6.20),
        "Geo-RRT-TO": (0.71, 3.90),
        "iDb-A*": (1.53, 5.72),
    },
    "v1_quad_one_obs": {
        "iDb-RRT-F": (0.87, 6.00),
        "iDb-RRT-C": (1.36, 7.03),
        "Geo-RRT-TO": (0.25, 2.72),
        "iDb-A*": (2.53, 4.54),
        "Kino-RRT": (40.68, 4.90, True),
    },
    "v1_window": {
        "iDb-RRT-F": (0.61, 5.22),
        "iDb-RRT-C": (0.88, 7.99),
        "Geo-RRT-TO": (9.05, 5.53),
        "iDb-A*": (1.64, 3.71),
        "Kino-RRT": (9.83, 10.08, True),
    },
    "v0_bugtrap3": {"iDb-RRT-F": (5.80, 11.87), "iDb-RRT-C": (4.43, 13.19), "iDb-A*": (23.42, 6.36)},
    "v0_recovery_with_obs4": {
        "iDb-RRT-F": (2.50, 9.74),
        "iDb-RRT-C": (2.58, 10.26),
        "Geo-RRT-TO": (0.33, 3.90, True),
        "iDb-A*": (6.49, 6.41),
    },
    "v1_recovery_with_obs4": {
        "iDb-RRT-F": (2.50, 9.71),
        "iDb-RRT-C": (2.38, 9.68),
        "Geo-RRT-TO": (0.30, 3.72, True),
        "iDb-A*": (59.71, 6.23),
    },
    "v1_window_double2": {
        "iDb-RRT-F": (2.18, 7.79),
        "iDb-RRT-C": (2.54, 10.86),
        "Geo-RRT-TO": (0.42, 4.62, True),
        "iDb-A*": (25.74, 5.09),
    },
}
# Flights in dynobench's repository: seconds to the first solution of that run of iDb-A*, best costs of iDb-A* and of RRT*+TO.
FLOWN = {
    "v0_empty_0_easy": (0.218, 1.31, 0.97),
    "v0_empty_1_easy": (0.810, 1.35, 1.20),
    "v0_quad_one_obs": (2.361, 2.99, 3.58),
    "v0_recovery": (1.131, 2.61, None),
    "v0_recovery_with_obs": (1.935, 3.52, None),
    "v0_window": (4.436, 2.49, None),
    "v1_empty_0_easy": (0.136, 0.80, 0.97),
    "v1_empty_1_easy": (0.175, 1.05, 0.89),
    "v1_quad_one_obs": (2.260, 2.42, 2.28),
    "v1_recovery": (0.389, 2.08, 2.00),
    "v1_recovery_with_obs": (2.972, 3.01, 4.21),
    "v1_window": (3.290, 2.18, None),
}
FAST = ("recovery", "recovery_with_obs", "window", "quad_one_obs")
LONG = ("bugtrap3", "recovery_with_obs4", "window_double2")


def search(problem, seed, cpu_s):
    """One search, judged. @param cpu_s limit of the process, None for a search that stops at its first solution"""
    with tempfile.TemporaryDirectory() as work:
        run = pathlib.Path(work) / "run"
        line = {"problem": problem.stem, "seed": seed, "limit_s": cpu_s, "cost_s": None, "refused": None}
        line.update(solve(problem, run, seed, cpu_s))
        if line["status"] == "solved":
            model = judge_in_space.MODELS[problem.stem[:2]]
            try:
                line["cost_s"] = judge_in_space.judge(
                    model, judge_in_space.read_problem(problem), *judge_in_space.read_flight(run)
                )
            except judge.Refused as why:
                line["refused"] = str(why)
        return line


def limit_of(text):
    return None if text == "first" else float(text)


def search_all(given):
    problems = sorted(pathlib.Path(given.problems).glob("*.yaml"))
    searches = [(p, seed, limit) for seed in range(1, given.seeds + 1) for p in problems for limit in given.limits]
    with open(given.file, "a", encoding="utf-8") as file, ThreadPoolExecutor(given.jobs) as pool:
        for line in pool.map(lambda each: search(*each), searches):
            print(json.dumps(line), file=file, flush=True)


def of(lines, problem, limit_s):
    return [line for line in lines if line["problem"] == problem and line["limit_s"] == limit_s]


def soonest_s(problem):
    """The soonest published first solution, be it one of less than half of the runs."""
    times = [column[0] for column in PUBLISHED.get(problem, {}).values()]
    return min(times + [FLOWN[problem][0]] if problem in FLOWN else times, default=None)


def best_known_s(problem):
    costs = [column[1] for column in PUBLISHED.get(problem, {}).values() if len(column) == 2]
    costs += [cost for cost in FLOWN.get(problem, (None,))[1:] if cost is not None]
    return min(costs, default=None)


def figures(lines):
    """Of each problem: medians, of all attempts, and how many were solved."""
    found = {}
    for problem in sorted({line["problem"] for line in lines}):
        first = of(lines, problem, None)
        found[problem] = {
            "solved": sum(line["cost_s"] is not None for line in lines if line["problem"] == problem),
            "attempts": sum(line["problem"] == problem for line in lines),
            "first_s": median([line["first_s"] if line["cost_s"] is not None else None for line in first]),
            "cpu_s": median([line["cpu_s"] if line["cost_s"] is not None else None for line in first]),
            "first_cost_s": median([line["cost_s"] for line in first]),
            "after_1": median([line["cost_s"] for line in of(lines, problem, 1.0)]),
            "after_10": median([line["cost_s"] for line in of(lines, problem, 10.0)]),
        }
    return found


def ratio_of(problem, found):
    best = best_known_s(problem)
    return found["after_10"] / best if best and found["after_10"] else None


def ours_table(found):
    print("| problem | solved | search s | process s | its cost s | after 1 s | after 10 s | best known s | ratio |")
    print("| --- | --: | --: | --: | --: | --: | --: | --: | --: |")
    for problem, each in found.items():
        cells = [f"{each['solved']}/{each['attempts']}", number(each["first_s"], "{:.3f}"), number(each["cpu_s"], "{:.3f}")]
        cells += [number(each[name]) for name in ("first_cost_s", "after_1", "after_10")]
        print(f"| {problem} | " + " | ".join(cells + [number(best_known_s(problem)), number(ratio_of(problem, each))]) + " |")


def published_table():
    planners = ("iDb-RRT-F", "iDb-RRT-C", "Geo-RRT-TO", "iDb-A*", "Kino-RRT")
    print("| problem | " + " | ".join(planners) + " | flown: iDb-A*, first / best | RRT*+TO, best |")
    print("| --- |" + " --: |" * (len(planners) + 2))
    for problem in sorted(PUBLISHED.keys() | FLOWN.keys()):
        columns = PUBLISHED.get(problem, {})
        texts = []
        for planner in planners:
            column = columns.get(planner)
            star = "*" if column and len(column) == 3 else ""
            texts.append(f"{column[0]:.2f}{star} / {column[1]:.2f}{star}" if column else "")
        first_s, best_s, other_s = FLOWN.get(problem, (None, None, None))
        texts.append(f"{first_s:.2f} / {best_s:.2f}" if first_s else "")
        print(f"| {problem} | " + " | ".join(texts + [number(other_s) if other_s else ""]) + " |")


def bounds_table(lines, found):
    def share(problems, is_kept):
        kept = [problem for problem in problems if is_kept(problem)]
        missing = ", ".join(problem for problem in problems if problem not in kept)
        return f"{len(kept)} of {len(problems)}" + (f"; not {missing}" if missing else ""), len(kept) == len(problems)

    def is_within(limit_s, name):
        return lambda problem: found[problem][name] is not None and found[problem][name] <= limit_s

    known = [problem for problem in found if soonest_s(problem)]
    fast = [problem for problem in found if problem[3:] in FAST]
    long = [problem for problem in found if problem[3:] in LONG]
    costed = [problem for problem in found if best_known_s(problem)]
    near = [problem for problem in costed if (ratio_of(problem, found[problem]) or 9) <= 1.15]
    plans = [line for line in lines if line["status"] == "solved"]
    refused = [line for line in plans if line["refused"]]
    rows = [
        (
            "first solution (process) sooner than every published one",
            *share(known, lambda p: found[p]["cpu_s"] is not None and found[p]["cpu_s"] < soonest_s(p)),
        ),
        ("first solution (search) within 0.05 s on recovery, recovery_with_obs, window, quad_one_obs", *share(fast, is_within(0.05, "first_s"))),
        ("first solution (search) within 0.5 s on bugtrap3, recovery_with_obs4, window_double2", *share(long, is_within(0.5, "first_s"))),
        (
            "cost after 10 s at most 1.15 of the best known on two thirds",
            f"{len(near)} of {len(costed)}",
            3 * len(near) >= 2 * len(costed),
        ),
        ("every search finds a flight that dynobench's rules accept", *share(list(found), lambda p: found[p]["solved"] == found[p]["attempts"])),
        ("dynobench's rules accept every plan", f"{len(plans) - len(refused)} of {len(plans)}", not refused),
    ]
    print("| bound | found | |\n| --- | --- | --- |")
    for bound, text, is_kept in rows:
        print(f"| {bound} | {text} | {'kept' if is_kept else '**not kept**'} |")


def failures(lines):
    """A line for each kind of failure of a problem, with its seeds."""
    kinds = {}
    for line in lines:
        if line["cost_s"] is None:
            limit = "first" if line["limit_s"] is None else f"{line['limit_s']:g} s"
            why = (line["refused"] or "no plan").split(":")[0]
            why = " ".join(word for word in why.split() if not word.replace(".", "").isdigit())
            kinds.setdefault((line["problem"], limit, why), []).append(str(line["seed"]))
    for (problem, limit, why), seeds in sorted(kinds.items()):
        print(f"- {problem}, {limit}: {why} (seeds {', '.join(seeds)})")
    if not kinds:
        print("None.")


def ompl_table(lines):
    print("| problem | planner | limit s | solved | first solution s | its cost s | nearest without |")
    print("| --- | --- | --: | --: | --: | --: | --: |")
    for problem, planner in sorted({(line["problem"], line["planner"]) for line in lines}):
        runs = [line for line in lines if (line["problem"], line["planner"]) == (problem, planner)]
        hits = [run for run in runs if run["first_s"] is not None]
        near = [run["nearest"] for run in runs if run["first_s"] is None]
        cells = ["/".join(f"{limit:g}" for limit in sorted({run["limit_s"] for run in runs})), f"{len(hits)}/{len(runs)}"]
        cells.append(number(median([run["first_s"] for run in runs])))
        cells += [number(median([run["cost_s"] for run in runs])), number(min(near) if near else None)]
        print(f"| {problem} | {planner.upper()} | " + " | ".join(cells) + " |")


def seeds_of(lines):
    """How many seeds there are at least of each kind of search."""
    texts = []
    for limit, name in ((None, "first solutions"), (1.0, "1 s"), (10.0, "10 s")):
        counts = [len(of(lines, problem, limit)) for problem in {line["problem"] for line in lines}]
        texts.append(f"{min(counts)} for {name}")
    return "seeds of each problem: " + ", ".join(texts)


def page(given):
    lines, ompl = read_lines(given.ours), read_lines(given.ompl)
    text = (HERE / "page_in_space.md").read_text(encoding="utf-8").replace("@COMMIT@", shell("bench/source_commit.sh"))
    parts = text.replace("@CPU@", processor()).replace("@SEEDS@", seeds_of(lines)).split("<!-- results -->")
    found = figures(lines)
    print(parts[0].rstrip() + "\n\n## Result\n")
    bounds_table(lines, found)
    print("\nOurs, medians of all attempts:\n")
    ours_table(found)
    print("\nPublished: first solution / its cost, in seconds; \\*: less than half of the runs had one.\n")
    published_table()
    print("\n## Failures\n")
    failures(lines)
    print("\n" + parts[1].strip() + "\n")
    ompl_table(ompl)
    print("\n" + parts[2].strip())


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    commands = parser.add_subparsers(required=True)
    ours = commands.add_parser("ours")
    ours.add_argument("problems")
    ours.add_argument("file")
    ours.add_argument("--seeds", type=int, default=50)
    ours.add_argument("--limits", type=limit_of, nargs="+", default=[None, 1.0, 10.0], help="CPU times of a process [s], or first")
    ours.add_argument("--jobs", type=int, default=1, help="searches at a time, of one thread each")
    ours.set_defaults(run=search_all)
    made = commands.add_parser("page")
    for name in ("ours", "ompl"):
        made.add_argument(name)
    made.set_defaults(run=page)
    given = parser.parse_args()
    given.run(given)


if __name__ == "__main__":
    sys.exit(main())
