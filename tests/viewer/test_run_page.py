#!/usr/bin/python3
"""What the page of a run must do, in a browser.

test_run_page.py TEMPLATE.html [--page PAGE.html --run FOLDER] [--expect DIR] [unittest's arguments]

With --page and --run a page that the program wrote is held against the files of its run as well.
UPDATE_EXPECTED=1 writes the expected pictures anew: look at them before they are committed.
"""

import argparse
import base64
import csv
import io
import math
import os
import re
import subprocess
import sys
import tempfile
import time
import unittest

import numpy as np
from PIL import Image

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

import sample_page
from browser import Browser
from packing import write_page

HERE = os.path.dirname(os.path.abspath(__file__))
arguments = None
scratch = tempfile.TemporaryDirectory()


def page_of(case):
    """Path and columns of an invented run's page, made once."""
    if case not in page_of.made:
        path = os.path.join(scratch.name, case + ".html")
        page_of.made[case] = (path, sample_page.write(arguments.template, sample_page.CASES[case](), path))
    return page_of.made[case]


page_of.made = {}


class BrowserTest(unittest.TestCase):
    browser_arguments = ()

    @classmethod
    def setUpClass(cls):
        cls.browser = Browser(arguments=cls.browser_arguments)
        cls.addClassCleanup(cls.browser.close)

    def setUp(self):
        self.browser.media()
        self.browser.resize(1400, 900)

    def open(self, case):
        path, columns = page_of(case)
        self.assertTrue(self.browser.open(path), "the page shows an error")
        self.browser.settle()
        return columns

    def js(self, script, *values):
        return self.browser.js(script, *values)

    def set_time(self, seconds):
        self.js("downwash.time = arguments[0]", seconds)
        self.browser.settle()

    def press(self, key, shift=False, target="document.body"):
        self.js(f"{target}.dispatchEvent(new KeyboardEvent('keydown', "
                "{key: arguments[0], shiftKey: arguments[1], bubbles: true, cancelable: true}))", key, shift)
        self.browser.settle()

    def middle_of(self, selector):
        return self.js("const b = document.querySelector(arguments[0]).getBoundingClientRect();"
                       "return [b.left + b.width / 2, b.top + b.height / 2]", selector)


class Opening(BrowserTest):
    def test_opens_from_a_file_without_a_word_on_the_console_or_a_request(self):
        for case in sample_page.CASES:
            with self.subTest(case):
                self.browser.complaints(), self.browser.requests()
                self.open(case)
                self.assertEqual(self.browser.complaints(), [])
                self.assertEqual(self.browser.requests(), [])

    def test_forbids_requests(self):
        self.open("solved")
        policy = self.js("return document.querySelector('meta[http-equiv]').content")
        self.assertIn("default-src 'none'", policy)
        self.assertNotIn("connect-src", policy)
        blocked = self.browser.driver.execute_async_script(
            "fetch('https://example.invalid/').then(() => arguments[0](false), () => arguments[0](true))")
        self.assertTrue(blocked)
        self.assertEqual(self.browser.requests(), [])
        self.browser.complaints()

    def test_columns_are_those_of_the_flight_to_the_last_bit(self):
        for case in ("solved", "open-air", "large"):
            columns = self.open(case)
            names = self.js("return Object.keys(downwash.data)")
            self.assertEqual(names, list(columns))
            for name in names:
                text = self.js("const b = new Uint8Array(downwash.data[arguments[0]].buffer); let s = '';"
                               "for (const v of b) s += String.fromCharCode(v); return btoa(s)", name)
                self.assertEqual(base64.b64decode(text), np.asarray(columns[name], dtype="<f8").tobytes(), (case, name))

    def test_a_minute_of_flight_and_ten_thousand_nodes_open_within_a_second(self):
        path, _ = page_of("large")
        self.assertLess(os.path.getsize(path), 2e6)
        times = []
        for _ in range(3):
            self.open("large")
            times.append(self.js("return performance.getEntriesByName('downwash-ready')[0].startTime"))
        print(f"opens in {', '.join(f'{t:.0f}' for t in sorted(times))} ms, {os.path.getsize(path) / 1e3:.0f} kB", file=sys.stderr)
        self.assertLess(min(times), 1000)

    def test_the_template_is_small_and_refers_to_nothing_outside(self):
        with open(arguments.template, encoding="utf-8") as file:
            text = file.read()
        self.assertLess(len(text.encode()), 500e3)
        self.assertIsNone(re.search(r"<(script|link|img|iframe)[^>]*(src|href)=[\"']?(?!data:|[\"'])", text))
        self.assertEqual(text.count('{"downwash":"run"}'), 1)
        self.assertEqual(len(re.findall("</script", text, re.I)), 3)

    def test_building_again_gives_the_same_bytes(self):
        again = os.path.join(scratch.name, "again.html")
        subprocess.run([os.path.join(HERE, "..", "..", "viewer", "build.sh"), again], check=True)
        with open(arguments.template, "rb") as one, open(again, "rb") as other:
            self.assertEqual(one.read(), other.read())


