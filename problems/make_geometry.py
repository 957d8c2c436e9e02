#!/usr/bin/env python3
"""Makes problems/meshes/girder.stl and problems/maps/pier.bt, the same bytes every time.

Run it anywhere: python3 problems/make_geometry.py. With --check it compares and writes nothing. It needs nothing but
Python 3.
"""

import math

from generators.geometry_files import MIDDLE, along_x, binary_stl, octomap, prism
from generators.shipped_files import check_or_write


# --- a plate girder as a closed triangle mesh, in millimetres ---------------------------------------------------------
# Along x, 12 m long; the origin is in the middle of the top of the upper flange. 1200 mm deep, flanges 500 x 40, web 20,
# a pair of stiffeners 15 mm thick every 2 m.

LENGTH, DEPTH, FLANGE, THICKNESS, WEB = 12000, 1200, 500, 40, 20


def girder():
    f, w, inner = FLANGE / 2, WEB / 2, DEPTH - THICKNESS
    lower = [(-f, -DEPTH), (f, -DEPTH), (f, -inner), (w, -inner), (-w, -inner), (-f, -inner)]
    web = [(-w, -inner), (w, -inner), (w, -THICKNESS), (-w, -THICKNESS)]
    upper = [(-f, -THICKNESS), (-w, -THICKNESS), (w, -THICKNESS), (f, -THICKNESS), (f, 0), (-f, 0)]
    upper = upper[4:] + upper[:4]  # fans must not begin on the straight edge with the web's corners
    outline = lower[:4] + [(w, -THICKNESS), (f, -THICKNESS), (f, 0), (-f, 0), (-f, -THICKNESS), (-w, -THICKNESS)]
    outline += lower[4:]
    triangles = prism([lower, web, upper], outline, along_x(-LENGTH / 2), along_x(LENGTH / 2))
    for middle in range(-4000, 4001, 2000):
        for side in (-1, 1):
            # 5 mm into web and flanges, so that no two solids share a corner.
            low, high = sorted((side * (w - 5), side * (f - 30)))
            plate = [(low, -inner - 5), (high, -inner - 5), (high, 5 - THICKNESS), (low, 5 - THICKNESS)]
            triangles += prism([plate], plate, along_x(middle - 7.5), along_x(middle + 7.5))
    return triangles


# --- a scanned pier as an octree --------------------------------------------------------------------------------------
# A round pier, 1.6 m across and 10 m high, that widens to 2.4 m at its head. The scan saw its surface only, 0.1 m voxels
# two deep, some centimetres rough. The origin is the middle of its foot.

RESOLUTION = 0.1


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


if __name__ == "__main__":
    check_or_write(
        {
            "meshes/girder.stl": binary_stl(girder(), "plate girder, millimetres; made by make_geometry.py"),
            "maps/pier.bt": octomap(pier_voxels(), RESOLUTION, "a scanned pier; made by make_geometry.py"),
        }
    )
