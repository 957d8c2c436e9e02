"""A hammerhead pier below its girders: look at it from all sides, in any order."""

from .geometry_files import along_x, binary_stl, prism
from .girder_bay import DECK, DESIGN_EXAMPLE, GIRDERS, OVERHANG, WEB_THICKNESS
from .problem_text import Problem, listed, tool_at, view_of

COLUMN = (1.3716, 4.7244, 4.572)  # 4'-6" x 15'-6", 15 ft high
CAP_LENGTH, CAP_WIDTH = 14.173, 1.524  # 46'-6" x 5'
CAP_END, CAP_DEPTH = 1.524, 3.353  # 5' at its ends, 11' at the column
PEDESTAL = (0.6, 0.6, 0.15)
BEARING = (0.36, 0.38, 0.09)
FLANGE = 0.07  # 2 3/4", over the pier
END_AWAY = 0.25  # of the tool from the end of the cap


def cap():
    """A closed prism; its foot is at z = 0."""
    half, column = CAP_LENGTH / 2, COLUMN[1] / 2
    right = [(column, 0), (half, CAP_DEPTH - CAP_END), (half, CAP_DEPTH)]
    outline = right + [(-y, z) for y, z in reversed(right)]
    outline = [(y, COLUMN[2] + z) for y, z in outline]
    return prism([outline], outline, along_x(-CAP_WIDTH / 2), along_x(CAP_WIDTH / 2))


def problems():
    about = [
        "Four places of a hammerhead pier, in any order.",
        "The vehicle starts on one side of the pier. It looks at a crack on the far side of the column, at the slope of "
        "the cap from below, at one of two bearings between cap and girders, and points at the end of the cap.",
    ]
    description = "Look at four places of a hammerhead pier, in any order."
    problem = Problem("around_a_pier", about, description, "hexa370_arm3", "around_a_pier.py")
    problem.between("ground", (-20, -20, -1), (20, 20, 0))
    problem.source("FHWA NHI-04-041, design step 8: a column of 4'-6\" x 15'-6\", 15 ft high.")
    problem.box("column", COLUMN, (0, 0, COLUMN[2] / 2))
    problem.source("Its cap: 46'-6\" x 5', 11' deep at the column and 5' at the ends.")
    content = binary_stl(cap(), "hammerhead cap, metres; made by make_space_problems.py")
    problem.mesh("cap", "meshes/pier_cap.stl", content)
    top = COLUMN[2] + CAP_DEPTH
    problem.source("Pedestals and bearings: 0.6 x 0.6 x 0.15 and 0.36 x 0.38 x 0.09 m (assumed).")
    places = [(i - (GIRDERS - 1) / 2) * DESIGN_EXAMPLE["spacing"] for i in range(GIRDERS)]
    for i, y in enumerate(places, 1):
        problem.box(f"pedestal_{i}", PEDESTAL, (0, y, top + PEDESTAL[2] / 2))
        problem.box(f"bearing_{i}", BEARING, (0, y, top + PEDESTAL[2] + BEARING[2] / 2))
    low = top + PEDESTAL[2] + BEARING[2]
    problem.source(
        "Girders of the same example: 9'-9\" apart, lower flanges of 14\" x 2 3/4\" over the pier, webs of 54\" x 1/2\", a "
        "slab of 8 1/2\" that ends 3'-11 1/2\" beyond the outer girders."
    )
    web_low, deck_low = low + FLANGE, low + FLANGE + DESIGN_EXAMPLE["web"]
    for i, y in enumerate(places, 1):
        flange, web = DESIGN_EXAMPLE["flange"] / 2, WEB_THICKNESS / 2
        problem.between(f"flange_{i}", (-6, y - flange, low), (6, y + flange, web_low))
        problem.between(f"web_{i}", (-6, y - web, web_low), (6, y + web, deck_low))
    half = places[-1] + OVERHANG
    problem.between("deck", (-6, -half, deck_low), (6, half, deck_low + DECK))
    problem.bounds = (-5, -10, 0.5), (5, 10, deck_low)
    problem.start = {"x_m": -3.5, "y_m": -3, "z_m": 1.5, "yaw_deg": 0}
    crack = view_of((COLUMN[0] / 2, 0.8, 2.5), 0.5, 1.5, (-1, 0, 0), 30)
    slope_y = 4.5
    slope = (CAP_DEPTH - CAP_END) / (CAP_LENGTH - COLUMN[1]) * 2
    below_cap = (0, slope_y, COLUMN[2] + slope * (slope_y - COLUMN[1] / 2))
    slope_view = view_of(below_cap, 0.5, 1.5, (0, -0.3, 1), 60)
    bearing_z = top + PEDESTAL[2] + BEARING[2] / 2
    bearings = [view_of((-BEARING[0] / 2, places[i], bearing_z), 0.4, 1.2, (1, 0, 0), 45) for i in (1, 3)]
    # The arm reaches no farther than the rotors: with the tool 0.1 m from a face these are at 0.08 m, too near for a hover
    # in gusts.
    end = tool_at((0, -CAP_LENGTH / 2 - END_AWAY, top - CAP_END / 2), (0, 1, 0))
    problem.goal = ["  in_any_order:", *listed([crack, slope_view], "    ")]
    problem.goal += ["    - any_of:", *listed(bearings, "        "), *listed([end], "    ")]
    return [problem]
