#!/usr/bin/env python3
"""Judges flights of the planar rotor by dynobench's rules: on the states and thrusts of trajectory.csv alone.

Usage: bench/dynobench/judge.py PROBLEM.yaml RUN_FOLDER...
A flight is its rows up to the first one that meets the goal; its cost is the time until then. Prints one line for each
folder: the cost in seconds, or why the flight is refused. The exit code is 1 if any is refused.

Rules (dynobench, quad2d_v0): every step is an explicit Euler step of 0.01 s to within 1e-2, the goal is met to within 3e-2,
limits of speed, pitch rate, thrust and place hold, and the body touches no box. Both distances are dynobench's: a sum of the
differences in place, pitch, speed and pitch rate with the weights 1, 0.5, 0.2, 0.2.
"""

import argparse
import csv
import math
import pathlib
import sys

import yaml

STEP_S = 0.01
MASS_KG = 0.034
INERTIA_KG_M2 = 1e-4
LEVER_M = 0.1
GRAVITY_M_S2 = 9.81
MAX_THRUST_N = 1.3 * MASS_KG * GRAVITY_M_S2 / 2
MAX_SPEED_M_S = 4.0
MAX_PITCH_RATE_RAD_S = 8.0
BODY_M = (0.6, 0.2)
WEIGHTS = (1.0, 0.5, 0.2, 0.2)
MAX_STEP_ERROR = 1e-2
MAX_GOAL_ERROR = 3e-2
ROUNDING = 1e-6


class Refused(Exception):
    """Why a flight is none by dynobench's rules."""


def read_problem(path):
    """Bounds, boxes, start and goal of a problem file, in the plane."""
    given = yaml.safe_load(pathlib.Path(path).read_text(encoding="utf-8"))
    around = given["environment"]
    boxes = []
    for obstacle in around.get("obstacles", []):
        box = obstacle["box"]
        boxes.append((box["center_m"][0], box["center_m"][2], box["size_m"][0], box["size_m"][2]))
    goal = given["goal"]["configuration"]
    return {
        "x_m": around["bounds"]["x_m"],
        "z_m": around["bounds"]["z_m"],
        "boxes": boxes,
        "start": (given["start"]["x_m"], given["start"]["z_m"], 0.0, 0.0, 0.0, 0.0),
        "goal": (goal["x_m"], goal["z_m"], 0.0, 0.0, 0.0, 0.0),
    }


