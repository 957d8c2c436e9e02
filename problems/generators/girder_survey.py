"""Missions below a bridge of steel girders: views of many places in any order, with one battery, and back."""

from .girder_bay import BOTTOM_FLANGE, CHORD, CLEARANCE, DESIGN_EXAMPLE, GIRDERS, GUSSET, WEB_THICKNESS
from .girder_bay import Bay, add_road, new_problem, source_of_girders
from .problem_text import mission, view_of

FOLDED = (-75, 150)  # clear of the rotors, also with a heavier arm
USABLE = 0.8  # of a battery's energy
BAY_BATTERY_WH = 355  # 6S, 16 Ah
GIRDER_BATTERY_WH = 100  # 6S, 4.5 Ah


def usable_joules(battery_wh):
    return round(USABLE * battery_wh * 3600)


def gusset_view(bay, frame, number, at_left, z):
    """A gusset of a cross frame from 0.5 to 1.2 m, out of its bay. From 0.3 m an error of place of 5 cm turns the line of
    sight by as much as a camera may be off its target."""
    side = 1 if at_left else -1
    girder_y = bay.girders_y[number if at_left else number + 1]
    y = girder_y + side * (WEB_THICKNESS / 2 + GUSSET[1] / 2)
    x = bay.frames_x[frame] - CHORD / 2 - GUSSET[0]
    return view_of((x, y, z), 0.5, 1.2, (1, -side, 0), 30)


def of_the_bay():
    """All upper gussets, and the lower ones between the girders of the middle cross frame."""
    bay = Bay(DESIGN_EXAMPLE)
    about = [
        "Thirty gussets between the girders of a bridge, in any order, with one battery.",
        "The vehicle starts below the bridge with its arm folded. It looks at all upper gussets of three cross frames and "
        "at six lower ones of the middle frame, each from its own direction and from 0.5 to 1.2 m, and returns. From bay "
        "to bay it has to pass under the girders.",
    ]
    problem = new_problem("girder_bay_survey", about, "Look at thirty gussets of a girder bridge and return.")
    problem.made_by = "girder_survey.py"
    add_road(problem)
    source_of_girders(problem, bay)
    bay.add_all(problem)
    half_width = bay.girders_y[-1] + 1
    problem.bounds = (-1.4 * bay.panel, -half_width, 0.5), (1.2 * bay.panel, half_width, bay.web_high)
    problem.start = {"x_m": bay.panel / 2, "y_m": 0, "z_m": 2, "yaw_deg": 180, "joints_deg": FOLDED}
    bays = range(GIRDERS - 1)
    upper = [(frame, number, left) for frame in range(3) for number in bays for left in (True, False)]
    targets = [gusset_view(bay, *place, bay.high_z) for place in upper]
    inner = [(1, number, left) for number in bays for left in (True, False)][1:-1]
    targets += [gusset_view(bay, *place, bay.low_z) for place in inner]
    problem.goal = mission(targets, problem.start, usable_joules(BAY_BATTERY_WH))
    return problem


def of_a_girder():
    """Both sides of one web."""
    about = [
        "Five places of a girder in any order, with one battery: the smallest mission.",
        "They are on both sides of its web, from left to right: the best order goes along one side and back along the "
        "other, and crosses twice under the girder or over it.",
    ]
    problem = new_problem("girder_survey", about, "Look at five places of a girder from both sides and return.")
    problem.made_by = "girder_survey.py"
    add_road(problem)
    problem.source('The middle of one girder of FHWA NHI-04-041: a web of 54" x 1/2", flanges of 14" x 7/8".')
    half, flange = 4, DESIGN_EXAMPLE["flange"] / 2
    low, high = CLEARANCE + BOTTOM_FLANGE, CLEARANCE + BOTTOM_FLANGE + DESIGN_EXAMPLE["web"]
    problem.between("bottom_flange", (-half, -flange, CLEARANCE), (half, flange, low))
    problem.between("web", (-half, -WEB_THICKNESS / 2, low), (half, WEB_THICKNESS / 2, high))
    problem.between("top_flange", (-half, -flange, high), (half, flange, high + BOTTOM_FLANGE))
    problem.bounds = (-4, -3, 0.5), (4, 3, 8)
    problem.start = {"x_m": -3, "y_m": -2, "z_m": 3, "yaw_deg": 0, "joints_deg": FOLDED}
    middle = (low + high) / 2
    places = [(-2, 1), (1.5, -1), (0, 1), (2.5, 1), (-1, -1)]
    targets = [view_of((x, y * WEB_THICKNESS / 2, middle), 0.6, 1.5, (0, -y, 0), 40) for x, y in places]
    problem.goal = mission(targets, problem.start, usable_joules(GIRDER_BATTERY_WH))
    return problem


def problems():
    return [of_the_bay(), of_a_girder()]
