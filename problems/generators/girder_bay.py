"""The underside of a bridge of steel girders, between cross frames: look at a gusset from another bay."""

import itertools
import math

from .geometry_files import MIDDLE, binary_stl, octomap, prism
from .problem_text import Problem, number, one, tool_at

# FHWA NHI-04-041, LRFD design example for a steel girder superstructure bridge (2003), in metres.
DESIGN_EXAMPLE = {
    "spacing": 2.972,  # 9'-9"
    "web": 1.3716,  # 54"
    "flange": 0.3556,  # 14"
    "panel": 6.096,  # 20'-0" between cross frames
}
GIRDERS = 5
WEB_THICKNESS = 0.0127  # 1/2"
BOTTOM_FLANGE = 0.0222  # 7/8"
HAUNCH = 0.0889  # 3 1/2", from the web's top to the slab
DECK = 0.216  # 8 1/2"
OVERHANG = 1.2065  # 3'-11 1/2", from the middle of the outer girder
CLEARANCE = 4.9
CHORD = 0.089  # of L 3 1/2 x 3 1/2
GUSSET = (WEB_THICKNESS, 0.3, 0.3)
TOOL = 0.1  # from gusset to tool
RESOLUTION = 0.1  # of the octree


def drawn_sizes(random):
    """Of bridges of 25 to 50 m; chosen before anything was planned."""
    return {
        "spacing": random.uniform(2.4, 3.6),
        "web": random.uniform(1.2, 1.8),
        "flange": random.uniform(0.3, 0.5),
        "panel": random.uniform(4.6, 7.6),
    }


class Bay:
    """Places that follow from the sizes. The road is at z = 0, the middle girder along x, the middle cross frame at
    x = 0."""

    def __init__(self, sizes):
        self.spacing, self.web, self.flange = sizes["spacing"], sizes["web"], sizes["flange"]
        self.panel = sizes["panel"]
        self.web_low = CLEARANCE + BOTTOM_FLANGE
        self.web_high = self.web_low + self.web
        self.deck_low = self.web_high + HAUNCH
        self.half_length = 1.5 * self.panel
        self.girders_y = [(i - (GIRDERS - 1) / 2) * self.spacing for i in range(GIRDERS)]
        self.frames_x = [-self.panel, 0.0, self.panel]
        # Chords are in the middle of their gussets, which end at the flanges.
        self.low_z, self.high_z = self.web_low + GUSSET[2] / 2, self.web_high - GUSSET[2] / 2

    def add_girders(self, problem):
        ends = -self.half_length, self.half_length
        for i, y in enumerate(self.girders_y, 1):
            parts = (
                ("bottom_flange", self.flange, CLEARANCE, self.web_low),
                ("web", WEB_THICKNESS, self.web_low, self.web_high),
                ("top_flange_and_haunch", self.flange, self.web_high, self.deck_low),
            )
            for part, width, low, high in parts:
                problem.between(f"girder_{i}_{part}", (ends[0], y - width / 2, low), (ends[1], y + width / 2, high))
        half = self.girders_y[-1] + OVERHANG
        problem.between("deck", (ends[0], -half, self.deck_low), (ends[1], half, self.deck_low + DECK))

    def add_frame(self, problem, frame, bay):
        """Two chords, two diagonals back to back, and gussets on the side of low x."""
        name, x = f"frame_{frame + 1}_bay_{bay + 1}", self.frames_x[frame]
        left, right = self.girders_y[bay] + WEB_THICKNESS / 2, self.girders_y[bay + 1] - WEB_THICKNESS / 2
        middle, width = (left + right) / 2, right - left
        for part, z in (("lower", self.low_z), ("upper", self.high_z)):
            problem.box(f"{name}_{part}_chord", (CHORD, width, CHORD), (x, middle, z))
        across, up = width - GUSSET[1], self.high_z - self.low_z
        slope_deg = math.degrees(math.atan2(up, across))
        for part, sign in (("rising", 1), ("falling", -1)):
            size = (CHORD / 2, math.hypot(across, up), CHORD)
            at = (x + sign * CHORD / 4, middle, (self.low_z + self.high_z) / 2)
            problem.box(f"{name}_{part}_diagonal", size, at, (sign * slope_deg, 0, 0))
        for side, y in (("left", left + GUSSET[1] / 2), ("right", right - GUSSET[1] / 2)):
            for part, z in (("lower", self.low_z), ("upper", self.high_z)):
                problem.box(f"{name}_{part}_{side}_gusset", GUSSET, (x - CHORD / 2 - GUSSET[0] / 2, y, z))

    def add_all(self, problem):
        self.add_girders(problem)
        problem.source(
            f"Cross frames every {number(self.panel)} m (example: 20 ft) of angles L 3 1/2 x 3 1/2 (assumed), gussets "
            "of 0.3 x 0.3 m (assumed)."
        )
        for frame in range(len(self.frames_x)):
            for bay in range(GIRDERS - 1):
                self.add_frame(problem, frame, bay)

    def set_task(self, problem, start_bay, goal_bay, at_left, frame):
        """From a bay, with the arm folded, to the upper gusset of another one, pointed at out of that bay."""
        x, z = self.frames_x[frame] - CHORD / 2 - GUSSET[0] - TOOL, self.high_z
        side = 1 if at_left else -1
        girder_y = self.girders_y[goal_bay if at_left else goal_bay + 1]
        y = girder_y + side * (WEB_THICKNESS / 2 + GUSSET[1] / 2)
        half_width = self.girders_y[-1] + 1
        problem.bounds = (-self.panel, -half_width, 0.5), (self.panel, half_width, self.web_high)
        start_y = (self.girders_y[start_bay] + self.girders_y[start_bay + 1]) / 2
        problem.start = {"x_m": self.panel / 2, "y_m": start_y, "z_m": self.low_z, "yaw_deg": 180}
        problem.start["joints_deg"] = (-90, 150)
        problem.goal = one(tool_at((x, y, z), (1, -side, 0), 20))


