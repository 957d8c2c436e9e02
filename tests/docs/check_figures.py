#!/usr/bin/env python3
"""Whether README.md and docs/ quote the numbers that stand on the pages of bench/results, as figures.txt ties them.

Usage: check_figures.py ROOT [figures.txt]

It complains where a number differs from its page, where a page has another commit than the table names, where a text or
a place is not found, and where a paragraph, list item or table that quotes a page holds a number that is not tied.
figures.txt explains its lines.
"""

import re
import sys
from fnmatch import fnmatchcase
from pathlib import Path

RESULTS = "bench/results"
WORDS = ["two", "three", "four", "five", "six", "seven", "eight", "nine", "ten", "eleven", "twelve"]
VALUES = {"no": 0, "none": 0, "one": 1, "twenty": 20, "thirty": 30} | {word: n for n, word in enumerate(WORDS, 2)}
DIGITS = r"\d+(?:,\d{3})*(?:\.\d+)?(?:e-?\d+)?"
SIGNED = rf"(?<![\w.,])[-+]?{DIGITS}"
# A number as the documentation writes it, and one that has to be tied: an exponent, the end of a name and 1/s need not.
QUOTED = rf"((?<![\d.,])[-+]?{DIGITS}(?!\d)|\b(?:{'|'.join(VALUES)})\b)"
NEEDED = rf"(?<![A-Za-z_^\d.])(?<!\^-)(?!1/s){DIGITS}|\b(?:{'|'.join(WORDS + ['twenty', 'thirty'])})\b"
LINK = re.compile(r"!?\[([^\]]*)\]\(([^)\s]*)\)")


class Fault(Exception):
    """What is wrong with a claim."""


def squeezed(text):
    return " ".join(text.split())


def is_results_page(target):
    return re.search(r"results/(?!README)[a-z_]+\.md", target) is not None


class Block:
    """A paragraph, a list item or a table: its text without the marks of links, and which characters are tied."""

    def __init__(self, line, lines, is_table):
        self.line = line
        self.is_table = is_table
        self.text = ""
        self.done = []  # for each character: need not be tied
        raw = squeezed(" ".join(lines)).replace("**", "")
        self.links = [target for _, target in LINK.findall(raw) if is_results_page(target)]
        self.quotes = bool(self.links)
        position = 0
        for link in LINK.finditer(raw):
            self._add(raw[position:link.start()], False)
            self._add(link[1], not is_results_page(link[2]))
            position = link.end()
        self._add(raw[position:], False)
        for code in re.finditer(r"`[^`]*`", self.text):
            self.tie(*code.span())

    def _add(self, text, done):
        self.text += text
        self.done += [done] * len(text)

    def tie(self, start, end):
        self.done[start:end] = [True] * (end - start)

    def untied(self):
        return [found[0] for found in re.finditer(NEEDED, self.text) if not all(self.done[found.start():found.end()])]


def blocks_of(path):
    """The blocks of a Markdown file; headings and code are left out."""
    blocks, lines, first, is_table, is_code = [], [], 0, False, False

    def end():
        if lines:
            blocks.append(Block(first, lines, is_table))
            previous = blocks[-2] if len(blocks) > 1 else None
            if is_table and previous and not previous.is_table and previous.text.endswith(":"):
                blocks[-1].quotes |= previous.quotes  # "page.md compares: | ... |"
        return []

    for number, line in enumerate(path.read_text().splitlines(), 1):
        if line.lstrip().startswith("```"):
            lines, is_code = end(), not is_code
        elif is_code:
            continue
        elif not line.strip() or line.startswith(("#", "<!--")):
            lines = end()
        else:
            if re.match(r" *(?:-|\d+\.) ", line) or line.startswith("|") != is_table:
                lines = end()
            if not lines:
                first, is_table = number, line.startswith("|")
            lines.append(line)
    end()
    return blocks


