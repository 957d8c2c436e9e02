#!/usr/bin/env python3
"""How often certified plans in space fail in fresh worlds when the judge flies them (docs/validation.md).

Usage: bench/judged_in_space.py [--worlds N] [--seed N] [downwash] >bench/results/judged_in_space.md
Each problem of bench/campaigns/space.yaml is planned once; the judge flies the plan in worlds that no search has seen, surfaces
evaluated directly. About an hour of one core for 300 worlds.
"""

import argparse
import pathlib
import re
import subprocess
import tempfile

from program import run

TREE = pathlib.Path(__file__).resolve().parent.parent
FRESH_SEED = 2**32  # seeds of searches are below: none has seen these worlds
LIMIT_S = 20


def problems():
    """The problem files of the campaign."""
    campaign = TREE / "bench/campaigns/space.yaml"
    names = re.findall(r"^  - (\S+\.yaml)$", campaign.read_text(), re.MULTILINE)
    return [(campaign.parent / name).resolve() for name in names]


def planned(program, problem, seed, folder):
    """What `solve` says of the first plan that counts."""
    limits = ("--time-limit", LIMIT_S, "--stop-at-first", "--threads", 1, "--seed", seed)
    return run(program, "solve", problem, *limits, "--out", folder, "--json")


def row(program, problem, seed, worlds, folder):
    """A line of the table."""
    solution = planned(program, problem, seed, folder)
    certificate = solution.get("certificate") or {}
    if not certificate.get("given"):
        return f"| {problem.stem} | none: {solution['status']} | | | | | |"
    judged = run(program, "validate", problem, "--plan", folder, "--runs", worlds, "--seed", FRESH_SEED, "--json")
    share = judged["failure_probability"]
    clearance = judged["clearance_m"]
    return (
        f"| {problem.stem} | {certificate['failures']} of {certificate['worlds']} | {judged['outcome']} | "
        f"{judged['failures']} of {judged['runs']} | [{100 * share['low']:.2f}, {100 * share['high']:.2f}] % | "
        f"{clearance['p01']:.3f} | {clearance['p50']:.3f} |"
    )


def main():
    """Prints the page."""
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("program", nargs="?", default=str(TREE / "build/downwash"))
    arguments.add_argument("--worlds", type=int, default=300, help="that the judge flies each plan in")
    arguments.add_argument("--seed", type=int, default=1, help="of the searches")
    asked = arguments.parse_args()
    commit = subprocess.run([TREE / "bench/source_commit.sh"], capture_output=True, text=True, check=True).stdout.strip()
    print("# Certified plans in space, flown by the judge in fresh worlds\n")
    print(
        f"Commit {commit}. Made by `bench/judged_in_space.py`: the first plan with a certificate of a search of one thread with seed {asked.seed}\n"
        f"and at most {LIMIT_S} s, flown by `downwash validate --runs {asked.worlds} --seed {FRESH_SEED}`. The judge has a plant, a control law, an\n"
        "integrator and effects of its own. Certificates bound the failure probability by 1 % with a confidence of 95 %.\n"
    )
    print("| problem | certificate: worlds failed | judged nominally | by the judge: worlds failed | 95 % interval | clearance m, 1 % | median |")
    print("| --- | ---: | --- | ---: | ---: | ---: | ---: |", flush=True)
    with tempfile.TemporaryDirectory() as name:
        for problem in problems():
            print(row(asked.program, problem, asked.seed, asked.worlds, pathlib.Path(name) / problem.stem), flush=True)


if __name__ == "__main__":
    main()
