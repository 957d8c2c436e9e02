#!/usr/bin/env python3
"""Pages to look at and to test with.

sample_page.py TEMPLATE.html OUT.html [--case NAME]     an invented run; the names are in CASES
sample_page.py TEMPLATE.html OUT.html --run FOLDER      a run that the program wrote (boxes along the axes only)
"""

import argparse
import copy
import csv
import json
import math
import os
import sys

import numpy as np

sys.dont_write_bytecode = True

from packing import flight_json, packed, tree_json, write_page
from shapes import ball, box, pipe, rectangle, wedge

ARM_M, RADIUS_M = 1.2, 0.1905
# Any classes: the page has none of its own.
SCALE = {"limits": [0.9, 0.95, 0.98, 0.99, 1.01, 1.02, 1.05, 1.1, 1.2, 1.3, 1.5, 2],
         "colors": ["#fe9929", "#fec44f", "#fee391", "#ffffff", "#c6dbef", "#9ecae1", "#6baed6", "#4292c6", "#2171b5",
                    "#08519c", "#08306b"]}
ROTORS = [[0.32, 0.32, 0.06], [0.32, -0.32, 0.06], [-0.32, 0.32, 0.06], [-0.32, -0.32, 0.06]]
COLUMNS = ("t_s,ref_x_m,ref_z_m,ref_arm_rad,x_m,z_m,pitch_rad,arm_rad,vx_m_s,vz_m_s,pitch_rate_rad_s,arm_rate_rad_s,"
           "thrust_cmd_n,pitch_torque_cmd_nm,arm_torque_nm,thrust_n,pitch_torque_nm,aero_factor_min,aero_factor_max,"
           "clearance_m,ee_x_m,ee_z_m,power_w,energy_j").split(",")


OCTO_ROTORS = [[round(0.55 * math.cos((i + 0.5) * math.pi / 4), 4), round(0.55 * math.sin((i + 0.5) * math.pi / 4), 4),
                0.06] for i in range(8)]


def robot_json():
    return {"name": "ars_lrm",
            "bodies": [{"outline": rectangle(-0.52, 0.52, -0.11, 0.11),
                        "solid": box("", [1.04, 1.04, 0.22], [0, 0, 0])["solid"]}],
            "rotors": {"radius_m": RADIUS_M, "positions_m": ROTORS, "min_thrust_n": 0, "max_thrust_n": 28},
            "arm": {"joint_m": [0, 0], "length_m": ARM_M, "radius_m": 0.03}}


def bridge():
    return [box("ground", [40, 20, 1], [0, 0, -0.5]), box("deck", [30, 8, 1], [0, 0, 10.5]),
            box("pier", [1.6, 6, 10], [3.8, 0, 5]), box("left_girder", [24, 0.4, 0.8], [-9, 2.2, 9.6]),
            box("right_girder", [24, 0.4, 0.8], [-9, -2.2, 9.6]), box("cross_girder", [0.4, 4, 0.3], [-7.2, 0, 9.85]),
            box("walkway", [7, 1.2, 1], [-3, 0, 7.8])]


def distance_to(obstacles, x, z):
    """From points to the nearest section."""
    least = np.full(np.broadcast(x, z).shape, np.inf)
    for obstacle in obstacles:
        for ring in obstacle["section"]:
            xs, zs = [p[0] for p in ring], [p[1] for p in ring]
            dx = np.maximum(np.maximum(min(xs) - x, x - max(xs)), 0)
            dz = np.maximum(np.maximum(min(zs) - z, z - max(zs)), 0)
            least = np.minimum(least, np.hypot(dx, dz))
    return least


def factor_at(obstacles, x, z):
    """Thrust below a deck as a ceiling would raise it: an invented curve of the right shape."""
    factor = np.ones(np.broadcast(x, z).shape)
    for obstacle in obstacles:
        for ring in obstacle["section"]:
            xs, zs = [p[0] for p in ring], [p[1] for p in ring]
            inside = 1 / (1 + np.exp(-(x - min(xs)) / 0.15)) / (1 + np.exp((x - max(xs)) / 0.15))
            below, above = min(zs) - z, z - max(zs)
            factor += inside * np.where(below > 0, 0.16 * (RADIUS_M / np.maximum(below, 0.06))**2, 0)
            factor += inside * np.where(above > 0, 0.06 * (RADIUS_M / np.maximum(above, 0.06))**2, 0)
            factor -= 0.05 * np.exp(-(np.minimum(abs(x - min(xs)), abs(x - max(xs))) / 0.4)**2) * (abs(below) < 0.5)
    return np.clip(factor, 0.9, 2)


