#!/usr/bin/env python3
"""Where vehicles in space can hover under a deck, a girder, a deck's edge and a pipe (docs/hold.md).

Usage: bench/hold_in_space.py [downwash] >bench/results/hold_in_space.md
Every hover is one of `downwash aeromap hold`: eigenvalues of a tick of the closed loop, surfaces evaluated directly.
"""

import collections
import pathlib
import re
import subprocess
import sys
import tempfile

from program import run

TREE = pathlib.Path(__file__).resolve().parent.parent
# With the joints at these angles in degrees: the arm on top of one robot leans forward, and still touches first.
ROBOTS = {"hexa370_arm3": (0, 0, 0), "snu_f550_arm2": (75, 0), "ars_lrm_space": (0,)}
UNDERSIDE_M = 6.0
# The girder is that of the FHWA LRFD design example: flange 0.36 m, web 1.37 m, a deck on top.
CEILINGS = {
    "deck": ["box: {size_m: [30, 30, 0.2], center_m: [0, 0, 6.1]}"],
    "deck's edge": ["box: {size_m: [30, 15, 0.2], center_m: [0, -7.5, 6.1]}"],
    "girder": [
        "box: {size_m: [30, 0.36, 0.03], center_m: [0, 0, 6.015]}",
        "box: {size_m: [30, 0.016, 1.37], center_m: [0, 0, 6.715]}",
        "box: {size_m: [30, 30, 0.2], center_m: [0, 0, 7.5]}",
    ],
    "pipe": ["cylinder: {radius_m: 0.25, length_m: 30, center_m: [0, 0, 6.25], axis: [1, 0, 0]}"],
}


def robot_file(folder, robot, observer):
    """A copy of a shipped robot, with another observer or the shipped one."""
    text = (TREE / f"problems/robots/{robot}.yaml").read_text()
    if observer is not None:
        text = re.sub(r"observer_gain_1_s: [0-9.]+", f"observer_gain_1_s: {observer}", text)
    file = folder / f"{robot}-{observer}.yaml"
    file.write_text(text)
    return file


def problem_file(folder, robot, ceiling):
    """A problem of one robot under one ceiling."""
    obstacles = "".join(f"    - {{{shape}}}\n" for shape in CEILINGS[ceiling])
    file = folder / f"{robot.stem}-{ceiling.split()[0]}.yaml"
    file.write_text(
        "schema: downwash/problem/v1\nname: hold\n"
        f"robot: {robot}\n"
        "environment:\n  bounds: {x_m: [-5, 5], y_m: [-5, 5], z_m: [0.5, 7]}\n"
        f"  obstacles:\n{obstacles}"
        "start: {x_m: 0, y_m: 0, z_m: 2}\ngoal:\n  configuration: {x_m: 1, y_m: 0, z_m: 2}\n"
    )
    return file


def highest_hub_m(robot):
    """Height of the highest rotor over the centre of mass."""
    places = re.search(r"positions_m:(.*?)\n  \w", robot.read_text(), re.DOTALL).group(1)
    return max(float(z) for z in re.findall(r"\[[-\d.]+, *[-\d.]+, *([-\d.]+)\]", places))


def holds(program, problem, low, high, step):
    """The hovers of a grid."""
    joints_deg = ROBOTS[next(robot for robot in ROBOTS if problem.stem.startswith(robot))]
    grid = ("--low", *low, "--high", *high, "--spacing", step, "--joints-deg", *joints_deg)
    return run(program, "aeromap", "hold", problem, *grid, "--json")["points"]


def least_gap_m(program, problem, hub_m, y_m):
    """The least distance of the rotors below the underside at which this and all greater ones are stable."""
    top = UNDERSIDE_M - hub_m
    points = holds(program, problem, (0, y_m, round(top - 1.5, 6)), (0, y_m, round(top, 6)), 0.01)
    least = None
    for point in points:
        if point["verdict"] != "stable":
            break
        least = UNDERSIDE_M - hub_m - point["z_m"]
    return least


def print_gaps(program, robots, folder):
    """The table of least distances."""
    print("## Least distance of the rotors\n")
    print("Metres between the hubs and the underside, below its middle or its edge, to a centimetre; from there on down")
    print("every hover is stable.\n")
    print("| robot | observer 1/s | " + " | ".join(CEILINGS) + " |")
    print("| --- | ---: |" + " ---: |" * len(CEILINGS))
    for robot, observer in robots:
        file = robot_file(folder, robot, observer)
        hub_m = highest_hub_m(file)
        row = []
        for ceiling in CEILINGS:
            gap = least_gap_m(program, problem_file(folder, file, ceiling), hub_m, 0)
            row.append("-" if gap is None else f"{gap:.2f}")
        print(f"| {robot} | {'shipped' if observer is None else observer} | {' | '.join(row)} |")
    print()


def print_across(program, robots, folder):
    """The table of hovers on a grid across a girder and a deck's edge."""
    print("## Across a girder and a deck's edge\n")
    print("Places 5 cm apart: 1 m to either side of the middle of the girder or of the edge, and from 5 to 75 cm between")
    print("the hubs and the underside. `in` is the coordinate in which unstable hovers move\nmost; the last column is the greatest distance at which one is unstable.\n")
    print("| robot | observer 1/s | ceiling | stable | unknown | unstable | no equilibrium | not flyable | fastest growth 1/s | in | unstable up to m |")
    print("| --- | ---: | --- |" + " ---: |" * 6 + " --- | ---: |")
    for robot, observer in robots:
        file = robot_file(folder, robot, observer)
        top = UNDERSIDE_M - highest_hub_m(file)
        for ceiling in ("girder", "deck's edge"):
            problem = problem_file(folder, file, ceiling)
            points = holds(program, problem, (0, -1, round(top - 0.75, 6)), (0, 1, round(top - 0.05, 6)), 0.05)
            verdicts = collections.Counter(point["verdict"] for point in points)
            unstable = [point for point in points if point["verdict"] == "unstable"]
            fastest = max((point["growth_rate_1_s"] for point in unstable), default=None)
            ways = collections.Counter(point["slowest_loop"] for point in unstable)
            lowest_m = min((point["z_m"] for point in unstable), default=None)
            gap = "-" if lowest_m is None else f"{top - lowest_m:.2f}"
            print(
                f"| {robot} | {'shipped' if observer is None else observer} | {ceiling} | {verdicts['stable']} | "
                f"{verdicts['unknown']} | {verdicts['unstable']} | {verdicts['no_equilibrium']} | "
                f"{verdicts['not_flyable'] + verdicts['in_collision']} | "
                f"{'-' if fastest is None else f'{fastest:.2f}'} | "
                f"{', '.join(f'{way} {count}' for way, count in ways.most_common()) or '-'} | {gap} |"
            )
    print()


def main():
    """Prints the page."""
    program = sys.argv[1] if len(sys.argv) > 1 else TREE / "build/downwash"
    commit = subprocess.run([TREE / "bench/source_commit.sh"], capture_output=True, text=True, check=True).stdout.strip()
    print("# Hover in space under ceilings\n")
    print(f"Commit {commit}. Made by `bench/hold_in_space.py`: `downwash aeromap hold` in space, yaw 0.\n")
    robots = [(robot, observer) for robot in ROBOTS for observer in (None, 0)]
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        print_gaps(program, robots, folder)
        print_across(program, robots, folder)


if __name__ == "__main__":
    main()
