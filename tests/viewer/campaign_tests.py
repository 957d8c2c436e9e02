"""The page of a campaign."""

import json
import os
import re
import sys
import xml.etree.ElementTree

import page_test
import sample_campaign
from packing import write_page
from sample_page import HOSTILE

FIGURES = ["worlds", "outcomes", "flown-costs", "cost-shares", "success", "costs", "first-solutions", "pairs"]


class Campaign(page_test.BrowserTest):
    def setUp(self):
        super().setUp()
        self.browser.complaints(), self.browser.requests()

    def show(self, figures):
        path = os.path.join(page_test.scratch.name, "campaign.html")
        write_page(page_test.arguments.campaign_template, figures, path)
        stands = self.browser.open(path)
        self.browser.settle()
        return stands

    def points_of(self, selector):
        """Of the steps and lines of a path: its numbers."""
        return [float(n) for n in re.findall(r"-?[\d.]+", self.one(selector, "e.getAttribute('d')"))]

    def test_has_every_figure_for_every_problem_and_asks_for_nothing(self):
        self.assertTrue(self.show(sample_campaign.campaign()))
        self.assertEqual(self.every("section.figure", "e.id"), FIGURES)
        self.assertEqual(self.every("section.figure", "e.querySelectorAll('.panel svg:not([hidden])').length"), [2] * 8)
        self.assertEqual(self.browser.complaints(), [])
        self.assertEqual(self.browser.requests(), [])

    def test_flights_in_worlds_lead_where_there_are_any(self):
        # Flights that held in the nominal world would name the second planner first, and it fails in most worlds.
        figures = sample_campaign.campaign()
        for totals, held, certified, plans, failed in ((figures["totals"][0], 5, 5, 5, 0), (figures["totals"][1], 9, 0, 9, 240)):
            totals.update(held=sample_campaign.share(held, 10), failed_flights=sample_campaign.share(0, 10))
            totals["in_worlds"].update(tested=10, certified=sample_campaign.share(certified, 10), flown=plans,
                                       failed=sample_campaign.share(failed, 50 * plans))
        self.show(figures)
        tiles = self.every(".of-planners > div", "[...e.querySelectorAll('dd span')].map(s => s.textContent)")
        self.assertEqual(tiles[0][:2], ["250 of 250", "flights in other worlds held, of 5 plans"])
        self.assertEqual(tiles[1][:2], ["210 of 450", "flights in other worlds held, of 9 plans"])
        self.assertIn("failed: 53.3 %", tiles[1][2])
        self.assertEqual(tiles[0][3:], ["certified plans: 5 of 10 seeds", "held in the nominal world: 5 of 10 seeds"])
        self.assertEqual(tiles[1][3:], ["certified plans: 0 of 10 seeds", "held in the nominal world: 9 of 10 seeds"])
        self.assertEqual(self.every("section.figure h2", "e.textContent")[:2],
                         ["Failures in worlds", "Flights in the nominal world"])
        self.assertIn("certified 20 of 20 seeds", self.one("#worlds .panel", "e.textContent"))
        self.assertEqual(self.one("#tables h3", "e.textContent"), "In other worlds")
        self.assertIn("in the nominal world", self.one(".verdict-text p", "e.textContent"))

    def test_a_planner_without_plans_has_its_row_among_flights_in_worlds(self):
        figures = sample_campaign.campaign()
        figures["cells"][1]["in_worlds"] = None
        self.show(figures)
        self.assertIn("mp-arm-da: no plan to fly", self.one("#worlds .panel", "e.textContent"))
        self.assertEqual(len(self.every("#worlds .panel:first-of-type .dot", "1")), 2)

    def test_certificates_lead_where_no_plan_was_flown_in_worlds(self):
        figures = sample_campaign.campaign()
        for each in figures["cells"] + figures["totals"]:
            each["in_worlds"].update(flown=0, failed=sample_campaign.share(0, 0))
        self.show(figures)
        tiles = self.every(".of-planners > div", "[...e.querySelectorAll('dd span')].map(s => s.textContent)")
        self.assertEqual(tiles[0][:3], ["40 of 40", "certified plans", "flights that held: 40 of 40"])
        self.assertEqual(self.one("section.figure", "e.id"), "outcomes")

    def test_one_problem_uses_the_width(self):
        for problems, columns in ((["bridge"], 1), (["bridge", "pipe_rack"], 2)):
            with self.subTest(problems=problems):
                self.browser.resize(1440, 900)
                self.show(sample_campaign.campaign(problems=problems))
                left, right = self.one(".campaign-figures", "(b => [b.left, b.right])(e.getBoundingClientRect())")
                seen = self.every(".campaign-figures .panel", "(b => [b.left, b.right])(e.getBoundingClientRect())")
                self.assertAlmostEqual(min(x for x, _ in seen), left, delta=1)
                self.assertAlmostEqual(max(x for _, x in seen), right, delta=1)
                first = self.every("#worlds .panel", "e.getBoundingClientRect().width")
                self.assertEqual(len(first), len(problems))
                self.assertGreater(min(first), 0.45 * (right - left))
                for low, high in seen:
                    self.assertGreater(high - low, 0.4 * (right - left))

    def test_a_plan_that_failed_is_no_success(self):
        figures = sample_campaign.campaign()
        cell = figures["cells"][2]  # mp-arm: 20 plans, of which 3 fly, 14 fail and 3 were never found
        cell.update(solved=sample_campaign.share(17, 20), held=sample_campaign.share(3, 20),
                    failed_flights=sample_campaign.share(14, 20))
        self.show(figures)
        widths = self.js("return [...document.querySelectorAll('#outcomes .panel')[0].querySelectorAll('.outcome.series-2')]"
                         ".map(e => [e.classList[1], Number(e.getAttribute('width'))])")
        whole = sum(width for _, width in widths)
        self.assertEqual([(kind, round(20 * width / whole, 1)) for kind, width in widths],
                         [("held", 3), ("failed", 14), ("without", 3)])
        text = self.one("#outcomes .panel", "e.textContent")
        self.assertIn("mp-arm: flight held 3, flight failed 14, no plan 3", text)
        self.assertIn("may fail when executed", self.one("#success .note", "e.textContent"))

    def test_failures_in_worlds_are_where_their_share_is(self):
        figures = sample_campaign.campaign()
        for cell in figures["cells"][:3]:
            cell["in_worlds"]["failed"] = {"hits": 30, "attempts": 600, "low": 0.034, "high": 0.07}
        self.show(figures)
        panel = "#worlds .panel "
        at = {text: x for text, x in self.every(panel + ".tick[text-anchor=middle]",
                                                "[e.textContent, Number(e.getAttribute('x'))]")}
        drawn = self.one(panel + ".dot", "Number(e.getAttribute('cx'))")
        self.assertAlmostEqual((drawn - at["0%"]) / (at["6%"] - at["0%"]), 5 / 6, delta=0.01)

    def test_no_figure_of_worlds_without_flights_in_worlds(self):
        figures = sample_campaign.campaign()
        for each in figures["cells"] + figures["totals"]:
            each["in_worlds"] = None
        self.show(figures)
        self.assertEqual(self.js("return document.querySelectorAll('#worlds').length"), 0)
        self.assertEqual(self.one("section.figure", "e.id"), "outcomes")
        self.assertEqual(self.one(".of-planners dd", "e.querySelectorAll('span')[1].textContent"), "flights that held")

    def test_axes_have_ticks_however_short_they_are(self):
        for low, high in ((0.11, 0.13), (1.2, 1.9), (0.3, 0.9), (0.002, 0.5)):
            with self.subTest(low=low, high=high):
                figures = sample_campaign.campaign()
                for cell in figures["cells"]:
                    times = [low + (high - low) * i / 19 for i in range(20)]
                    cell["seeds"]["first_solution_s"] = times
                    cell["first_solution_s"] = sample_campaign.spread(times)
                self.show(figures)
                ticks = self.every("#first-solutions .panel:first-of-type .tick[text-anchor=middle]",
                                   "[e.textContent, e.getBoundingClientRect().left, e.getBoundingClientRect().right]")
                self.assertGreaterEqual(len(ticks), 2, ticks)
                for (_, _, right), (_, left, _) in zip(ticks, ticks[1:]):
                    self.assertLess(right, left, ticks)

    def test_the_axis_of_a_short_search_has_numbers_below_a_second(self):
        figures = sample_campaign.campaign()
        for cell in figures["cells"]:
            cell["cost_curve"] = [{"time_s": t, "cost": sample_campaign.spread([9000 / t])} for t in (0.67, 0.9, 3)]
        self.show(figures)
        ticks = [float(text) for text in self.every("#costs .panel:first-of-type .tick[text-anchor=middle]", "e.textContent")]
        self.assertEqual(ticks, [0.7, 0.8, 1, 2, 3])

    def test_words_of_rows_are_broken_on_a_phone_and_not_cut_off(self):
        self.browser.resize(390, 844, mobile=True)
        figures = sample_campaign.campaign()
        self.show(figures)
        words = self.every("#worlds .panel:first-of-type .row-name", "[e.textContent.slice(1, -1), e.getBBox().y, "
                           "e.getBBox().x + e.getBBox().width, e.ownerSVGElement.viewBox.baseVal.width]")
        self.assertEqual(" ".join(text for text, *_ in words[:2]),
                         "mp-arm-ada: 0.0 % [0.0, 1.9], 20 plans flown, certified 20 of 20 seeds")
        self.assertAlmostEqual(words[1][1] - words[0][1], 14, delta=0.5)
        for _, _, right, width in words:
            self.assertLess(right, width)
        self.assertNotIn("…", self.js("return document.querySelector('.campaign-figures').textContent"))

    def test_tiles_of_planners_share_the_width(self):
        self.browser.resize(1440, 900)
        self.show(sample_campaign.campaign())
        left, right = self.one(".of-planners", "(b => [b.left, b.right])(e.getBoundingClientRect())")
        seen = self.every(".of-planners > div", "(b => [b.left, b.right])(e.getBoundingClientRect())")
        self.assertEqual(len(seen), 3)
        self.assertAlmostEqual(seen[-1][1], right, delta=1)
        for low, high in seen:
            self.assertAlmostEqual(high - low, (right - left) / 3, delta=1)

    def test_dots_of_seeds_are_seen_above_their_boxes(self):
        self.show(sample_campaign.campaign())
        order = self.js("return [...document.querySelectorAll('#flown-costs .panel:first-of-type .series-0')]"
                        ".map(e => e.classList[0])")
        self.assertLess(order.index("box"), order.index("seed-dot"))
        self.assertEqual(order[-1], "median")
        self.assertEqual(set(self.every("#flown-costs .seed-dot", "Number(e.getAttribute('r'))")), {2.3})

    def test_an_empty_list_of_causes_is_none(self):
        self.show(sample_campaign.campaign())
        rows = self.every("[aria-label=Flights] tbody tr", "e.lastChild.textContent")
        self.assertEqual(rows[0], "none")
        self.assertTrue(rows[2].startswith("collision "))

    def test_no_zero_has_a_minus_sign(self):
        figures = sample_campaign.campaign()
        for cell in figures["cells"]:
            cell["least_clearance_m"] = -0.0000004
        figures["comparisons"][0]["median_difference"] = -0.0
        self.show(figures)
        self.assertEqual(re.findall(r"[-−]0(?:\.0+)?(?![\d.])", self.js("return document.getElementById('page').textContent")), [])

    def test_a_success_curve_ends_at_its_share_and_its_band_at_the_interval(self):
        figures = sample_campaign.campaign()
        cell = figures["cells"][0]
        cell["solved_over_time"] = cell["solved_over_time"][:13]
        self.show(figures)
        panel = "#success .panel "
        ticks = self.every(panel + ".tick[text-anchor=end]", "[e.textContent, Number(e.getAttribute('y'))]")
        at = {text: y for text, y in ticks}
        height = at["0%"] - at["100%"]
        share = (at["0%"] - self.points_of(panel + ".line.series-0")[-2]) / height
        self.assertAlmostEqual(share, 13 / 20, delta=0.002)
        highest = (at["0%"] - min(y for y in self.points_of(panel + ".band.series-0")[1::2] if y > 0)) / height
        self.assertAlmostEqual(highest, cell["solved_over_time"][-1]["solved"]["high"], delta=0.002)

    def test_every_seed_with_a_flight_that_held_is_a_dot(self):
        figures = sample_campaign.campaign()
        self.show(figures)
        for i, cell in enumerate(figures["cells"][:3]):
            held = cell["held"]["hits"]
            dots = self.js("return document.querySelector('#flown-costs .panel').querySelectorAll(arguments[0]).length",
                           f".seed-dot.series-{i}")
            self.assertEqual(dots, held)
        pair = figures["comparisons"][0]
        self.assertEqual(self.js("return document.querySelector('#pairs .panel').querySelectorAll('.seed-dot').length"),
                         pair["pairs"])

    def test_a_planner_that_is_switched_off_leaves_all_figures(self):
        self.show(sample_campaign.campaign())
        lines = "return document.querySelectorAll('.panel .series-1').length"
        self.assertGreater(self.js(lines), 10)
        self.js("document.querySelectorAll('.planner input')[1].click()")
        self.assertEqual(self.js(lines), 0)
        self.assertGreater(self.js("return document.querySelectorAll('.panel .series-0').length"), 10)
        self.js("document.querySelectorAll('.planner input').forEach(e => e.checked && e.click())")
        self.assertEqual(self.js("return document.querySelectorAll('.panel svg:not([hidden])').length"), 0)
        self.assertIn("None of the planners shown", self.one("#success .panel", "e.textContent"))

    def test_a_sweep_shows_what_margins_buy_and_starts_with_the_first(self):
        figures = sample_campaign.campaign(margins=(0.05, 0.1, 0.2, 0.4))
        self.show(figures)
        self.assertEqual(self.every(".planner input", "e.checked").count(True), 3)
        dots = self.js("return document.querySelector('#margins .panel').querySelectorAll('.dot.series-2').length")
        self.assertEqual(dots, 4)

    def test_a_sweep_with_several_sets_of_parameters_has_a_curve_for_each(self):
        sets = ({"goal_bias": 0.05}, {"goal_bias": 0.2, "step_m": 1})
        self.show(sample_campaign.campaign(margins=(0.05, 0.1, 0.2, 0.4), parameters=sets))
        self.assertEqual(self.js("return document.querySelector('#margins .panel').querySelectorAll('.line').length"), 6)
        styles = [f".dot.series-{i}" for i in range(6)]
        dots = self.js("const panel = document.querySelector('#margins .panel');"
                       "return arguments[0].map(style => panel.querySelectorAll(style).length)", styles)
        self.assertEqual(dots, [4] * 6)
        self.assertEqual(self.every("#margins .key-line .entry", "e.textContent")[4:],
                         ["mp-arm rrt-star, goal_bias 0.05", "mp-arm rrt-star, goal_bias 0.2, step_m 1"])
        self.assertIn("mp-arm rrt-star, goal_bias 0.2, step_m 1: no margin", self.one("#tables", "e.textContent"))

    def test_the_head_says_what_came_of_it(self):
        figures = sample_campaign.campaign()
        self.show(figures)
        self.assertEqual(self.one(".verdict h2", "e.textContent"), "Targets met: 1 of 1")
        figures["bars"].append({**figures["bars"][0], "kept": False, "found": "3/20"})
        self.show(figures)
        self.assertEqual(self.one(".verdict h2", "e.textContent"), "Targets missed: 1 of 2")
        self.assertIn("found 3/20", self.one(".verdict", "e.textContent"))
        figures["runs_done"] = 7
        self.show(figures)
        self.assertEqual(self.one(".verdict h2", "e.textContent"), "Not finished: 7 of 120 runs")
        figures.update(runs_done=120, bars=[])
        self.show(figures)
        self.assertIn("sets no targets", self.one(".verdict h2", "e.textContent"))

    def test_an_empty_campaign_stands_too(self):
        figures = sample_campaign.campaign()
        for cell in figures["cells"]:
            cell.update(solved=sample_campaign.share(0, 0), solved_over_time=[], cost_curve=[], cost_over_time=[])
            cell["in_worlds"] = None
            cell["seeds"] = {name: [] for name in cell["seeds"]}
        figures.update(runs_done=0, comparisons=[], failures=[])
        for totals in figures["totals"]:
            totals.update(failed_flights=sample_campaign.share(0, 0), held=sample_campaign.share(0, 0), in_worlds=None)
        self.assertTrue(self.show(figures))
        self.assertEqual(self.browser.complaints(), [])

    def test_text_of_others_stays_text(self):
        text = json.dumps(sample_campaign.campaign())
        figures = json.loads(text)
        for cell in figures["cells"][:3]:
            cell["problem"] = HOSTILE + "w" * 10000
        figures["settings"].update(campaign=HOSTILE, description=HOSTILE * 3)
        figures["failures"][0]["cause"] = HOSTILE
        self.assertTrue(self.show(figures))
        self.assertEqual(self.one("h1", "e.textContent"), HOSTILE)
        self.assertEqual(self.js("return document.querySelectorAll('main script, main img, main iframe').length"), 0)
        self.assertLessEqual(self.js("return document.documentElement.scrollWidth"), 1400)
        self.assertEqual(self.browser.complaints(), [])

    def test_no_page_is_wider_than_a_phone(self):
        for width in (360, 768):
            self.browser.resize(width, 800, mobile=width < 700)
            self.show(sample_campaign.campaign(margins=(0.05, 0.1)))
            self.open_details()
            self.assertLessEqual(self.js("return document.documentElement.scrollWidth"), width)

    def saved(self):
        return self.browser.driver.execute_async_script(
            "const done = arguments[0], make = URL.createObjectURL;"
            "URL.createObjectURL = blob => {"
            "    URL.createObjectURL = make; blob.text().then(done); return make(blob); };"
            "document.querySelector('#success .panel button').click()")

    def test_a_figure_is_saved_in_light_colours_whatever_the_theme(self):
        for theme in ("light", "dark"):
            self.browser.media(prefers_color_scheme=theme)
            self.show(sample_campaign.campaign())
            saved = self.saved()
            root = xml.etree.ElementTree.fromstring(saved)
            self.assertTrue(root.tag.endswith("svg"))
            self.assertNotIn("var(", saved)
            strokes = {e.get("stroke") for e in root.iter() if e.tag.endswith("path")}
            self.assertIn("rgb(0, 96, 184)", strokes)
            self.assertIn("time of the search [s]", saved)
            self.assertEqual(self.js("return document.documentElement.dataset.theme"), theme)

    def test_an_empty_figure_cannot_be_saved(self):
        self.show(sample_campaign.campaign())
        shown = "return document.querySelectorAll('#success .panel button:not([hidden])').length"
        self.assertEqual(self.js(shown), 2)
        self.js("document.querySelectorAll('.planner input').forEach(e => e.checked && e.click())")
        self.assertEqual(self.js(shown), 0)
        self.js("document.querySelector('.planner input').click()")
        self.assertEqual(self.js(shown), 2)
        self.js("document.querySelector('#success .panel svg').removeAttribute('viewBox')")
        self.assertTrue(xml.etree.ElementTree.fromstring(self.saved()).tag.endswith("svg"))

    def test_a_page_without_a_campaign_says_so(self):
        self.assertFalse(self.browser.open(page_test.arguments.campaign_template))
        self.assertIn("empty template", self.one("[role=alert]", "e.textContent"))
        self.assertFalse(self.show({"schema": "downwash/campaign-report/v9"}))
        self.assertIn("campaign-report/v9", self.one("[role=alert]", "e.textContent"))

    def test_a_large_campaign_is_small_and_opens_within_a_second(self):
        figures = sample_campaign.campaign(problems=[f"problem {i}" for i in range(8)], seeds=200)
        self.show(figures)
        size = os.path.getsize(os.path.join(page_test.scratch.name, "campaign.html"))
        opened = self.js("return performance.getEntriesByName('downwash-ready')[0].startTime")
        print(f"4800 runs open in {opened:.0f} ms, {size / 1e3:.0f} kB", file=sys.stderr)
        self.assertLess(size, 2e6)
        self.assertLess(opened, 1000)

    def test_a_page_says_what_it_leaves_out_and_what_it_pools(self):
        figures = sample_campaign.campaign()
        figures["seed_step"] = 5
        figures["processor_models"] = 2
        del figures["settings"]["processor"]
        for cell in figures["cells"]:
            cell["seeds"] = {name: values[::5] for name, values in cell["seeds"].items()}
        failure = figures["failures"][0]
        failure["seeds"] = failure["seeds"][:1]
        self.assertTrue(self.show(figures))
        text = self.js("return document.getElementById('page').textContent")
        self.assertIn("dots: every 5th seed", text)
        self.assertIn("of 2 models of processors together", text)
        self.assertIn("a host", text)
        self.assertIn(f"{failure['seeds'][0]} …", text)
        held = figures["cells"][0]["held"]
        self.assertIn(f"{held['hits']} of {held['attempts']} flights held",
                      self.one("#cost-shares svg", "e.getAttribute('aria-label') ?? e.outerHTML"))
        self.assertEqual(self.browser.complaints(), [])

    def test_the_programs_page_holds_the_figures_of_its_report(self):
        if not page_test.arguments.campaign:
            self.skipTest("no page of the program given")
        folder = page_test.arguments.campaign
        self.assertTrue(self.browser.open(os.path.join(folder, "report.html")))
        with open(os.path.join(folder, "report.json"), encoding="utf-8") as file:
            self.assertEqual(self.js("return downwash.figures"), json.load(file))
        self.assertEqual(self.every("section.figure", "e.id"), ["margins"] + FIGURES)
        self.assertEqual(self.browser.complaints(), [])
        self.assertEqual(self.browser.requests(), [])