def map_json(obstacles, bounds, cell=0.05):
    (x_low, x_high), (z_low, z_high) = bounds["x_m"], bounds["z_m"]
    columns, rows = round((x_high - x_low) / cell) + 1, round((z_high - z_low) / cell) + 1
    x, z = np.meshgrid(x_low + cell * np.arange(columns), z_low + cell * np.arange(rows))
    levels = np.round((factor_at(obstacles, x, z) - 0.9) / 1.1 * 254).astype(np.uint8)
    levels[distance_to(obstacles, x, z) < 0.3 * RADIUS_M] = 255
    return {"rotor": 1, "lateral_m": 0.32, "x_low_m": x_low, "z_low_m": z_low, "cell_m": cell, "columns": columns,
            "rows": rows, "factor_low": 0.9, "factor_high": 2.0, "scale": SCALE, "levels": packed(levels.tobytes())}


def rest_to_rest(stops, times, t):
    """Quintic between stops (x, z, arm), held after the last."""
    out = np.empty((len(t), 3))
    for i, now in enumerate(t):
        leg = min(max(int(np.searchsorted(times, now, side="right")) - 1, 0), len(stops) - 2)
        s = min(1, max(0, (now - times[leg]) / (times[leg + 1] - times[leg])))
        out[i] = np.asarray(stops[leg]) + (10 * s**3 - 15 * s**4 + 6 * s**5) * (np.subtract(stops[leg + 1], stops[leg]))
    return out


def invented_flight(stops, times, duration_s, obstacles, rotors=ROTORS):
    """Columns of a flight that follows its reference late and with a swing: kinematics, no simulation."""
    t = np.arange(round(duration_s * 100) + 1) * 0.01
    reference = rest_to_rest(stops, times, t)
    state = rest_to_rest(stops, times, t - 0.15)
    state[:, 1] += 0.02 * np.sin(2.1 * t) * (1 - np.exp(-t))
    x, z, arm = state.T
    vx, vz, arm_rate = np.gradient(state, 0.01, axis=0).T
    ax, az = np.gradient(vx, 0.01), np.gradient(vz, 0.01)
    pitch = np.arctan2(ax, 9.81 + az) + 0.01 * np.sin(5 * t)
    s = pitch + arm
    ee_x, ee_z = x + ARM_M * np.cos(s), z - ARM_M * np.sin(s)
    factors = [factor_at(obstacles, x + hub[0], z + hub[2]) for hub in rotors]
    thrust = 4.95 * np.hypot(ax, 9.81 + az) / len(rotors)
    commands = [thrust / factor * (1 + 0.05 * np.sign(hub[0]) * np.sin(3 * t)) for hub, factor in zip(rotors, factors)]
    power = 3.154 * sum(command**1.5 for command in commands)
    clearance = np.maximum(0, distance_to(obstacles, x, z) - 0.2) if obstacles else np.full(len(t), np.nan)
    zero = np.zeros(len(t))
    values = [t, *reference.T, x, z, pitch, arm, vx, vz, np.gradient(pitch, 0.01), arm_rate, sum(commands), zero,
              zero, sum(np.multiply(commands, factors)), zero, np.min(factors, axis=0), np.max(factors, axis=0), clearance, ee_x,
              ee_z, power, np.concatenate([[0], np.cumsum(power[:-1]) * 0.01])]
    names = list(COLUMNS)
    for rotor, own in enumerate(zip(commands, factors)):
        names += [f"rotor_{rotor + 1}_cmd_n", f"rotor_{rotor + 1}_aero_factor"]
        values += own
    return names, [np.asarray(v, dtype=float) for v in values]


