"""Closed meshes that several problems have."""

import math

from .geometry_files import prism


def arc(radius, from_deg, to_deg, steps, center=(0, 0)):
    """Points of a circle, counter-clockwise, both ends included."""
    angles = [math.radians(from_deg + (to_deg - from_deg) * i / steps) for i in range(steps + 1)]
    return [(center[0] + radius * math.cos(a), center[1] + radius * math.sin(a)) for a in angles]


def band(inner, outer, place_low, place_high):
    """The solid between two lines of as many points each, drawn out from one plane to another. Seen against that way
    both run counter-clockwise, the inner one to the left of the outer one."""
    quads = [[inner[i], outer[i], outer[i + 1], inner[i + 1]] for i in range(len(inner) - 1)]
    return prism(quads, outer + inner[::-1], place_low, place_high)


def along_skewed_x(x, skew_deg):
    """Places of points (y, z) in an upright plane at x that is turned by an angle about the vertical."""
    slope = math.tan(math.radians(skew_deg))
    return lambda point: (x + slope * point[0], *point)
