#!/usr/bin/env python3
"""Writes dynobench's problems of its two quadrotors as problem files in space. bench/dynobench_space.sh calls it.

Usage: bench/dynobench/space_problems.py FOLDER
Places, sizes and bounds are those of https://github.com/quimortiz/dynobench (MIT), envs/quadrotor_v0 and quadrotor_v1 at
commit 4ddf752; recovery_with_obs2, recovery_with_obs4, bugtrap3 and window_double2 stand in its branch iros-dev, commit
8b64520. Robots, limits of motion and planner are the same in every file.
"""

import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
LEVEL = None
UPSIDE_DOWN = (0.0436194, -0.9990482, 0.0, 0.0)  # w, x, y, z: turned by 175 degrees about x

RECOVERY_OBS = ((0.25, 0.25, 1.5), (1.5, 1.5, 0.3))
LEFT_RIGHT_WINDOW = (((1.5, 3, 1.9), (1, 0.3, 1)), ((2, 3, 2.7), (2, 0.3, 0.6)), ((2, 3, 1.2), (2, 0.3, 0.4)))

# Models; bounds of x, y, z; boxes (centre, full size); start, its attitude, goal.
PROBLEMS = {
    "empty_0_easy": ("v0 v1", ((-1, 1), (-1, 1), (0.8, 3)), (), (0, 0, 1), LEVEL, (0, 0, 2)),
    "empty_1_easy": ("v0 v1", ((-1, 1), (-1, 1), (0.8, 2.5)), (), (0, 0, 1), LEVEL, (0.5, 0.5, 2)),
    "quad_one_obs": ("v0 v1", ((0, 6), (0, 6), (0, 6)), (((3, 3, 3), (3, 3, 2)),), (1, 1, 3), LEVEL, (5, 5, 3)),
    "window": (
        "v0 v1",
        ((1, 5), (0.5, 5.5), (1, 3)),
        (
            ((4, 3, 2), (2, 0.3, 2)),
            ((1.1, 3, 1.9), (0.2, 0.3, 1)),
            ((2, 3, 2.7), (2, 0.3, 0.6)),
            ((2, 3, 1.2), (2, 0.3, 0.4)),
        ),
        (4, 1, 2),
        LEVEL,
        (4, 5, 2),
    ),
    "recovery": ("v0", ((-1, 1), (-1, 2), (-2, 2)), (), (0, 0, 1), UPSIDE_DOWN, (0, 0.8, 1)),
    "recovery ": ("v1", ((-2, 2), (-2, 2), (-2, 2)), (), (0, 0, 1), UPSIDE_DOWN, (0, 0.15, 1)),
    "recovery_with_obs": ("v0", ((-2, 2), (-2, 2), (-2, 3)), (RECOVERY_OBS,), (0, 0, 0.8), UPSIDE_DOWN, (0, 0, 2.5)),
    "recovery_with_obs ": ("v1", ((-2, 2), (-2, 2), (-3, 3)), (RECOVERY_OBS,), (0, 0, 0.8), UPSIDE_DOWN, (0, 0, 2.5)),
    "recovery_with_obs2": (
        "v0",
        ((-2, 2), (-2, 2), (-2, 6)),
        (RECOVERY_OBS, ((0.5, 0.5, 3), (2, 2, 0.3)), ((-0.5, -0.5, 4), (2, 2, 0.3))),
        (0, 0, 0.8),
        UPSIDE_DOWN,
        (0, 0, 5),
    ),
    "recovery_with_obs4": (
        "v0 v1",
        ((-4, 4), (-2, 2), (-2, 6)),
        (((0, -1.2, 3), (4, 1.5, 0.4)), ((0, 1.2, 3), (4, 1.5, 0.4)), ((0, 0, 4), (0.4, 4, 6))),
        (1, 0, 5),
        UPSIDE_DOWN,
        (-1, 0, 5),
    ),
    "bugtrap3": (
        "v0 v1",
        ((0, 8), (0, 6), (-2, 4)),
        (
            ((4.5, 3, 1), (0.2, 3, 3)),
            ((3, 2, 1), (3, 0.2, 3)),
            ((3, 4, 1), (3, 0.2, 3)),
            ((3, 3, 0), (3, 3, 0.2)),
            ((3, 3, 3), (3, 3, 0.2)),
            ((5.5, 2, 1), (2, 0.2, 3)),
            ((5.5, 4, 1), (2, 0.2, 3)),
            ((5, 3, 0), (3, 3, 0.2)),
            ((5, 3, 3), (3, 3, 0.2)),
        ),
        (3.8, 3, 1),
        LEVEL,
        (5.2, 3, 1),
    ),
    "window_double2": (
        "v1",
        ((1, 7), (0, 6), (1, 3)),
        (
            ((4, 3, 2), (2, 0.3, 2)),
            *LEFT_RIGHT_WINDOW,
            ((7, 3, 2), (2, 0.3, 2)),
            ((5, 3, 2.7), (2, 0.3, 0.8)),
            ((5, 3, 1.2), (2, 0.3, 0.8)),
            ((4, 1.5, 2), (0.2, 3, 2)),
        ),
        (5, 2, 2),
        LEVEL,
        (2, 2, 2),
    ),
}