def tree_between(count, bounds, obstacles):
    random = np.random.RandomState(7)
    nodes, parents = [[-10.0, 8.5, 1.57]], [-1]
    while len(nodes) < count:
        x, z = random.uniform(*bounds["x_m"]), random.uniform(*bounds["z_m"])
        recent = np.asarray(nodes[-400:])[:, :2]
        near = int(np.argmin(np.hypot(recent[:, 0] - x, recent[:, 1] - z))) + max(0, len(nodes) - 400)
        step = np.clip([x - nodes[near][0], z - nodes[near][1]], -0.8, 0.8)
        point = [nodes[near][0] + step[0], nodes[near][1] + step[1]]
        if distance_to(obstacles, *point) > 0.3:
            nodes.append(point + [random.uniform(-1.5, 1.5)])
            parents.append(near)
    return tree_json(nodes, parents)


def planning_json(improvements, rejected=None):
    causes = dict.fromkeys(["bounds", "collision", "direct_flight", "flyable_area", "goal_missed", "saturation",
                            "too_long", "tracking", "unstable"], 0)
    return {"wall_s": 5.1, "map_wall_s": 0.2, "flight_wall_s": 0.09,
            "first_solution_wall_s": improvements[0][0] * 0.6 if improvements else None, "iterations": 1788,
            "edges_simulated": 11311, "simulated_s": 72534.19, "states_checked": 8578042,
            "improvements": [{"wall_s": s, "iteration": n, "cost": c} for s, n, c in improvements],
            "rejected": {**causes, **(rejected or {"bounds": 1, "collision": 6161, "goal_missed": 79, "tracking": 68})},
            "nearest_approach_m": None, "obstruction": None}


def solved_report(duration_s=19.58, end=(1.62, 9.51, -0.295)):
    bounds = {"x_m": [-12, 12], "z_m": [0.5, 12]}
    obstacles = bridge()
    stops = [(-10, 8.5, math.pi / 2), (-8.03, 9.19, 0.886), (-1.73, 9.49, 0.763), end]
    times = [duration_s * share for share in (0, 0.18, 0.5, 0.745)]
    names, columns = invented_flight(stops, times, duration_s, obstacles)
    column = dict(zip(names, columns))
    error = np.hypot(column["x_m"] - column["ref_x_m"], column["z_m"] - column["ref_z_m"])
    knots = [{"t_s": t, "x_m": x, "z_m": z, "arm_rad": arm} for t, (x, z, arm) in zip(times, stops)]
    energy = float(column["energy_j"][-1])
    solution = {
        "schema": "downwash/solution/v1", "status": "solved", "interrupted": False,
        "problem": {"name": "bridge_inspection", "file": "problems/bridge_inspection.yaml", "sha256": "21" * 32},
        "variant": "mp-arm-ada", "algorithm": "rrt-star", "objective": "energy", "seed": 1, "version": "0.1.0",
        "threads": 2, "cost": energy - 27.9,
        "planning": planning_json([(0.07, 36, energy * 1.8), (0.24, 84, energy * 1.45), (0.47, 196, energy * 1.29),
                                   (0.89, 348, energy * 1.07), (4.48, 1636, energy * 1.003),
                                   (5.1, 1788, energy - 27.9)]),
        "plan": {"waypoints": [{k: knot[k] for k in ("x_m", "z_m", "arm_rad")} for knot in knots], "reference": knots},
        "execution": {"aero": True, "outcome": "ok", "min_clearance_m": float(np.min(column["clearance_m"])),
                      "energy_j": energy, "duration_s": float(column["t_s"][-1]), "cost": energy,
                      "max_tracking_error_m": float(np.max(error)), "max_saturation": 0.547, "goal_error_m": 0.0887,
                      "goals": [{"met": True, "error_m": 0.0887}]}}
    return {
        "schema": "downwash/report/v1", "version": "0.1.0",
        "command": "downwash solve problems/bridge_inspection.yaml --variant mp-arm-ada --seed 1 --max-iterations 1788",
        "solution": solution, "cost_unit": "J", "effective_yaml": "schema: downwash/problem/v1\nname: bridge_inspection\n",
        "description": "Inspect the joint between a bridge deck and a pier, past a maintenance walkway under the deck.",
        "scene": {"bounds": bounds, "obstacles": obstacles}, "robot": robot_json(),
        "start": {"x_m": -10, "z_m": 8.5, "arm_rad": math.pi / 2},
        "goals": [{"kind": "end_effector", "x_m": 2.85, "z_m": 9.85, "tolerance_x_m": 0.1, "tolerance_z_m": 0.1,
                   "direction_rad": None}],
        "goal_order": "single", "limits": {"safety_margin_m": 0.05, "max_tilt_rad": math.radians(35)},
        "map": map_json(obstacles, bounds), "flight": flight_json(names, columns),
        "tree": tree_between(600, bounds, obstacles), "_columns": column}


