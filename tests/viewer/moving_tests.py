"""Moving: slider, keys, mouse, playing, layers; and what the page says."""

import time

import page_test
import sample_page


class Moving(page_test.BrowserTest):
    def assert_tip_is_where_the_flight_says(self, columns):
        row = self.js("return downwash.row")
        drawn = self.middle_of(".vehicle.flown.now .tip")
        wanted = self.pixels(columns["ee_x_m"][row], columns["ee_z_m"][row])
        self.assertAlmostEqual(drawn[0], wanted[0], delta=0.3)
        self.assertAlmostEqual(drawn[1], wanted[1], delta=0.3)

    def test_the_slider_moves_the_vehicle(self):
        columns = self.open("solved")
        for seconds in (0, 3.21, 7.77, 12, 19.58):
            self.set_time(seconds)
            self.assertAlmostEqual(self.js("return downwash.time"), seconds, places=9)
            self.assert_tip_is_where_the_flight_says(columns)
            self.assertIn(f"{seconds:.2f}", self.js("return document.querySelector('.time-text').textContent"))

    def test_the_drawing_is_right_when_zoomed_too(self):
        columns = self.open("solved")
        self.set_time(6)
        before = self.js("const [a] = downwash.pixels(0, 9), [b] = downwash.pixels(1, 9); return b - a")
        for _ in range(3):
            self.press("+", target="document.querySelector('.scene-svg')")
        (left, low), (right, _), (_, high) = self.pixels(0, 9), self.pixels(1, 9), self.pixels(0, 10)
        after, up = right - left, low - high
        self.assertAlmostEqual(after / before, 1.4**3, places=3)
        self.assertAlmostEqual(after, up, places=6)  # equal axes
        self.assert_tip_is_where_the_flight_says(columns)

    def test_zooming_out_never_zooms_in(self):
        self.open_changed("solved", lambda report: report.update(
            map=None, scene={**report["scene"], "bounds": {"x_m": [-300, 300], "z_m": [0, 300]}}))
        widths = []
        for button in ("All", "−", "−", "+"):
            self.js("[...document.querySelectorAll('.zoom-tools button')]"
                    ".find(b => b.textContent === arguments[0]).click()", button)
            self.browser.settle()
            widths.append(self.js("const [a] = downwash.pixels(0, 9), [b] = downwash.pixels(1, 9); return b - a"))
        whole, out, farther, nearer = widths
        self.assertAlmostEqual(out / whole, 0.9, places=6)
        self.assertAlmostEqual(farther, out, places=9)
        self.assertAlmostEqual(nearer / farther, 1.4, places=6)

    def mouse(self, kind, x, y, **more):
        self.browser.driver.execute_cdp_cmd("Input.dispatchMouseEvent", {
            "type": kind, "x": x, "y": y, "button": "none" if kind == "mouseWheel" else "left",
            "buttons": 0 if kind in ("mouseReleased", "mouseWheel") else 1, "clickCount": 1, **more})

    def drag(self, x, y, to_x, to_y):
        self.mouse("mousePressed", x, y)
        for share in (0.3, 0.6, 1):
            self.mouse("mouseMoved", x + share * (to_x - x), y + share * (to_y - y))
        self.mouse("mouseReleased", to_x, to_y)
        self.browser.settle()

    def test_the_mouse_moves_the_scene_and_zooms_it_once_it_was_clicked(self):
        self.open("solved")
        self.js("document.querySelector('.scene-svg').scrollIntoView()")
        width = "const [a] = downwash.pixels(0, 9), [b] = downwash.pixels(1, 9); return b - a"
        x, y = self.middle_of(".scene-svg")
        before, scroll = self.js(width), self.js("return scrollY")
        self.mouse("mouseWheel", x, y, deltaX=0, deltaY=-200)
        time.sleep(0.3)
        self.assertEqual(self.js(width), before)  # the page scrolls
        self.assertLess(self.js("return scrollY"), scroll)
        x, y = self.middle_of(".scene-svg")
        at = self.js("return downwash.pixels(0, 9)")
        self.drag(x, y, x + 60, y - 25)
        moved = self.js("return downwash.pixels(0, 9)")
        self.assertAlmostEqual(moved[0] - at[0], 60, delta=1)
        self.assertAlmostEqual(moved[1] - at[1], -25, delta=1)
        self.mouse("mouseWheel", x, y, deltaX=0, deltaY=-200)
        time.sleep(0.3)
        self.browser.settle()
        self.assertGreater(self.js(width), 1.1 * before)
        self.js("[...document.querySelectorAll('.zoom-tools button')].find(b => b.textContent === 'Flight').click()")
        self.browser.settle()
        self.assertAlmostEqual(self.js(width), before, places=6)

    def test_a_drag_in_a_plot_moves_vehicle_and_slider(self):
        columns = self.open("solved")
        for plot, share in (("tracking", 0.3), ("factor", 0.7)):
            self.js("document.querySelector(`[data-plot=${arguments[0]}]`).scrollIntoView({block: 'center'})", plot)
            box = self.one(f"[data-plot={plot}] svg", "e.getBoundingClientRect().toJSON()")
            left, top, width = box["left"], box["top"] + 30, box["width"]
            self.drag(left + 0.5 * width, top, left + share * width, top + 5)
            row = self.js("return downwash.row")
            self.assertAlmostEqual(row / self.js("return downwash.rows"), share, delta=0.1)
            self.assertEqual(int(self.js("return document.querySelector('input.time').value")), row)
            self.assert_tip_is_where_the_flight_says(columns)
            cursors = self.every(".cursor", "e.getAttribute('d').split(' ')[0]")
            self.assertEqual(len(set(cursors)), 1)
            drawn = self.middle_of(f"[data-plot={plot}] .cursor")[0]
            self.assertAlmostEqual(drawn, left + share * width, delta=2)

    def test_the_pointer_says_what_is_below_it(self):
        self.open("solved")
        self.js("document.querySelector('.scene-svg').scrollIntoView()")
        for place, words in (((-3, 9.5), "K 1.0"), ((0, 10.5), "not flyable")):
            x, y = self.pixels(*place)
            self.mouse("mouseMoved", x, y, buttons=0, button="none")
            self.assertIn(words, self.js("return document.querySelector('.pointer-text').textContent"))

    def test_keys(self):
        self.open("solved")
        row = "return downwash.row"
        self.press("ArrowRight")
        self.assertEqual(self.js(row), 1)
        self.press("ArrowRight", shift=True)
        self.assertEqual(self.js(row), 101)
        self.press("ArrowLeft")
        self.press("ArrowLeft", shift=True)
        self.assertEqual(self.js(row), 0)
        self.press("End")
        self.assertEqual(self.js(row), 1958)
        self.press("Home")
        self.assertEqual(self.js(row), 0)
        self.press(" ")
        self.assertTrue(self.js("return downwash.is_playing"))
        time.sleep(0.5)
        self.press(" ")
        self.assertFalse(self.js("return downwash.is_playing"))
        self.assertGreater(self.js(row), 10)

    def touch(self, kind, *points):
        self.browser.driver.execute_cdp_cmd("Input.dispatchTouchEvent", {
            "type": kind, "touchPoints": [{"x": x, "y": y, "id": i} for i, (x, y) in enumerate(points)]})

    def test_a_tap_on_the_picture_plays_and_pauses_and_a_moving_or_second_finger_does_not(self):
        self.browser.resize(390, 844, mobile=True)
        self.browser.driver.execute_cdp_cmd("Emulation.setTouchEmulationEnabled", {"enabled": True})
        try:
            self.open("solved")
            is_playing = "return downwash.is_playing"
            x, y = self.middle_of(".scene-svg")
            for wanted in (True, False):
                self.touch("touchStart", (x, y))
                self.touch("touchEnd")
                self.browser.settle()
                self.assertEqual(self.js(is_playing), wanted)
            self.touch("touchStart", (x, y))
            self.touch("touchMove", (x + 40, y))
            self.touch("touchEnd")
            self.touch("touchStart", (x, y))
            self.touch("touchStart", (x, y), (x + 60, y))
            self.touch("touchEnd")
            self.browser.settle()
            self.assertFalse(self.js(is_playing))
            # Fingers find the buttons.
            for selector in (".play", ".speed select"):
                self.assertGreaterEqual(self.one(selector, "e.getBoundingClientRect().height"), 44)
            for selector in (".zoom-tools button", ".view-choice button"):
                self.assertGreaterEqual(self.one(selector, "e.getBoundingClientRect().height"), 40)
            self.assertLess(self.one(".playback", "e.getBoundingClientRect().bottom"), 844)
        finally:
            self.browser.driver.execute_cdp_cmd("Emulation.setTouchEmulationEnabled", {"enabled": False})

    def test_a_space_on_a_control_belongs_to_the_control(self):
        self.open("solved")
        self.press(" ", target="document.querySelector('[data-toggle=map]')")
        self.assertFalse(self.js("return downwash.is_playing"))

    def test_playing_keeps_to_the_clock_and_ends_at_the_end(self):
        self.open("solved")
        self.set_time(18.9)
        self.js("document.querySelector('.speed select').value = '4'; document.querySelector('.play').click()")
        time.sleep(1)
        self.assertFalse(self.js("return downwash.is_playing"))
        self.assertEqual(self.js("return downwash.row"), 1958)
        self.js("document.querySelector('.speed select').value = '0.25'")
        self.set_time(5)
        elapsed = self.browser.driver.execute_async_script(
            "const done = arguments[0], play = document.querySelector('.play'), from = performance.now(); play.click();"
            "setTimeout(() => { play.click(); done((performance.now() - from) / 1000); }, 1200)")
        self.assertAlmostEqual(self.js("return downwash.time") - 5, 0.25 * elapsed, delta=0.06)

    def test_layers_switch_on_and_off(self):
        self.open("solved")
        layers = self.js("return downwash.layers")
        self.assertEqual(set(layers), {"map", "tree", "planned", "flown", "tip", "snapshots", "forces", "names"})
        for layer, is_on in layers.items():
            for wanted in (not is_on, is_on):
                self.js("document.querySelector(`[data-toggle=${arguments[0]}]`).click()", layer)
                self.browser.settle()
                self.assertEqual(self.js("return downwash.layers[arguments[0]]", layer), wanted)
                shown = self.js("const g = document.querySelector(`[data-layer=${arguments[0]}]`);"
                                "return getComputedStyle(g).display !== 'none' && g.childNodes.length > 0", layer)
                self.assertEqual(shown, wanted, layer)

    def test_goals_and_obstacles_have_their_shapes(self):
        self.open("solids")
        self.assertEqual(self.every(".goal-region", "e.tagName"), ["rect", "rect", "circle"])
        self.assertEqual(len([d for d in self.every(".section-line", "e.getAttribute('d')") if d]), 1)
        self.assertEqual(len(self.every("path.projection", "1")), 11)
        self.assertEqual(len(self.every("path.section", "1")), 9)  # without the two girders beside the plane

    def test_very_many_obstacles_are_few_elements(self):
        self.open_changed("solved", sample_page.add_very_many_obstacles)
        self.assertEqual([len(self.every(f".obstacles path.{kind}", "1")) for kind in ("projection", "section", "section-line")],
                         [1, 1, 1])
        for kind, count in (("projection", 2507), ("section", 1255)):
            self.assertEqual(self.one(f"path.{kind}", "e.getAttribute('d').split('M').length - 1"), count)
            self.assertEqual(self.one(f"path.{kind}", "getComputedStyle(e).fillRule"), "nonzero")
        names = [text.strip("\u2068\u2069") for text in self.every(".of-section, .of-projection", "e.firstChild.data")]
        self.assertIn("deck", names)
        self.assertLessEqual(len(names), 200)
        self.assertEqual(self.every(".obstacle-table", "1"), [])
        self.open_details()
        self.assertEqual(len(self.every(".obstacle-table tbody tr", "1")), 1000)
        self.assertEqual(self.one(".obstacle-table + p", "e.textContent.replaceAll('\\u202f', ' ')"), "and 1 507 more")

    def test_arrows_are_command_times_factor(self):
        columns = self.open("solved")
        self.set_time(10)
        lengths = self.every(".force", "e.getTotalLength()")
        thrusts = [sum(columns[f"rotor_{r}_cmd_n"][1000] * columns[f"rotor_{r}_aero_factor"][1000] for r in pair)
                   for pair in ((1, 2), (3, 4))]
        self.assertEqual(len(lengths), 2)
        self.assertAlmostEqual(lengths[0] / lengths[1], thrusts[0] / thrusts[1], places=4)
        words = self.every(".of-force", "e.textContent")
        self.assertEqual(words, [f"×{columns[f'rotor_{r}_aero_factor'][1000]:.2f}" for r in (1, 3)])

    def test_figures_are_those_of_the_solution(self):
        self.open("solved")
        figures = self.js("return Object.fromEntries([...document.querySelectorAll('.figures > div')].map("
                          "d => [d.querySelector('dt').textContent, d.querySelector('.figure').textContent]))")
        solution = self.js("return downwash.solution")
        execution = solution["execution"]
        plain = {k: v.replace("\u202f", "").replace("\u00a0", " ") for k, v in figures.items()}
        self.assertEqual(plain["Cost, energy"], f"{execution['cost']:.0f} J")
        self.assertEqual(plain["Duration"], f"{execution['duration_s']:.2f} s")
        self.assertEqual(plain["Minimum clearance"], f"{execution['min_clearance_m']:.3f} m")
        self.assertEqual(plain["Goal error"], f"{execution['goal_error_m']:.3f} m")

    def test_no_figure_is_shown_twice(self):
        for case in ("solved", "open-air", "five-goals"):
            self.open(case)
            figures = [text for text in self.every(".figures .figure", "e.textContent") if text != "–"]
            self.assertEqual(len(figures), len(set(figures)), (case, figures))

    def test_every_hover_at_a_goal_is_marked_on_the_slider_and_in_the_plots(self):
        columns = self.open("five-goals")
        end_s = columns["t_s"][-1]
        track = self.one("input.time", "e.getBoundingClientRect().toJSON()")
        thumb = 18  # its middle is at the time
        marks = self.every(".mark.hover", "[e.textContent, e.getBoundingClientRect().left, e.getBoundingClientRect().right]")
        self.assertEqual([text for text, _, _ in marks], ["1", "2", "3", "4", "5"])
        for (_, left, right), (from_s, to_s) in zip(marks, sample_page.HOVERS_S):
            for drawn, time_s in ((left, from_s), (right, to_s)):
                wanted = track["left"] + thumb / 2 + (track["width"] - thumb) * time_s / end_s
                self.assertAlmostEqual(drawn, wanted, delta=1)
        bands = self.every("[data-plot=clearance] .hover-band", "[e.getAttribute('x'), e.getAttribute('width')].map(Number)")
        self.assertEqual(len(bands), 5)
        scale = bands[4][1] / 5
        self.assertAlmostEqual(bands[1][0] - bands[0][0], 5 * scale, places=6)
        self.assertAlmostEqual(bands[1][1], 3 * scale, places=6)

    def test_thrust_ratios_of_many_rotors_stand_side_by_side_in_the_picture(self):
        for width in (1280, 390):
            self.browser.resize(width, 900, mobile=width < 700)
            self.open("five-goals")
            frame = self.one(".scene-svg .frame", "e.getBoundingClientRect().toJSON()")
            for seconds in (0, 5, 14, 33):
                self.set_time(seconds)
                boxes = sorted(self.every(".of-force", "[e.getBoundingClientRect().left, e.getBoundingClientRect().right]"))
                self.assertEqual(len(boxes), 4)
                for (_, right), (left, _) in zip(boxes, boxes[1:]):
                    self.assertLess(right, left, (width, seconds))
                self.assertGreaterEqual(boxes[0][0], frame["left"])
                self.assertLessEqual(boxes[-1][1], frame["right"])


