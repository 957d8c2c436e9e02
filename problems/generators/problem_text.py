"""A problem in space, written as its file: obstacles with the source of their sizes, start and goals."""

import math
import textwrap

# Of goals in space, as in the problems of the plane. A vehicle that hovers still misses 5 cm in one of twenty worlds: the
# offsets of the scene, the attitude and the joints add up over the arm.
TOLERANCE_M = 0.1


def number(value):
    """To a tenth of a millimetre."""
    text = f"{value:.4f}".rstrip("0").rstrip(".")
    return "0" if text in ("-0", "") else text


def vector(values):
    return "[" + ", ".join(number(value) for value in values) + "]"


def fields(values):
    """A map on one line: "{x_m: 1, yaw_deg: 90}". Numbers and vectors are written; everything else stands as it is."""

    def written(value):
        if isinstance(value, bool):
            return "true" if value else "false"
        if isinstance(value, (int, float)):
            return number(value)
        if isinstance(value, (list, tuple)):
            return vector(value)
        if isinstance(value, dict):
            return fields(value)
        return str(value)

    return "{" + ", ".join(f"{key}: {written(value)}" for key, value in values.items()) + "}"


def comment(text, indent=""):
    return [f"{indent}# {line}" for line in textwrap.wrap(text, 118 - len(indent))]


class Problem:
    """The parts of a problem file, in the order in which they are added."""

    def __init__(self, name, about, description, robot, made_by):
        """@param about paragraphs of the comment at the top   @param robot name of a file of robots/
        @param made_by name of the file of generators/
        """
        self.name, self.about, self.description = name, about, description
        self.robot, self.made_by = robot, made_by
        self.solids = []  # (name, size, center, rpy_deg) of each box, for meshes and octrees of the same
        self.lines = []
        self.bounds = self.start = None
        self.goal = []
        self.files = {}  # of geometry, by path below problems/: bytes

    def source(self, text):
        """A comment over the obstacles that follow: where their sizes come from."""
        self.lines += comment(text, "    ")

    def _obstacle(self, name, kind, values):
        self.lines.append(f"    - {{name: {name}, {kind}: {fields(values)}}}")

    def box(self, name, size, center, rpy_deg=(0, 0, 0)):
        self.solids.append((name, tuple(size), tuple(center), tuple(rpy_deg)))
        values = {"size_m": size, "center_m": center}
        if any(rpy_deg):
            values["rpy_deg"] = rpy_deg
        self._obstacle(name, "box", values)

    def between(self, name, low, high):
        """A box from its low corner to its high one."""
        self.box(name, [h - l for l, h in zip(low, high)], [(l + h) / 2 for l, h in zip(low, high)])

    def cylinder(self, name, radius, length, center, axis=(0, 0, 1)):
        values = {"radius_m": radius, "length_m": length, "center_m": center}
        if tuple(axis) != (0, 0, 1):
            values["axis"] = axis
        self._obstacle(name, "cylinder", values)

    def rod(self, name, radius, start, end):
        """A cylinder from one point to another."""
        way = [e - s for s, e in zip(start, end)]
        length = math.sqrt(sum(w * w for w in way))
        self.cylinder(name, radius, length, [(s + e) / 2 for s, e in zip(start, end)], [w / length for w in way])

    def mesh(self, name, file, content):
        """A mesh in metres where it stands. @param file below problems/   @param content its bytes"""
        self.files[file] = content
        self._obstacle(name, "mesh", {"file": "../" + file})

    def octomap(self, name, file, content):
        self.files[file] = content
        self._obstacle(name, "octomap", {"file": "../" + file})

    def text(self):
        out = []
        for paragraph in (*self.about, f"problems/make_space_problems.py makes this file, by generators/{self.made_by}."):
            out += ["#"] * (out != []) + comment(paragraph)
        out += ["schema: downwash/problem/v1", f"name: {self.name}", f"description: {self.description}"]
        out += [f"robot: ../robots/{self.robot}.yaml", "environment:"]
        low, high = self.bounds
        bounds = {f"{axis}_m": (l, h) for axis, l, h in zip("xyz", low, high)}
        out += [f"  bounds: {fields(bounds)}", "  obstacles:", *self.lines]
        out += ["uncertainty: {}", f"start: {fields(self.start)}", "goal:", *self.goal]
        return "\n".join(out) + "\n"


def goal(kind, values, hold_s=5):
    """The lines of one goal."""
    return [f"{kind}: {fields(values)}", f"hold_s: {number(hold_s)}"]


def tool_at(position, direction, direction_tolerance_deg=15):
    """The goal of a tool around a point."""
    values = {"position_m": position, "tolerance_m": TOLERANCE_M, "direction": direction}
    return goal("end_effector", values | {"direction_tolerance_deg": direction_tolerance_deg})


def view_of(target, nearest, farthest, direction, cone_deg):
    """The goal of a camera."""
    values = {"target_m": target, "distance_m": (nearest, farthest), "direction": direction}
    return goal("camera", values | {"view_cone_deg": cone_deg})


def one(lines):
    """The goal of a problem with one."""
    return [f"  {line}" for line in lines]


def listed(goals, indent="  "):
    """Goals below each other: in turn or, behind a key, any of them or in any order."""
    out = []
    for lines in goals:
        out.append(f"{indent}- {lines[0]}")
        out += [f"{indent}  {line}" for line in lines[1:]]
    return out


def mission(targets, start, energy_budget):
    """Targets in any order, then back to the start. @param energy_budget of the battery in joules"""
    back = fields(start | {"hold_s": 5})
    return ["  in_any_order:", *listed(targets, "    "), f"  return_to: {back}", f"  energy_budget_j: {energy_budget}"]
