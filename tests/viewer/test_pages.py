#!/usr/bin/python3
"""What the pages of runs, flights in space, robots, campaigns, comparisons and validations must do, in a browser.

test_pages.py TEMPLATES [--run FOLDER] [--campaign FOLDER] [--validation FOLDER] [--expect DIR] [unittest's arguments]

TEMPLATES is the folder with run.html, space.html, robot.html, campaign.html, comparison.html and validation.html as apps/viewer/build.sh makes
them. With --run, --campaign and --validation pages that the program wrote are held against the files beside them as well.
UPDATE_EXPECTED=1 writes the expected pictures anew: look at them before they are committed.
"""

import argparse
import os
import sys
import unittest

sys.dont_write_bytecode = True

import page_test
from campaign_tests import *
from certificate_tests import *
from comparison_tests import *
from looks_tests import *
from moving_tests import *
from opening_tests import *
from robot_tests import *
from space_tests import *
from validation_tests import *


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("templates")
    parser.add_argument("--run")
    parser.add_argument("--campaign")
    parser.add_argument("--validation")
    parser.add_argument("--expect", default=os.path.join(page_test.HERE, "expected"))
    page_test.arguments, rest = parser.parse_known_args()
    page_test.arguments.template = os.path.join(page_test.arguments.templates, "run.html")
    page_test.arguments.space_template = os.path.join(page_test.arguments.templates, "space.html")
    page_test.arguments.robot_template = os.path.join(page_test.arguments.templates, "robot.html")
    page_test.arguments.campaign_template = os.path.join(page_test.arguments.templates, "campaign.html")
    page_test.arguments.comparison_template = os.path.join(page_test.arguments.templates, "comparison.html")
    page_test.arguments.validation_template = os.path.join(page_test.arguments.templates, "validation.html")
    unittest.main(argv=[sys.argv[0], *rest])


if __name__ == "__main__":
    main()
