#!/usr/bin/env python3
"""Invented robots, in the shape of the page's data.

sample_robot.py TEMPLATE.html OUT.html [--case NAME]     the names are in CASES
"""

import argparse
import sys

sys.dont_write_bytecode = True

import sample_space
from packing import write_page

INERTIA = [[0.02, 0, 0], [0, 0.021, 0], [0, 0, 0.035]]
WEIGHT_N = 2.53 * 9.80665


def robot(joints=3):
    drawn = sample_space.robot_json(joints)
    facts = {**drawn.pop("facts"), "hover_rotor": 2, "hover_joints_rad": [1.2] * joints}
    masses = [0.1] * joints
    drawn["multirotor"] = {"mass_kg": facts["mass_kg"] - sum(masses), "inertia_kg_m2": INERTIA}
    for link, mass in zip(drawn["links"], masses):
        link.update(mass_kg=mass, center_of_mass_m=[0.01, 0, -0.06], inertia_kg_m2=[[1e-4, 0, 0], [0, 1e-4, 0], [0, 0, 2e-5]])
    count = len(drawn["rotors"])
    lever = 2 * WEIGHT_N / count / 0.185 ** 2  # of rotors on a circle
    return {"schema": "downwash/robot-report/v1", "version": "0.1.0", "file": "robots/hexa370_arm3.yaml", "is_planar": False,
            "robot": drawn, "pose": {"joints_rad": [0.0] * joints},
            "hover": {"middle_n": [WEIGHT_N / count] * count,
                      "forward_n_m": [lever * rotor["position_m"][0] for rotor in drawn["rotors"]],
                      "left_n_m": [lever * rotor["position_m"][1] for rotor in drawn["rotors"]]},
            "facts": facts, "warnings": ["hexa.yaml:3:1: this <i>may</i> not be meant"]}


def planar():
    page = robot(1)
    page["is_planar"] = True
    page["warnings"] = []
    page["robot"]["name"] = "planar"
    for rotor in page["robot"]["rotors"]:
        rotor["spin"] = 0
    for body in [page["robot"]["multirotor"], *page["robot"]["links"]]:
        body.pop("inertia_kg_m2")
        body["pitch_inertia_kg_m2"] = 0.02
    return page


def tiny():
    """As small as a Crazyflie."""
    page = robot(0)
    drawn = page["robot"]
    drawn["rotor_radius_m"] = 0.023
    for rotor in drawn["rotors"]:
        rotor["position_m"] = [0.2 * value for value in rotor["position_m"]]
    drawn["bodies"] = []
    return page


CASES = {"robot": robot, "robot-planar": planar, "robot-armless": lambda: robot(0), "robot-tiny": tiny}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("template")
    parser.add_argument("out")
    parser.add_argument("--case", choices=CASES, default="robot")
    arguments = parser.parse_args()
    write_page(arguments.template, CASES[arguments.case](), arguments.out)


if __name__ == "__main__":
    main()
