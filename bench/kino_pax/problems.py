#!/usr/bin/env python3
"""Writes Kino-PAX's worlds of its quadrotor as problem files in space. bench/kino_pax.sh calls it.

Usage: bench/kino_pax/problems.py FOLDER
Obstacles are those of trees.csv and house.csv in this folder: boxes, a line "low x, y, z, high x, y, z" each, copied from
include/config/obstacles/quadTrees and quadHouse of https://github.com/aria-systems-group/Kino-PAX (MIT, (c) 2024 ARIA Systems
Group), commit fb0d4fe. Start, goal, goal radius and bounds are theirs.
"""

import csv
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent

TEXT = """\
# Kino-PAX's world `{name}` of its quadrotor; problems.py has the sources.
schema: downwash/problem/v1
name: kino_pax_{name}
robot: {here}/quadrotor.yaml
environment:
  bounds: {{x_m: [0, 100], y_m: [0, 100], z_m: [0, 100]}}
  obstacles:
{obstacles}
aero: {{ground: {{model: none}}, ceiling: {{model: none}}}}
start: {{x_m: 10, y_m: 8, z_m: 5}}
goal:
  configuration: {{x_m: 80, y_m: 95, z_m: 90, tolerance_m: 5}}   # their radius, in which they need not stop
  hold_s: 4
motion:
  max_speed_m_s: 8
  max_acceleration_m_s2: 2
  max_jerk_m_s3: 2
  yaw: hold
planner:
  variant: mp-arm-da        # no surface changes thrust
  objective: time
  safety_margin_m: 0.05
  max_saturation: 1000      # demands are clipped
"""


def box_of(number, row):
    # Some of the house have low and high exchanged or alike: theirs hardly ever stop a motion, ours are full boxes.
    low, high = zip(*(sorted((float(a), float(b))) for a, b in zip(row[:3], row[3:6])))
    size = ", ".join(f"{max(b - a, 0.01):.6g}" for a, b in zip(low, high))
    center = ", ".join(f"{(a + b) / 2:.6g}" for a, b in zip(low, high))
    return f"    - {{name: box_{number}, box: {{size_m: [{size}], center_m: [{center}]}}}}"


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    folder = pathlib.Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    for name in ("trees", "house"):
        with open(HERE / f"{name}.csv", newline="", encoding="utf-8") as file:
            boxes = [box_of(number, row) for number, row in enumerate(csv.reader(file), 1) if row]
        text = TEXT.format(name=name, here=HERE, obstacles="\n".join(boxes))
        (folder / f"{name}.yaml").write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
