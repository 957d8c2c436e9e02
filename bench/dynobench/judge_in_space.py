#!/usr/bin/env python3
"""Judges flights of dynobench's quadrotors by dynobench's rules: on the states and thrusts of trajectory.csv alone.

Usage: bench/dynobench/judge_in_space.py v0|v1 PROBLEM.yaml RUN_FOLDER...
A flight is its rows up to the first one that meets the goal; its cost is the time until then. Prints one line for each
folder: the cost in seconds, or why the flight is refused. The exit code is 1 if any is refused.

Rules (dynobench, quad3d_v0 and quad3d_omplapp): every step is an explicit Euler step of 0.01 s to within 1e-2, start and goal
are met to within 3e-2, bounds of place, of each component of velocity and angular velocity and of the controls are overrun
by less than 1e-2, and the sphere enters no box by 1e-2 m. Distances are dynobench's: a sum of the differences in place,
attitude (half the angle), velocity and angular velocity with the weights 1, 0.5, 0.1, 0.05.
"""

import argparse
import csv
import math
import pathlib
import sys

import yaml
from judge import GRAVITY_M_S2, MAX_GOAL_ERROR, MAX_STEP_ERROR, ROUNDING, STEP_S, Refused, report

MAX_SPEED_M_S = 4.0
MAX_RATE_RAD_S = 8.0
RADIUS_M = 0.25
WEIGHTS = (1.0, 0.5, 0.1, 0.05)
MAX_OVERRUN = 1e-2
COLUMNS = ("x_m", "y_m", "z_m", "qw", "qx", "qy", "qz", "vx_m_s", "vy_m_s", "vz_m_s", "wx_rad_s", "wy_rad_s", "wz_rad_s")


class SmallQuadrotor:
    """quadrotor_v0, a Crazyflie 2.1: the controls are the thrusts of four rotors."""

    mass_kg = 0.034
    inertia_kg_m2 = (16.571710e-6, 16.655602e-6, 29.261652e-6)

    def controls(self, rotors_n):
        """Thrusts as dynobench's multiples of a quarter of the weight, and their limits."""
        quarter_n = self.mass_kg * GRAVITY_M_S2 / 4
        return [(thrust_n / quarter_n, 0.0, 1.3) for thrust_n in rotors_n]

    def wrench(self, rotors_n):
        f1, f2, f3, f4 = rotors_n
        arm_m = 0.046 / math.sqrt(2)
        return sum(rotors_n), (arm_m * (-f1 - f2 + f3 + f4), arm_m * (-f1 + f2 + f3 - f4), 0.006 * (-f1 + f2 - f3 + f4))


class LargeQuadrotor:
    """quadrotor_v1, OMPL.app's: the controls are the thrust and three torques. The rotors of our file give them."""

    mass_kg = 1.0
    inertia_kg_m2 = (1.0, 1.0, 1.0)

    def wrench(self, rotors_n):
        f1, f2, f3, f4, f5, f6 = rotors_n
        return f1 + f2, (100 * (f3 - f4), 100 * (f5 - f6), 5.4366 * (f2 - f1))

    def controls(self, rotors_n):
        """Thrust over the weight, torques over 20 N m, and their limits."""
        thrust_n, torques_nm = self.wrench(rotors_n)
        return [(thrust_n / (self.mass_kg * GRAVITY_M_S2), 0.0, 1.5)] + [(torque / 20, -2.0, 2.0) for torque in torques_nm]


MODELS = {"v0": SmallQuadrotor(), "v1": LargeQuadrotor()}


def read_problem(path):
    """Bounds, boxes, start and goal of a problem file."""
    given = yaml.safe_load(pathlib.Path(path).read_text(encoding="utf-8"))
    around = given["environment"]
    boxes = [(obstacle["box"]["center_m"], obstacle["box"]["size_m"]) for obstacle in around.get("obstacles", [])]
    still = (0.0,) * 6
    start, goal = given["start"], given["goal"]["configuration"]
    place_of = lambda where: tuple(float(where[name]) for name in ("x_m", "y_m", "z_m"))  # noqa: E731
    return {
        "bounds": [around["bounds"][name] for name in ("x_m", "y_m", "z_m")],
        "boxes": boxes,
        "start": place_of(start) + tuple(start.get("attitude", (1.0, 0.0, 0.0, 0.0))) + still,
        "goal": place_of(goal) + (1.0, 0.0, 0.0, 0.0) + still,
    }


