"""The crown of a road tunnel between two jet fans: tap the lining, then look at a fan's anchors."""

import math

from .geometry_files import along_x, binary_stl
from .problem_text import Problem, listed, tool_at, view_of
from .profiles import arc, band

RADIUS, CENTER_Z = 5.5, 1.5
LINING = 0.4
HALF_LENGTH = 10.0
FAN, FAN_LENGTH = 1.2, 3.0  # outside
APART = 2.4  # axes of the two fans
FAN_LOW = 4.7
WALKWAY = (1.0, 0.15)


def problems():
    about = [
        "The crown of a road tunnel between two jet fans.",
        "The vehicle starts over the road. It rises between the fans and holds its tool, which is on top, to the crown of "
        "the lining. Then it looks at an anchor of one fan, which the fan hides from below.",
    ]
    description = "Reach a tunnel's crown between jet fans, then look at an anchor of one."
    problem = Problem("tunnel_crown", about, description, "snu_f550_arm2", "tunnel_crown.py")
    problem.source(
        "A road of 7.5 m with walkways of 1 m and 4.5 m of height for traffic (RABT, cross-section 10.5T): a lining with "
        "a radius of 5.5 m about a line 1.5 m over the road, 0.4 m thick (assumed), 20 m of it."
    )
    problem.between("road", (-HALF_LENGTH, -7, -1), (HALF_LENGTH, 7, 0))
    low_deg = -math.degrees(math.asin(CENTER_Z / RADIUS))
    lines = [arc(RADIUS + more, low_deg, 180 - low_deg, 42, (0, CENTER_Z)) for more in (0, LINING)]
    solid = band(*lines, along_x(-HALF_LENGTH), along_x(HALF_LENGTH))
    content = binary_stl(solid, "tunnel lining, metres; made by make_space_problems.py")
    problem.mesh("lining", "meshes/tunnel_lining.stl", content)
    for side, sign in (("right", -1), ("left", 1)):
        inner, outer = 3.75, 3.75 + WALKWAY[0]
        low, high = sorted((sign * inner, sign * outer))
        problem.between(f"{side}_walkway", (-HALF_LENGTH, low, 0), (HALF_LENGTH, high, WALKWAY[1]))
    problem.source(
        "A pair of jet fans of 1 m with 0.1 m of silencer around and silencers of one diameter at both ends, 1.2 x 3 m "
        "outside; two diameters between their axes, 0.2 m over the height for traffic; four rods of 40 mm each "
        "(assumed)."
    )
    fan_z = FAN_LOW + FAN / 2
    for side, sign in (("right", -1), ("left", 1)):
        problem.cylinder(f"{side}_fan", FAN / 2, FAN_LENGTH, (0, sign * APART / 2, fan_z), (1, 0, 0))
        for i, (x, across) in enumerate(((-0.75, -0.4), (-0.75, 0.4), (0.75, -0.4), (0.75, 0.4)), 1):
            y = sign * APART / 2 + across
            low, high = fan_z + math.sqrt((FAN / 2) ** 2 - across**2), CENTER_Z + math.sqrt(RADIUS**2 - y**2)
            problem.cylinder(f"{side}_rod_{i}", 0.02, high - low, (x, y, (low + high) / 2))
    problem.bounds = (-6, -4, 0.5), (6, 4, 6.9)
    problem.start = {"x_m": -5, "y_m": -2, "z_m": 1.5, "yaw_deg": 0}
    # The nut of the rod that is nearest to the crown, on the side of the crown.
    anchor_y = APART / 2 - 0.4 - 0.025
    anchor = (0.75, anchor_y, CENTER_Z + math.sqrt(RADIUS**2 - anchor_y**2) - 0.05)
    crown = (0, 0, CENTER_Z + RADIUS - 0.1)
    problem.goal = listed([tool_at(crown, (0, 0, 1)), view_of(anchor, 0.4, 1, (0, 1, 1), 45)])
    return [problem]
