#!/usr/bin/env python3
"""Writes random problems for the planar rotor, of the kind of dynobench's five.

Usage: bench/dynobench/random_scenes.py FOLDER [--count N] [--seed S]
The space is 6 m by 6 m. Three to six boxes, a slab or a block each, stand anywhere; start and goal are at least 2 m apart, and the
level body at each of them keeps 0.1 m from everything. Nothing else is asked, so a scene may have no solution. Motion and planner
are those of the five problems, taken over from quad_bugtrap.yaml.
"""

import argparse
import pathlib
import random

import yaml

SPACE_M = 6.0
BODY_M = (0.6, 0.2)
CLEAR_M = 0.1
MIN_WAY_M = 2.0


def draw_box(draw):
    """Centre and size of a slab along either axis, or of a block."""
    long_m, thick_m = draw.uniform(0.8, 3.4), draw.uniform(0.2, 0.5)
    size = draw.choice([(long_m, thick_m), (thick_m, long_m), (draw.uniform(0.4, 1.5), draw.uniform(0.4, 1.5))])
    return tuple(round(value, 2) for value in (draw.uniform(0, SPACE_M), draw.uniform(0, SPACE_M), *size))


def is_free(place, boxes):
    """Whether the level body there keeps clear of all boxes."""
    return all(
        any(abs(place[axis] - box[axis]) > (BODY_M[axis] + box[2 + axis]) / 2 + CLEAR_M for axis in (0, 1))
        for box in boxes
    )


def draw_place(draw, boxes):
    """A free place within the space."""
    while True:
        place = tuple(round(draw.uniform(0.5, SPACE_M - 0.5), 2) for _ in range(2))
        if is_free(place, boxes):
            return place


def draw_scene(draw):
    """Boxes, start and goal."""
    boxes = [draw_box(draw) for _ in range(draw.randint(3, 6))]
    while True:
        start, goal = draw_place(draw, boxes), draw_place(draw, boxes)
        if (start[0] - goal[0]) ** 2 + (start[1] - goal[1]) ** 2 >= MIN_WAY_M**2:
            return boxes, start, goal


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--count", type=int, default=20)
    parser.add_argument("--seed", type=int, default=1)
    given = parser.parse_args()
    here = pathlib.Path(__file__).resolve().parent
    problem = yaml.safe_load((here / "quad_bugtrap.yaml").read_text(encoding="utf-8"))
    problem["robot"] = str(here / "planar_rotor.yaml")
    draw = random.Random(given.seed)
    given.folder.mkdir(parents=True, exist_ok=True)
    for number in range(1, given.count + 1):
        boxes, start, goal = draw_scene(draw)
        problem["name"] = f"random_{number:02}"
        problem["environment"] = {
            "bounds": {"x_m": [0, SPACE_M], "z_m": [0, SPACE_M]},
            "obstacles": [
                {"name": f"box_{i}", "box": {"size_m": [box[2], 1, box[3]], "center_m": [box[0], 0, box[1]]}}
                for i, box in enumerate(boxes, 1)
            ],
        }
        problem["start"] = {"x_m": start[0], "z_m": start[1], "arm_deg": 0}
        problem["goal"]["configuration"].update({"x_m": goal[0], "z_m": goal[1]})
        path = given.folder / f"{problem['name']}.yaml"
        path.write_text(yaml.safe_dump(problem, sort_keys=False), encoding="utf-8")


if __name__ == "__main__":
    main()