class Verdicts(page_test.BrowserTest):
    def verdict(self):
        return self.js("return document.querySelector('.verdict').innerText")

    def test_solved_and_flown(self):
        self.open("solved")
        self.assertIn("Solved, and the plan flies", self.verdict())

    def test_a_failed_flight_says_how_where_and_when(self):
        columns = self.open("collision")
        text = self.verdict().replace("\u00a0", " ")
        self.assertIn("ends in a collision", text)
        self.assertIn("breaks off after 12.00 s", text)
        self.assertIn(f"x {columns['x_m'][-1]:.2f} m, z {columns['z_m'][-1]:.2f} m", text)
        self.assertEqual(self.js("return downwash.row"), 1200)  # what went wrong is what is shown first
        self.assertEqual(self.js("return document.querySelectorAll('.trouble-mark, .mark.failure').length"), 2)

    def test_warnings_are_seen_at_once_and_told_in_full_when_asked_for(self):
        self.open("doubtful")
        self.assertEqual(self.one(".warnings-count", "e.textContent"), "⚠ 2 warnings")
        self.assertIn("nearly unstable", self.one(".warnings summary", "e.textContent"))
        self.assertLess(self.one(".warnings summary", "e.getBoundingClientRect().height"), 30)
        self.js("document.querySelector('.warnings').open = true")
        self.assertIn("problems/robots/mine.yaml:48", self.one(".warnings li", "e.innerText"))
        for case in ("solved", "certified"):  # files of former versions have no list of warnings
            self.open(case)
            self.assertEqual(self.js("return document.querySelectorAll('.warnings').length"), 0)

    def test_targets_are_named_in_the_order_in_which_the_search_went_to_them(self):
        # Without a plan the page has the goals as they stand in the problem.
        def change(goal):
            def change_report(report):
                report["goals"] = [{**report["goals"][1], "x_m": 2.85 + i, "name": f"target {i + 1}"} for i in range(3)]
                report["goal_order"] = "any_order"
                report["solution"]["planning"]["goal"] = goal
                report["solution"]["order"] = {
                    "visits": [{"target": 3, "alternative": None}, {"target": 1, "alternative": 2}],
                    "left_out": [{"target": 2, "reason": "no_flight", "energy_j": None}], "is_best": True, "legs": 7,
                    "cost_of_legs": 812.5}
            return change_report

        for goal, name in ((1, "target 3"), (2, "target 1"), (3, "the place to return to")):
            self.open_changed("unsolved", change(goal))
            text = self.verdict().replace("\u00a0", " ")
            self.assertIn(f"0.62 m from the region of {name}.", text)
            self.assertIn(f"to the region of {name}", self.one(".figures", "e.textContent"))
            self.assertIn("order of the targets: 3, 1 (alternative 2); no plan in that order was found", text)
            self.assertNotIn("cheapest", text)

    def test_nothing_found_says_what_blocked_it_and_where(self):
        self.open("unsolved")
        text = self.verdict().replace("\u00a0", " ")
        self.assertIn("No plan within the limits", text)
        self.assertIn("touches an obstacle, at x 1.20 m, z 9.40 m", text)
        self.assertIn("from the region of goal 2", text)
        self.assertEqual(self.js("return document.querySelectorAll('.trouble-mark').length"), 1)
        self.assertEqual(self.js("return document.querySelectorAll('input.time, .plots').length"), 0)
        self.assertIsNone(self.js("return downwash.time"))
