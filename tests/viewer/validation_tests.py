"""The page of a validation."""

import json
import os

import numpy as np

import page_test
import sample_validation
from packing import write_page
from sample_page import HOSTILE


class Validation(page_test.BrowserTest):
    def setUp(self):
        super().setUp()
        self.browser.complaints(), self.browser.requests()

    def show(self, case):
        report, columns = sample_validation.CASES[case]()
        path = os.path.join(page_test.scratch.name, f"validation-{case}.html")
        write_page(page_test.arguments.validation_template, report, path)
        self.assertTrue(self.browser.open(path), "the page shows an error")
        self.browser.settle()
        return report, columns

    def choose(self, index):
        self.browser.driver.execute_async_script(
            "downwash.show(arguments[0]).then(arguments[1])", index)
        self.browser.settle()

    def sections(self):
        return self.every("main > section[aria-labelledby]", "e.getAttribute('aria-labelledby').replace('-title', '')")

    def test_opens_without_a_word_on_the_console_or_a_request_and_shows_what_there_is(self):
        wanted = {"plain": ["verdict", "flights", "repeat"],
                  "worlds": ["verdict", "worlds", "clearance", "sensitivity", "flights", "repeat"],
                  "disputed": ["verdict", "disagreements", "worlds", "clearance", "sensitivity", "flights", "repeat"],
                  "open-air": ["verdict", "worlds", "flights", "repeat"]}
        for case, sections in wanted.items():
            with self.subTest(case):
                self.show(case)
                self.assertEqual(self.sections(), sections)
                self.assertEqual(self.browser.complaints(), [])
                self.assertEqual(self.browser.requests(), [])

    def test_the_verdict_says_how_often_it_fails(self):
        self.show("worlds")
        text = self.one(".verdict", "e.textContent.replaceAll('\\u202f', ' ')")
        self.assertIn("The plan is valid", text)
        self.assertIn("664 of 1 000 worlds failed", text)
        self.assertIn("22 of 221 only because the vehicle is beside its plane", self.one(".worlds", "e.textContent"))
        self.choose(1)
        self.assertIn("to the right of its plane", self.one(".flights", "e.textContent"))
        self.show("disputed")
        self.assertNotIn("beside its plane", self.one(".worlds", "e.textContent"))
        self.assertIn("contradicted in 2 places", self.one(".verdict", "e.textContent"))
        self.assertEqual(self.every(".disagreements td", "e.textContent")[2], HOSTILE)
        self.assertEqual(self.js("return document.querySelectorAll('main script, main img').length"), 0)

    def test_parameters_that_matter_most_come_first(self):
        self.show("worlds")
        titles = self.every("#sensitivity .panel .plot-title", "e.textContent")
        self.assertEqual([title.split(",")[0] for title in titles],
                         sorted(sample_validation.PARAMETERS, key=lambda p: -abs(sample_validation.PARAMETERS[p]))[:6])
        self.assertEqual(self.js("return document.querySelectorAll('#sensitivity .share-bar').length"), 60)

    def test_the_fan_is_as_high_as_the_clearance_and_0_is_contact(self):
        report, _ = self.show("worlds")
        numbers = [float(n) for n in self.one(".fan-line.of-minimum", "e.getAttribute('d')")[1:].replace("L", " ").split()]
        ground = self.one("#clearance .contact", "Number(e.getAttribute('y')) + 1")
        height = ground - np.asarray(numbers[1::2])
        wanted = np.asarray(report["clearance"]["minimum"])
        np.testing.assert_allclose(height, height.max() / wanted.max() * wanted, atol=0.2)
        self.assertTrue(np.any(wanted == 0))

    def test_the_worst_flights_can_be_played(self):
        report, columns = self.show("worlds")
        self.assertEqual(len(self.every(".choice", "1")), 4)
        self.assertEqual(self.js("return downwash.rows"), len(columns["t_s"]))
        self.choose(2)
        self.assertEqual(self.js("return [downwash.flight, downwash.rows, downwash.row]"), [2, 1000, 999])
        self.assertEqual(len(self.every(".scene-svg", "1")), 1)
        self.press("Home")
        self.assertEqual(self.js("return downwash.row"), 0)
        for _ in range(3):
            self.press("ArrowRight")
        self.assertEqual(self.js("return downwash.row"), 3)
        self.js("document.querySelectorAll('.choice input')[0].click()")
        self.browser.driver.execute_async_script("setTimeout(arguments[0], 300)")
        self.assertEqual(self.js("return [downwash.flight, downwash.row]"), [0, 0])

    def test_hovers_have_the_numbers_of_their_goals(self):
        self.show("five-goals")
        self.assertEqual(self.every(".mark.hover", "e.textContent"), ["1", "2", "3", "4", "5"])

    def test_obstacles_stand_where_the_world_has_them(self):
        self.show("worlds")
        before = self.one(".obstacles .section", "e.getAttribute('d')")
        self.choose(3)
        self.assertNotEqual(self.one(".obstacles .section", "e.getAttribute('d')"), before)
        self.assertIn("0.03 m below", self.one(".flights .hint", "e.textContent.replaceAll('\\u00a0', ' ')"))
        self.choose(0)
        self.assertEqual(self.one(".obstacles .section", "e.getAttribute('d')"), before)

    def test_no_page_is_wider_than_a_phone(self):
        for case in sample_validation.CASES:
            for width in (360, 390, 768):
                with self.subTest(case=case, width=width):
                    self.browser.resize(width, 800, mobile=width < 700)
                    self.show(case)
                    self.open_details()
                    self.assertLessEqual(self.js("return document.documentElement.scrollWidth"), width)

    def test_a_page_without_a_validation_says_so(self):
        self.assertFalse(self.browser.open(page_test.arguments.validation_template))
        self.assertIn("empty template", self.one("[role=alert]", "e.textContent"))

    def test_the_programs_page_holds_the_findings_beside_it(self):
        folder = page_test.arguments.validation
        if not folder:
            self.skipTest("no page of the program given")
        self.assertTrue(self.browser.open(os.path.join(folder, "validation.html")))
        self.browser.settle()
        with open(os.path.join(folder, "validation.json"), encoding="utf-8") as file:
            findings = json.load(file)
        self.assertEqual(self.js("return downwash.report.findings"), findings)
        self.assertGreaterEqual(self.js("return downwash.report.flights.length"), 4)
        for index in range(4):
            self.choose(index)
            self.assertGreater(self.js("return downwash.rows"), 1)
        worst = findings["worst"][0]
        self.assertEqual(self.js("return downwash.report.flights[1].world"), worst["world"])
        self.assertEqual(self.js("return downwash.report.flights[1].outcome"), worst["outcome"])
        self.assertAlmostEqual(min(self.js("return downwash.report.clearance.minimum")), worst["min_clearance_m"], delta=1e-6)
        self.assertEqual(self.browser.complaints(), [])
        self.assertEqual(self.browser.requests(), [])
