#!/usr/bin/env python3
"""An inspection mission in space on the Python package of Downwash: mission.cpp, decision by decision.

Targets in any order with one battery, and back. The planner makes one certified flight to all targets if it finds one,
and else several that begin and end at safe stops. On the way a sensor finds an obstacle 5 cm lower than the drawing has
it, and the vehicle goes on along a plan from the middle of its flight. An independent judge flies every flight among the
true obstacles.

Usage: mission.py PROBLEM.yaml OBSTACLE [ITERATIONS]
  ITERATIONS: of each search, which makes a mission repeatable; default: 120 s before a flight, and in flight 0.4 s
Exit codes: 0 all targets seen and all flights good, 1 not all of them, 2 bad input.
"""

from __future__ import annotations

import json
import math
import pathlib
import sys
import tempfile
from typing import Any

import downwash
import numpy as np

LOWER_M = 0.05  # than on the drawing
SIGHT_M = 1.5  # of the sensor, from the multirotor's centre of mass
SENSOR_PERIOD_S = 0.1
LEAD_S = 0.5  # from what the sensor says to the first tick of the new plan
PLANNING_SHARE = 0.8  # of the lead, for planning
ON_GROUND_S = 120  # for the plan of a flight


def obstacle_in(problem: downwash.Problem, name: str) -> dict[str, Any]:
    """The obstacle of that name, which has to be a box."""
    for obstacle in problem["environment.obstacles"]:
        if obstacle["name"] == name and "box" in obstacle:
            return dict(obstacle)
    raise downwash.InputError(f"environment.obstacles has no box called '{name}'")


def with_obstacle(problem: downwash.Problem, obstacle: dict[str, Any]) -> downwash.Problem:
    """The problem with another obstacle of that name."""
    obstacles = [obstacle if each["name"] == obstacle["name"] else each for each in problem["environment.obstacles"]]
    return problem.replace({"environment.obstacles": obstacles})


def distance_m(at_m: list[float], box: dict[str, Any]) -> float:
    """From a place to a box whose edges are along the axes."""
    beyond_m = [max(0.0, abs(at - center) - 0.5 * size) for at, center, size in zip(at_m, box["center_m"], box["size_m"])]
    return math.sqrt(sum(each * each for each in beyond_m))


def numbers_of(targets: list[int]) -> str:
    return "".join(f" {target + 1}" for target in targets)


def configuration_at_end(plan: downwash.Columns) -> dict[str, Any]:
    """Where a plan ends, as a start or a goal in a problem file."""
    joints = [name for name in plan if name.startswith("joint_") and name.endswith("_rad") and "rate" not in name]
    at: dict[str, Any] = {name: float(plan[name][-1]) for name in ("x_m", "y_m", "z_m")}
    at["yaw_deg"] = math.degrees(plan["yaw_rad"][-1])
    at["joints_deg"] = [math.degrees(plan[name][-1]) for name in joints]
    return at


def say(t_s: float, text: str) -> None:
    print(f"{t_s:8.2f} s  {text}")


