#!/usr/bin/env python3
"""Measures how reading, mapping and planning grow with the number of obstacles of a scene and of triangles of a mesh.

Usage: bench/scene_growth.py [downwash] [--most N] >bench/results/scene_growth.md
A plant of boxes, or a rugged deck of triangles, lies over a field; the vehicle crosses the field under it. Every command
runs alone, on two threads; its memory is the peak of the process, as the kernel counts it.
"""

import argparse
import json
import math
import os
import pathlib
import platform
import random
import re
import struct
import subprocess
import tempfile
import time

TREE = pathlib.Path(__file__).resolve().parent.parent
OBSTACLES = [10, 100, 1_000, 10_000, 25_000, 100_000]
TRIANGLES = [1_000, 10_000, 100_000, 1_000_000]
SEARCH_S = 10

PROBLEM = """schema: downwash/problem/v1
name: growth
robot: {robot}
environment:
  bounds: {{x_m: [-20, 20], z_m: [1, 12]}}
  obstacles:
    - {{name: ground, box: {{size_m: [120, 120, 1], center_m: [0, 0, -0.5]}}}}
{obstacles}
start: {{x_m: -16, z_m: 4, arm_deg: 90}}
goal: {{configuration: {{x_m: 16, z_m: 7, tolerance_m: 0.3}}, hold_s: 2}}
"""


def boxes(count):
    """Boxes over the field, their undersides between 8.5 and 11 m: of equal number per area, so that more are smaller."""
    draw = random.Random(count)
    side_m = 0.5 * 40 / math.sqrt(count)
    lines = []
    for i in range(count - 1):
        x_m, y_m = draw.uniform(-20, 20), draw.uniform(-20, 20)
        height_m = draw.uniform(0.2, 1)
        z_m = draw.uniform(8.5, 11) + height_m / 2
        lines.append(f"    - {{name: b{i}, box: {{size_m: [{side_m:.4g}, {side_m:.4g}, {height_m:.3g}], "
                     f"center_m: [{x_m:.4f}, {y_m:.4f}, {z_m:.4f}]}}}}")
    return "\n".join(lines)


def deck(count, file):
    """A sheet of triangles 10 m above the ground with bumps of 0.3 m, as a binary STL."""
    draw = random.Random(count)
    cells = max(1, round(math.sqrt(count / 2)))
    heights = [[10 + draw.uniform(-0.3, 0.3) for _ in range(cells + 1)] for _ in range(cells + 1)]

    def corner(i, j):
        return (-20 + 40 * i / cells, -20 + 40 * j / cells, heights[i][j])

    with open(file, "wb") as out:
        out.write(b" " * 80 + struct.pack("<I", 2 * cells * cells))
        for i in range(cells):
            for j in range(cells):
                a, b, c, d = corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)
                for triangle in ((a, c, b), (a, d, c)):
                    out.write(struct.pack("<12fH", 0, 0, 0, *(v for vertex in triangle for v in vertex), 0))
    return 2 * cells * cells


def measured(command):
    """Wall time [s], peak memory [MiB], exit code and output of a command."""
    with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as err:
        begin = time.monotonic()
        child = subprocess.Popen(command, stdout=out, stderr=err)
        _, status, usage = os.wait4(child.pid, 0)
        wall_s = time.monotonic() - begin
        out.seek(0)
        err.seek(0)
        return (wall_s, usage.ru_maxrss / 1024, os.waitstatus_to_exitcode(status), out.read().decode(),
                err.read().decode())


def row(program, folder, pieces, obstacles):
    """A row of the table: reading, map, search."""
    problem = folder / "growth.yaml"
    problem.write_text(PROBLEM.format(robot=TREE / "problems/robots/ars_lrm.yaml", obstacles=obstacles))
    size_mib = problem.stat().st_size / 2**20
    read_s, read_mib, code, _, error = measured([program, "check", str(problem)])
    if code != 0:
        refused = re.sub(r"^\S*/", "", error.strip().splitlines()[0])
        return f"| {pieces:,} | {size_mib:.1f} | refused: {refused} | | | | |"
    command = [program, "solve", str(problem), "--no-cache", "--quiet", "--json", "--force", "--threads", "2"]
    command += ["--seed", "1", "--time-limit", str(SEARCH_S), "--out", str(folder / "out")]
    _, solve_mib, _, text, error = measured(command)
    try:
        solution = json.loads(text)
    except json.JSONDecodeError:
        return f"| {pieces:,} | {size_mib:.1f} | {read_s:.2f} | {read_mib:.0f} | {error.strip().splitlines()[0]} | | |"
    planning = solution["planning"]
    first_s = planning["first_solution_wall_s"]
    return (f"| {pieces:,} | {size_mib:.1f} | {read_s:.2f} | {read_mib:.0f} | {planning['map_wall_s']:.2f} | "
            f"{'none' if first_s is None else f'{first_s:.2f}'} | {planning['iterations']:,} | {solve_mib:.0f} |")


def table(title, first):
    print(f"## {title}\n")
    print(f"| {first} | file [MiB] | read and check [s] | memory [MiB] | filling the map, both threads [s] | first plan [s] | "
          f"iterations in {SEARCH_S} s | memory [MiB] |")
    print("| ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |", flush=True)


def processor():
    for line in pathlib.Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith("model name"):
            return line.split(":", 1)[1].strip()
    return platform.machine()


def main():
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("program", nargs="?", default=str(TREE / "build/downwash"))
    arguments.add_argument("--most", type=int, default=10**9, help="leave out larger scenes")
    given = arguments.parse_args()
    commit = subprocess.run(["bench/source_commit.sh"], cwd=TREE, capture_output=True, text=True, check=True).stdout
    print("# Large scenes\n")
    print(f"Commit {commit.strip()}, {processor()}, 2 threads. Made by `bench/scene_growth.py`.\n")
    print("The first plan comes from a bare start, without a cached map: the map fills while the search runs. Refinement and the\n"
          "flights that check plans take their share of the ten seconds, so iterations differ from row to row.\n")
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        table("Boxes", "obstacles")
        for count in OBSTACLES:
            if count <= given.most:
                print(row(given.program, folder, count, boxes(count)), flush=True)
        print()
        table("A deck of triangles", "triangles")
        for count in TRIANGLES:
            if count <= given.most:
                pieces = deck(count, folder / "deck.stl")
                mesh = "    - {name: deck, mesh: {file: deck.stl}}"
                print(row(given.program, folder, pieces, mesh), flush=True)


if __name__ == "__main__":
    main()
