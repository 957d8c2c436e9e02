"""A box culvert that crosses below a road askew: look at joints of its roof and of a haunch."""

import math

from .geometry_files import binary_stl, prism
from .problem_text import Problem, listed, view_of
from .profiles import along_skewed_x

SPAN = RISE = 3.658  # 12 ft
WALL = 0.305  # 12 in, slabs and haunches too
SKEW_DEG = 30
ROAD = 2 * 3.658 + 2 * 2.438  # lanes of 12 ft, shoulders of 8 ft
UNIT = 1.829  # 6 ft
PARAPET = 0.457  # 1'-6" over the roof
WING_DEG = 30


def barrel(half_length):
    """Walls, slabs and haunches as one closed mesh: eight convex pieces around the opening. The road runs along the
    ends, which are askew to the axis x; the invert is at z = 0."""
    y, z, t = SPAN / 2, RISE, WALL
    outer = [(-y - t, -t), (y + t, -t), (y + t, z + t), (-y - t, z + t)]
    inner = [(-y + t, 0), (y - t, 0), (y, t), (y, z - t), (y - t, z), (-y + t, z), (-y, z - t), (-y, t)]
    a, b, c, d, e, f, g, h = inner
    polygons = [
        [outer[0], outer[1], b, a],
        [outer[1], c, b],
        [outer[1], outer[2], d, c],
        [outer[2], e, d],
        [outer[2], outer[3], f, e],
        [outer[3], g, f],
        [outer[3], outer[0], h, g],
        [outer[0], a, h],
    ]
    low, high = along_skewed_x(-half_length, SKEW_DEG), along_skewed_x(half_length, SKEW_DEG)
    ends = prism(polygons, [], low, high)
    return ends + prism([], outer, low, high) + prism([], inner[::-1], low, high)


def problems():
    half_length = ROAD / math.cos(math.radians(SKEW_DEG)) / 2
    about = [
        "Joints inside a box culvert that crosses below a road askew.",
        "The vehicle starts outside, behind a wing wall. It enters by a skewed mouth and looks at two places of a joint "
        "between precast units: at the roof, and at the haunch of the far wall. Its arm is on top.",
    ]
    description = "Enter a skewed box culvert and look at a joint, at the roof and at a haunch."
    problem = Problem("culvert", about, description, "snu_f550_arm2", "culvert.py")
    problem.between("ground", (-25, -20, -2), (25, 20, -WALL))
    problem.source(
        "The barrel: 12 x 12 ft inside, walls, slabs and haunches of 12 in, as precast boxes of this size by ASTM C1577, "
        "in units of 6 ft. It lies below two lanes of 12 ft with shoulders of 8 ft (AASHTO), 30 degrees askew (assumed). "
        "x is its axis."
    )
    content = binary_stl(barrel(half_length), "box culvert, metres; made by make_space_problems.py")
    problem.mesh("barrel", "meshes/skewed_culvert.stl", content)
    problem.source("Aprons level with the invert; parapets of 1'-6\" over the roof and 1 ft thick (assumed).")
    skew = math.radians(SKEW_DEG)
    half_width = SPAN / 2 + WALL
    for name, sign in (("near", -1), ("far", 1)):
        # From the inner end of the mouth, below the barrel's floor, to 4 m before its outer end.
        near, far = (half_length + side * half_width * math.tan(skew) for side in (-1, 1))
        length = far + 4 - near
        problem.box(f"{name}_apron", (length, 2 * half_width, WALL), (sign * (near + length / 2), 0, -WALL / 2))
        # Along the skewed end.
        problem.box(
            f"{name}_parapet",
            (WALL, 2 * half_width / math.cos(skew), PARAPET),
            (sign * (half_length - WALL / 2), 0, RISE + WALL + PARAPET / 2),
            (0, 0, -SKEW_DEG),
        )
    problem.source("Wing walls, 12 ft long and 1 ft thick, that open by 30 degrees (assumed).")
    for name, side in (("right", -1), ("left", 1)):
        mouth_y = side * (SPAN / 2 + WALL / 2)
        mouth_x = -half_length + mouth_y * math.tan(skew)
        out = math.radians(180 - side * WING_DEG)
        length = SPAN
        problem.box(
            f"{name}_wing_wall",
            (length, WALL, RISE),
            (mouth_x + length / 2 * math.cos(out), mouth_y + length / 2 * math.sin(out), RISE / 2),
            (0, 0, math.degrees(out) - 180),
        )
    joint_x = -half_length + 4 * UNIT
    problem.bounds = (-half_length - 7, -6, 0.3), (half_length + 2, 6, 6)
    problem.start = {"x_m": -half_length - 5, "y_m": -3, "z_m": 1.5, "yaw_deg": 0, "joints_deg": (-60, 100)}
    haunch = joint_x, SPAN / 2 - WALL / 2, RISE - WALL / 2
    views = [view_of((joint_x, 0.6, RISE), 0.4, 1, (0, 0, 1), 30), view_of(haunch, 0.4, 1, (0, 1, 1), 30)]
    problem.goal = listed(views)
    return [problem]
