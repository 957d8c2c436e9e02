"""What the tests of the page share: a browser per class, pages of invented runs, short ways to ask the page."""

import base64
import os
import tempfile
import unittest

import sample_page
from browser import Browser

HERE = os.path.dirname(os.path.abspath(__file__))
arguments = None  # of the command line
scratch = tempfile.TemporaryDirectory()
made = {}


def page_of(case):
    """Path and columns of an invented run's page, made once."""
    if case not in made:
        path = os.path.join(scratch.name, case + ".html")
        made[case] = (path, sample_page.write(arguments.template, sample_page.CASES[case](), path))
    return made[case]


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
        self.open_page(path)
        return columns

    def open_changed(self, case, change):
        """The page of an invented run whose data `change` has changed."""
        report = sample_page.CASES[case]()
        change(report)
        path = os.path.join(scratch.name, "changed.html")
        sample_page.write(arguments.template, report, path)
        self.open_page(path)

    def open_page(self, path):
        self.assertTrue(self.browser.open(path), "the page shows an error")
        self.browser.settle()

    def open_details(self):
        self.js("document.querySelectorAll('details').forEach(d => { d.open = true; })")
        self.browser.settle()

    def js(self, script, *values):
        return self.browser.js(script, *values)

    def set_time(self, seconds):
        self.js("downwash.time = arguments[0]", seconds)
        self.browser.settle()

    def press(self, key, shift=False, target="document.body"):
        self.js(f"{target}.dispatchEvent(new KeyboardEvent('keydown', "
                "{key: arguments[0], shiftKey: arguments[1], bubbles: true, cancelable: true}))", key, shift)
        self.browser.settle()

    def every(self, selector, expression):
        """The expression of each element `e` that the selector finds."""
        return self.js(f"return [...document.querySelectorAll(arguments[0])].map(e => {expression})", selector)

    def one(self, selector, expression):
        return self.js(f"const e = document.querySelector(arguments[0]); return {expression}", selector)

    def pixels(self, x_m, z_m):
        """Of a point of the plane of motion, in the window."""
        return self.js("return downwash.pixels(...arguments)", x_m, z_m)

    def column(self, name):
        """The bits of a decoded column."""
        text = self.js("const bytes = new Uint8Array(downwash.data[arguments[0]].buffer); let text = '';"
                       "for (const value of bytes) text += String.fromCharCode(value); return btoa(text)", name)
        return base64.b64decode(text)

    def middle_of(self, selector):
        return self.js("const b = document.querySelector(arguments[0]).getBoundingClientRect();"
                       "return [b.left + b.width / 2, b.top + b.height / 2]", selector)
