#!/usr/bin/python3
"""What the page of a run must do, in a browser.

test_run_page.py TEMPLATE.html [--page PAGE.html --run FOLDER] [--expect DIR] [unittest's arguments]

With --page and --run a page that the program wrote is held against the files of its run as well.
UPDATE_EXPECTED=1 writes the expected pictures anew: look at them before they are committed.
"""

import argparse
import os
import sys
import unittest

sys.dont_write_bytecode = True

import page_test
from looks_tests import *
from moving_tests import *
from opening_tests import *


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("template")
    parser.add_argument("--page")
    parser.add_argument("--run")
    parser.add_argument("--expect", default=os.path.join(page_test.HERE, "expected"))
    page_test.arguments, rest = parser.parse_known_args()
    unittest.main(argv=[sys.argv[0], *rest])


if __name__ == "__main__":
    main()