def failed_report(outcome="collision"):
    """A flight that ends against the deck."""
    report = solved_report(12.0, (1.56, 9.93, -0.02))
    report["solution"]["execution"].update(outcome=outcome, goal_error_m=1.11, min_clearance_m=0.0,
                                           goals=[{"met": False, "error_m": 1.11}])
    report["solution"]["variant"] = "mp-arm"
    return report


def unsolved_report():
    report = solved_report()
    report["solution"].update(status="none", plan=None, execution=None, cost=None)
    report["solution"]["planning"] = {
        **planning_json([], {"collision": 8123, "unstable": 17}), "nearest_approach_m": 0.431,
        "obstruction": {"cause": "collision", "x_m": 1.2, "z_m": 9.4, "arm_rad": -0.4, "goal_distance_m": 0.62}, "goal": 2}
    report.update(flight=None, _columns=None, goal_order="in_turn")
    report["goals"].insert(0, {"kind": "state", "x_m": -6, "z_m": 9.1, "arm_rad": 0.8,
                               "tolerance_x_m": 0.1, "tolerance_z_m": 0.1, "is_disc": False})
    return report


HOSTILE = '</script><img src=x onerror="window.hacked=1">&amp; "quotes" \'$&\' \u202eright to left\u202c \U0001f681 '


def hostile_report():
    report = solved_report()
    report["solution"]["problem"].update(name=HOSTILE + "\u05e9\u05dc\u05d5\u05dd", file=HOSTILE)
    report["description"] = HOSTILE + "long " * 2000
    report["command"] = HOSTILE + "x" * 10000
    report["effective_yaml"] = "name: " + HOSTILE + "\n" + "y" * 10000
    for obstacle in report["scene"]["obstacles"]:
        obstacle["name"] = HOSTILE + obstacle["name"]
    report["scene"]["obstacles"][1]["name"] = "w" * 10000
    return report


def large_report():
    report = solved_report(59.99)
    report["tree"] = tree_between(10000, report["scene"]["bounds"], report["scene"]["obstacles"])
    return report


def open_air_report():
    """No obstacles, no map, no tree; a state as goal with its arm free; no tilt limit; a sum as objective."""
    report = solved_report()
    names, columns = invented_flight([(-4, 3, 1.57), (5, 6, 0)], [0, 8], 13, [])
    report["solution"]["objective"] = {"energy": 1, "time": 50}
    report["cost_unit"] = ""
    report["scene"] = {"bounds": {"x_m": [-8, 8], "z_m": [0, 9]}, "obstacles": []}
    report.update(map=None, tree=None, description="", flight=flight_json(names, columns),
                  _columns=dict(zip(names, columns)),
                  start={"x_m": -4, "z_m": 3, "arm_rad": 1.57},
                  goals=[{"kind": "state", "x_m": 5, "z_m": 6, "arm_rad": None}],
                  limits={"safety_margin_m": 0, "max_tilt_rad": None})
    report["solution"]["execution"]["min_clearance_m"] = None
    return report


