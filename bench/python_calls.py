#!/usr/bin/python3
"""Times calls from Python beside the same calls from C++, and writes bench/results/python_calls.md. A minute.

Both sides run in turns, on one thread. Usage: bench/python_calls.py [--rounds N]
"""

from __future__ import annotations

import argparse
import json
import pathlib
import subprocess
import sys
import tempfile
import time
from typing import Any, Callable

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "build" / "python"))
POINTS = 1_000_000
SEARCHES = 300


def seconds_of(work: Callable[[], Any]) -> float:
    begin = time.perf_counter()
    work()
    return time.perf_counter() - begin


def processor_seconds_of(work: Callable[[], Any]) -> float:
    begin = time.process_time()
    work()
    return time.process_time() - begin


def from_python(problem: Any, quick: Any, points: Any) -> dict[str, float]:
    import downwash

    result: dict[str, Any] = {}
    direct_s = processor_seconds_of(lambda: result.update(k=downwash.factor(problem, points, threads=1)))
    built = downwash.AeroMap.build(problem, threads=1)
    map_s = processor_seconds_of(lambda: built.factor(points, threads=1))
    solve_s = min(seconds_of(lambda: downwash.solve(quick, threads=1)) for _ in range(SEARCHES))
    return {"direct_s": direct_s, "map_s": map_s, "solve_s": solve_s, "sum": float(result["k"].cumsum()[-1])}


def measured(rounds: int) -> list[tuple[dict[str, float], dict[str, float]]]:
    import downwash
    import numpy as np

    file = ROOT / "problems" / "bridge_inspection.yaml"
    problem = downwash.read_problem(file)
    quick = downwash.read_problem(ROOT / "problems" / "open_air.yaml").replace(
        {
            "uncertainty": "none",
            "planner.variant": "mp-arm",
            "planner.time_limit_s": None,
            "planner.max_iterations": 1,
        }
    )
    bounds = problem["environment.bounds"]
    low, high = zip(bounds["x_m"], bounds["z_m"])
    points = np.random.default_rng(1).uniform(low, high, size=(POINTS, 2))
    pairs = []
    with tempfile.NamedTemporaryFile() as stored, tempfile.NamedTemporaryFile("w", suffix=".yaml") as search:
        points.tofile(stored.name)
        search.write(quick.to_yaml(pathlib.Path(search.name).parent))
        search.flush()
        command = [ROOT / "build/bench/bench_python_calls", file, stored.name, search.name, str(SEARCHES)]
        for _ in range(rounds):
            done = subprocess.run(command, check=True, capture_output=True, text=True)
            pairs.append((json.loads(done.stdout), from_python(problem, quick, points)))
    for cpp, python in pairs:
        assert cpp["sum"] == python["sum"], "K differs between C++ and Python"
    return pairs


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rounds", type=int, default=9)
    options = parser.parse_args()
    for command in (
        ["./dev", "build", "--target", "bench_python_calls"],
        ["./dev", "build", "--target", "downwash_python"],
    ):
        subprocess.run(command, cwd=ROOT, check=True)
    pairs = measured(options.rounds)

    best = [{key: min(pair[side][key] for pair in pairs) for key in pairs[0][0]} for side in (0, 1)]
    commit = subprocess.run(
        [ROOT / "bench/source_commit.sh"], check=True, capture_output=True, text=True
    ).stdout.strip()

    def row(call: str, key: str, digits: int) -> str:
        cpp, python = (1e3 * side[key] for side in best)
        return f"| {call} | {cpp:.{digits}f} ms | {python:.{digits}f} ms | {python / cpp:.2f} |"

    ratio = best[1]["direct_s"] / best[0]["direct_s"]
    overhead_ms = 1e3 * (best[1]["solve_s"] - best[0]["solve_s"])

    def verdict(is_kept: bool) -> str:
        return "kept" if is_kept else "**missed**"

    lines = [
        "# Calls from Python beside calls from C++",
        "",
        f"Commit `{commit}`, Release. `bench/python_calls.py` writes this page: the best of {options.rounds} rounds",
        "in which both sides take turns, one thread each; other programs can only add to a time. K is that of",
        "`bridge_inspection`, its times are those of the processor; the search is the fastest, by the clock, of",
        f"{SEARCHES} a round in `open_air` in the nominal world.",
        "",
        "| call | C++ | Python | ratio |",
        "|---|---:|---:|---:|",
        row(f"K at {POINTS} points, evaluated directly", "direct_s", 1),
        row(f"K at {POINTS} points, from a map", "map_s", 1),
        row("a search of one iteration (mp-arm)", "solve_s", 3),
        "",
        "| bound | found | |",
        "|---|---|---|",
        f"| K evaluated directly: at most 1.2 times C++ | {ratio:.2f} | {verdict(ratio <= 1.2)} |",
        f"| overhead of a search: below 1 ms | {overhead_ms:.3f} ms | {verdict(overhead_ms < 1)} |",
    ]
    page = ROOT / "bench" / "results" / "python_calls.md"
    page.write_text("\n".join(lines) + "\n", encoding="utf-8")
    print(page.read_text(encoding="utf-8"))
    return 0


if __name__ == "__main__":
    sys.exit(main())