# Dynobench's limits are 4 m/s and 8 rad/s (458 deg/s) in each component. The reference leaves the controller a part of each.
COMMON = """\
motion:
  max_speed_m_s: 3.6
  max_acceleration_m_s2: 14
  max_jerk_m_s3: 500
  max_thrust_ratio: 1.3
  max_tilt_rate_deg_s: 300
  yaw: hold
planner:
  variant: mp-arm-da        # no surface changes thrust
  objective: time
  safety_margin_m: 0.002
  max_saturation: 1000     # demands are clipped
  max_pitch_rate_deg_s: 458  # 8 rad/s
"""


def of_model(name, model):
    """Whether the problem `name` is one of the model, which is all that a blank behind a name says."""
    return model in PROBLEMS[name][0].split()


def numbers(values):
    return "[" + ", ".join(f"{value:g}" for value in values) + "]"


def text_of(name, model):
    _, bounds, boxes, start, attitude, goal = PROBLEMS[name]
    lines = [
        f"# The problem `{name.strip()}` of dynobench (https://github.com/quimortiz/dynobench, quadrotor_{model}): places and sizes are its own.",
        "schema: downwash/problem/v1",
        f"name: {model}_{name.strip()}",
        f"robot: {HERE}/quadrotor_{model}.yaml",
        "environment:",
        "  bounds: {" + ", ".join(f"{axis}_m: {numbers(each)}" for axis, each in zip("xyz", bounds)) + "}",
        "  obstacles:" if boxes else "  obstacles: []",
    ]
    for number, (center, size) in enumerate(boxes, 1):
        lines.append(f"    - {{name: box_{number}, box: {{size_m: {numbers(size)}, center_m: {numbers(center)}}}}}")
    lines.append("aero: {ground: {model: none}, ceiling: {model: none}}")
    place = ", ".join(f"{axis}_m: {value:g}" for axis, value in zip("xyz", start))
    turned = f", attitude: [{', '.join(str(value) for value in attitude)}]" if attitude else ""
    lines.append(f"start: {{{place}{turned}}}")
    place = ", ".join(f"{axis}_m: {value:g}" for axis, value in zip("xyz", goal))
    lines.append("goal:")
    lines.append(f"  configuration: {{{place}, yaw_deg: 0, tolerance_m: 0.012, tolerance_deg: 2}}")
    lines.append("  hold_s: 4")
    return "\n".join(lines) + "\n" + COMMON


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    folder = pathlib.Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    for name in PROBLEMS:
        for model in ("v0", "v1"):
            if of_model(name, model):
                path = folder / f"{model}_{name.strip()}.yaml"
                path.write_text(text_of(name, model), encoding="utf-8")


if __name__ == "__main__":
    main()