class Page:
    """A page of results, or a part of it."""

    def __init__(self, name, lines, title=""):
        self.name = name
        self.lines = lines
        self.title = title

    def commit(self):
        found = re.search(r"commit `?([0-9a-f]{7,40}(?:-dirty)?)", "\n".join(self.lines), re.IGNORECASE)
        return found[1] if found else "none"

    def section(self, title):
        """What stands under a heading, or after a paragraph that begins in bold face, up to the next one like it."""

        def level(line):
            marks = re.match(r"#+ |\*\*", line)
            return 9 if marks and marks[0] == "**" else len(marks[0]) if marks else None

        starts = [n for n, line in enumerate(self.lines) if level(line) and line.lstrip("#* ").startswith(title)]
        if len(starts) != 1:
            raise Fault(f"{self.name} has {len(starts) or 'no'} sections '{title}'")
        start = starts[0]
        rest = self.lines[start + 1:]
        ends = [n for n, line in enumerate(rest) if level(line) and level(line) <= level(self.lines[start])]
        return Page(self.name, [self.lines[start], *rest[:ends[0] if ends else None]], title)

    def tables(self):
        tables, rows = [], []
        for line in [*self.lines, ""]:
            if line.startswith("|"):
                rows.append([cell.strip().strip("*") for cell in line.strip().strip("|").split("|")])
            elif rows:
                tables.append((rows[0], rows[2:]))
                rows = []
        return tables

    def values(self, place):
        """The numbers at a place: 'row > column', 'row > column > n', or words of the page with '#' in place of a number."""
        if "#" in place:
            pattern = re.escape(squeezed(place)).replace(r"\#", rf"([-+]?{DIGITS})").replace(r"\ ", " ")
            found = set(re.findall(pattern, squeezed(" ".join(self.lines))))
            if len(found) != 1:
                raise Fault(f"{self.name} has {len(found) or 'no'} places '{place}'")
            return [as_number(found.pop())]
        row, column, *nth = [part.strip() for part in place.split(" > ")]
        cells = [cells[columns[0]] for header, rows in self.tables()
                 if len(columns := matches([[cell] for cell in header], column)) == 1
                 for cells in (rows[n] for n in matches(rows, row)) if len(cells) > columns[0]]
        if not cells or (len(cells) > 1 and "*" not in row):
            raise Fault(f"{self.name} has {len(cells) or 'no'} places '{place}'")
        nth = int(nth[0]) - 1 if nth else 0
        found = [re.findall(SIGNED, cell) for cell in cells]
        if any(len(numbers) <= nth for numbers in found) and "*" not in row:
            raise Fault(f"{self.name} has '{cells[0]}' at '{place}', which is no number")
        return [as_number(numbers[nth]) for numbers in found if len(numbers) > nth]


def matches(rows, name):
    """Which rows begin with the cells of a name, '*' standing for any letters; 'A .. B': the first B after each A."""
    first, *then = name.split(" .. ")
    wanted = [cell.strip() for cell in first.split(" | ")]
    found = [n for n, cells in enumerate(rows)
             if len(cells) >= len(wanted) and all(map(fnmatchcase, cells, wanted))]
    for later in then:
        found = [next((n for n in matches(rows, later) if n > before), None) for before in found]
    return [n for n in found if n is not None]


def as_number(text):
    return VALUES[text] if text in VALUES else float(text.replace(",", ""))


def evaluate(expression, page):
    """An expression of places in [] and arithmetic."""
    names = {"min": min, "max": max, "sum": sum, "count": len, "nonzero": lambda values: sum(map(bool, values))}

    def name_of(place):
        values = page.values(place[1])
        names[f"_{len(names)}"] = values if "*" in place[1] else values[0]
        return f"_{len(names) - 1}"

    return eval(re.sub(r"\[([^\]]*)\]", name_of, expression), {"__builtins__": {}}, names)  # our own table


def is_rounded(quoted, value):
    """Whether a value rounds to a quoted number, at the digits that are quoted; a half may go either way."""
    digits = len(re.sub(r"e.*", "", quoted).partition(".")[2])
    exponent = int(quoted.partition("e")[2] or 0) if "e" in quoted and quoted not in VALUES else 0
    return abs(value - as_number(quoted)) <= 0.5 * 10.0 ** (exponent - digits) * (1 + 1e-9)


def claims_of(table):
    """Headers and claims of figures.txt: (line, document, page, commit, sections, text); 'own' for numbers of no page."""
    header = None
    for number, line in enumerate(table.read_text().splitlines(), 1):
        if not line.strip() or line.lstrip().startswith("#"):
            continue
        if not line.startswith(" "):
            header = re.fullmatch(r"(\S+) (?:from ([a-z_]+\.md)@(\S+)((?: > .+)?)|own)", line.rstrip())
            if not header:
                sys.exit(f"{table}:{number}: expected 'DOCUMENT from PAGE@COMMIT [> SECTION]' or 'DOCUMENT own'")
            document, page, commit, sections = header.groups()
        elif not header:
            sys.exit(f"{table}:{number}: no document stands above it")
        else:
            yield number, document, page, commit, [part for part in (sections or "").split(" > ") if part], line.strip()