class Trouble(BrowserTest):
    def says(self, page_text, words):
        path = os.path.join(scratch.name, "trouble.html")
        with open(path, "w", encoding="utf-8") as file:
            file.write(page_text)
        self.assertFalse(self.browser.open(path))
        self.assertIn(words, self.js("return document.querySelector('[role=alert]').textContent"))
        self.assertEqual(self.js("return document.querySelectorAll('.scene, .plots, .verdict').length"), 0)

    def text_of(self, change):
        report = sample_page.solved_report()
        report.pop("_columns")
        change(report)
        path = os.path.join(scratch.name, "changed.html")
        write_page(arguments.template, report, path)
        with open(path, encoding="utf-8") as file:
            return file.read()

    def test_a_page_without_a_run_says_so(self):
        with open(arguments.template, encoding="utf-8") as file:
            self.says(file.read(), "empty template")

    def test_broken_data_is_named_instead_of_half_a_page(self):
        with open(arguments.template, encoding="utf-8") as file:
            template = file.read()
        self.says(template.replace('{"downwash":"run"}', '{"schema": "downwash/rep'), "damaged")
        self.says(template.replace('{"downwash":"run"}', "{}"), "without a schema")
        self.says(self.text_of(lambda r: r.update(schema="downwash/report/v9")), "downwash/report/v9")
        self.says(self.text_of(lambda r: r.pop("robot")), "“robot” is missing")
        self.says(self.text_of(lambda r: r["flight"].update(data=r["flight"]["data"][:5000])), "flight of this page cannot be unpacked")
        self.says(self.text_of(lambda r: r["flight"].update(rows=7)), "where")
        self.says(self.text_of(lambda r: r["flight"].update(data="%%%")), "cannot be unpacked")
        self.says(self.text_of(lambda r: r["scene"].pop("bounds")), "expected shape")

    def test_an_old_browser_is_told_what_it_lacks(self):
        script = self.browser.driver.execute_cdp_cmd("Page.addScriptToEvaluateOnNewDocument",
                                                     {"source": "delete window.DecompressionStream"})
        try:
            self.says(self.text_of(lambda r: None), "lacks DecompressionStream")
        finally:
            self.browser.driver.execute_cdp_cmd("Page.removeScriptToEvaluateOnNewDocument", script)


