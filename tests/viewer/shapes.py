"""Solids of the page's data: what the plane of motion cuts of them, and their shadow."""

import math


def rectangle(x_low, x_high, z_low, z_high):
    return [[x_low, z_low], [x_high, z_low], [x_high, z_high], [x_low, z_high]]


def box(name, size_m, center_m):
    """A box along the axes of the plane's frame."""
    (a, b, c), (x, y, z) = size_m, center_m
    ring = rectangle(x - a / 2, x + a / 2, z - c / 2, z + c / 2)
    return {"name": name, "kind": "box", "section": [ring] if abs(y) < b / 2 else [], "projection": [ring],
            "solid": {"box": {"size_m": list(size_m), "center_m": list(center_m),
                              "axes": [[1, 0, 0], [0, 1, 0], [0, 0, 1]]}}}


def circle(x, z, radius, corners=64):
    turn = 2 * math.pi / corners
    return [[x + radius * math.cos(i * turn), z + radius * math.sin(i * turn)] for i in range(corners)]


def pipe(name, radius_m, length_m, center_m):
    """A cylinder across the plane of motion."""
    ring = circle(center_m[0], center_m[2], radius_m)
    return {"name": name, "kind": "cylinder", "section": [ring] if abs(center_m[1]) < length_m / 2 else [],
            "projection": [ring],
            "solid": {"cylinder": {"radius_m": radius_m, "length_m": length_m, "center_m": list(center_m),
                                   "axis": [0, 1, 0]}}}


def ball(name, radius_m, center_m):
    x, y, z = center_m
    section = [circle(x, z, math.sqrt(radius_m**2 - y**2))] if abs(y) < radius_m else []
    return {"name": name, "kind": "sphere", "section": section, "projection": [circle(x, z, radius_m)],
            "solid": {"sphere": {"radius_m": radius_m, "center_m": list(center_m)}}}


def wedge(name, corners, half_width, pack):
    """A prism of triangles over a triangle in the plane of motion."""
    import numpy as np

    vertices = [[x, y, z] for y in (-half_width, half_width) for x, z in corners]
    faces = [[0, 2, 1], [3, 4, 5], [0, 1, 4], [0, 4, 3], [1, 2, 5], [1, 5, 4], [2, 0, 3], [2, 3, 5]]
    return {"name": name, "kind": "mesh", "section": [corners], "projection": [corners],
            "solid": {"triangles": {"vertices": pack(np.asarray(vertices, dtype="<f4").tobytes()),
                                    "indices": pack(np.asarray(faces, dtype="<u4").tobytes())}}}