def read_flight(folder):
    """States (x, z, pitch, their rates) and the thrusts (front, rear) until the next one."""
    columns = ("x_m", "z_m", "pitch_rad", "vx_m_s", "vz_m_s", "pitch_rate_rad_s")
    with open(pathlib.Path(folder) / "trajectory.csv", newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    for number, row in enumerate(rows):
        if abs(float(row["t_s"]) - number * STEP_S) > ROUNDING:
            raise Refused(f"row {number} is not a step of {STEP_S} s after the one before")
    states = [tuple(float(row[name]) for name in columns) for row in rows]
    thrusts = [(float(row["rotor_1_cmd_n"]), float(row["rotor_2_cmd_n"])) for row in rows]
    return states, thrusts


def difference(a, b):
    """Dynobench's distance of two states."""
    turn = (a[2] - b[2] + math.pi) % (2 * math.pi) - math.pi
    parts = (math.hypot(a[0] - b[0], a[1] - b[1]), abs(turn), math.hypot(a[3] - b[3], a[4] - b[4]), abs(a[5] - b[5]))
    return sum(weight * part for weight, part in zip(WEIGHTS, parts))


def euler_step(state, thrust):
    """The state one step later; pitch is positive nose down, so that the front rotor turns it backwards."""
    x, z, pitch, vx, vz, rate = state
    front, rear = thrust
    lift = (front + rear) / MASS_KG
    turn = LEVER_M * (rear - front) / INERTIA_KG_M2
    ax, az = lift * math.sin(pitch), lift * math.cos(pitch) - GRAVITY_M_S2
    return (
        x + STEP_S * vx,
        z + STEP_S * vz,
        pitch + STEP_S * rate,
        vx + STEP_S * ax,
        vz + STEP_S * az,
        rate + STEP_S * turn,
    )


def touches(state, box):
    """Whether the turned body and an upright box overlap: separating axes of two rectangles."""
    cosine, sine = math.cos(state[2]), math.sin(state[2])
    dx, dz = box[0] - state[0], box[1] - state[1]
    half_x, half_z = BODY_M[0] / 2, BODY_M[1] / 2
    box_x, box_z = box[2] / 2, box[3] / 2
    # Nose down: the body's x axis is (cos, -sin), its z axis (sin, cos).
    for axis_x, axis_z in ((1, 0), (0, 1), (cosine, -sine), (sine, cosine)):
        reach = (
            half_x * abs(axis_x * cosine - axis_z * sine)
            + half_z * abs(axis_x * sine + axis_z * cosine)
            + box_x * abs(axis_x)
            + box_z * abs(axis_z)
        )
        if abs(axis_x * dx + axis_z * dz) > reach:
            return False
    return True


def check_state(problem, number, state):
    """Refuses a state that breaks a limit or touches a box."""
    if not all(math.isfinite(value) for value in state):
        raise Refused(f"state {number} has a number that is not finite")
    for name, value in (("x_m", state[0]), ("z_m", state[1])):
        low, high = problem[name]
        if not low - ROUNDING <= value <= high + ROUNDING:
            raise Refused(f"state {number} leaves the bounds: {name} is {value:.4f}")
    if math.hypot(state[3], state[4]) > MAX_SPEED_M_S + ROUNDING:
        raise Refused(f"state {number} is faster than {MAX_SPEED_M_S} m/s")
    if abs(state[5]) > MAX_PITCH_RATE_RAD_S + ROUNDING:
        raise Refused(f"state {number} turns faster than {MAX_PITCH_RATE_RAD_S} rad/s: {state[5]:.3f}")
    for box in problem["boxes"]:
        if touches(state, box):
            raise Refused(f"state {number} touches the box around ({box[0]}, {box[1]})")


def check_step(number, state, thrust, after):
    """Refuses a step with thrusts beyond the limits, or that Euler's does not come near."""
    if any(not -ROUNDING <= each <= MAX_THRUST_N + ROUNDING for each in thrust):
        raise Refused(f"step {number} has a thrust beyond 0 to {MAX_THRUST_N:.6f} N: {thrust}")
    error = difference(euler_step(state, thrust), after)
    if not error <= MAX_STEP_ERROR:
        raise Refused(f"step {number} differs from Euler's by {error:.4f}, more than {MAX_STEP_ERROR}")


def judge(problem, states, thrusts):
    """The cost of a flight [s]; raises Refused."""
    if not states or difference(states[0], problem["start"]) > ROUNDING:
        raise Refused("the flight does not begin at the start")
    errors = [difference(state, problem["goal"]) for state in states]
    end = next((number for number, error in enumerate(errors) if error <= MAX_GOAL_ERROR), None)
    flown = states if end is None else states[: end + 1]
    for number, state in enumerate(flown):
        check_state(problem, number, state)
    for number, (state, after) in enumerate(zip(flown, flown[1:])):
        check_step(number, state, thrusts[number], after)
    if end is None:
        raise Refused(f"no state meets the goal to within {MAX_GOAL_ERROR}: the nearest one differs by {min(errors):.4f}")
    return end * STEP_S


def report(runs, cost_s):
    """Prints a line for each folder. The exit code: 1 if any is refused.
    cost_s: of a folder's flight [s]; raises Refused."""
    refused = False
    for run in runs:
        try:
            print(f"{run}: accepted, {cost_s(run):.2f} s")
        except Refused as why:
            refused = True
            print(f"{run}: refused: {why}")
    return 1 if refused else 0


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("problem", help="a problem file")
    parser.add_argument("runs", nargs="+", help="folders that `downwash solve` wrote")
    given = parser.parse_args()
    problem = read_problem(given.problem)
    return report(given.runs, lambda run: judge(problem, *read_flight(run)))


if __name__ == "__main__":
    sys.exit(main())
