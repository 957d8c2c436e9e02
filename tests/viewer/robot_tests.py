"""The page of a robot."""

import os

import numpy as np

import page_test
import sample_robot
from packing import write_page
from space_tests import OWN


class Robots(page_test.BrowserTest):
    def show(self, case):
        report = sample_robot.CASES[case]()
        path = os.path.join(page_test.scratch.name, f"{case}.html")
        write_page(page_test.arguments.robot_template, report, path)
        self.assertTrue(self.browser.open(path), "the page shows an error")
        self.browser.settle()
        return report

    def turn(self, joint, degrees):
        self.js("const e = document.querySelector(`[data-joint='${arguments[0]}']`);"
                "e.value = arguments[1]; e.dispatchEvent(new Event('input'))", joint, degrees)
        self.browser.settle()

    def cells(self, label):
        return self.every(f"[aria-label='{label}'] tbody tr", "[...e.children].map((cell) => cell.textContent)")

    def test_opens_from_a_file_with_its_picture_and_without_a_word_on_the_console_or_a_request(self):
        for case in sample_robot.CASES:
            with self.subTest(case):
                self.browser.complaints(), self.browser.requests()
                self.show(case)
                self.assertEqual(self.one(".stage", "e.dataset.state"), "open")
                complaints = [c["message"] for c in self.browser.complaints()]
                self.assertEqual([c for c in complaints if not any(word in c for word in OWN)], [])
                self.assertEqual(self.browser.requests(), [])

    def test_masses_and_rotors_stand_in_tables_and_warnings_as_text(self):
        report = self.show("robot")
        self.assertEqual([row[0] for row in self.cells("Masses")], ["multirotor", "link 1", "link 2", "link 3", "whole"])
        rotors = self.cells("Rotors")
        self.assertEqual([row[3] for row in rotors], ["right ↻", "left ↺"] * 3)
        carried = sum(float(row[5].replace("−", "-")) for row in rotors)
        self.assertAlmostEqual(carried, report["facts"]["mass_kg"] * 9.80665, delta=0.01)
        self.assertEqual(self.every(".robot-warnings li", "e.textContent"), report["warnings"])
        self.show("robot-planar")
        self.assertEqual({row[3] for row in self.cells("Rotors")}, {"–"})

    def test_a_slider_moves_the_arm_and_what_follows_from_it(self):
        report = self.show("robot")
        before = self.js("return downwash.view.tip()")
        np.testing.assert_allclose(before, np.sum([link["joint_m"] for link in report["robot"]["links"]], axis=0) +
                                   report["robot"]["end_effector_m"], atol=1e-6)
        self.turn(0, 60)
        # The joints turn about -y: what hangs moves forward.
        state = self.js("return downwash.state")
        np.testing.assert_allclose(self.js("return downwash.view.tip()"), state["tip_m"], atol=1e-5)
        np.testing.assert_allclose(self.js("return downwash.view.center()"), state["whole_m"], atol=1e-5)
        self.assertGreater(state["whole_m"][0], 0.005)
        forward = [k for k, rotor in enumerate(report["robot"]["rotors"]) if rotor["position_m"][0] > 0.1]
        backward = [k for k, rotor in enumerate(report["robot"]["rotors"]) if rotor["position_m"][0] < -0.1]
        self.assertGreater(min(state["thrusts_n"][k] for k in forward), max(state["thrusts_n"][k] for k in backward))
        # By hand: one link of all three turned, 0.1 kg each.
        turn = np.radians(60)
        hung, at = np.asarray([0.01, 0, -0.06]), np.zeros(3)
        moment = np.zeros(3)
        for i, link in enumerate(report["robot"]["links"]):
            joint = np.asarray(link["joint_m"], dtype=float)
            at = at + (joint if i == 0 else rotated(joint, turn))
            moment += 0.1 * (at + rotated(hung, turn))
        np.testing.assert_allclose(state["whole_m"], moment / report["facts"]["mass_kg"], atol=1e-9)
        self.js("document.querySelector('.joint-sliders button').click()")
        self.browser.settle()
        np.testing.assert_allclose(self.js("return downwash.view.tip()"), before, atol=1e-6)

    def test_layers_can_be_switched_off(self):
        self.show("robot")
        for layer in ("solids", "masses", "forces", "spins", "reach", "names"):
            self.js(f"document.querySelector('[data-toggle={layer}]').click()")
        self.browser.settle()
        self.assertEqual(set(self.js("return downwash.layers").values()), {False})

    def test_a_page_of_another_kind_says_so(self):
        path = os.path.join(page_test.scratch.name, "wrong.html")
        write_page(page_test.arguments.robot_template, {"schema": "downwash/report/v1"}, path)
        self.assertFalse(self.browser.open(path))
        self.assertIn("downwash/robot-report/v1", self.one(".page-trouble", "e.textContent"))


def rotated(v, angle):
    """About -y."""
    c, s = np.cos(angle), np.sin(angle)
    return np.asarray([c * v[0] - s * v[2], v[1], s * v[0] + c * v[2]])