def solids_report():
    """Every kind of solid, an open surface too large for the page, three goals in turn, rotors that do not coincide."""
    report = solved_report()
    report["scene"]["obstacles"] += [pipe("pipe", 0.5, 6, [-6, 0, 6]), ball("tank", 1, [6, 0.4, 4]),
                                     {"name": "sheet", "kind": "mesh", "section": [], "solid": None,
                                      "section_lines": [[[-9, 5], [-7, 4.5], [-5, 5]]],
                                      "projection": [[[-9, 5], [-7, 4.5], [-5, 5]]]},
                                     wedge("slope", [[7, 0], [11, 0], [11, 3]], 2, packed)]
    report["goals"] = [{"kind": "state", "x_m": -6, "z_m": 9.1, "arm_rad": 0.8,
                        "tolerance_x_m": 0.1, "tolerance_z_m": 0.1, "is_disc": False},
                       {"kind": "end_effector", "x_m": -1, "z_m": 8.9, "tolerance_x_m": 0.2, "tolerance_z_m": 0.1,
                        "direction_rad": -1.57}, report["goals"][0]]
    report["goal_order"] = "in_turn"
    report["solution"]["execution"]["goals"] = [{"met": True, "error_m": 0.05}, {"met": True, "error_m": 0.09},
                                                {"met": True, "error_m": 0.0887}]
    report["robot"]["rotors"]["positions_m"] = [[0.35, 0.3, 0.06], [0.25, -0.3, 0.06],
                                                [-0.25, 0.3, 0.06], [-0.35, -0.3, 0.06]]
    return report


# Where the flight through five goals stays, and from when to when.
HOVERS_S = [(4, 6), (9, 12), (16, 18), (23, 25), (30, 35)]


def five_goals_report():
    """Eight rotors that coincide in pairs, five goals in a sequence, a hover at each."""
    report = solved_report()
    places = [(-7, 9.2, 1.2), (-4, 9.2, 0.6), (-1, 9, 0), (1, 7, 0.4), (1.62, 9.51, -0.295)]
    stops = [(-10, 8.5, math.pi / 2)] + [place for place in places for _ in range(2)]
    times = [0] + [time for hover in HOVERS_S for time in hover]
    names, columns = invented_flight(stops, times, times[-1], report["scene"]["obstacles"], OCTO_ROTORS)
    report["flight"], report["_columns"] = flight_json(names, columns), dict(zip(names, columns))
    # The last hover is what follows the reference.
    report["solution"]["plan"]["reference"] = [{"t_s": t, "x_m": x, "z_m": z, "arm_rad": arm}
                                               for t, (x, z, arm) in zip(times[:-1], stops)]
    report["goals"] = [{"kind": "end_effector", "x_m": x + ARM_M * math.cos(arm), "z_m": z - ARM_M * math.sin(arm),
                        "tolerance_x_m": 0.1, "tolerance_z_m": 0.1, "direction_rad": None, "hold_s": high - low}
                       for (x, z, arm), (low, high) in zip(places, HOVERS_S)]
    report["goal_order"] = "in_turn"
    report["solution"]["execution"].update(duration_s=times[-1], goals=[{"met": True, "error_m": 0.05}] * 5)
    report["robot"]["rotors"]["positions_m"] = OCTO_ROTORS
    return report


def doubtful_report():
    """What reading the problem warned of."""
    report = solved_report()
    report["solution"]["warnings"] = [
        {"file": "problems/robots/mine.yaml", "line": 48, "column": 1,
         "message": "controller makes a hover in free air nearly unstable with the arm at -90 deg: the loop of thrust has "
                    "margins of 1.2 dB and 7 deg; less rotors.time_constant_s or controller.delay_s, or other gains"},
        {"file": "problems/bridge_inspection.yaml", "line": 31, "column": 3, "message": HOSTILE}]
    return report


