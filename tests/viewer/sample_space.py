#!/usr/bin/env python3
"""Invented flights in space, in the shape of the page's data.

sample_space.py TEMPLATE.html OUT.html [--case NAME]     the names are in CASES
"""

import argparse
import math
import os
import sys

import numpy as np

sys.dont_write_bytecode = True

import sample_validation
from packing import flight_json, packed, write_page

AXES = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]
LINKS_M = [[0, 0, -0.1], [0, 0, -0.132], [0, 0, -0.075]]
TIP_M = [0, 0, -0.05]


def obstacle(name, kind, solid, low_m, high_m):
    return {"name": name, "kind": kind, "low_m": list(low_m), "high_m": list(high_m), "solid": solid}


def box(name, size_m, center_m):
    low, high = [c - s / 2 for s, c in zip(size_m, center_m)], [c + s / 2 for s, c in zip(size_m, center_m)]
    return obstacle(name, "box", {"box": {"size_m": size_m, "center_m": center_m, "axes": AXES}}, low, high)


def pipe(name, radius_m, length_m, center_m, axis):
    half = [abs(a) * length_m / 2 + (1 - abs(a)) * radius_m for a in axis]
    return obstacle(name, "cylinder", {"cylinder": {"radius_m": radius_m, "length_m": length_m, "center_m": center_m,
                                                    "axis": axis}},
                    [c - h for c, h in zip(center_m, half)], [c + h for c, h in zip(center_m, half)])


def wedge(name, corners, low_y, high_y):
    """A prism of triangles over a triangle in x and z."""
    vertices = [[x, y, z] for y in (low_y, high_y) for x, z in corners]
    faces = [[0, 2, 1], [3, 4, 5], [0, 1, 4], [0, 4, 3], [1, 2, 5], [1, 5, 4], [2, 0, 3], [2, 3, 5]]
    solid = {"triangles": {"vertices": packed(np.asarray(vertices, dtype="<f4").tobytes()),
                           "indices": packed(np.asarray(faces, dtype="<u4").tobytes())}}
    x, z = [c[0] for c in corners], [c[1] for c in corners]
    return obstacle(name, "mesh", solid, [min(x), low_y, min(z)], [max(x), high_y, max(z)])


def robot_json(joints=3):
    rotors = [{"position_m": [0.185 * math.cos(math.radians(30 + 60 * k)), 0.185 * math.sin(math.radians(30 + 60 * k)),
                              0.05], "axis": [0, 0, 1], "spin": -1 if k % 2 == 0 else 1, "min_thrust_n": 0,
               "max_thrust_n": 20.7} for k in range(6)]
    links = [{"joint_m": LINKS_M[i], "axis": [0, -1, 0], "mass_kg": 0.1, "limits_rad": [-1.671, 1.671] if i < 2 else [-1.0, 1.671],
              "max_torque_nm": 1,
              "bodies": [{"capsule": {"radius_m": 0.02, "from_m": [0, 0, 0],
                                      "to_m": (LINKS_M + [TIP_M])[i + 1] if i < 2 else TIP_M}}]} for i in range(joints)]
    return {"name": "hexa370_arm3",
            "bodies": [{"cylinder": {"radius_m": 0.12, "length_m": 0.1, "center_m": [0, 0, -0.02], "axis": [0, 0, 1]}}],
            "rotor_radius_m": 0.0889, "rotors": rotors, "links": links,
            "end_effector_m": TIP_M if joints else [0, 0, -0.15], "tool_direction": [0, 0, -1],
            "facts": {"mass_kg": 2.53, "thrust_to_weight": 5.0, "reach_m": 0.357, "hover_share": 0.24}}


def girder_bay():
    return ([box("ground", [14, 12, 0.5], [0, 0, -0.25]), box("deck", [10, 9, 0.22], [0, 0, 4.9])] +
            [box(f"girder {i + 1}", [10, 0.3, 1.2], [0, -3 + 3 * i, 4.19]) for i in range(3)] +
            [box(f"frame {i + 1}", [0.12, 5.7, 0.5], [-3 + 3 * i, 0, 4.2]) for i in range(3)] +
            [pipe("drain", 0.12, 9, [0, 1.3, 3.3], [1, 0, 0]), wedge("haunch", [[3.6, 2.4], [4.4, 3.6], [4.4, 2.4]], -0.5, 0.5),
             pipe("pier", 0.5, 3.6, [4.2, 0, 1.8], [0, 0, 1])])


