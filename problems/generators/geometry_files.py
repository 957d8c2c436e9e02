"""Solids of triangles as STL and sets of voxels as OctoMap, the same bytes every time."""

import math
import struct


def convex_face(corners):
    """A convex polygon as a fan of triangles."""
    return [(corners[0], corners[i], corners[i + 1]) for i in range(1, len(corners) - 1)]


def prism(polygons, outline, place_low, place_high):
    """The solid between two planes: its ends made of convex polygons, its sides of the outline. Polygons and outline
    are points (a, b), counter-clockwise seen against the way from the low end to the high one.

    @param place_low,place_high make a place of a point (a, b) at that end
    """
    triangles = []
    for polygon in polygons:
        triangles += convex_face([place_high(c) for c in polygon])
        triangles += [(a, c, b) for a, b, c in convex_face([place_low(c) for c in polygon])]
    for a, b in zip(outline, outline[1:] + outline[:1]):
        triangles += convex_face([place_low(a), place_low(b), place_high(b), place_high(a)])
    return triangles


def along_x(x):
    """Places of points (y, z) in the upright plane at x."""
    return lambda point: (x, *point)


def along_z(z):
    """Places of points (x, y) in the level plane at z."""
    return lambda point: (*point, z)


def binary_stl(triangles, comment):
    out = comment.encode().ljust(80) + struct.pack("<I", len(triangles))
    for a, b, c in triangles:
        u = [b[i] - a[i] for i in range(3)]
        v = [c[i] - a[i] for i in range(3)]
        normal = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
        size = math.sqrt(sum(x * x for x in normal))
        out += struct.pack("<12fH", *(x / size for x in normal), *a, *b, *c, 0)
    return out


MIDDLE = 32768  # of the 65536 voxels along each axis: the voxel whose low corner is the origin
FULL = "occupied"


def tree_of(voxels, low=(0, 0, 0), size=2 * MIDDLE):
    """None where nothing is occupied, FULL where everything is, else the eight children."""
    if not voxels:
        return None
    if size == 1:
        return FULL
    half = size // 2
    parts = [set() for _ in range(8)]
    for voxel in voxels:
        parts[sum((voxel[axis] >= low[axis] + half) << axis for axis in range(3))].add(voxel)
    children = [tree_of(part, [low[a] + half * (n >> a & 1) for a in range(3)], half) for n, part in enumerate(parts)]
    return FULL if children == [FULL] * 8 else children


def octomap(voxels, resolution_m, comment):
    """The file of a set of voxels: two bits a child (occupied 2, follows 3), depth first."""
    nodes, stream = 1, b""

    def write(children):
        nonlocal nodes, stream
        bits = 0
        for n, child in enumerate(children):
            nodes += child is not None
            bits |= (0 if child is None else 2 if child == FULL else 3) << 2 * n
        stream += struct.pack("<H", bits)
        for child in children:
            if isinstance(child, list):
                write(child)

    write(tree_of(voxels))
    header = f"# Octomap OcTree binary file\n# {comment}\nid OcTree\nsize {nodes}\nres {resolution_m}\ndata\n"
    return header.encode() + stream
