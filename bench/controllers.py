#!/usr/bin/env python3
"""Plans the shipped problems, each with its uncertainty, with every control law, and writes a page of what each law buys.

Usage: bench/controllers.py [downwash] [--seeds N] [--time-limit S] >bench/results/controllers.md
Two searches run at a time, on one thread each.
"""

import argparse
import json
import pathlib
import re
import shutil
import statistics
import subprocess
import tempfile
from concurrent.futures import ThreadPoolExecutor

TREE = pathlib.Path(__file__).resolve().parent.parent
OBSERVER = "  observer: {gain_1_s: %g}\n"
FEED_FORWARD = "  feed_forward: {}\n"
OTHER = "controller:\n  type: %s\n  rate_hz: 100\n  delay_s: 0.01\n  rotor_lead: 1\n"
CASCADED = OTHER % "cascaded-pid"
LYAPUNOV = OTHER % "lyapunov"


def alone(text):
    """The shipped law without its observer, and with the arm's gains that have the same margins then."""
    text = re.sub(r"^  observer:.*\n(?:    .*\n)+", "", text, flags=re.M)
    return text.replace("kp: 22", "kp: 34").replace("ki: 5\n", "ki: 10\n")


# Name, and what becomes of the text of the shipped robot's controller.
LAWS = [
    ("model-inversion, observer 3 1/s (shipped)", lambda text: text),
    ("model-inversion alone", alone),
    ("model-inversion + feed-forward", lambda text: alone(text) + FEED_FORWARD),
    ("shipped + feed-forward", lambda text: text + FEED_FORWARD),
    ("cascaded-pid", lambda text: CASCADED),
    ("cascaded-pid + observer, 3 1/s", lambda text: CASCADED + OBSERVER % 3),
    ("cascaded-pid + feed-forward, observer 3 1/s", lambda text: CASCADED + FEED_FORWARD + OBSERVER % 3),
    ("lyapunov", lambda text: LYAPUNOV),
    ("lyapunov + observer, 3 1/s", lambda text: LYAPUNOV + OBSERVER % 3),
]


def problems_with(law, folder):
    """A copy of the shipped problems whose robot flies another law."""
    shutil.copytree(TREE / "problems", folder)
    robot = folder / "robots/ars_lrm.yaml"
    text = robot.read_text()
    block = re.search(r"^controller:.*?(?=^\S|\Z)", text, re.S | re.M)
    robot.write_text(text[: block.start()] + law(block.group(0).rstrip() + "\n") + "\n" + text[block.end():])
    return folder


def solved(program, problem, seed, limit_s, out):
    """What a search says of itself, or None if it ends before."""
    command = [program, "solve", problem, "--seed", str(seed), "--time-limit", str(limit_s)]
    command += ["--threads", "1", "--quiet", "--json", "--out", out]
    run = subprocess.run(command, capture_output=True, text=True, check=False)
    try:
        return json.loads(run.stdout)
    except json.JSONDecodeError:
        raise SystemExit(f"bench/controllers.py: {problem}: {run.stderr}") from None


def is_certified(run):
    return run["status"] == "solved" and run["certificate"]["given"]


def median(values, form):
    return form.format(statistics.median(values)) if values else "-"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("program", type=pathlib.Path, nargs="?", default=TREE / "build/downwash")
    parser.add_argument("--seeds", type=int, default=3)
    parser.add_argument("--time-limit", type=float, default=10)
    given = parser.parse_args()
    program = given.program.resolve()
    commit = subprocess.run([f"{TREE}/bench/source_commit.sh"], capture_output=True, text=True, check=True)
    names = sorted(path.name for path in (TREE / "problems").glob("*.yaml"))
    with tempfile.TemporaryDirectory() as work:
        jobs = []
        for i, (law, change) in enumerate(LAWS):
            folder = problems_with(change, pathlib.Path(work) / f"law{i}")
            jobs += [(law, name, seed, folder / name, f"{work}/run{i}-{name}-{seed}")
                     for name in names for seed in range(1, given.seeds + 1)]
        with ThreadPoolExecutor(2) as pool:
            done = pool.map(lambda job: solved(program, job[3], job[2], given.time_limit, job[4]), jobs)
            runs = {job[:3]: run for job, run in zip(jobs, done)}

    print("# What each control law buys in planning\n")
    print(f"Commit {commit.stdout.strip()}. The shipped problems, each with its uncertainty, MP-ARM-ADA, seeds 1 to {given.seeds}, "
          f"{given.time_limit:g} s and one thread each, two searches at a time. The robot is the shipped one but for its law; *alone* is that law without its observer, with arm gains (kp 34, ki 10) of the same margins. "
          "A feed-forward reads the nominal map, while the worlds of the certificate have other surfaces at other places. "
          "Made by `bench/controllers.py`.\n")
    print("*certified*: searches whose plan got its certificate. *first certified*: median wall time of those. *cost*: median, over problems and "
          "seeds on which both laws are certified, of the flown cost over that of the shipped law. *failures*: of all certificates' worlds together. "
          "*clearance*: median of the certificates' 10 % quantiles.\n")
    print("| law | certified | first certified | cost | failures | clearance |")
    print("| --- | ---: | ---: | ---: | ---: | ---: |")
    reference = LAWS[0][0]
    for law, _ in LAWS:
        own = {key[1:]: run for key, run in runs.items() if key[0] == law}
        good = {key: run for key, run in own.items() if is_certified(run)}
        ratios = [run["execution"]["cost"] / runs[(reference, *key)]["execution"]["cost"]
                  for key, run in good.items() if is_certified(runs[(reference, *key)])]
        failures = sum(run["certificate"]["failures"] for run in good.values())
        worlds = sum(run["certificate"]["worlds"] for run in good.values())
        print(f"| {law} | {len(good)}/{len(own)} | {median([r['planning']['first_certified_wall_s'] for r in good.values()], '{:.2f} s')} "
              f"| {median(ratios, '{:.3f}')} | {failures} of {worlds} | {median([r['certificate']['clearance_m']['p10'] for r in good.values()], '{:.3f} m')} |")
    print("\nCertified searches by problem:\n")
    print("| problem | " + " | ".join(law for law, _ in LAWS) + " |")
    print("| --- |" + " ---: |" * len(LAWS))
    for name in names:
        counts = [sum(is_certified(runs[(law, name, seed)]) for seed in range(1, given.seeds + 1)) for law, _ in LAWS]
        print(f"| {name.removesuffix('.yaml')} | " + " | ".join(map(str, counts)) + " |")


if __name__ == "__main__":
    main()