class Moving(BrowserTest):
    def assert_tip_is_where_the_flight_says(self, columns):
        row = self.js("return downwash.row")
        drawn = self.middle_of(".vehicle.flown.now .tip")
        wanted = self.js("return downwash.pixels(arguments[0], arguments[1])", columns["ee_x_m"][row], columns["ee_z_m"][row])
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
        after, up = self.js("const [a, c] = downwash.pixels(0, 9), [b] = downwash.pixels(1, 9), [, d] = downwash.pixels(0, 10);"
                            "return [b - a, c - d]")
        self.assertAlmostEqual(after / before, 1.4**3, places=3)
        self.assertAlmostEqual(after, up, places=6)  # equal axes
        self.assert_tip_is_where_the_flight_says(columns)

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
            left, top, width = self.js("const b = document.querySelector(`[data-plot=${arguments[0]}] svg`).getBoundingClientRect();"
                                       "return [b.left, b.top + 30, b.width]", plot)
            self.drag(left + 0.5 * width, top, left + share * width, top + 5)
            row = self.js("return downwash.row")
            self.assertAlmostEqual(row / self.js("return downwash.rows"), share, delta=0.1)
            self.assertEqual(int(self.js("return document.querySelector('input.time').value")), row)
            self.assert_tip_is_where_the_flight_says(columns)
            cursors = self.js("return [...document.querySelectorAll('.cursor')].map(c => c.getAttribute('d').split(' ')[0])")
            self.assertEqual(len(set(cursors)), 1)
            drawn = self.middle_of(f"[data-plot={plot}] .cursor")[0]
            self.assertAlmostEqual(drawn, left + share * width, delta=2)

    def test_the_pointer_says_what_is_below_it(self):
        self.open("solved")
        self.js("document.querySelector('.scene-svg').scrollIntoView()")
        for place, words in (((-3, 9.5), "factor 1.0"), ((0, 10.5), "not flyable")):
            x, y = self.js("return downwash.pixels(...arguments)", *place)
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

    def test_a_space_on_a_control_belongs_to_the_control(self):
        self.open("solved")
        self.press(" ", target="document.querySelector('[data-toggle=map]')")
        self.assertFalse(self.js("return downwash.is_playing"))

    def test_playing_keeps_to_the_clock_and_ends_at_the_end(self):
        self.open("solved")
        self.set_time(18.9)
        self.js("const s = document.querySelector('.speed select'); s.value = '4'; document.querySelector('.play').click()")
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

    def test_arrows_are_command_times_factor(self):
        columns = self.open("solved")
        self.set_time(10)
        lengths = self.js("return [...document.querySelectorAll('.force')].map(p => p.getTotalLength())")
        thrusts = [sum(columns[f"rotor_{r}_cmd_n"][1000] * columns[f"rotor_{r}_aero_factor"][1000] for r in pair)
                   for pair in ((1, 2), (3, 4))]
        self.assertEqual(len(lengths), 2)
        self.assertAlmostEqual(lengths[0] / lengths[1], thrusts[0] / thrusts[1], places=4)
        words = self.js("return [...document.querySelectorAll('.of-force')].map(p => p.textContent)")
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
        self.assertEqual(plain["Least clearance"], f"{execution['min_clearance_m']:.3f} m")
        self.assertEqual(plain["Goal error"], f"{execution['goal_error_m']:.3f} m")
        self.assertEqual(plain["Iterations"], str(solution["planning"]["iterations"]))


class Verdicts(BrowserTest):
    def verdict(self):
        return self.js("return document.querySelector('.verdict').innerText")

    def test_solved_and_flown(self):
        self.open("solved")
        self.assertIn("Solved, and it flies", self.verdict())

    def test_a_failed_flight_says_how_where_and_when(self):
        columns = self.open("collision")
        text = self.verdict().replace("\u00a0", " ")
        self.assertIn("ends in a collision", text)
        self.assertIn("breaks off after 12.00 s", text)
        self.assertIn(f"x {columns['x_m'][-1]:.2f} m, z {columns['z_m'][-1]:.2f} m", text)
        self.assertEqual(self.js("return downwash.row"), 1200)  # what went wrong is what is shown first
        self.assertEqual(self.js("return document.querySelectorAll('.trouble-mark, .mark.failure').length"), 2)

    def test_nothing_found_says_what_blocked_it_and_where(self):
        self.open("unsolved")
        text = self.verdict().replace("\u00a0", " ")
        self.assertIn("No plan within the limits", text)
        self.assertIn("touches an obstacle, at x 1.20 m, z 9.40 m", text)
        self.assertEqual(self.js("return document.querySelectorAll('.trouble-mark').length"), 1)
        self.assertEqual(self.js("return document.querySelectorAll('input.time, .plots').length"), 0)
        self.assertIsNone(self.js("return downwash.time"))