def source_of_girders(problem, bay):
    problem.source(
        "FHWA NHI-04-041, a design example of a steel girder bridge: five girders "
        f"{number(bay.spacing)} m apart (example: 9'-9\"), webs {number(bay.web)} m high (54\") and 1/2\" thick, flanges "
        f"{number(bay.flange)} m wide (14\"), the lower one 7/8\" thick; 3 1/2\" from the web to the slab, a slab of "
        "8 1/2\" that ends 3'-11 1/2\" beyond the outer girders."
    )


def add_road(problem):
    problem.source("Height over the road: 16 ft, the least of AASHTO for interstates.")
    problem.between("road", (-20, -20, -1), (20, 20, 0))


def new_problem(name, about, description):
    return Problem(name, about, description, "hexa960_arm2", "girder_bay.py")


def with_boxes(name="girder_bay", random=None):
    bay = Bay(DESIGN_EXAMPLE if random is None else drawn_sizes(random))
    about = [
        "A gusset of a cross frame between the girders of a bridge.",
        "The vehicle starts between two girders, with its arm folded. It has to leave that bay downwards, pass under the "
        "girders and rise into another bay, where the deck and the flanges pull at its rotors. There the tool points at "
        "the upper gusset of a cross frame, out of the bay.",
    ]
    if random is not None:
        about.append("Spacing, depth, flanges, panel, start and goal are drawn at random.")
    problem = new_problem(name, about, "Point at a gusset of a cross frame, from another bay of a girder bridge.")
    add_road(problem)
    source_of_girders(problem, bay)
    bay.add_all(problem)
    if random is None:
        bay.set_task(problem, start_bay=0, goal_bay=2, at_left=False, frame=1)
    else:
        start_bay = random.below(GIRDERS - 1)
        goal_bay = (start_bay + 1 + random.below(GIRDERS - 2)) % (GIRDERS - 1)
        bay.set_task(problem, start_bay, goal_bay, at_left=random.below(2) == 0, frame=1 + random.below(2))
    return problem


def box_corner(solid, signs):
    """A corner of a box, turned about x as obstacles are. @param signs of the corner along each axis"""
    _, size, center, (roll_deg, _, _) = solid
    x, y, z = (sign * s / 2 for sign, s in zip(signs, size))
    c, s = math.cos(math.radians(roll_deg)), math.sin(math.radians(roll_deg))
    return center[0] + x, center[1] + c * y - s * z, center[2] + s * y + c * z


def triangles_of(solid):
    """The twelve triangles of a box."""
    outline = [(-1, -1), (1, -1), (1, 1), (-1, 1)]
    return prism(
        [outline],
        outline,
        lambda c: box_corner(solid, (-1, *c)),
        lambda c: box_corner(solid, (1, *c)),
    )


def cell_of(coordinate):
    return MIDDLE + math.floor(round(coordinate / RESOLUTION, 6))


def cells_of(solid):
    """The cells in which a box has points; of a turned one a grid of points, a third of a cell apart, tells."""
    _, size, _, rpy_deg = solid
    if not any(rpy_deg):
        corners = box_corner(solid, (-1, -1, -1)), box_corner(solid, (1, 1, 1))
        ranges = [range(cell_of(low), cell_of(high) + 1) for low, high in zip(*corners)]
        return set(itertools.product(*ranges))
    counts = [math.ceil(3 * s / RESOLUTION) for s in size]
    grid = itertools.product(*(range(count + 1) for count in counts))
    places = (box_corner(solid, [2 * n / count - 1 for n, count in zip(at, counts)]) for at in grid)
    return {tuple(cell_of(a) for a in place) for place in places}


def of_a_survey(boxes, kind):
    """The same bay as one obstacle from a file. @param boxes the problem with boxes   @param kind mesh or octomap"""
    bay = Bay(DESIGN_EXAMPLE)
    bridge = [solid for solid in boxes.solids if solid[0] != "road"]
    form = "a mesh" if kind == "mesh" else f"an octree with cells of {number(RESOLUTION)} m"
    about = [f"girder_bay.yaml with the bridge as one obstacle, {form}."]
    problem = new_problem(f"girder_bay_{kind}", about, f"The girder bay as {form}.")
    add_road(problem)
    source_of_girders(problem, bay)
    if kind == "mesh":
        triangles = [triangle for solid in bridge for triangle in triangles_of(solid)]
        content = binary_stl(triangles, "girder bay, metres; made by make_space_problems.py")
        problem.mesh("bridge", "meshes/girder_bay.stl", content)
    else:
        cells = set().union(*(cells_of(solid) for solid in bridge))
        content = octomap(cells, RESOLUTION, "girder bay; made by make_space_problems.py")
        problem.octomap("bridge", "maps/girder_bay.bt", content)
    bay.set_task(problem, start_bay=0, goal_bay=2, at_left=False, frame=1)
    return problem


def problems():
    boxes = with_boxes()
    return [boxes, of_a_survey(boxes, "mesh"), of_a_survey(boxes, "octomap")]
