"""Damage to texts and bytes, drawn from a generator that is passed in."""

import random

# What a user may put where a value is expected, and some things that nobody should.
HOSTILE_VALUES = [
    "nan", ".nan", "inf", "-.inf", "-1", "0", "-0.0", "1e308", "-1e308", "1e-308", "1e400", "4294967296", "9" * 400,
    "''", "[]", "{}", "null", "~", "true", "[[[[[[]]]]]]", "{a: {a: {a: {}}}}", "0x10", "1,5", "5 m", "!!str 1", "*a", "&a b",
    "'\\0'", "\"\\u0000\"", "\u202e\U0001f681", "../../../../etc/passwd", "/dev/zero", ".", "a" * 10000, "'" + "\n" * 50 + "'",
    "]]>", "</script><script>", "%s%n", "\t", "- - -", "? :", "|", ">",
]


def flipped(data: bytes, draw: random.Random) -> bytes:
    """The same with a few of its bits changed."""
    changed = bytearray(data)
    for _ in range(draw.choice([1, 1, 2, 8])):
        if changed:
            changed[draw.randrange(len(changed))] ^= 1 << draw.randrange(8)
    return bytes(changed)


def cut(data: bytes, draw: random.Random) -> bytes:
    """The same up to some byte."""
    return data[: draw.randrange(len(data) + 1)]


def spliced(data: bytes, draw: random.Random) -> bytes:
    """The same with a part repeated, left out or replaced by noise."""
    begin, end = sorted(draw.randrange(len(data) + 1) for _ in range(2))
    part = draw.choice([b"", data[begin:end] * 3, draw.randbytes(min(end - begin, 64))])
    return data[:begin] + part + data[end:]


def with_hostile_value(text: str, draw: random.Random) -> str:
    """A text of lines "key: value" with one value replaced, or one line moved, doubled or left out."""
    lines = text.split("\n")
    at = draw.randrange(len(lines))
    kind = draw.randrange(6)
    if kind < 3:
        keyed = [i for i, line in enumerate(lines) if ":" in line and not line.lstrip().startswith("#")] or [at]
        at = draw.choice(keyed)
        pieces = lines[at].split(":")
        piece = draw.randrange(1, len(pieces)) if len(pieces) > 1 else 0
        tail = pieces[piece][len(pieces[piece].rstrip(",]}")):] if draw.random() < 0.7 else ""
        pieces[piece] = " " + draw.choice(HOSTILE_VALUES) + tail
        lines[at] = ":".join(pieces)
    elif kind == 3:
        lines.insert(draw.randrange(len(lines)), lines[at])
    elif kind == 4:
        lines.insert(draw.randrange(len(lines)), lines.pop(at))
    else:
        lines.pop(at)
    return "\n".join(lines)


def damaged(data: bytes, draw: random.Random) -> bytes:
    """Any of these, the last one for texts only."""
    kind = draw.randrange(5)
    if kind >= 3:
        try:
            return with_hostile_value(data.decode(), draw).encode(errors="surrogatepass")
        except UnicodeError:
            pass
    return [flipped, cut, spliced][kind % 3](data, draw)