class Checker:
    def __init__(self, root, table):
        self.root = root
        self.table = table
        self.documents = {
            str(path.relative_to(root)): blocks_of(path)
            for path in [root / "README.md", *sorted((root / "docs").glob("**/*.md"))] if path.exists()
        }
        self.tied = 0
        self.faults = []

    def complain(self, where, text):
        self.faults.append(f"{where}: {text}")

    def find(self, document, pattern, text):
        found = [(block, match) for block in self.documents.get(document, []) for match in re.finditer(pattern, block.text)]
        if not found:
            raise Fault(f"{document} does not say: {text}")
        return found

    def claim(self, document, page, text):
        """Ties the numbers in the braces of a text to the values of their expressions."""
        is_copy = text.startswith("= ")
        if is_copy:
            text = text[2:]
            if squeezed(text) not in squeezed(" ".join(page.lines)):
                raise Fault(f"{RESULTS}/{page.name} does not say: {text}")
        words = re.split(r"\{([^}]*)\}", text)
        parts = [re.escape(squeezed(f"x{part}x")[1:-1]) for part in words[::2]]
        found = self.find(document, QUOTED.join(parts), re.sub(r"\{[^}]*\}", "...", text))
        # The name of a row or a column that an expression uses is tied as well.
        places = " ".join([page.title, *(re.sub(r" > \d+$", "", place) for place in re.findall(r"\[([^\]]*)\]", text))])
        for block, match in found:
            block.quotes = True
            for number in re.finditer(NEEDED, match[0]):
                if is_copy or re.search(rf"(?<![\d.,]){re.escape(number[0])}(?![\d.,]*\d)", places):
                    block.tie(match.start() + number.start(), match.start() + number.end())
                    self.tied += is_copy
            for n, expression in enumerate(words[1::2], 1):
                if expression:  # without one, another claim ties it
                    block.tie(*match.span(n))
                    self.tied += 1
        if len(found) > 1:
            raise Fault(f"{document} says this {len(found)} times; quote more of the sentence: {text}")
        for n, expression in enumerate(words[1::2], 1):
            if expression and not is_rounded(match[n], value := evaluate(expression, page)):
                self.complain(f"{document}:{block.line}",
                              f"says {match[n]} in '{match[0]}', {RESULTS}/{page.name} has {value:.6g}: {expression}")

    def run(self):
        other_commits = set()
        for number, document, name, commit, sections, text in claims_of(self.table):
            where = f"{self.table.name}:{number}"
            try:
                if document not in self.documents:
                    raise Fault(f"there is no {document}")
                if name is None:
                    for block, match in self.find(document, re.escape(squeezed(text)), text):
                        block.tie(*match.span())
                    continue
                path = self.root / RESULTS / name
                if not path.exists():
                    raise Fault(f"there is no {RESULTS}/{name}")
                page = Page(name, path.read_text().splitlines())
                if commit != page.commit() and (document, name, commit) not in other_commits:
                    other_commits.add((document, name, commit))
                    self.complain(where, f"{document} quotes {name} of commit {commit}; the page is of {page.commit()}. "
                                  "Look whether the sentences still hold, and name the new commit")
                for section in sections:
                    page = page.section(section)
                self.claim(document, page, text)
            except (Fault, SyntaxError, NameError, TypeError, ValueError, ZeroDivisionError) as fault:
                self.complain(where, fault if isinstance(fault, Fault) else f"{fault}: {text}")
        for document, blocks in self.documents.items():
            for block in blocks:
                if block.quotes and (numbers := block.untied()):
                    self.complain(f"{document}:{block.line}", f"quotes a page of results, and {self.table.name} does not tie "
                                  f"{', '.join(numbers)} in '{block.text[:60]}...'")
        return self.faults


def main():
    root = Path(sys.argv[1])
    table = Path(sys.argv[2]) if len(sys.argv) > 2 else root / "tests/docs/figures.txt"
    checker = Checker(root, table)
    faults = checker.run()
    print(*faults, sep="\n", end="\n" if faults else "")
    print(f"{checker.tied} numbers are tied to pages of results, {len(faults)} faults")
    return 1 if faults or not checker.tied else 0


if __name__ == "__main__":
    sys.exit(main())
