#!/usr/bin/env python3
"""How far the wash of the rotors on the arm moves hover, energy and failures in worlds (docs/model.md 2.7).

Usage: bench/arm_wash.py [downwash] [--seeds N] [--runs N] [--iterations N] >bench/results/arm_wash.md
Searches run one after the other, on two threads; flights in worlds are those of `downwash validate`.
"""

import argparse
import pathlib
import re
import statistics
import subprocess
import tempfile

from program import run

TREE = pathlib.Path(__file__).resolve().parent.parent
PLUS = "positions_m: [[0.45, 0, 0.06], [-0.45, 0, 0.06], [0, 0.45, 0.06], [0, -0.45, 0.06]]"
ROBOTS = {"ars_lrm": None, "plus layout": PLUS}
PROBLEMS = ["bridge_inspection", "pipe_rack"]
ANGLES_DEG = [-30, 0, 15, 30, 45, 60, 75, 90]
WASH = "  wash: {scale: 1}\n"


def problem_file(folder, problem, hubs, has_wash):
    """A copy of a shipped problem with a copy of the shipped robot."""
    robot = (TREE / "problems/robots/ars_lrm.yaml").read_text()
    if hubs is not None:
        robot = re.sub(r"positions_m: .*", hubs, robot)
    robot = re.sub(r"^  wash: .*\n", "", robot, flags=re.MULTILINE)
    if has_wash:
        robot = robot.replace("\n  limits_deg:", f"\n{WASH}  limits_deg:")
    name = f"{problem}-{'plus' if hubs else 'ars'}-{'wash' if has_wash else 'calm'}"
    (folder / f"{name}-robot.yaml").write_text(robot)
    text = (TREE / f"problems/{problem}.yaml").read_text()
    text = re.sub(r"robots/ars_lrm\w*\.yaml", f"{name}-robot.yaml", text)
    for kept in ("meshes", "maps", "tables"):
        text = text.replace(f"{kept}/", f"{TREE}/problems/{kept}/")
    file = folder / f"{name}.yaml"
    file.write_text(text)
    return file


def trim(program, file, arm_deg):
    """Thrust [N], power of the rotors over that of all at one newton, joint torque [N m] of a hover in free air."""
    point = run(program, "aeromap", "hold", file, "--arm-deg", arm_deg, "--at", 1, 30, "--json")["points"][0]
    thrusts_n = point["trim"]["rotor_commands_n"]
    return sum(thrusts_n), sum(t**1.5 for t in thrusts_n), point["trim"]["joint_torque_nm"], point["verdict"]


def print_hovers(options, folder):
    """The table of hovers."""
    print("## Hover in free air\n")
    print("Thrust, power and joint torque of `downwash aeromap hold`, without and with the wash.\n")
    print("| robot | arm deg | thrust N | with wash | power | joint torque N m | with wash | verdict with wash |")
    print("| --- | ---: | ---: | ---: | ---: | ---: | ---: | --- |")
    for name, hubs in ROBOTS.items():
        calm_file = problem_file(folder, "open_air", hubs, False)
        wash_file = problem_file(folder, "open_air", hubs, True)
        for arm_deg in ANGLES_DEG:
            thrust, power, torque, _ = trim(options.program, calm_file, arm_deg)
            washed_thrust, washed_power, washed_torque, verdict = trim(options.program, wash_file, arm_deg)
            print(f"| {name} | {arm_deg} | {thrust:.2f} | {100 * (washed_thrust / thrust - 1):+.2f} % | "
                  f"{100 * (washed_power / power - 1):+.2f} % | {torque:.3f} | {washed_torque - torque:+.3f} | {verdict} |")
    print()


def planned(options, file, seed, out):
    """A search in worlds."""
    return run(options.program, "solve", file, "--seed", seed, "--max-iterations", options.iterations, "--threads", 2,
               "--quiet", "--json", "--force", "--out", out)


def median_kj(energies_j):
    """A median as text."""
    return f"{statistics.median(energies_j) / 1000:.2f}" if energies_j else "-"


def print_plans(options, folder):
    """The table of plans."""
    print("## Plans\n")
    print("Plans that were made without the wash, flown without and with it; and plans that were made with it. Energy is the "
          "median\nover seeds, in the nominal world. Failures are of all plans with a flight, certified or not. A search with a wash has "
          "other worlds,\nspread evenly over one number more: its plans are others even where no slipstream meets the arm.\n")
    print("| robot | problem | made without: certified | energy kJ | with wash kJ | failed in worlds | with wash | "
          "made with: certified | energy kJ | failed in worlds |")
    print("| --- | --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |")
    for name, hubs in ROBOTS.items():
        for problem in PROBLEMS:
            files = {has_wash: problem_file(folder, problem, hubs, has_wash) for has_wash in (False, True)}
            certified = {False: 0, True: 0}
            energies = {False: [], True: []}
            failures = {"calm": 0, "moved": 0, "wash": 0}
            runs = {"calm": 0, "moved": 0, "wash": 0}
            moved = []
            for seed in range(1, options.seeds + 1):
                for has_wash, file in files.items():
                    out = folder / f"run-{has_wash}"
                    solution = planned(options, file, seed, out)
                    certified[has_wash] += solution["status"] == "solved"
                    if solution["execution"] is None or solution["status"] == "none":
                        continue
                    energies[has_wash].append(solution["execution"]["energy_j"])
                    where = {"wash": True} if has_wash else {"calm": False, "moved": True}
                    for key, in_wash in where.items():
                        flown = run(options.program, "validate", "--plan", out, files[in_wash], "--runs", options.runs,
                                    "--threads", 2, "--json")
                        failures[key] += flown["failures"]
                        runs[key] += options.runs
                    if not has_wash:
                        again = run(options.program, "execute", "--plan", out, files[True], "--quiet", "--json", "--force",
                                    "--out", folder / "again")
                        moved.append(again["execution"]["energy_j"])
            shares = {key: f"{failures[key]} of {runs[key]}" for key in failures}
            print(f"| {name} | {problem} | {certified[False]} of {options.seeds} | {median_kj(energies[False])} | "
                  f"{median_kj(moved)} | {shares['calm']} | {shares['moved']} | {certified[True]} of {options.seeds} | "
                  f"{median_kj(energies[True])} | {shares['wash']} |", flush=True)


def processor():
    """Name of the processor."""
    for line in pathlib.Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith("model name"):
            return line.split(":", 1)[1].strip()
    return "unknown"


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program", nargs="?", default=str(TREE / "build/downwash"))
    parser.add_argument("--seeds", type=int, default=3)
    parser.add_argument("--runs", type=int, default=100)
    parser.add_argument("--iterations", type=int, default=600)
    options = parser.parse_args()
    commit = subprocess.run([f"{TREE}/bench/source_commit.sh"], capture_output=True, text=True, check=True).stdout.strip()
    print("# The wash of the rotors on the arm\n")
    print(f"Commit {commit}, on {processor()}. `bench/arm_wash.py --seeds {options.seeds} --runs {options.runs} "
          f"--iterations {options.iterations}`;\n[model.md 2.7](../../docs/model.md#27-wash-on-the-arm) has the formulas. "
          "`ars_lrm` is the shipped robot, whose rotors stand 0.32 m beside the plane of\nthe arm. In the plus layout they stand "
          "0.45 m in front, behind and on both sides: the arm sweeps below two of them.\n")
    with tempfile.TemporaryDirectory() as folder:
        print_hovers(options, pathlib.Path(folder))
        print_plans(options, pathlib.Path(folder))


if __name__ == "__main__":
    main()
