"""Files as other programs write them: tables of every dialect, rounded and holed meshes, octrees with colours."""

import random
import struct


def deck(corners, low, high, offset=(0, 0)) -> str:
    """OBJ of a plate over a polygon, its lower and upper side one face each."""
    count = len(corners)
    text = "".join(f"v {x + offset[0]} {y + offset[1]} {z}\n" for z in (low, high) for x, y in corners)
    text += "f " + " ".join(str(count - i) for i in range(count)) + "\n"
    text += "f " + " ".join(str(count + 1 + i) for i in range(count)) + "\n"
    for i in range(count):
        after = (i + 1) % count
        text += f"f {i + 1} {after + 1} {after + count + 1} {i + count + 1}\n"
    return text


def noisy_stl(data: bytes, draw: random.Random, noise: float, missing=0, doubled=0, turned=0) -> bytes:
    """A binary STL file whose corners are off by some noise in its unit, and some of whose triangles are missing, there twice or turned."""
    triangles = [data[84 + 50 * i:134 + 50 * i] for i in range(struct.unpack("<I", data[80:84])[0])]
    draw.shuffle(triangles)
    triangles = triangles[missing:] + triangles[missing:missing + doubled]
    changed = []
    for i, triangle in enumerate(triangles):
        corners = [x + draw.uniform(-noise, noise) for x in struct.unpack("<9f", triangle[12:48])]
        if i < turned:
            corners = corners[3:6] + corners[0:3] + corners[6:9]
        changed.append(triangle[:12] + struct.pack("<9f", *corners) + triangle[48:])
    return data[:80] + struct.pack("<I", len(changed)) + b"".join(changed)


def color_octree(draw: random.Random) -> bytes:
    """A full octree of voxels of half a metre with colours, about half of them occupied."""
    nodes = []

    def add(depth: int):
        children = draw.randrange(1, 256) if 13 <= depth < 16 else 1 << draw.randrange(8) if depth < 13 else 0
        nodes.append(struct.pack("<f", draw.choice([0.85, -0.4])) + draw.randbytes(3) + bytes([children]))
        for child in range(8):
            if children >> child & 1:
                add(depth + 1)

    add(0)
    return b"# Octomap OcTree file\nid ColorOcTree\nsize %d\nres 0.5\ndata\n" % len(nodes) + b"".join(nodes)


def written(text: str, draw: random.Random) -> bytes:
    """A plain CSV text, with decimal points and a line of names, in a dialect and an encoding of some other program."""
    separator = draw.choice([",", ";", "\t", ", ", " ; "])
    is_quoted = draw.random() < 0.5
    has_comma = draw.random() < 0.5 and (is_quoted or separator[0] != ",")
    has_empty_column = draw.random() < 0.3
    has_index = draw.random() < 0.3
    lines = []
    row = -1
    for line in text.splitlines():
        if line.startswith("#"):
            lines.append(line)
            continue
        cells = line.split(",")
        if row >= 0 and has_comma:
            cells = [cell.replace(".", ",") for cell in cells]
        if has_index:
            cells = ["" if row < 0 else str(row)] + cells
        row += 1
        cells += [""] * has_empty_column
        lines.append(separator.join(f'"{cell}"' if is_quoted else cell for cell in cells))
    end = draw.choice(["\n", "\r\n", "\r"])
    encoding = draw.choice(["utf-8", "utf-8-sig", "utf-16", "utf-16-be", "utf-16-le"])
    return (end.join(lines) + draw.choice(["", end])).encode(encoding)
