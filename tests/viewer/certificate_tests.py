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
        self.assertIn("1.731", self.one(".figures", "e.textContent"))
        self.assertIn("--world 17", self.one(".certificate .command code", "e.textContent"))
        self.assertEqual(len(self.every(".worst-worlds tbody tr", "1")), 10)

    def test_a_missing_one_says_why(self):
        self.open("uncertified")
        self.assertIn("A plan was found, but it is not certified", self.verdict())
        self.assertIn("Not certified: 4 of 37 worlds failed (collision 3, goal missed 1).", self.verdict())
        self.assertEqual(self.every(".certificate .bars .count", "e.textContent"), ["3", "1"])

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
