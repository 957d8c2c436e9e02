#!/usr/bin/env python3
"""Whether check_figures.py notices faults: a small tree of a page and documents is right, and each planted fault is found."""

import contextlib
import io
import tempfile
import unittest
from pathlib import Path

import check_figures

PAGE = """# Results

Commit abcdef012345; seeds 1-20.

## Flights

| problem | planner | failed flight | median | 95 % |
|---|---|---|---|---|
| bridge | ours | 3/200 [0.5, 4.3 %] | 951 ms | 1.92 s |
| bridge | theirs | 10/200 [2.7, 9.0 %] | 4247 ms | 8 s |
| culvert | ours | 0/200 [0.0, 1.9 %] | 20 ms | 0.04 s |
| | after | 7/9 | none | none |

**With a margin**:

| problem | solved |
| --- | --- |
| bridge | 20/20 |
| culvert | 0/20 |
"""
README = """# Name

Of [200](bench/results/page.md) flights, **3** failed with a
median of 0.95 s, 4.47 times sooner than theirs.

- With a margin, one of two problems is solved ([page.md](bench/results/page.md)).

Nothing is quoted here: 17.
"""
DOCUMENT = """[page.md](../bench/results/page.md) has both:

| flights | failed |
| --- | --- |
| 200 | 3 |
"""
TABLE = """# What it quotes
README.md from page.md@abcdef012345 > Flights
  Of {[bridge | ours > failed flight > 2]} flights, {[bridge | ours > failed flight]} failed with a median of {[bridge | ours > median] / 1000} s
  {[bridge | theirs > median] / [bridge | ours > median]} times sooner

README.md from page.md@abcdef012345 > With a margin
  With a margin, {nonzero([* > solved])} of {count([* > solved])} problems

docs/page.md from page.md@abcdef012345
  | {[bridge | ours > failed flight > 2]} | {[bridge | ours > failed flight]} |
"""


