"""The chamber of a concrete box girder: through the openings of two diaphragms, to an anchor."""

from .problem_text import Problem, listed, tool_at

WIDTH, HEIGHT = 4.9, 1.98  # inside
SLAB, WEB = 0.23, 0.38
HALF_LENGTH = 6.0
OPENING = (0.9, 1.2)  # width, height
DIAPHRAGM = 0.3
DUCT = 0.11
ANCHOR = (0.15, 0.25)  # radius and length of its cap


def diaphragm(problem, name, x, opening_y):
    low, high = opening_y - OPENING[0] / 2, opening_y + OPENING[0] / 2
    ends = x - DIAPHRAGM / 2, x + DIAPHRAGM / 2
    problem.between(f"{name}_right", (ends[0], -WIDTH / 2, 0), (ends[1], low, HEIGHT))
    problem.between(f"{name}_left", (ends[0], high, 0), (ends[1], WIDTH / 2, HEIGHT))
    problem.between(f"{name}_lintel", (ends[0], low, OPENING[1]), (ends[1], high, HEIGHT))


def problems():
    about = [
        "An anchor in the chamber of a concrete box girder, behind two diaphragms.",
        "The openings of the diaphragms are at the floor and offset to either side, and external tendons run beside them. "
        "The vehicle passes both openings, near the floor and a lintel at once, and points at one of two anchors at the "
        "far end.",
    ]
    description = "Pass two offset diaphragm openings of a box girder, to an anchor."
    problem = Problem("box_girder_chamber", about, description, "hexa370_arm3", "box_girder_chamber.py")
    problem.source(
        "The chamber: a segment 2.4 m deep as of the AASHTO-PCI-ASBI standard segments; slabs of 0.23 and 0.19 m, upright "
        "webs of 0.38 m, 4.9 m between them (assumed). FDOT Structures Design Guidelines 4.6.1 ask for 6 ft of height "
        "inside at least."
    )
    half, wide = HALF_LENGTH + DIAPHRAGM, WIDTH / 2 + WEB
    problem.between("bottom_slab", (-half, -wide, -0.19), (half, wide, 0))
    problem.between("top_slab", (-half, -wide, HEIGHT), (half, wide, HEIGHT + SLAB))
    problem.between("right_web", (-half, -wide, 0), (half, -WIDTH / 2, HEIGHT))
    problem.between("left_web", (-half, WIDTH / 2, 0), (half, wide, HEIGHT))
    problem.between("near_end", (-half, -WIDTH / 2, 0), (-HALF_LENGTH, WIDTH / 2, HEIGHT))
    problem.between("far_end", (HALF_LENGTH, -WIDTH / 2, 0), (half, WIDTH / 2, HEIGHT))
    problem.source(
        "Openings of 0.9 x 1.2 m (assumed: 3 x 4 ft; the same guidelines ask for 32 x 42 in at least), flush with the "
        "floor as they ask. They are 2 m apart across the girder, and the diaphragms 0.3 m thick and 4 m apart (assumed)."
    )
    diaphragm(problem, "diaphragm_1", -2, 1)
    diaphragm(problem, "diaphragm_2", 2, -1)
    problem.source(
        "External tendons, ducts of 0.11 m for 19 strands of 0.6 in: they come down from the ends to the diaphragms, which "
        "deviate them 0.3 m over the floor, and run on level (assumed)."
    )
    for side, y in (("right", -1.9), ("left", 1.9)):
        down, up = 0.3, HEIGHT - 0.45
        places = [(-HALF_LENGTH, y, up), (-2, y, down), (2, y, down), (HALF_LENGTH, y, up)]
        for i, (start, end) in enumerate(zip(places, places[1:]), 1):
            problem.rod(f"{side}_tendon_{i}", DUCT / 2, start, end)
    problem.source("Caps of anchors on the far end: 0.3 m across, 0.25 m long (assumed).")
    anchors = {"right": (-1.2, 0.9), "left": (1.2, 0.9)}
    for side, (y, z) in anchors.items():
        problem.cylinder(f"{side}_anchor", ANCHOR[0], ANCHOR[1], (HALF_LENGTH - ANCHOR[1] / 2, y, z), (1, 0, 0))
    problem.bounds = (-HALF_LENGTH, -WIDTH / 2, 0), (HALF_LENGTH, WIDTH / 2, HEIGHT)
    problem.start = {"x_m": -4.5, "y_m": -1, "z_m": 1, "yaw_deg": 0}
    tools = [tool_at((HALF_LENGTH - ANCHOR[1] - 0.1, y, z), (1, 0, 0)) for y, z in anchors.values()]
    problem.goal = ["  any_of:", *listed(tools, "    ")]
    return [problem]
