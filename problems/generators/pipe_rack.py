"""A pipe rack of a plant: cross it between its tiers, to a flange."""

from .problem_text import TOLERANCE_M, Problem, goal, number, one

WIDTH, BENT = 6.0, 6.0
TIERS = 4.5, 6.5  # tops of the beams
STEEL = 0.3  # HE 300 B: 300 x 300 mm
TIE = 0.2  # HE 200 B
# Outside diameters of ASME B36.10M by nominal size, and of class 150 flanges by ASME B16.5.
PIPES = {100: 0.1143, 150: 0.1683, 200: 0.2191, 250: 0.2730, 300: 0.3239, 400: 0.4064, 600: 0.6096}
FLANGES = {100: 0.229, 150: 0.279, 200: 0.343, 250: 0.406, 300: 0.483, 400: 0.597, 600: 0.813}
FLANGE_PAIR = 0.064  # two flanges of 30.2 mm and a gasket, as of size 300
GAP = 0.025  # between a flange and the next line, at least
# Lines of both tiers from one column to the other; None is 20 % of the width, left for future ones.
LOWER = (600, 400, 300, 200, 100, None, 300, 150)
UPPER = (250, 150, None, 200, 100, 100)
TARGET = 6  # of the lower tier
TOOL = 0.1  # over the flange


def places_across(lines, width):
    """Middles of lines in a row, evenly apart between the columns with room for their flanges."""
    inside = width - STEEL
    spare = 0.2 * width if None in lines else 0
    taken = sum(FLANGES[size] for size in lines if size) + spare
    gap = (inside - taken) / (len(lines) + 1)
    if gap < GAP:
        raise ValueError(f"{lines} do not fit into {width} m")
    places, y = [], -inside / 2 + gap
    for size in lines:
        room = FLANGES[size] if size else spare
        places.append(y + room / 2)
        y += room + gap
    return places


def drawn_lines(random, count):
    """Sizes of lines with the space for future ones among them."""
    sizes = sorted(PIPES)
    lines = [sizes[random.below(len(sizes))] for _ in range(count)]
    lines.insert(random.below(count + 1), None)
    return tuple(lines)


def add_frames(problem, width, bent, tiers):
    for i, x in enumerate((-bent, 0.0, bent), 1):
        for side, sign in (("right", -1), ("left", 1)):
            problem.between(
                f"bent_{i}_{side}_column",
                (x - STEEL / 2, sign * width / 2 - STEEL / 2, 0),
                (x + STEEL / 2, sign * width / 2 + STEEL / 2, tiers[1]),
            )
        for tier, top in zip(("lower", "upper"), tiers):
            half = (width - STEEL) / 2
            problem.between(f"bent_{i}_{tier}_beam", (x - STEEL / 2, -half, top - STEEL), (x + STEEL / 2, half, top))
    for side, sign in (("right", -1), ("left", 1)):
        size, z = (2 * bent, TIE, TIE), sum(tiers) / 2
        problem.box(f"{side}_tie", size, (0, sign * width / 2, z))


def add_lines(problem, tier, lines, places, top, half_length):
    for i, (size, y) in enumerate(zip(lines, places), 1):
        if size:
            radius = PIPES[size] / 2
            problem.cylinder(f"{tier}_line_{i}", radius, 2 * half_length, (0, y, top + radius), (1, 0, 0))


def make(name="pipe_rack", random=None):
    width, bent, tiers, lower, upper, target = WIDTH, BENT, TIERS, LOWER, UPPER, TARGET
    if random is not None:
        width = random.uniform(6, 8)
        bent = random.uniform(5, 7)
        first = random.uniform(4, 5)
        tiers = first, first + random.uniform(1.8, 2.5)
        lower, upper = drawn_lines(random, 5), drawn_lines(random, 5)
        chosen = random.below(5)
        target = [i for i, size in enumerate(lower) if size][chosen]
    about = [
        "A flange between the tiers of a pipe rack.",
        "The vehicle starts beside the rack, near the ground. It has to fly in between the tiers, past a tie beam, and "
        "cross over the lines of the lower tier below those of the upper one. The gripper ends upright over a flange, "
        "across its line.",
    ]
    if random is not None:
        about.append("Width, bents, tiers, lines and flange are drawn at random.")
    description = "Cross a pipe rack between its tiers, to a flange."
    problem = Problem(name, about, description, "hexa370_arm3", "pipe_rack.py")
    problem.between("ground", (-20, -20, -1), (20, 20, 0))
    problem.source(
        f"A rack {number(width)} m wide with bents every {number(bent)} m and beams at {number(tiers[0])} and "
        f"{number(tiers[1])} m. Usual (pipingengineer.org): 6, 8 or 10 m wide and 4.5 m under the first tier; bents "
        "every 6 m. Columns and beams: HE 300 B, 300 x 300 mm (EN 10365). Ties half-way between the tiers: HE 200 B "
        "(assumed)."
    )
    add_frames(problem, width, bent, tiers)
    problem.source(
        f"Lower tier: nominal sizes {sizes_text(lower)}, outside diameters of ASME B36.10M; apart by their class 150 "
        "flanges (ASME B16.5) and equal gaps, with a fifth of the width left for future lines."
    )
    lower_y, upper_y = places_across(lower, width), places_across(upper, width)
    add_lines(problem, "lower", lower, lower_y, tiers[0], 1.25 * bent)
    size, x, y = lower[target], bent / 3, lower_y[target]
    z = tiers[0] + PIPES[size] / 2
    problem.source("A pair of flanges of that line: ASME B16.5, class 150, two of 30 mm with a gasket.")
    problem.cylinder("flange", FLANGES[size] / 2, FLANGE_PAIR, (x, y, z), (1, 0, 0))
    problem.source(f"Upper tier: nominal sizes {sizes_text(upper)}, likewise.")
    add_lines(problem, "upper", upper, upper_y, tiers[1], 1.25 * bent)
    reach = width / 2 + 3
    problem.bounds = (-bent, -reach, 0.5), (bent, reach, tiers[1] + 2)
    near = -1 if y > 0 else 1
    problem.start = {"x_m": -bent / 2, "y_m": near * (width / 2 + 2), "z_m": 1.5, "yaw_deg": -near * 90}
    at = x, y, z + FLANGES[size] / 2 + TOOL
    pose = {"position_m": at, "rpy_deg": (0, 0, -near * 90), "tolerance_m": TOLERANCE_M, "tolerance_deg": 10}
    problem.goal = one(goal("pose", pose))
    return problem


def sizes_text(lines):
    return ", ".join(str(size) for size in lines if size)


def problems():
    return [make()]