class Mission:
    def __init__(self, drawing: downwash.Problem, name: str, iterations: int | None) -> None:
        goal = drawing["goal"]
        if not isinstance(goal, dict) or not {"in_any_order", "return_to"} <= set(goal):
            raise downwash.InputError("goal is no mission: expected in_any_order and return_to")
        self._targets: list[dict[str, Any]] = goal["in_any_order"]
        self._return_to = goal["return_to"]
        self._full_j: float | None = goal.get("energy_budget_j")
        self._left_j = self._full_j
        self._home = self._start = drawing["start"]
        self._name = name
        self._iterations = iterations
        self._lower = obstacle_in(drawing, name)
        self._lower["box"]["center_m"][2] -= LOWER_M
        self._believed = drawing
        self._truth = with_obstacle(drawing, self._lower)
        self._knows = False  # where the obstacle is
        self._left = list(range(len(self._targets)))  # targets that no flight has visited
        self._seen = self._flights = self._good = 0

    def run(self) -> bool:
        """Whether all targets were seen and all flights were good."""
        asked = list(self._left)
        while asked:
            solution = self._plan_to(asked)
            if solution is not None:
                self._fly(asked, solution)
                asked = list(self._left)
            elif len(asked) > 1:
                print(f"no certified flight to the targets{numbers_of(asked)}: fewer at once")
                asked = asked[: (len(asked) + 1) // 2]
            else:
                print(f"no certified flight to target{numbers_of(asked)}")
                self._left.remove(asked[0])
                asked = list(self._left)
        print(
            f"{self._seen} of {len(self._targets)} targets seen in {self._flights} flights, of which {self._good} good"
        )
        return self._seen == len(self._targets) and self._good == self._flights

    def _plan_to(self, asked: list[int]) -> downwash.Solution | None:
        """A flight to some of the targets, from where the vehicle is, and back. It visits one at least."""
        goal: dict[str, Any] = {"in_any_order": [self._targets[i] for i in asked], "return_to": self._return_to}
        if self._left_j is not None:
            goal["energy_budget_j"] = self._left_j
        self._problem = self._believed.replace({"goal": goal, "start": self._start})
        self._planner = downwash.Planner(self._problem, threads=1, stop_at_first=True)
        solution = self._planner.solve()
        is_good = solution.status == "solved" and solution.order is not None and solution.order["visits"]
        return solution if is_good else None

    def _fly(self, asked: list[int], solution: downwash.Solution) -> None:
        assert solution.order is not None and solution.plan is not None
        visits = [asked[visit["target"] - 1] for visit in solution.order["visits"]]
        first = solution.plan
        self._flights += 1
        print(f"flight {self._flights}: {first['t_s'][-1]:.2f} s to the targets{numbers_of(visits)}")
        if solution.certificate is not None:
            counts = solution.certificate
            print(f"          certificate: {counts['failures']} failures in {counts['worlds']} worlds")
        goals = self._planner.problem["goal"]  # in their order, and the place to return to
        seen_at = None if self._knows else self._obstacle_seen(first, goals)
        if seen_at is None:
            self._judge(first, goals, visits)
            return
        self._knows = True
        answer = self._replan(first, seen_at)
        flown = joined(first, seen_at + self._ticks(LEAD_S), answer.plan, self._planner.tick_s)
        if answer.advice in ("keep", "follow"):
            self._judge(flown, goals, visits)
            return
        # The goals that are left are those after the visited ones.
        left = self._planner.problem["goal"]
        visited = len(goals) - (len(left) if isinstance(left, list) else 1)
        end = configuration_at_end(flown)
        self._judge(flown, [*goals[:visited], {"configuration": end}], visits[:visited], is_back=False)
        self._start = end

    def _obstacle_seen(self, plan: downwash.Columns, goals: list[dict[str, Any]]) -> int | None:
        """The tick of a plan at which the sensor first sees the obstacle."""
        truth = self._flown_problem(goals)
        flight = downwash.execute(truth, self._as_solution(plan, truth))
        for tick in range(0, len(flight), self._ticks(SENSOR_PERIOD_S)):
            if distance_m([float(flight[name][tick]) for name in ("x_m", "y_m", "z_m")], self._lower["box"]) < SIGHT_M:
                return tick
        return None

    def _replan(self, plan: downwash.Columns, seen_at: int) -> downwash.Answer:
        seen_s = seen_at * self._planner.tick_s
        say(seen_s, f"{self._name} is {LOWER_M:.3f} m lower than on the drawing")
        self._believed = with_obstacle(self._believed, self._lower)

        def tell(answer: downwash.Answer) -> None:
            end = ", ".join(f"{answer.plan[name][-1]:.3f}" for name in ("x_m", "y_m", "z_m"))
            say(seen_s, f"{answer.advice}: {answer.plan['t_s'][-1]:.2f} s to ({end}) m")

        tick = seen_at + self._ticks(LEAD_S)
        start = self._planner.predicted(self._planner.start, plan, tick)
        limit: dict[str, Any] = {"time_limit_s": PLANNING_SHARE * LEAD_S}
        if self._iterations is not None:
            limit = {"max_iterations": self._iterations}
        return self._planner.replan(start, tick, put=[self._lower], on_answer=tell, **limit)

    def _judge(
        self, plan: downwash.Columns, goals: list[dict[str, Any]], visits: list[int], is_back: bool = True
    ) -> None:
        """Flies a plan among the true obstacles, and keeps account of targets and battery."""
        truth = self._flown_problem(goals)
        flight = downwash.validate(truth, self._as_solution(plan, truth)).record
        battery_kj = math.inf if self._left_j is None else 1e-3 * self._left_j
        say(
            flight["duration_s"],
            f"{flight['outcome']}, least clearance {flight['min_clearance_m']:.3f} m, "
            f"{1e-3 * flight['energy_j']:.1f} of {battery_kj:.1f} kJ",
        )
        if flight["outcome"] == "ok":
            self._good += 1
            self._seen += len(visits)
        self._left = [target for target in self._left if target not in visits]
        self._start = self._home
        if self._full_j is not None and self._left_j is not None:  # a fresh battery at home
            self._left_j = self._full_j if is_back else self._left_j - flight["energy_j"]

    def _flown_problem(self, goals: list[dict[str, Any]]) -> downwash.Problem:
        """The true problem of a flight that begins where the vehicle is."""
        return self._truth.replace({"goal": goals, "start": self._start})

    @staticmethod
    def _as_solution(plan: downwash.Columns, problem: downwash.Problem) -> downwash.Solution:
        """A plan as a solution of a problem, by way of a file."""
        knots = [dict(zip(plan, map(float, row))) for row in zip(*plan.values())]
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "solution.json"
            file.write_text(json.dumps({"schema": "downwash/solution/v1", "plan": {"reference": knots}}), encoding="utf-8")
            return downwash.read_solution(file, problem)

    def _ticks(self, time_s: float) -> int:
        return round(time_s / self._planner.tick_s)


def joined(
    first: downwash.Columns, tick: int, rest: downwash.Columns, tick_s: float
) -> downwash.Columns:
    """The beginning of a plan, and from a tick on another one."""
    before = np.rint(first["t_s"] / tick_s) < tick
    times = np.concatenate([first["t_s"][before], rest["t_s"] + tick * tick_s])
    columns = {name: np.concatenate([first[name][before], rest[name]]) for name in first if name != "t_s"}
    return {"t_s": times, **columns}


def main() -> int:
    if len(sys.argv) not in (3, 4):
        print(f"usage: {sys.argv[0]} PROBLEM.yaml OBSTACLE [ITERATIONS]", file=sys.stderr)
        return 2
    try:
        iterations = int(sys.argv[3]) if len(sys.argv) == 4 else None
        limit = None if iterations is not None else ON_GROUND_S
        drawing = downwash.read_problem(sys.argv[1])
        drawing = drawing.replace({"planner.max_iterations": iterations, "planner.time_limit_s": limit})
        return 0 if Mission(drawing, sys.argv[2], iterations).run() else 1
    except (downwash.InputError, ValueError) as error:
        print(error, file=sys.stderr)
        return 2


if __name__ == "__main__":
    sys.exit(main())
