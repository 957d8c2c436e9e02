#!/usr/bin/env python3
"""Attacks the program: damaged files, extreme values, kills, shared folders. Prints what it tried and what it found.

Usage: attack.py DOWNWASH PROBLEMS [--share S] [--seed N] [--only KIND...]
"""

import argparse
import pathlib
import random
import sys
import tempfile
import time

import tries
import writing
from program import Finding, Program

KINDS = tries.KINDS + writing.KINDS


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("problems", type=pathlib.Path, help="the folder of the shipped problems")
    parser.add_argument("--share", type=float, default=1, help="of the number of tries, 1 for all")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", nargs="*", choices=[kind.name for kind in KINDS])
    parser.add_argument("--keep", type=pathlib.Path, help="a folder for what findings were made with")
    given = parser.parse_args()

    found = []
    for kind in KINDS:
        if given.only and kind.name not in given.only:
            continue
        tries = max(1, round(kind.tries * given.share))
        begin = time.monotonic()
        failures = 0
        with tempfile.TemporaryDirectory(prefix="downwash-attack-") as folder:
            attack = kind.attack(Program(given.program.resolve(), pathlib.Path(folder)), given.problems.resolve())
            for i in range(tries):
                try:
                    attack.attempt(random.Random(f"{kind.name} {given.seed} {i}"))
                except Finding as finding:
                    failures += 1
                    found.append(f"{kind.name} {i}: {finding}")
                    if given.keep:
                        attack.keep(given.keep / f"{kind.name}-{i}")
        print(f"{kind.name:<12} {tries:>5} tries {failures:>4} findings {time.monotonic() - begin:>7.0f} s  {kind.what}", flush=True)
    for finding in found:
        print(f"\n{finding}")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
