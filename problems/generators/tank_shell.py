"""The shell of a storage tank below its wind girder: press a gauge on it."""

import math

from .geometry_files import along_z, binary_stl
from .problem_text import Problem, goal, one
from .profiles import arc, band

RADIUS, HEIGHT = 15.0, 13.5
GIRDER_DROP = 1.1  # 42 in below the top
GIRDER_WIDTH = 0.71  # 28 in
GIRDER_PLATE = 0.01
SECTOR_DEG = 30  # to either side of the place
BRACKET = (0.6, 0.01, 0.4)
BRACKETS_APART = 3.0  # along the shell
CURB = 0.075
RISER = 0.1143  # DN 100


def problems():
    about = [
        "A thickness gauge on the shell of a tank, below its wind girder.",
        "The vehicle starts beside the tank, near the ground. It rises to the underside of the wind girder, which is a "
        "walkway, and presses a gauge on the shell 0.3 m below it with 5 N, between two brackets. It leans by 6 degrees as it "
        "presses.",
    ]
    description = "Press a gauge on the shell of a tank, below its wind girder."
    problem = Problem("tank_shell", about, description, "ars_lrm_space", "tank_shell.py")
    problem.between("ground", (-40, -20, -1), (20, 20, 0))
    problem.source("A tank of 30 m, 13.5 m high: six courses of 2.25 m (assumed). The shell meets x = 0.")
    problem.cylinder("shell", RADIUS, HEIGHT, (-RADIUS, 0, HEIGHT / 2))
    problem.source(
        "Its wind girder as a walkway by API 650, 5.9: at least 710 mm (28 in) clear of the top angle of 75 mm, 1100 mm "
        "(42 in) below the top; 10 mm thick (assumed). As a sector of 60 degrees."
    )
    high = HEIGHT - GIRDER_DROP
    center = (-RADIUS, 0)
    inner, outer = (arc(RADIUS + width, -SECTOR_DEG, SECTOR_DEG, 24, center) for width in (0, CURB + GIRDER_WIDTH))
    solid = band(inner, outer, along_z(high - GIRDER_PLATE), along_z(high))
    content = binary_stl(solid, "wind girder, metres; made by make_space_problems.py")
    problem.mesh("wind_girder", "meshes/wind_girder.stl", content)
    problem.source("Brackets of 0.6 x 0.4 m below it, 3 m apart (assumed).")
    for i in range(-2, 2):
        angle = (i + 0.5) * BRACKETS_APART / RADIUS
        away = RADIUS + BRACKET[0] / 2
        at = (-RADIUS + away * math.cos(angle), away * math.sin(angle), high - GIRDER_PLATE - BRACKET[2] / 2)
        problem.box(f"bracket_{i + 3}", BRACKET, at, (0, 0, math.degrees(angle)))
    problem.source("A riser of DN 100 (ASME B36.10M) up to the wind girder, 0.3 m off the shell (assumed).")
    riser_y = -2.5
    riser_x = math.sqrt((RADIUS + 0.3) ** 2 - riser_y**2) - RADIUS
    problem.cylinder("riser", RISER / 2, high - GIRDER_PLATE, (riser_x, riser_y, (high - GIRDER_PLATE) / 2))
    problem.bounds = (0.3, -6, 0.5), (8, 6, 16)
    problem.start = {"x_m": 4, "y_m": -4, "z_m": 2, "yaw_deg": 180, "joints_deg": (90,)}
    touch = {"obstacle": "shell", "force_n": 5, "part": "end_effector"}
    at = {"position_m": (0, 0, high - GIRDER_PLATE - 0.3), "tolerance_m": 0.1}
    problem.goal = one(goal("contact", touch | at))
    return [problem]
