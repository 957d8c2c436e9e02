"""The page of a flight in space."""

import json
import math
import os

import numpy as np

import page_test
import sample_page
import sample_space
from packing import write_page

# Of drawing without a graphics card.
OWN = ("software WebGL", "GPU stall", "GL Driver Message")


class Space(page_test.BrowserTest):
    def setUp(self):
        super().setUp()
        self.browser.complaints(), self.browser.requests()

    def show(self, case, change=None):
        report = sample_space.CASES[case]()
        if change:
            change(report)
        path = os.path.join(page_test.scratch.name, f"{case}.html")
        columns = sample_space.write(page_test.arguments.space_template, report, path)
        self.assertTrue(self.browser.open(path), "the page shows an error")
        self.browser.settle()
        return report, columns

    def view(self, call, *values):
        return self.js(f"return downwash.view.{call}", *values)

    def plots(self):
        return self.every("[data-plot]", "e.dataset.plot")

    def test_opens_from_a_file_with_its_picture_and_without_a_word_on_the_console_or_a_request(self):
        for case in sample_space.CASES:
            with self.subTest(case):
                self.browser.complaints(), self.browser.requests()
                self.show(case)
                self.assertEqual(self.one(".stage", "e.dataset.state"), "open")
                complaints = [c["message"] for c in self.browser.complaints()]
                self.assertEqual([c for c in complaints if not any(word in c for word in OWN)], [])
                self.assertEqual(self.browser.requests(), [])

    def test_columns_are_those_of_the_flight_to_the_last_bit(self):
        for case in ("space", "space-armless"):
            _, columns = self.show(case)
            self.assertEqual(self.js("return Object.keys(downwash.data)"), list(columns))
            for name, values in columns.items():
                self.assertEqual(self.column(name), np.asarray(values, dtype="<f8").tobytes(), (case, name))

    def test_the_drawn_arm_ends_where_the_flight_has_the_end_effector(self):
        for case in ("space", "space-armless"):
            _, columns = self.show(case)
            for seconds in (0, 5.5, 12, 12.9):
                self.set_time(seconds)
                row = self.js("return downwash.row")
                drawn = self.view("tip()")
                for axis, value in zip("xyz", drawn):
                    self.assertAlmostEqual(value, columns[f"ee_{axis}_m"][row], places=5)

    def test_the_whole_flight_is_seen_first_and_from_every_side(self):
        for width in (1400, 390):
            self.browser.resize(width, 850, width < 600)
            _, columns = self.show("space")
            for side in (None, "Top", "Side", "Front"):
                if side:
                    self.js("[...document.querySelectorAll('.zoom-tools button')].find(b => b.textContent === arguments[0]).click()",
                            side)
                    self.browser.settle()
                for row in range(0, len(columns["t_s"]), 200):
                    x, y = self.view("seen_at(...arguments)", *[float(columns[f"{a}_m"][row]) for a in "xyz"])
                    self.assertTrue(0 < x < 1 and 0 < y < 1, (width, side, row, x, y))
        across = [self.view("seen_at(0, arguments[0], 2)[0]", y) for y in (-1, 1)]  # from the front: y to the right
        self.assertGreater(across[1], across[0])

    def test_plots_have_every_joint_and_the_numbers_of_the_moment(self):
        _, columns = self.show("space")
        self.assertEqual(self.plots(), ["tracking", "tilt", "attitude", "yaw", "joint-1", "joint-2", "joint-3", "thrust", "factor",
                                        "clearance", "speed", "power", "energy"])
        self.set_time(6)
        row = self.js("return downwash.row")
        at = {name: values[row] for name, values in columns.items()}
        q = [at[name] for name in ("qw", "qx", "qy", "qz")]
        tilt = math.degrees(math.acos(1 - 2 * (q[1]**2 + q[2]**2)))
        error = math.dist([at[f"{a}_m"] for a in "xyz"], [at[f"ref_{a}_m"] for a in "xyz"])
        shown = {plot: self.every(f"[data-plot={plot}] .value", "e.textContent") for plot in self.plots()}
        self.assertEqual(shown["tracking"], [f"{error:.3f}\u00a0m"])
        self.assertEqual(shown["tilt"], [f"{tilt:.1f}°"])
        self.assertEqual(shown["joint-2"], [f"{math.degrees(at[name]):.1f}°" for name in ("joint_2_rad", "ref_joint_2_rad")])
        self.assertEqual(shown["speed"], [f"{math.hypot(*[at[f'v{a}_m_s'] for a in 'xyz']):.2f}\u00a0m/s"])
        self.assertIn("limit 95.74°", self.every("[data-plot=joint-1] .limit-name", "e.textContent")[1].replace("\u00a0", " "))
        self.show("space-armless")
        self.assertEqual(self.plots(), ["tracking", "tilt", "attitude", "yaw", "thrust", "factor", "speed", "power", "energy"])

    def test_yaw_goes_on_beyond_half_a_turn(self):
        def turn(report):
            columns = report["_columns"]
            yaw = np.linspace(0, 7, len(columns["t_s"]))
            columns["ref_yaw_rad"] = yaw
            columns.update(zip(("qw", "qx", "qy", "qz"), sample_space.quaternion(0 * yaw, 0 * yaw, yaw)))
            report["flight"] = sample_space.flight_json(list(columns), list(columns.values()))
        self.show("space", turn)
        self.press("End")
        self.assertEqual(self.every("[data-plot=yaw] .value", "e.textContent"), ["401.1°", "401.1°"])

    def test_keys_move_the_flight_and_the_view(self):
        self.show("space")
        self.press("ArrowRight", shift=True)
        self.assertEqual(self.js("return downwash.row"), 100)
        self.press("End")
        self.assertEqual(self.js("return downwash.row"), self.js("return downwash.rows") - 1)
        before = self.view("seen_at(3, 3, 3)")
        self.press("a", target="document.querySelector('.stage canvas')")
        self.assertNotEqual(self.view("seen_at(3, 3, 3)"), before)
        self.press("0", target="document.querySelector('.stage canvas')")
        for value, first in zip(self.view("seen_at(3, 3, 3)"), before):
            self.assertAlmostEqual(value, first, places=6)
        self.press(" ")
        self.assertTrue(self.js("return downwash.is_playing"))
        self.press(" ")
        self.assertFalse(self.js("return downwash.is_playing"))

    def test_layers_are_switched(self):
        self.show("space")
        self.js("document.querySelector('[data-toggle=names]').click()")
        self.browser.settle()
        self.assertEqual(self.one(".names3d", "getComputedStyle(e).display"), "none")
        self.assertFalse(self.js("return downwash.layers.names"))
        for layer in self.every("[data-toggle]", "e.dataset.toggle"):
            self.js("document.querySelector(`[data-toggle=${arguments[0]}]`).click()", layer)
            self.browser.settle()

    def test_names_lie_on_no_other(self):
        self.show("space")
        boxes = [b for b in self.every(".name3d", "getComputedStyle(e).display === 'none' ? null : "
                                       "(b => [b.left, b.top, b.right, b.bottom])(e.getBoundingClientRect())") if b]
        self.assertGreater(len(boxes), 10)
        for i, a in enumerate(boxes):
            for b in boxes[:i]:
                self.assertFalse(a[0] < b[2] and b[0] < a[2] and a[1] < b[3] and b[1] < a[3])

    def test_hovers_carry_the_numbers_of_their_goals(self):
        self.show("space")
        self.assertEqual(self.every(".mark.hover", "e.textContent"), ["1", "2"])

    def test_a_flight_that_breaks_off_is_shown_at_its_end_with_where_and_how(self):
        self.show("space-collision")
        self.assertEqual(self.js("return downwash.row"), 819)
        self.assertEqual(self.one("#verdict-title", "e.textContent"), "The flight ends in a collision")
        self.assertIn("breaks off after 8.19\u00a0s", self.one(".verdict", "e.textContent"))

    def test_a_problem_before_it_is_planned_has_goals_of_every_kind_and_no_plots(self):
        self.show("space-unplanned")
        self.assertEqual(self.one("#verdict-title", "e.textContent"), "Not planned yet")
        self.assertEqual(self.js("return document.querySelectorAll('.plots, .playback, .figures').length"), 0)
        kinds = self.every("[aria-label=Goals] tbody tr", "e.children[1].textContent")
        self.assertEqual(kinds, ["end effector with an attitude", "camera that looks at a point", "vehicle and arm", "touch"])
        (low, high), *_ = self.view("goals()")
        self.assertAlmostEqual(high[0] - low[0], 0.2, places=2)
        self.assertAlmostEqual((high[2] + low[2]) / 2, 3, places=2)

    def test_a_scene_without_a_flight_is_as_wide_as_the_page(self):
        self.show("space-unplanned")
        width = "(e => e.getBoundingClientRect().width)"
        self.assertGreater(self.js(f"return {width}(document.querySelector('.stage'))"),
                           0.9 * self.js(f"return {width}(document.querySelector('main'))"))

    def test_a_search_has_its_certificate_and_its_costs_on_the_page(self):
        def plan(report):
            report["solution"].update(
                threads=2, planning=sample_page.planning_json([(0.2, 30, 5000.0), (0.9, 90, 4600.0)], {"collision": 381}),
                certificate=sample_page.certificate_json(True, 684, 0, (0, 0, 0.0054), {}))
        self.show("space", plan)
        self.assertEqual(self.one(".certificate-line", "e.textContent"),
                         "Certified: 0 of 684 worlds failed; the failure probability is at most 1\u00a0% with 95\u00a0% confidence.")
        self.assertIn("touches an obstacle", self.one(".search", "e.textContent"))
        self.assertIn("in 2 steps", self.one(".cost-svg", "e.getAttribute('aria-label')"))
        self.show("space")
        self.assertEqual(self.every(".search, .certificate, .certificate-line", "e.className"), [])

    def test_a_search_without_a_plan_says_what_stopped_it(self):
        def fail(report):
            report["flight"] = None
            report["solution"].update(
                status="none", plan=None, execution=None,
                planning={**sample_page.planning_json([], {"collision": 12}), "nearest_approach_m": 0.431,
                          "obstruction": {"cause": "collision", "goal_distance_m": 0.431, "obstacles": ["girder 2"]}})
        self.show("space", fail)
        self.assertEqual(self.one("#verdict-title", "e.textContent"), "No plan within the limits")
        said = self.one(".verdict", "e.textContent")
        self.assertIn("within 0.431\u00a0m of the goal.", said)
        self.assertIn("What stopped it: touches an obstacle near girder 2.", said)

    def test_what_a_judge_found_stands_on_the_page(self):
        self.show("space-judged")
        self.assertIn("In 1\u202f000 worlds 13 flights failed.", self.one(".judge-line", "e.textContent"))
        self.assertEqual(len(self.every(".judge .probability", "1")), 2)
        self.show("space")
        self.assertEqual(self.every(".judge, .judge-line", "1"), [])

    def test_text_of_others_stays_text(self):
        self.show("space-hostile")
        self.assertNotEqual(self.js("return document.title"), "owned")
        self.assertEqual(self.js("return document.querySelectorAll('#page img, #page b').length"), 0)
        self.open_details()
        self.assertIn("<b>deck</b>&amp;", self.every("[aria-label=Obstacles] th", "e.textContent"))

    def test_missing_columns_are_said_and_nothing_is_shown(self):
        def cut(report):
            report["flight"]["columns"].remove("qz")
            report["flight"]["same_as"].pop()
        report = sample_space.CASES["space"]()
        report.pop("_columns")
        cut(report)
        path = os.path.join(page_test.scratch.name, "space-damaged.html")
        write_page(page_test.arguments.space_template, json.loads(json.dumps(report)), path)
        self.assertFalse(self.browser.open(path))
        self.assertIn("lacks qz", self.one("[role=alert]", "e.textContent"))

    def test_fits_a_phone(self):
        self.browser.resize(390, 844, mobile=True)
        for case in ("space", "space-unplanned", "space-judged"):
            self.show(case)
            self.assertLessEqual(self.js("return document.documentElement.scrollWidth"), 390)

    def test_is_printed_in_light_colours_with_its_picture(self):
        self.browser.media(prefers_color_scheme="dark")
        self.show("space")
        self.assertGreater(len(self.browser.pdf()), 100_000)
        size = "[e.style.width, e.style.height, e.querySelector('canvas').width]"
        before = self.one(".stage", size)
        self.js("dispatchEvent(new Event('beforeprint'))")
        self.browser.settle()
        self.assertEqual(self.one(".stage", "e.style.width"), "690px")
        self.js("dispatchEvent(new Event('afterprint'))")
        self.browser.settle()
        self.assertEqual(self.one(".stage", size), before)


class SpaceWithoutWebGL(page_test.BrowserTest):
    browser_arguments = ("--disable-gpu", "--disable-3d-apis")

    def test_plots_and_tables_stand_without_the_picture(self):
        path = os.path.join(page_test.scratch.name, "space-plain.html")
        sample_space.write(page_test.arguments.space_template, sample_space.CASES["space"](), path)
        self.assertTrue(self.browser.open(path))
        self.assertEqual(self.one(".stage", "e.dataset.state"), "failed")
        self.assertIn("no WebGL", self.one(".space-note", "e.textContent"))
        self.assertEqual(len(self.every("[data-plot]", "1")), 13)
