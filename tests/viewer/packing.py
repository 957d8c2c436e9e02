"""The packed parts of a page's data, written independently of the program that reads and the one that writes them."""

import base64
import json
import zlib

import numpy as np


def packed(data):
    return base64.b64encode(zlib.compress(data, 9)).decode()


def flight_json(names, columns):
    """`columns`: arrays of doubles, as many as names."""
    rows = len(columns[0]) if columns else 0
    bits = [np.ascontiguousarray(column, dtype="<f8").view("<u8") for column in columns]
    same_as, stored = [], []
    for index, column in enumerate(bits):
        twin = next((i for i in range(index) if same_as[i] < 0 and np.array_equal(bits[i], column)), -1)
        same_as.append(twin)
        if twin < 0:
            changed = column.copy()
            changed[1:] ^= column[:-1]
            stored.append(changed.view(np.uint8).reshape(rows, 8).T.tobytes())
    return {"rows": rows, "columns": list(names), "same_as": same_as, "data": packed(b"".join(stored))}


def tree_json(nodes, parents):
    """`nodes`: n x 3 of x, z, arm."""
    coordinates = np.asarray(nodes, dtype="<f4").T.tobytes()
    return {"nodes": len(parents), "data": packed(coordinates + np.asarray(parents, dtype="<i4").tobytes())}


def script_json(report):
    """JSON that cannot end the script element it stands in."""
    text = json.dumps(report, ensure_ascii=False)
    for character in "<>&\u2028\u2029":
        text = text.replace(character, "\\u%04x" % ord(character))
    return text


def write_page(template, report, page):
    with open(template, encoding="utf-8") as file:
        text = file.read()
    placeholder = '{"downwash":"nothing"}'
    assert text.count(placeholder) == 1
    with open(page, "w", encoding="utf-8") as file:
        file.write(text.replace(placeholder, script_json(report)))