def crowded_report():
    """Fifty obstacles, one in three beside the plane of motion."""
    report = solved_report()
    shapes = [lambda name, x, y, z: box(name, [0.6, 1.5, 0.3], [x, y, z]), lambda name, x, y, z: pipe(name, 0.2, 3, [x, y, z]),
              lambda name, x, y, z: ball(name, 0.25, [x, y, z])]
    report["scene"]["obstacles"] = [shapes[i % 3](f"obstacle_{i + 1}", -9 + 2 * (i % 10), 2.5 * (i % 3 == 0), 1.5 + 1.3 * (i // 10))
                                    for i in range(50)]
    report["map"] = map_json(report["scene"]["obstacles"], report["scene"]["bounds"])
    return report


def add_very_many_obstacles(report):
    """2500 small ones that overlap, every other one beside the plane of motion."""
    report["scene"]["obstacles"] += [box(f"brick_{i + 1}", [0.12, 0.3, 0.12], [-11 + 0.1 * (i % 50), i % 2, 1 + 0.1 * (i // 50)])
                                     for i in range(2500)]


def certificate_json(given, worlds, failures, interval, causes):
    worst = [{"world": 17 + 40 * i, "outcome": cause, "min_clearance_m": 0.0 if cause == "collision" else 0.041}
             for i, cause in enumerate(c for c, count in causes.items() for _ in range(count))]
    worst += [{"world": 300 + i, "outcome": "ok", "min_clearance_m": 0.012 + 0.001 * i} for i in range(10 - len(worst))]
    return {"given": given, "worlds": worlds, "failures": failures,
            "failure_probability": dict(zip(("estimate", "low", "high"), interval)), "max_failure_probability": 0.01,
            "confidence": 0.95, "attempts": 2, "clearance_m": {"p01": 0.021, "p10": 0.064, "p50": 0.091},
            "causes": causes, "worst": worst}


def certified_report():
    """A certificate that is given, and the flight in a world."""
    report = solved_report()
    report["solution"]["certificate"] = certificate_json(True, 1016, 1, (1 / 1016, 0.000025, 0.00547), {"collision": 1})
    report["solution"]["planning"]["first_certified_wall_s"] = 1.731
    report["solution"]["execution"].update(world={"index": 17, "seed": 1}, lateral_m=-0.031)
    return report


def uncertified_report():
    """A plan that reaches the goal but fails too often."""
    report = solved_report()
    report["solution"]["status"] = "approximate"
    report["solution"]["certificate"] = certificate_json(False, 37, 4, (4 / 37, 0.03, 0.254),
                                                         {"collision": 3, "goal_missed": 1})
    report["solution"]["planning"]["first_certified_wall_s"] = None
    report["solution"]["planning"]["obstruction"] = {"cause": "certificate", "x_m": 1.2, "z_m": 9.4, "arm_rad": -0.4,
                                                     "goal_distance_m": 0}
    return report


def unplanned_report():
    """A problem before it is planned."""
    report = solved_report()
    solution = report["solution"]
    del solution["planning"]
    solution.update(status="unplanned", plan=None, execution=None, cost=None, certificate=None)
    report.update(flight=None, tree=None, command=None, _columns=None)
    return report


CASES = {"solved": solved_report, "unplanned": unplanned_report, "collision": failed_report,
         "unsolved": unsolved_report, "hostile": hostile_report,
         "large": large_report, "open-air": open_air_report, "solids": solids_report, "five-goals": five_goals_report,
         "crowded": crowded_report, "doubtful": doubtful_report,
         "certified": certified_report, "uncertified": uncertified_report}


def run_report(folder):
    """A run that the program wrote, without tree; the map is invented."""
    import yaml

    report = copy.deepcopy(solved_report())
    with open(os.path.join(folder, "solution.json"), encoding="utf-8") as file:
        report["solution"] = json.load(file)
    with open(os.path.join(folder, "effective.yaml"), encoding="utf-8") as file:
        report["effective_yaml"] = file.read()
    problem = yaml.safe_load(report["effective_yaml"])
    with open(os.path.join(folder, "trajectory.csv"), encoding="utf-8") as file:
        names, *rows = list(csv.reader(file))
    values = np.array([[float(v) if v else math.nan for v in row] for row in rows])
    environment = problem["environment"]
    obstacles = [box(o["name"], o["box"]["size_m"], o["box"]["center_m"]) for o in environment["obstacles"]]
    report["scene"] = {"bounds": {k: environment["bounds"][k] for k in ("x_m", "z_m")}, "obstacles": obstacles}
    report["description"] = problem["description"]
    report["map"] = map_json(obstacles, report["scene"]["bounds"])
    if rows:
        report["flight"] = flight_json(names, list(values.T))
        report["_columns"] = dict(zip(names, values.T))
    else:
        report.update(flight=None, _columns=None)
    return report


def write(template, report, page):
    """Also returns what its columns are."""
    columns = report.pop("_columns", None)
    write_page(template, report, page)
    return columns


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("template")
    parser.add_argument("out")
    parser.add_argument("--case", choices=CASES, default="solved")
    parser.add_argument("--run")
    arguments = parser.parse_args()
    report = run_report(arguments.run) if arguments.run else CASES[arguments.case]()
    write(arguments.template, report, arguments.out)


if __name__ == "__main__":
    main()
