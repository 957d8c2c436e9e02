#!/usr/bin/env python3
"""Draws block diagrams from text: blocks.py blocks.txt FOLDER writes FOLDER/NAME.svg for every diagram in the file.

A diagram is a line `diagram NAME`, then `row A | B | C` for blocks from left to right with arrows between them, perhaps
`below D under B` for a block below another, and `edge A -> B: label` for any other arrow. A block that begins with `(`
has no frame."""
import pathlib
import sys
from xml.sax.saxutils import escape

WIDTH, HEIGHT, GAP, LANE = 118, 46, 34, 26
STYLE = ('<style>text{font:13px sans-serif;fill:#1b2026;text-anchor:middle}.label{font-size:12px;fill:#5b6670}'
         'rect{fill:#fff;stroke:#0060b8;stroke-width:1.4}path{fill:none;stroke:#30363d;stroke-width:1.3}</style>'
         '<defs><marker id="tip" viewBox="0 0 8 8" refX="8" refY="4" markerWidth="8" markerHeight="8" orient="auto">'
         '<path d="M0 0L8 4L0 8z" style="fill:#30363d;stroke:none"/></marker></defs>')


def diagrams(text):
    found = {}
    current = None
    for line in text.splitlines():
        line = line.strip()
        if not line or line.startswith('#'):
            continue
        word, rest = line.split(' ', 1)
        if word == 'diagram':
            current = found[rest] = {'row': [], 'below': [], 'edges': []}
        elif word == 'row':
            current['row'] = [name.strip() for name in rest.split('|')]
        elif word == 'below':
            current['below'].append([part.strip() for part in rest.split(' under ')])
        elif word == 'edge':
            ends, _, label = rest.partition(':')
            current['edges'].append([part.strip() for part in ends.split('->')] + [label.strip()])
        else:
            sys.exit(f'blocks.py: {line}: expected diagram, row, below or edge')
    return found


def block(name, x, y):
    words = name.strip('()').split(' ')
    lines, line = [], ''
    for word in words:
        if line and len(line) + len(word) > 15:
            lines.append(line)
            line = word
        else:
            line = f'{line} {word}'.strip()
    lines.append(line)
    frame = '' if name.startswith('(') else f'<rect x="{x}" y="{y}" width="{WIDTH}" height="{HEIGHT}" rx="4"/>'
    first = y + HEIGHT / 2 + 5 - 8 * (len(lines) - 1)
    return frame + ''.join(f'<text x="{x + WIDTH / 2}" y="{first + 16 * i}">{escape(part)}</text>'
                           for i, part in enumerate(lines))


def drawn(diagram):
    top = 14
    places = {name: (10 + i * (WIDTH + GAP), top) for i, name in enumerate(diagram['row'])}
    below_y = top + HEIGHT + 44
    for name, over in diagram['below']:
        places[name] = (places[over][0], below_y)
    parts = [block(name, *at) for name, at in places.items()]
    for left, right in zip(diagram['row'], diagram['row'][1:]):
        parts.append(f'<path marker-end="url(#tip)" d="M{places[left][0] + WIDTH} {top + HEIGHT / 2}'
                     f'H{places[right][0]}"/>')
    lowest = below_y + (HEIGHT if diagram['below'] else -26)
    lane = 0
    used = {}

    def port(name, is_start):
        """Arrows at one side of a block do not lie on each other."""
        key = (name, is_start)
        used[key] = used.get(key, 0) + 1
        return places[name][0] + WIDTH / 2 + (14 if is_start else -14) + 12 * (used[key] - 1)

    for start, end, label in diagram['edges']:
        (x0, y0), (x1, y1) = places[start], places[end]
        if y0 != y1 and abs(x0 - x1) < 1:
            from_y, to_y = (y0, y1 + HEIGHT) if y0 > y1 else (y0 + HEIGHT, y1)
            x = port(start, True)
            path, at = f'M{x} {from_y}V{to_y}', (x + 8, (from_y + to_y) / 2 + 4, 'start')
        elif y0 > y1 and x1 > x0:
            x = port(end, False)
            path, at = f'M{x0 + WIDTH} {y0 + HEIGHT / 2}H{x}V{y1 + HEIGHT}', ((x0 + WIDTH + x) / 2, y0 + HEIGHT / 2 - 6, 'middle')
        elif y0 < y1 and x0 > x1:
            x = port(start, True)
            path, at = f'M{x} {y0 + HEIGHT}V{y1 + HEIGHT / 2}H{x1 + WIDTH}', ((x1 + WIDTH + x) / 2, y1 + HEIGHT / 2 - 6, 'middle')
        else:
            lane += 1
            y = lowest + LANE * lane
            xs, xe = port(start, True), port(end, False)
            path, at = f'M{xs} {y0 + HEIGHT}V{y}H{xe}V{y1 + HEIGHT}', ((xs + xe) / 2, y - 6, 'middle')
        parts.append(f'<path marker-end="url(#tip)" d="{path}"/>')
        if label:
            parts.append(f'<text class="label" x="{at[0]}" y="{at[1]}" style="text-anchor:{at[2]}">{escape(label)}</text>')
    width = 10 + len(diagram['row']) * (WIDTH + GAP)
    height = lowest + LANE * lane + 14
    return (f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" width="{width}" height="{height}">'
            f'<rect width="{width}" height="{height}" style="stroke:none"/>{STYLE}{"".join(parts)}</svg>\n')


def main():
    source, folder = map(pathlib.Path, sys.argv[1:])
    for name, diagram in diagrams(source.read_text()).items():
        (folder / f'{name}.svg').write_text(drawn(diagram))


main()
