"""What tests of planners that plan again in flight share, in the plane and in space."""

import numpy as np


def midway(planner):
    """The vehicle in the middle of the last plan, and the tick there."""
    tick = round(planner.plan["t_s"][-1] / planner.tick_s / 2)
    return planner.predicted(planner.start, planner.plan, tick), tick


def same(plan, other):
    return list(plan) == list(other) and all(np.array_equal(plan[name], other[name]) for name in plan)
