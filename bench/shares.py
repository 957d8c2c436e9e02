#!/usr/bin/env python3
"""Runs bench/campaigns/shares.yaml, 102,000 searches, in shards on a Slurm of its own on this machine, and writes bench/results/shares.md.

Half an hour of two processors. Stop it when you like: with the same folder and program it goes on where it was.

Usage: bench/shares.py FOLDER [--program DOWNWASH] [--shards N]
"""

import argparse
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "tests/slurm"))
from cluster import Cluster  # noqa: E402


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("folder", type=pathlib.Path, help="for shards and their merge")
    parser.add_argument("--program", type=pathlib.Path, default=ROOT / "build/downwash")
    parser.add_argument("--shards", type=int, default=60)
    given = parser.parse_args()
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(128 + signal.SIGTERM))  # the cluster is taken away, too
    os.nice(19)  # its daemons and tasks, too
    folder, program = given.folder.resolve(), given.program.resolve()
    subprocess.run([program, "bench", "slurm", ROOT / "bench/campaigns/shares.yaml", "--shards", str(given.shards), "--out", folder],
                   check=True, stdout=subprocess.DEVNULL)
    with tempfile.TemporaryDirectory(prefix="downwash-slurm-") as name:
        pathlib.Path(name).chmod(0o755)
        with Cluster(pathlib.Path(name), nodes=2) as cluster:
            submitted = cluster.run("bash", str(folder / "submit.sh"))
            print(submitted.stdout, submitted.stderr, flush=True)
            job = submitted.stdout.split("; job ")[1].split()[0]
            while not cluster.has_ended(job):
                time.sleep(5)
    # 0 and 1 both report; a target that is missed is in the page.
    report = subprocess.run([program, "bench", "report", folder / "merged"], capture_output=True, text=True, check=False)
    if report.returncode > 1:
        print(report.stderr)
        return report.returncode
    (ROOT / "bench/results/shares.md").write_text(report.stdout)
    subprocess.run([ROOT / "bench/bars.sh", "--write"], check=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
