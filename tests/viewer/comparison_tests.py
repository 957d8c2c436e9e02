"""The page of a flight log beside its plan."""

import os

import page_test
import sample_comparison
from packing import write_page
from sample_page import HOSTILE


class Comparison(page_test.BrowserTest):
    def setUp(self):
        super().setUp()
        self.browser.complaints(), self.browser.requests()

    def show(self, case):
        path = os.path.join(page_test.scratch.name, f"comparison-{case}.html")
        write_page(page_test.arguments.comparison_template, sample_comparison.CASES[case](), path)
        self.assertTrue(self.browser.open(path), "the page shows an error")
        self.browser.settle()

    def sections(self):
        return self.every("main > section[aria-labelledby]", "e.getAttribute('aria-labelledby').replace('-title', '')")

    def test_opens_without_a_word_on_the_console_or_a_request_and_shows_what_there_is(self):
        wanted = {"plain": ["verdict", "phases", "places", "errors", "clearance", "thrust", "repeat"],
                  "bare": ["verdict", "phases", "places", "errors", "repeat"]}
        for case, sections in wanted.items():
            with self.subTest(case):
                self.show(case)
                self.assertEqual(self.sections(), sections)
                self.assertEqual(self.browser.complaints(), [])
                self.assertEqual(self.browser.requests(), [])

    def test_a_panel_for_each_axis_with_the_worlds_the_times_outside_and_a_gap_in_the_log(self):
        self.show("plain")
        self.assertEqual(self.every("#places .plot-title", "e.textContent"),
                         [f"{axis} from the reference" for axis in "xyz"])
        self.assertEqual(len(self.every("#places .band", "e.getAttribute('d').length")), 3)
        self.assertEqual(len(self.every("#places .outside", "1")), 1)
        self.assertEqual(len(self.every(".jump", "1")), 4)
        flown = self.every("#places .line.series-1", "e.getAttribute('d').split('M').length - 1")
        self.assertEqual(flown, [2, 2, 2])
        self.show("bare")
        self.assertEqual(len(self.every("#places .plot-title", "1")), 2)
        self.assertEqual(len(self.every(".jump, .jumps", "1")), 0)

    def test_the_verdict_has_the_figures_and_foreign_text_stays_text(self):
        self.show("plain")
        text = self.one(".verdict", "e.textContent.replaceAll('\\u00a0', ' ')")
        for part in ("81.37 s of the log", "correlation of speeds 0.987", "23 mm", "0.184 m", "3.1%", "95.0% of the plan",
                     "the log jumps", "position by 500 mm (vehicle_local_position.xy_reset_counter)"):
            self.assertIn(part, text)
        self.show("bare")
        self.assertEqual(self.one("h1", "e.textContent"), HOSTILE)
        self.assertEqual(self.js("return document.querySelectorAll('main script, main img').length"), 0)
