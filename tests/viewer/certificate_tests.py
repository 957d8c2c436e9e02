"""The certificate of a plan on the page of a run."""

import page_test


class Certificate(page_test.BrowserTest):
    def verdict(self):
        return self.one(".verdict-text", "e.textContent.replaceAll('\\u00a0', ' ').replaceAll('\\u202f', ' ')")

    def test_a_run_without_one_does_not_mention_it(self):
        self.open("solved")
        self.assertEqual(self.every(".certificate, .certificate-line", "1"), [])
        self.assertNotIn("ertified", self.js("return document.querySelector('main').textContent"))

    def test_a_given_one_says_what_it_promises_and_in_which_world_the_flight_was(self):
        self.open("certified")
        self.assertIn("Certified: 1 of 1 016 worlds failed; the failure probability is at most 1 % with 95 % confidence.",
                      self.verdict())
        self.assertIn("in world 17 of seed 1", self.verdict())
        self.assertIn("to the right of its plane", self.verdict())
        self.assertIn("1.731", self.one(".figures", "e.textContent"))
        self.assertIn("--world 17", self.one(".certificate .command code", "e.textContent"))
        self.assertEqual(len(self.every(".worst-worlds tbody tr", "1")), 10)

    def test_its_command_stands_beside_the_worst_worlds(self):
        self.browser.resize(1440, 900)
        self.open("certified")
        table = self.one(".certificate .worst-worlds", "e.getBoundingClientRect().toJSON()")
        command = self.one(".certificate .command", "e.getBoundingClientRect().toJSON()")
        self.assertGreater(command["left"], table["right"])
        self.assertLess(command["bottom"], table["bottom"])

    def test_a_missing_one_says_why(self):
        self.open("uncertified")
        self.assertIn("A plan was found, but it is not certified", self.verdict())
        self.assertIn("Not certified: 4 of 37 worlds failed (collision 3, goal missed 1).", self.verdict())
        self.assertEqual(self.every(".certificate .bars .count", "e.textContent"), ["3", "1"])

    def test_what_was_set_is_not_rounded(self):
        self.open_changed("certified", lambda report: report["solution"]["certificate"].update(
            confidence=0.9999, max_failure_probability=0.0124))
        self.assertIn("the failure probability is at most 1.24 % with 99.99 % confidence.", self.verdict())
        text = self.one(".probability", "e.textContent.replaceAll('\\u00a0', ' ')")
        self.assertIn("99.99 % interval", text)
        self.assertIn("allowed: 1.24 %", text)

    def test_one_without_flights_is_no_estimate(self):
        self.open_changed("uncertified", lambda report: report["solution"]["certificate"].update(
            worlds=0, failures=0, failure_probability={"estimate": 0, "low": 0, "high": 1}, causes={}, worst=[],
            clearance_m=dict.fromkeys(("p01", "p10", "p50"))))
        self.assertIn("Not certified: the search ended before its first flights.", self.verdict())
        self.assertEqual(self.one(".probability .figure", "e.textContent"), "–")
        self.assertEqual(self.every(".probability-estimate", "1"), [])

    def test_the_bar_ends_where_the_interval_does(self):
        for case, low, high, kind in (("certified", 0.000025, 0.00547, "within"), ("uncertified", 0.03, 0.254, "beyond")):
            self.open(case)
            box = "(b => [b.left, b.right])(e.getBoundingClientRect())"
            limit = self.one(".probability-limit", box)[0]
            left, right = self.one(".probability-interval." + kind, box)
            start = self.one(".probability-track", box)[0]
            per_pixel = 0.01 / (limit + 1 - start)  # its line is two pixels wide
            self.assertAlmostEqual((left - start) * per_pixel, low, delta=3 * per_pixel)
            self.assertAlmostEqual((right - start) * per_pixel, high, delta=0.05 * high)