def quaternion(roll, pitch, yaw):
    """Of Rz(yaw) Ry(pitch) Rx(roll), scalar first."""
    (cr, sr), (cp, sp), (cy, sy) = [(np.cos(a / 2), np.sin(a / 2)) for a in (roll, pitch, yaw)]
    return np.stack([cr * cp * cy + sr * sp * sy, sr * cp * cy - cr * sp * sy, cr * sp * cy + sr * cp * sy,
                     cr * cp * sy - sr * sp * cy])


def turned(q, v):
    """Vectors v, 3 or 3 x n, from body axes to the world by quaternions 4 x n."""
    w, u = q[0], q[1:]
    v = np.broadcast_to(np.asarray(v, dtype=float).reshape(3, -1), u.shape)
    return v + 2 * np.cross(u, np.cross(u, v, axis=0) + w * v, axis=0)


def product(a, b):
    return np.stack([a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3], a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
                     a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1], a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0]])


def tip_of(robot, position, q, joints):
    """End effector in the world: through every link, by quaternions."""
    at = np.array(position)
    for link, angle in zip(robot["links"], joints):
        at = at + turned(q, link["joint_m"])
        axis = np.asarray(link["axis"], dtype=float)
        q = product(q, np.stack([np.cos(angle / 2), *(axis[:, None] * np.sin(angle / 2))]))
    return at + turned(q, robot["end_effector_m"])


def invented_flight(robot, stops, times, duration_s, joints=3, ceiling_m=3.59):
    """Columns of a flight that follows its reference late and with a swing: kinematics, no simulation. Stops are x, y,
    z, yaw and the joints."""
    t = np.arange(round(duration_s * 100) + 1) * 0.01
    reference = rest_to_rest(stops, times, t)
    state = rest_to_rest(stops, times, t - 0.12)
    state[:, 2] += 0.015 * np.sin(2.1 * t) * (1 - np.exp(-t))
    state[:, 1] += 0.02 * np.sin(1.3 * t) * (1 - np.exp(-t))
    speed = np.gradient(state, 0.01, axis=0)
    ax, ay, az = np.gradient(speed[:, :3], 0.01, axis=0).T
    yaw = state[:, 3]
    forward, left = ax * np.cos(yaw) + ay * np.sin(yaw), -ax * np.sin(yaw) + ay * np.cos(yaw)
    pitch = np.arctan2(forward, 9.81 + az) + 0.01 * np.sin(5 * t)
    roll = -np.arctan2(left, 9.81 + az) + 0.008 * np.sin(4 * t)
    q = quaternion(roll, pitch, yaw)
    rotors = robot["rotors"]
    gap = np.maximum(0.1, ceiling_m - state[:, 2])
    factors = [1 + 0.16 * (0.0889 / gap)**2 * (1 + 0.2 * r["position_m"][0]) for r in rotors]
    thrust = 2.53 * np.sqrt(ax**2 + ay**2 + (9.81 + az)**2) / len(rotors)
    commands = [thrust / f * (1 + 0.1 * math.cos(k) * np.sin(3 * t)) for k, f in enumerate(factors)]
    power = 3 * sum(c**1.5 for c in commands)
    tip = tip_of(robot, state[:, :3].T, q, [state[:, 4 + i] for i in range(joints)])
    columns = {"t_s": t, **{f"ref_{n}": reference[:, i] for i, n in enumerate(["x_m", "y_m", "z_m", "yaw_rad"])},
               **{f"ref_joint_{i + 1}_rad": reference[:, 4 + i] for i in range(joints)},
               **dict(zip(["x_m", "y_m", "z_m"], state[:, :3].T)), **dict(zip(["qw", "qx", "qy", "qz"], q)),
               **{f"joint_{i + 1}_rad": state[:, 4 + i] for i in range(joints)},
               **dict(zip(["vx_m_s", "vy_m_s", "vz_m_s"], speed[:, :3].T)),
               "wx_rad_s": np.gradient(roll, 0.01), "wy_rad_s": np.gradient(pitch, 0.01), "wz_rad_s": np.gradient(yaw, 0.01),
               **{f"joint_{i + 1}_rate_rad_s": speed[:, 4 + i] for i in range(joints)},
               **{f"joint_{i + 1}_torque_nm": 0 * t for i in range(joints)}, "aero_factor_min": np.min(factors, axis=0),
               "aero_factor_max": np.max(factors, axis=0), "clearance_m": np.maximum(0, gap - 0.14),
               **dict(zip(["ee_x_m", "ee_y_m", "ee_z_m"], tip)), "power_w": power,
               "energy_j": np.concatenate([[0], np.cumsum(power[:-1]) * 0.01])}
    for k, (command, factor) in enumerate(zip(commands, factors)):
        columns[f"rotor_{k + 1}_cmd_n"], columns[f"rotor_{k + 1}_aero_factor"] = command, factor
    return columns


