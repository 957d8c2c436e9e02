"""Opening: from a file, exactly, quickly; and with data that is none."""

import csv
import math
import os
import re
import subprocess
import sys

import numpy as np

import page_test
import sample_page
from packing import write_page


class Opening(page_test.BrowserTest):
    def test_opens_from_a_file_without_a_word_on_the_console_or_a_request(self):
        for case in sample_page.CASES:
            with self.subTest(case):
                self.browser.complaints(), self.browser.requests()
                self.open(case)
                self.assertEqual(self.browser.complaints(), [])
                self.assertEqual(self.browser.requests(), [])

    def test_shows_a_problem_before_it_is_planned(self):
        self.open("unplanned")
        self.assertEqual(self.js("return document.querySelector('#verdict-title').textContent"), "Not planned yet")
        self.assertEqual(self.js("return document.querySelectorAll('.figures, .search, .plots, .playback').length"), 0)
        self.assertEqual(self.js("return document.querySelectorAll('.scene-svg .at-start').length"), 1)
        self.assertEqual(self.js("return document.querySelectorAll('.open-3d').length"), 1)
        self.assertEqual(self.one(".verdict p code", "e.textContent"), "downwash check")
        self.assertNotIn("`", self.one(".verdict", "e.textContent"))

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
                self.assertEqual(self.column(name), np.asarray(columns[name], dtype="<f8").tobytes(), (case, name))

    def test_a_minute_of_flight_and_ten_thousand_nodes_open_within_a_second(self):
        path, _ = page_test.page_of("large")
        self.assertLess(os.path.getsize(path), 2e6)
        times = []
        for _ in range(3):
            self.open("large")
            times.append(self.js("return performance.getEntriesByName('downwash-ready')[0].startTime"))
        milliseconds = ", ".join(f"{t:.0f}" for t in sorted(times))
        print(f"opens in {milliseconds} ms, {os.path.getsize(path) / 1e3:.0f} kB", file=sys.stderr)
        self.assertLess(min(times), 1000)

    def test_the_template_is_small_and_refers_to_nothing_outside(self):
        with open(page_test.arguments.template, encoding="utf-8") as file:
            text = file.read()
        self.assertLess(len(text.encode()), 500e3)
        self.assertIsNone(re.search(r"<(script|link|img|iframe)[^>]*(src|href)=[\"']?(?!data:|[\"'])", text))
        self.assertEqual(text.count('{"downwash":"nothing"}'), 1)
        self.assertEqual(len(re.findall("</script", text, re.I)), 3)

    def test_building_again_gives_the_same_bytes(self):
        again = os.path.join(page_test.scratch.name, "again")
        subprocess.run([os.path.join(page_test.HERE, "..", "..", "apps", "viewer", "build.sh"), again], check=True)
        for template in (page_test.arguments.template, page_test.arguments.campaign_template,
                         page_test.arguments.validation_template):
            with open(template, "rb") as one, open(os.path.join(again, os.path.basename(template)), "rb") as other:
                self.assertEqual(one.read(), other.read())


class Trouble(page_test.BrowserTest):
    def says(self, page_text, words):
        path = os.path.join(page_test.scratch.name, "trouble.html")
        with open(path, "w", encoding="utf-8") as file:
            file.write(page_text)
        self.assertFalse(self.browser.open(path))
        self.assertIn(words, self.js("return document.querySelector('[role=alert]').textContent"))
        self.assertEqual(self.js("return document.querySelectorAll('.scene, .plots, .verdict').length"), 0)

    def text_of(self, change):
        report = sample_page.solved_report()
        report.pop("_columns")
        change(report)
        path = os.path.join(page_test.scratch.name, "changed.html")
        write_page(page_test.arguments.template, report, path)
        with open(path, encoding="utf-8") as file:
            return file.read()

    def test_a_page_without_a_run_says_so(self):
        with open(page_test.arguments.template, encoding="utf-8") as file:
            self.says(file.read(), "empty template")

    def test_broken_data_is_named_instead_of_half_a_page(self):
        with open(page_test.arguments.template, encoding="utf-8") as file:
            template = file.read()
        self.says(template.replace('{"downwash":"nothing"}', '{"schema": "downwash/rep'), "damaged")
        self.says(template.replace('{"downwash":"nothing"}', "{}"), "without a schema")
        self.says(self.text_of(lambda r: r.update(schema="downwash/report/v9")), "downwash/report/v9")
        self.says(self.text_of(lambda r: r.pop("robot")), "“robot” is missing")
        self.says(self.text_of(lambda r: r["flight"].update(data=r["flight"]["data"][:5000])), "cannot be unpacked")
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


class WrittenPage(page_test.BrowserTest):
    """A page of the program, held against the files of its run."""

    def setUp(self):
        super().setUp()
        if not page_test.arguments.run:
            self.skipTest("no --page and --run")

    def test_shows_its_run(self):
        self.assertTrue(self.browser.open(os.path.join(page_test.arguments.run, "report.html")))
        self.browser.settle()
        self.assertEqual(self.browser.complaints(), [])
        with open(os.path.join(page_test.arguments.run, "trajectory.csv"), encoding="utf-8") as file:
            names, *rows = list(csv.reader(file))
        if not rows:
            self.assertIsNone(self.js("return downwash.time"))
            return
        values = np.array([[float(v) if v else math.nan for v in row] for row in rows])
        self.assertEqual(self.js("return Object.keys(downwash.data)"), names)
        for index, name in enumerate(names):
            decoded = np.frombuffer(self.column(name), dtype="<f8")
            np.testing.assert_array_equal(decoded, values[:, index], name)
        for row in (0, len(rows) // 3, len(rows) - 1):
            self.set_time(values[row, 0])
            drawn = self.middle_of(".vehicle.flown.now .tip")
            wanted = self.pixels(*(values[row, names.index(name)] for name in ("ee_x_m", "ee_z_m")))
            np.testing.assert_allclose(drawn, wanted, atol=0.3)
