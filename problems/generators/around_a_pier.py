"""A hammerhead pier below its girders: look at it from all sides, in any order."""

from .geometry_files import along_x, binary_stl, prism
from .problem_text import Problem, goal, listed

COLUMN = (1.3716, 4.7244, 4.572)  # 4'-6" x 15'-6", 15 ft high
CAP_LENGTH, CAP_WIDTH = 14.173, 1.524  # 46'-6" x 5'
CAP_END, CAP_DEPTH = 1.524, 3.353  # 5' at its ends, 11' at the column
SPACING, GIRDERS = 2.972, 5
PEDESTAL = (0.6, 0.6, 0.15)
BEARING = (0.36, 0.38, 0.09)
FLANGE = (0.3556, 0.07)  # 14" x 2 3/4", over the pier
WEB = (0.0127, 1.3716)


def cap():
    """A closed prism; its foot is at z = 0."""
    half, column = CAP_LENGTH / 2, COLUMN[1] / 2
    outline = [(-column, 0), (column, 0), (half, CAP_DEPTH - CAP_END), (half, CAP_DEPTH), (-half, CAP_DEPTH), (-half, CAP_DEPTH - CAP_END)]
    outline = [(y, COLUMN[2] + z) for y, z in outline]
    return prism([outline], outline, along_x(-CAP_WIDTH / 2), along_x(CAP_WIDTH / 2))


def problems():
    about = [
        "Four places of a hammerhead pier, in any order.",
        "",
        "The vehicle starts on one side of the pier. It looks at a crack on the far side of the column, at the slope of the cap from",
        "below, at one of two bearings between cap and girders, and holds its gripper to the end of the cap.",
    ]
    problem = Problem("around_a_pier", about, "Look at four places of a hammerhead pier, in any order.", "hexa370_arm3", "around_a_pier.py")
    problem.between("ground", (-20, -20, -1), (20, 20, 0))
    problem.source("FHWA NHI-04-041, design step 8: a column of 4'-6\" x 15'-6\", 15 ft high.")
    problem.box("column", COLUMN, (0, 0, COLUMN[2] / 2))
    problem.source("Its cap: 46'-6\" x 5', 11' deep at the column and 5' at the ends.")
    problem.mesh("cap", "meshes/pier_cap.stl", binary_stl(cap(), "hammerhead cap, metres; made by make_space_problems.py"))
    top = COLUMN[2] + CAP_DEPTH
    problem.source("Pedestals and bearings: 0.6 x 0.6 x 0.15 and 0.36 x 0.38 x 0.09 m (assumed).")
    places = [(i - (GIRDERS - 1) / 2) * SPACING for i in range(GIRDERS)]
    for i, y in enumerate(places, 1):
        problem.box(f"pedestal_{i}", PEDESTAL, (0, y, top + PEDESTAL[2] / 2))
        problem.box(f"bearing_{i}", BEARING, (0, y, top + PEDESTAL[2] + BEARING[2] / 2))
    low = top + PEDESTAL[2] + BEARING[2]
    problem.source("Girders of the same example: 9'-9\" apart, lower flanges of 14\" x 2 3/4\" over the pier, webs of 54\" x 1/2\", a slab of 8 1/2\".")
    for i, y in enumerate(places, 1):
        problem.between(f"flange_{i}", (-6, y - FLANGE[0] / 2, low), (6, y + FLANGE[0] / 2, low + FLANGE[1]))
        problem.between(f"web_{i}", (-6, y - WEB[0] / 2, low + FLANGE[1]), (6, y + WEB[0] / 2, low + FLANGE[1] + WEB[1]))
    high = low + FLANGE[1] + WEB[1]
    problem.between("deck", (-6, -7.15, high), (6, 7.15, high + 0.216))
    problem.bounds = (-5, -10, 0.5), (5, 10, high)
    problem.start = {"x_m": -3.5, "y_m": -3, "z_m": 1.5, "yaw_deg": 0}
    crack = {"target_m": (COLUMN[0] / 2, 0.8, 2.5), "distance_m": (0.5, 1.5), "direction": (-1, 0, 0), "view_cone_deg": 30}
    slope = {"target_m": (0, 4.5, COLUMN[2] + (4.5 - COLUMN[1] / 2) * (CAP_DEPTH - CAP_END) / (CAP_LENGTH / 2 - COLUMN[1] / 2)), "distance_m": (0.5, 1.5), "direction": (0, -0.3, 1), "view_cone_deg": 60}
    bearings = [
        goal("camera", {"target_m": (-BEARING[0] / 2, places[i], top + PEDESTAL[2] + BEARING[2] / 2), "distance_m": (0.4, 1.2), "direction": (1, 0, 0), "view_cone_deg": 45})
        for i in (1, 3)
    ]
    end = {"position_m": (0, -CAP_LENGTH / 2 - 0.1, top - CAP_END / 2), "tolerance_m": 0.05, "direction": (0, 1, 0), "direction_tolerance_deg": 15}
    problem.goal = ["  in_any_order:", *listed([goal("camera", crack), goal("camera", slope)], "    ")]
    problem.goal += ["    - any_of:", *listed(bearings, "        "), *listed([goal("end_effector", end)], "    ")]
    return [problem]