def rest_to_rest(stops, times, t):
    """Quintic between stops, held after the last."""
    out = np.empty((len(t), len(stops[0])))
    for i, now in enumerate(t):
        leg = min(max(int(np.searchsorted(times, now, side="right")) - 1, 0), len(stops) - 2)
        s = min(1, max(0, (now - times[leg]) / (times[leg + 1] - times[leg])))
        out[i] = np.asarray(stops[leg]) + (10 * s**3 - 15 * s**4 + 6 * s**5) * np.subtract(stops[leg + 1], stops[leg])
    return out


def end_effector_goal(name, number, position_m, direction=None):
    return {"name": name, "number": number, "hold_s": 5, "kind": "end_effector", "position_m": position_m, "tolerance_m": 0.1,
            "direction": direction, "direction_tolerance_rad": 0.35}


def report_of(name, robot, obstacles, goals, order, flight=None, outcome=None, execution=None):
    report = {"schema": "downwash/space-report/v1", "version": "0.1.0", "name": name,
              "description": "Look at two gussets between girders.", "command": "", "solution": None, "cost_unit": "J", "warnings": [],
              "findings": None, "effective_yaml": "schema: downwash/problem/v1\n", "flight": None,
              "scene": {"bounds": {"low_m": [-5, -4, 0.5], "high_m": [5, 4, 4.6]}, "obstacles": obstacles}, "robot": robot,
              "start": {"position_m": [-3.5, -3.4, 1.2], "attitude": [1, 0, 0, 0], "joints_rad": [0] * len(robot["links"])},
              "goals": goals, "goal_order": order,
              "limits": {"safety_margin_m": 0.05, "max_tilt_rad": 0.61, "max_speed_m_s": 1}}
    if flight is not None:
        report["flight"] = flight_json(list(flight), list(flight.values()))
        report["command"] = "downwash execute effective.yaml --plan solution.json --out again"
        report["solution"] = {"status": "solved", "variant": "mp-arm-ada", "objective": "energy",
                              "problem": {"name": name, "file": "bay.yaml", "sha256": "0" * 64}, "warnings": [],
                              "plan": {"reference": []},
                              "execution": {"aero": True, "outcome": outcome, "min_clearance_m": 0.1, "energy_j": 2000,
                                            "duration_s": 24, "cost": 2000.5, "max_tracking_error_m": 0.1,
                                            "max_saturation": 0.6, "goal_error_m": 0.04, **(execution or {})}}
    report["_columns"] = flight
    return report