def read_flight(folder):
    """States (place, quaternion with its scalar first, velocity, angular velocity) and rotor thrusts until the next one."""
    with open(pathlib.Path(folder) / "trajectory.csv", newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    for number, row in enumerate(rows):
        if abs(float(row["t_s"]) - number * STEP_S) > ROUNDING:
            raise Refused(f"row {number} is not a step of {STEP_S} s after the one before")
    states = [tuple(float(row[name]) for name in COLUMNS) for row in rows]
    rotors = [name for name in rows[0] if name.startswith("rotor_") and name.endswith("_cmd_n")] if rows else []
    thrusts = [tuple(float(row[name]) for name in rotors) for row in rows]
    return states, thrusts


def difference(a, b):
    """Dynobench's distance of two states."""
    same = min(1.0, abs(sum(x * y for x, y in zip(a[3:7], b[3:7]))))
    parts = (math.dist(a[:3], b[:3]), math.acos(same), math.dist(a[7:10], b[7:10]), math.dist(a[10:], b[10:]))
    return sum(weight * part for weight, part in zip(WEIGHTS, parts))


def product(p, q):
    """Of two quaternions with their scalars first."""
    a, b, c, d = p
    e, f, g, h = q
    return (
        a * e - b * f - c * g - d * h,
        a * f + b * e + c * h - d * g,
        a * g - b * h + c * e + d * f,
        a * h + b * g - c * f + d * e,
    )


def euler_step(model, state, rotors_n):
    """The state one step later, all rates at the beginning of the step; the attitude turns by the angle |w| h."""
    place, turned, velocity, rates = state[:3], state[3:7], state[7:10], state[10:]
    thrust_n, torques_nm = model.wrench(rotors_n)
    w, x, y, z = turned
    up = (2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y))
    gravity = (0, 0, GRAVITY_M_S2)
    speed = math.hypot(*rates)
    half = 0.5 * STEP_S * speed
    scale = math.sin(half) / speed if speed > 0 else 0.0
    j = model.inertia_kg_m2
    spin = tuple(j[i] * rates[i] for i in range(3))
    gyro = tuple(spin[(i + 1) % 3] * rates[(i + 2) % 3] - spin[(i + 2) % 3] * rates[(i + 1) % 3] for i in range(3))
    return (
        tuple(place[i] + STEP_S * velocity[i] for i in range(3))
        + product(turned, (math.cos(half),) + tuple(scale * rate for rate in rates))
        + tuple(velocity[i] + STEP_S * (thrust_n / model.mass_kg * up[i] - gravity[i]) for i in range(3))
        + tuple(rates[i] + STEP_S * (torques_nm[i] + gyro[i]) / j[i] for i in range(3))
    )


def depth_in_box(place, box):
    """How far the sphere around a place reaches into an upright box [m]; negative outside."""
    beyond = [abs(p - c) - s / 2 for p, c, s in zip(place, *box)]
    outside = math.hypot(*(max(0.0, each) for each in beyond))
    return RADIUS_M - (outside if outside > 0 else max(beyond))


def check_state(problem, number, state):
    """Refuses a state that breaks a limit or enters a box."""
    if not all(math.isfinite(value) for value in state):
        raise Refused(f"state {number} has a number that is not finite")
    for name, value, (low, high) in zip("xyz", state, problem["bounds"]):
        if not low - MAX_OVERRUN < value < high + MAX_OVERRUN:
            raise Refused(f"state {number} leaves the bounds: {name} is {value:.4f}")
    fastest = max(map(abs, state[7:10]))
    if not fastest < MAX_SPEED_M_S + MAX_OVERRUN:
        raise Refused(f"state {number} has a component of velocity of {fastest:.3f} m/s, more than {MAX_SPEED_M_S}")
    fastest = max(map(abs, state[10:]))
    if not fastest < MAX_RATE_RAD_S + MAX_OVERRUN:
        raise Refused(f"state {number} has a component of angular velocity of {fastest:.3f} rad/s, more than {MAX_RATE_RAD_S}")
    for box in problem["boxes"]:
        if depth_in_box(state[:3], box) >= MAX_OVERRUN:
            raise Refused(f"state {number} is in the box around {tuple(box[0])}")


def check_step(model, number, state, rotors_n, after):
    """Refuses a step with controls beyond their limits, or that Euler's does not come near."""
    for value, low, high in model.controls(rotors_n):
        if not low - MAX_OVERRUN < value < high + MAX_OVERRUN:
            raise Refused(f"step {number} has a control beyond {low} to {high}: {value:.4f}")
    error = difference(euler_step(model, state, rotors_n), after)
    if not error <= MAX_STEP_ERROR:
        raise Refused(f"step {number} differs from Euler's by {error:.4f}, more than {MAX_STEP_ERROR}")


def judge(model, problem, states, thrusts):
    """The cost of a flight [s]; raises Refused."""
    if not states or difference(states[0], problem["start"]) > MAX_GOAL_ERROR:
        raise Refused("the flight does not begin at the start")
    errors = [difference(state, problem["goal"]) for state in states]
    end = next((number for number, error in enumerate(errors) if error <= MAX_GOAL_ERROR), None)
    flown = states if end is None else states[: end + 1]
    for number, state in enumerate(flown):
        check_state(problem, number, state)
    for number, (state, after) in enumerate(zip(flown, flown[1:])):
        check_step(model, number, state, thrusts[number], after)
    if end is None:
        raise Refused(f"no state meets the goal to within {MAX_GOAL_ERROR}: the nearest one differs by {min(errors):.4f}")
    return end * STEP_S


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("model", choices=sorted(MODELS), help="which quadrotor")
    parser.add_argument("problem", help="a problem file")
    parser.add_argument("runs", nargs="+", help="folders that `downwash solve` wrote")
    given = parser.parse_args()
    problem = read_problem(given.problem)
    return report(given.runs, lambda run: judge(MODELS[given.model], problem, *read_flight(run)))


if __name__ == "__main__":
    sys.exit(main())