class Looks(BrowserTest):
    def background(self):
        return [int(v) for v in re.findall(r"\d+", self.js("return getComputedStyle(document.body).backgroundColor"))[:3]]

    def test_dark_and_light_follow_the_system_and_the_switch(self):
        self.browser.media(prefers_color_scheme="dark")
        self.open("solved")
        self.assertLess(max(self.background()), 60)
        self.browser.media(prefers_color_scheme="light")
        self.browser.settle()
        self.assertGreater(min(self.background()), 230)
        self.js("document.querySelector('[name=theme][value=dark]').click()")
        self.assertLess(max(self.background()), 60)
        images = self.js("return [...document.querySelectorAll('.map image')].filter(i => getComputedStyle(i).display !== 'none').length")
        self.assertEqual(images, 1)

    def test_words_have_contrast_in_both(self):
        def luminance(color):
            parts = [v / 255 for v in color]
            parts = [v / 12.92 if v <= 0.04045 else ((v + 0.055) / 1.055)**2.4 for v in parts]
            return 0.2126 * parts[0] + 0.7152 * parts[1] + 0.0722 * parts[2]

        for theme in ("light", "dark"):
            self.browser.media(prefers_color_scheme=theme)
            self.open("collision")
            paper = luminance(self.background())
            for selector in ("h1", ".muted", ".verdict h2", ".plot-title", ".plot .tick", ".word.of-time", "summary"):
                color = self.js("const e = document.querySelector(arguments[0]), c = getComputedStyle(e);"
                                "return e instanceof SVGElement ? c.fill : c.color", selector)
                other = luminance([int(v) for v in re.findall(r"\d+", color)[:3]])
                ratio = (max(paper, other) + 0.05) / (min(paper, other) + 0.05)
                self.assertGreater(ratio, 4.5, (theme, selector, color))

    def test_no_page_is_wider_than_a_phone(self):
        for case in sample_page.CASES:
            for width in (360, 390, 768):
                with self.subTest(case=case, width=width):
                    self.browser.resize(width, 800, mobile=width < 700)
                    self.open(case)
                    self.js("document.querySelectorAll('details').forEach(d => { d.open = true; })")
                    self.browser.settle()
                    self.assertLessEqual(self.js("return document.documentElement.scrollWidth"), width)

    def test_prints_light_without_controls(self):
        self.browser.media(prefers_color_scheme="dark")
        self.open("solved")
        pdf = self.browser.pdf()
        self.assertTrue(pdf.startswith(b"%PDF"))
        self.assertLessEqual(len(re.findall(rb"/Type\s*/Page\b", pdf)), 4)
        self.browser.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": "print"})
        try:
            self.assertGreater(min(self.background()), 230)
            is_seen = "return document.querySelector(arguments[0]).getBoundingClientRect().width > 0"
            for selector in (".playback", ".layers", ".readout", ".view3d", ".vehicle.now", ".theme"):
                self.assertFalse(self.js(is_seen, selector), selector)
            for selector in (".snapshots .vehicle", ".plot-svg", ".verdict", ".figures", ".map image"):
                self.assertTrue(self.js(is_seen, selector), selector)
        finally:
            self.browser.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": ""})

    def test_looks_as_expected(self):
        """Coarsely, a pixel for a square of eight: fonts differ between machines."""
        for name, case, width, mobile in (("desktop", "solved", 1400, False), ("phone", "solved", 390, True),
                                          ("unsolved", "unsolved", 1400, False)):
            with self.subTest(name):
                self.browser.resize(width, 900, mobile)
                self.open(case)
                if case == "solved":
                    self.set_time(8)
                picture = Image.open(io.BytesIO(self.browser.screenshot(whole=True))).convert("RGB")
                small = picture.resize((picture.width // 8, picture.height // 8), Image.BOX)
                path = os.path.join(arguments.expect, name + ".png")
                if os.environ.get("UPDATE_EXPECTED"):
                    small.quantize(64).save(path, optimize=True)
                    continue
                expected = Image.open(path).convert("RGB")
                self.assertAlmostEqual(small.height, expected.height, delta=0.06 * expected.height)
                height = min(small.height, expected.height, 70)  # further down another font's lines have moved everything
                crop = (0, 0, small.width, height)
                difference = np.abs(np.asarray(small.crop(crop), int) - np.asarray(expected.crop(crop), int)).mean()
                self.assertLess(difference, 12, f"mean difference of {difference:.1f} of 255")


class Hostile(BrowserTest):
    def test_foreign_text_is_shown_and_does_nothing(self):
        self.open("hostile")
        self.assertIsNone(self.js("return window.hacked ?? null"))
        self.assertEqual(self.js("return document.querySelectorAll('#page img, #page script').length"), 0)
        self.assertIn(sample_page.HOSTILE.strip(), self.js("return document.querySelector('h1').textContent"))
        for selector in (".description", ".command code", ".yaml code", ".foreign-name", ".pairs"):
            self.assertIn(sample_page.HOSTILE.strip(), self.js("return document.querySelector(arguments[0]).textContent", selector))
        self.assertEqual(self.js("return [...document.querySelectorAll('h1, .description, .foreign-name')].filter(e => !e.querySelector('bdi')).length"), 0)

    def test_long_text_is_clipped_with_a_way_to_read_it(self):
        self.open("hostile")
        for selector in (".description", ".command pre"):
            box = self.js("const e = document.querySelector(arguments[0]); return [e.clientHeight, e.scrollHeight, e.tabIndex]", selector)
            self.assertLess(box[0], 500)
            self.assertGreater(box[1], box[0])
            self.assertEqual(box[2], 0)
        widest = self.js("return Math.max(...[...document.querySelectorAll('.of-section, .of-projection')].map(e => e.getBBox().width))")
        self.assertLess(widest, 320)


class Access(BrowserTest):
    def test_every_control_and_picture_has_a_name(self):
        for case in ("solved", "unsolved"):
            self.open(case)
            nameless = self.js("""
                return [...document.querySelectorAll('input, select, button, [role=img], [role=group], [role=region]')].filter(e => {
                    const name = e.getAttribute('aria-label') || e.textContent.trim() || e.closest('label')?.textContent.trim();
                    return !name;
                }).map(e => e.outerHTML.slice(0, 120))""")
            self.assertEqual(nameless, [])
            self.assertEqual(self.js("return document.querySelectorAll('h1').length"), 1)
            self.assertEqual(self.js("return document.documentElement.lang"), "en")

    def test_descriptions_say_what_the_picture_says(self):
        columns = self.open("solved")
        label = self.js("return document.querySelector('[data-plot=clearance] svg').getAttribute('aria-label')").replace("\u00a0", " ")
        self.assertIn(f"from {np.min(columns['clearance_m']):.3f} m", label)
        self.assertIn("safety margin 0.050 m", label)
        scene = self.js("return document.querySelector('.scene-svg').getAttribute('aria-label')")
        self.assertIn("7 obstacles", scene)

    def test_the_focus_is_seen_wherever_it_goes(self):
        self.open("solved")
        for _ in range(25):
            self.browser.driver.execute_cdp_cmd("Input.dispatchKeyEvent", {"type": "keyDown", "key": "Tab", "windowsVirtualKeyCode": 9})
            outline = self.js("const e = document.activeElement, c = getComputedStyle(e);"
                              "return [e.tagName, c.outlineStyle, parseFloat(c.outlineWidth)]")
            self.assertNotEqual(outline[0], "BODY")
            self.assertNotEqual(outline[1], "none", outline)
            self.assertGreater(outline[2], 0.9, outline)

    def test_plots_are_tables_too(self):
        columns = self.open("solved")
        rows = self.js("return [...document.querySelectorAll('.table-of-plots tbody tr')].map(r => r.innerText || r.textContent)")
        self.assertEqual(len(rows), 21)
        self.assertIn(f"{columns['clearance_m'][0]:.3f}", rows[0])


class InThreeDimensions(BrowserTest):
    browser_arguments = ("--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader")

    def test_opens_on_demand_and_follows_the_slider(self):
        columns = self.open("solids")
        self.assertEqual(self.js("return document.querySelectorAll('canvas').length"), 0)
        self.js("document.querySelector('.open-3d').click()")
        for _ in range(100):
            if self.js("return document.querySelector('.stage').dataset.state ?? ''"):
                break
            time.sleep(0.1)
        self.assertEqual(self.js("return document.querySelector('.stage').dataset.state"), "open",
                         self.js("return document.querySelector('.view3d [role=status]').textContent"))
        for seconds in (0, 6, 15):
            self.set_time(seconds)
            row = self.js("return downwash.row")
            tip = self.js("return document.querySelector('.stage').view.tip()")
            for drawn, wanted in zip(tip, (columns["ee_x_m"][row], 0, columns["ee_z_m"][row])):
                self.assertAlmostEqual(drawn, wanted, places=5)
        time.sleep(0.3)
        self.js("document.querySelector('.stage').scrollIntoView({block: 'center'})")
        box = self.js("const b = document.querySelector('.stage').getBoundingClientRect(); return [b.left, b.top, b.right, b.bottom]")
        picture = Image.open(io.BytesIO(self.browser.screenshot())).convert("L").crop(tuple(int(v) for v in box))
        self.assertGreater(np.asarray(picture).std(), 8)
        self.press("d", target="document.querySelector('.stage canvas')")
        self.assertEqual([c for c in self.browser.complaints() if "GPU stall" not in c["message"] and "GroupMarker" not in c["message"]], [])


class WithoutWebGl(BrowserTest):
    browser_arguments = ("--disable-gpu", "--disable-3d-apis")

    def test_says_so(self):
        self.open("solved")
        self.js("document.querySelector('.open-3d').click()")
        time.sleep(0.3)
        self.assertIn("no WebGL", self.js("return document.querySelector('.view3d [role=status]').textContent"))


class WrittenPage(BrowserTest):
    """A page of the program, held against the files of its run."""

    def setUp(self):
        super().setUp()
        if not arguments.page or not arguments.run:
            self.skipTest("no --page and --run")

    def test_shows_its_run(self):
        self.assertTrue(self.browser.open(arguments.page))
        self.browser.settle()
        self.assertEqual(self.browser.complaints(), [])
        with open(os.path.join(arguments.run, "trajectory.csv"), encoding="utf-8") as file:
            names, *rows = list(csv.reader(file))
        if not rows:
            self.assertIsNone(self.js("return downwash.time"))
            return
        values = np.array([[float(v) if v else math.nan for v in row] for row in rows])
        self.assertEqual(self.js("return Object.keys(downwash.data)"), names)
        for index, name in enumerate(names):
            text = self.js("const b = new Uint8Array(downwash.data[arguments[0]].buffer); let s = '';"
                           "for (const v of b) s += String.fromCharCode(v); return btoa(s)", name)
            decoded = np.frombuffer(base64.b64decode(text), dtype="<f8")
            np.testing.assert_array_equal(decoded, values[:, index], name)
        for row in (0, len(rows) // 3, len(rows) - 1):
            self.set_time(values[row, 0])
            drawn = self.middle_of(".vehicle.flown.now .tip")
            wanted = self.js("return downwash.pixels(arguments[0], arguments[1])",
                             *(values[row, names.index(name)] for name in ("ee_x_m", "ee_z_m")))
            np.testing.assert_allclose(drawn, wanted, atol=0.3)


def main():
    global arguments
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("template")
    parser.add_argument("--page")
    parser.add_argument("--run")
    parser.add_argument("--expect", default=os.path.join(HERE, "expected"))
    arguments, rest = parser.parse_known_args()
    unittest.main(argv=[sys.argv[0], *rest])


if __name__ == "__main__":
    main()