def solved_report():
    robot = robot_json()
    stops = [[-3.5, -3.4, 1.2, 0, 0, 0, 0], [-1.0, -1.6, 3.1, 0.9, 0.6, 0.8, 0.4], [-1.0, -1.6, 3.1, 0.9, 0.6, 0.8, 0.4],
             [2.2, 1.9, 2.6, 2.4, 1.1, -0.5, 0.2], [2.2, 1.9, 2.6, 2.4, 1.1, -0.5, 0.2]]
    flight = invented_flight(robot, stops, [0, 7, 10, 17, 22], 22)
    tips = [[float(flight[f"ee_{a}_m"][row]) for a in "xyz"] for row in (950, -1)]
    goals = [end_effector_goal("goal 1", 1, tips[0], [0.4, 0.5, -0.4]), end_effector_goal("goal 2", 2, tips[1])]
    return report_of("girder_bay", robot, girder_bay(), goals, "in_turn", flight, "ok")


def judged_report():
    report = solved_report()
    findings, _ = sample_validation.worlds_report(failures=13)
    report["findings"] = findings["findings"]
    return report


def collision_report():
    report = solved_report()
    flight = {name: column[:820] for name, column in report["_columns"].items()}
    flight["clearance_m"] = flight["clearance_m"].copy()
    flight["clearance_m"][-1] = -0.002
    made = report_of("girder_bay", report["robot"], report["scene"]["obstacles"], report["goals"], "in_turn", flight, "collision")
    return made


def unplanned_report():
    """Every kind of goal, and a warning."""
    at = {"name": "goal 1", "number": 1, "hold_s": 5}
    goals = [{**at, "kind": "pose", "position_m": [-2, -1.5, 3], "tolerance_m": 0.1, "rpy_rad": [0, 0.5, 1], "tolerance_rad": 0.09},
             {**at, "name": "goal 2", "number": 2, "kind": "camera", "position_m": [0, 2.8, 4], "distance_m": [0.5, 1.2],
              "direction": [0, 1, 0.4], "view_cone_rad": 0.52, "aim_tolerance_rad": 0.09, "sees": True},
             {**at, "name": "goal 3", "number": 3, "kind": "configuration", "position_m": [2, -2, None], "tolerance_m": 0.2,
              "yaw_rad": 1.2, "joints_rad": [0.5, 0.5, 0], "tolerance_rad": 0.09},
             {**at, "name": "goal 4", "number": 4, "kind": "contact", "position_m": None, "tolerance_m": 0.1,
              "obstacle": "pier", "force_n": 5}]
    report = report_of("girder_bay", robot_json(), girder_bay(), goals, "any_order")
    report["warnings"] = [{"file": "bay.yaml", "line": 3, "column": 1, "message": "robot: <b>odd</b>"}]
    return report


def armless_report():
    """A quadrotor without arm in open air."""
    robot = robot_json(joints=0)
    robot["rotors"] = robot["rotors"][:4]
    stops = [[-3.5, -3.4, 1.2, 0], [3, 2, 4, 0], [3, 2, 4, 0]]
    flight = invented_flight(robot, stops, [0, 8, 13], 13, joints=0, ceiling_m=1e3)
    flight["clearance_m"] = np.full(len(flight["t_s"]), np.nan)
    goal = {"name": "goal", "number": 1, "hold_s": 5, "kind": "configuration", "position_m": [3, 2, 4], "tolerance_m": 0.1,
            "yaw_rad": None, "joints_rad": None, "tolerance_rad": 0.09}
    return report_of("open_air", robot, [], [goal], "single", flight, "ok")


def hostile_report():
    """Text of others."""
    report = solved_report()
    report["description"] = "</script><script>document.title = 'owned'</script> \u202eright to left"
    report["robot"]["name"] = report["name"] = "<img src=x onerror=\"document.title='owned'\">"
    report["scene"]["obstacles"][1]["name"] = "<b>deck</b>&amp;"
    report["scene"]["obstacles"][2]["name"] = "w" * 300
    return report


CASES = {"space": solved_report, "space-judged": judged_report, "space-collision": collision_report,
         "space-unplanned": unplanned_report, "space-armless": armless_report, "space-hostile": hostile_report}


def write(template, report, page):
    columns = report.pop("_columns")
    write_page(template, report, page)
    return columns


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("template")
    parser.add_argument("page")
    parser.add_argument("--case", choices=CASES, default="space")
    given = parser.parse_args()
    write(given.template, CASES[given.case](), given.page)
    print(os.path.abspath(given.page))


if __name__ == "__main__":
    main()