class CheckFigures(unittest.TestCase):
    def faults(self, page=PAGE, readme=README, document=DOCUMENT, table=TABLE):
        """What the checker complains of."""
        with tempfile.TemporaryDirectory() as folder:
            root = Path(folder)
            for path, text in {"bench/results/page.md": page, "README.md": readme, "docs/page.md": document,
                               "figures.txt": table}.items():
                (root / path).parent.mkdir(parents=True, exist_ok=True)
                (root / path).write_text(text)
            checker = check_figures.Checker(root, root / "figures.txt")
            return checker.run()

    def expect(self, *parts, **files):
        faults = self.faults(**files)
        self.assertEqual(len(faults), 1, faults)
        for part in parts:
            self.assertIn(part, faults[0])

    def changed(self, text, old, new):
        self.assertEqual(text.count(old), 1, old)
        return text.replace(old, new)

    def test_what_is_right(self):
        # 4247 / 951 is 4.466; 4.47 and 4.5 are both its roundings.
        self.assertEqual(self.faults(), [])
        self.assertEqual(self.faults(readme=self.changed(README, "4.47 times", "4.5 times")), [])

    def test_another_value_in_the_document(self):
        self.expect("README.md:3: says 4", "bench/results/page.md has 3", readme=self.changed(README, "**3**", "4"))
        self.expect("says 4.4", "has 4.46583", readme=self.changed(README, "4.47", "4.4"))
        self.expect("says 4.46 ", readme=self.changed(README, "4.47", "4.46"))
        self.expect("says two", "has 1", readme=self.changed(README, "one of two", "two of two"))
        self.expect("docs/page.md:3: says 5", document=self.changed(DOCUMENT, "| 3 |", "| 5 |"))

    def test_another_value_on_the_page(self):
        faults = self.faults(page=self.changed(PAGE, "| ours | 3/200", "| ours | 4/200"))
        self.assertEqual(len(faults), 2, faults)  # both documents
        self.expect("says one", "has 0", page=self.changed(PAGE, "| bridge | 20/20 |", "| bridge | 0/20 |"))

    def test_another_commit(self):
        faults = self.faults(page=self.changed(PAGE, "abcdef012345", "abcdef012346"))
        self.assertEqual(len(faults), 2, faults)
        self.assertIn("README.md quotes page.md of commit abcdef012345; the page is of abcdef012346", faults[0])
        faults = self.faults(page=self.changed(PAGE, "Commit abcdef012345; s", "S"))
        self.assertIn("the page is of none", faults[0])
        self.assertEqual(self.faults(page=self.changed(PAGE, "Commit abcdef012345; s", "S"), table=TABLE.replace("abcdef012345", "none")), [])
        self.assertIn("the page is of abcdef012345-dirty", self.faults(page=self.changed(PAGE, "012345;", "012345-dirty;"))[0])

    def test_a_number_that_is_not_tied(self):
        self.expect("README.md:3", "does not tie 12 in", readme=self.changed(README, "than theirs", "than theirs, in 12 cases"))
        self.expect("does not tie four in", readme=self.changed(README, "than theirs", "than four others"))
        self.expect("docs/page.md:3", "does not tie 9 in", document=DOCUMENT + "| late | 9 |\n")
        self.expect("README.md:10", "does not tie 18",
                    readme=README + "\n[page.md](bench/results/page.md) says 18, see [2.1](docs/page.md) and `17`.\n")
        own = TABLE + "\nREADME.md own\n  says 18,\n"
        self.assertEqual(self.faults(readme=README + "\n[page.md](bench/results/page.md) says 18, R^2 and 1/s.\n", table=own), [])
        # A paragraph without a link that holds a tied number.
        self.expect("does not tie 17", readme=self.changed(README, "here: 17.", "here: 17, and 0.04 s."),
                    table=TABLE + "\nREADME.md from page.md@abcdef012345\n  and {[culvert | ours > median .. 95 %]} s\n")

    def test_a_text_that_is_gone(self):
        self.expect("README.md does not say: ... times sooner", "figures.txt:4", table=TABLE, readme=self.changed(
            README, "0.95 s, 4.47 times sooner than theirs", "0.95 s"))
        self.expect("README.md does not say: in 9 worlds", table=TABLE + "\nREADME.md own\n  in 9 worlds\n")
        self.expect("says this 2 times", readme=README + "\nIt is 4.47 times sooner.\n")

    def test_a_place_that_is_gone(self):
        self.expect("page.md has no places 'bridge | theirs > median'", "figures.txt:4",
                    page=self.changed(PAGE, "| theirs |", "| other |"))
        self.assertIn("no sections 'With a margin'", self.faults(page=self.changed(PAGE, "**With a margin**", "With one"))[0])
        self.assertIn("which is no number", self.faults(page=self.changed(PAGE, "4247 ms", "none"))[0])
        self.assertIn("there is no bench/results/other.md", self.faults(table=TABLE.replace("page.md@", "other.md@"))[0])
        self.assertIn("there is no docs/other.md", self.faults(table=TABLE.replace("docs/page.md from", "docs/other.md from"))[0])

    def test_places(self):
        page = check_figures.Page("page.md", PAGE.splitlines())
        for expression, value in {"[seeds 1-#.]": 20, "max([* | ours > failed flight])": 3, "[bridge | theirs .. culvert > median]": 20,
                                  "sum([* > failed flight > 2])": 609, "[bridge | ours > failed flight > 4]": 4.3,
                                  "[bridge | ours > median .. 95 %]": 1.92}.items():
            self.assertEqual(check_figures.evaluate(expression, page), value, expression)
        for expression in ("[bridge > failed flight]", "[bridge | ours > length]", "[seeds #-20, nowhere]"):
            with self.assertRaises(check_figures.Fault, msg=expression):
                check_figures.evaluate(expression, page)

    def test_copies(self):
        copied = TABLE + "\ndocs/page.md from page.md@abcdef012345\n  = | culvert | 0/20 |\n"
        document = DOCUMENT + "\n| problem | solved |\n| --- | --- |\n| culvert | 0/20 |\n"
        self.assertEqual(self.faults(document=document, table=copied), [])
        self.assertIn("page.md does not say", self.faults(document=document.replace("0/20", "1/20"), table=copied.replace("0/20", "1/20"))[0])
        self.assertIn("docs/page.md does not say", self.faults(document=document.replace("0/20", "1/20"), table=copied)[0])

    def test_a_table_that_cannot_be_read(self):
        for table in ("README.md page.md\n", "  no document\n"):
            with self.assertRaises(SystemExit), contextlib.redirect_stderr(io.StringIO()):
                self.faults(table=table)
        self.assertIn("figures.txt:4", self.faults(table=self.changed(TABLE, "{[bridge | theirs > median] /", "{[bridge | theirs > median] //("))[0])

    def test_roundings(self):
        for quoted, value in (("4.5", 4.47), ("4.47", 4.47), ("100,000", 1e5), ("none", 0), ("0.060", 0.0598), ("123", 123.5), ("1e-3", 0.0014)):
            self.assertTrue(check_figures.is_rounded(quoted, value), quoted)
        for quoted, value in (("4.4", 4.47), ("4.50", 4.47), ("none", 1), ("100,000", 99999), ("1e-3", 0.0016)):
            self.assertFalse(check_figures.is_rounded(quoted, value), quoted)


if __name__ == "__main__":
    unittest.main()
