#!/usr/bin/env python3
"""Makes problems/meshes/girder.stl and problems/maps/pier.bt, the same bytes every time.

Run it anywhere: python3 problems/make_geometry.py. It needs nothing but Python 3.
"""

import math
import pathlib
import struct

HERE = pathlib.Path(__file__).parent


# --- a plate girder as a closed triangle mesh, in millimetres ---------------------------------------------------------
# Along x, 12 m long; the origin is in the middle of the top of the upper flange. 1200 mm deep, flanges 500 x 40, web 20,
# a pair of stiffeners 15 mm thick every 2 m.

LENGTH, DEPTH, FLANGE, THICKNESS, WEB = 12000, 1200, 500, 40, 20


def convex_face(corners):
    """A convex polygon as a fan of triangles."""
    return [(corners[0], corners[i], corners[i + 1]) for i in range(1, len(corners) - 1)]


def prism(polygons, outline, x_low, x_high):
    """The solid between two upright planes: its ends made of convex polygons, its sides of the outline (y, z), both
    counter-clockwise seen against the x axis."""
    triangles = []
    for polygon in polygons:
        triangles += convex_face([(x_high, *c) for c in polygon])
        triangles += [(a, c, b) for a, b, c in convex_face([(x_low, *c) for c in polygon])]
    for a, b in zip(outline, outline[1:] + outline[:1]):
        triangles += convex_face([(x_low, *a), (x_low, *b), (x_high, *b), (x_high, *a)])
    return triangles


def girder():
    f, w, inner = FLANGE / 2, WEB / 2, DEPTH - THICKNESS
    lower = [(-f, -DEPTH), (f, -DEPTH), (f, -inner), (w, -inner), (-w, -inner), (-f, -inner)]
    web = [(-w, -inner), (w, -inner), (w, -THICKNESS), (-w, -THICKNESS)]
    upper = [(-f, -THICKNESS), (-w, -THICKNESS), (w, -THICKNESS), (f, -THICKNESS), (f, 0), (-f, 0)]
    upper = upper[4:] + upper[:4]  # fans must not begin on the straight edge with the web's corners
    outline = lower[:4] + [(w, -THICKNESS), (f, -THICKNESS), (f, 0), (-f, 0), (-f, -THICKNESS), (-w, -THICKNESS)]
    outline += lower[4:]
    triangles = prism([lower, web, upper], outline, -LENGTH / 2, LENGTH / 2)
    for middle in range(-4000, 4001, 2000):
        for side in (-1, 1):
            # 5 mm into web and flanges, so that no two solids share a corner.
            low, high = sorted((side * (w - 5), side * (f - 30)))
            plate = [(low, -inner - 5), (high, -inner - 5), (high, 5 - THICKNESS), (low, 5 - THICKNESS)]
            triangles += prism([plate], plate, middle - 7.5, middle + 7.5)
    return triangles


def binary_stl(triangles):
    out = b"plate girder, millimetres; made by make_geometry.py".ljust(80) + struct.pack("<I", len(triangles))
    for a, b, c in triangles:
        u = [b[i] - a[i] for i in range(3)]
        v = [c[i] - a[i] for i in range(3)]
        normal = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
        size = math.sqrt(sum(x * x for x in normal))
        out += struct.pack("<12fH", *(x / size for x in normal), *a, *b, *c, 0)
    return out


# --- a scanned pier as an octree --------------------------------------------------------------------------------------
# A round pier, 1.6 m across and 10 m high, that widens to 2.4 m at its head. The scan saw its surface only, 0.1 m voxels
# two deep, some centimetres rough. The origin is the middle of its foot.

RESOLUTION = 0.1
MIDDLE = 32768  # of the 65536 voxels along each axis


def pier_voxels():
    state = 1
    voxels = set()
    for k in range(100):
        radius = 0.8 + 0.4 * max(0.0, (k - 89) / 10)
        for i in range(-14, 14):
            for j in range(-14, 14):
                state = (1103515245 * state + 12345) % 2**31
                rough = 0.05 * (state / 2**31 - 0.5)
                distance = math.hypot((i + 0.5) * RESOLUTION, (j + 0.5) * RESOLUTION)
                if radius + rough - 0.2 <= distance <= radius + rough or (k == 99 and distance <= radius + rough):
                    voxels.add((MIDDLE + i, MIDDLE + j, MIDDLE + k))
    return voxels


FULL = "occupied"


def tree_of(voxels, low, size):
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


def octomap(root):
    """The file: two bits a child (occupied 2, follows 3), depth first."""
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

    write(root)
    header = "# Octomap OcTree binary file\n# a scanned pier; made by make_geometry.py\n"
    return (header + f"id OcTree\nsize {nodes}\nres {RESOLUTION}\ndata\n").encode() + stream


(HERE / "meshes" / "girder.stl").write_bytes(binary_stl(girder()))
(HERE / "maps" / "pier.bt").write_bytes(octomap(tree_of(pier_voxels(), [0, 0, 0], 65536)))
