#!/usr/bin/env python3
"""Makes the problems of problems/space/ with the sizes of real structures, and the meshes and octrees that they refer
to.

Run it anywhere: python3 problems/make_space_problems.py. It needs nothing but Python 3. With --check it compares and
writes nothing; with --seed N DIR it writes a girder bay and a pipe rack of random sizes into DIR, beside copies of
their robots.
"""

import sys

from generators import around_a_pier, box_girder_chamber, culvert, girder_bay, girder_survey
from generators import pipe_rack, tank_shell, tunnel_crown, window
from generators.shipped_files import PROBLEMS, check_or_write, write_files

FAMILIES = [girder_bay, girder_survey, pipe_rack, culvert, tank_shell, box_girder_chamber, tunnel_crown, window, around_a_pier]
RANDOM_FAMILIES = {"girder_bay": girder_bay.with_boxes, "pipe_rack": pipe_rack.make}


class Random:
    """Numbers that follow from a seed, the same in every version of Python (Steele, Lea and Flood 2014: SplitMix64)."""

    def __init__(self, seed):
        self.state = seed

    def _next(self):
        self.state = (self.state + 0x9E3779B97F4A7C15) % 2**64
        z = self.state
        z = (z ^ z >> 30) * 0xBF58476D1CE4E5B9 % 2**64
        z = (z ^ z >> 27) * 0x94D049BB133111EB % 2**64
        return z ^ z >> 31

    def uniform(self, low, high):
        return low + (high - low) * self._next() / 2**64

    def below(self, count):
        """0 to count - 1."""
        return self._next() * count // 2**64


def files_of(problems):
    files = {}
    for problem in problems:
        files[f"space/{problem.name}.yaml"] = problem.text().encode()
        files.update(problem.files)
    return files


def random_files(seed):
    problems = [make(f"{name}_{seed}", Random(seed)) for name, make in RANDOM_FAMILIES.items()]
    robots = {f"robots/{p.robot}.yaml" for p in problems}
    return files_of(problems) | {name: (PROBLEMS / name).read_bytes() for name in robots}


if __name__ == "__main__":
    if len(sys.argv) == 4 and sys.argv[1] == "--seed" and sys.argv[2].isdecimal():
        write_files(random_files(int(sys.argv[2])), sys.argv[3])
    else:
        check_or_write(files_of(problem for family in FAMILIES for problem in family.problems()))
