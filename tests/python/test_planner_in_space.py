"""Planning again in the middle of a flight in space. test_planner.py has what does not depend on the family."""

import dataclasses

import downwash
import numpy as np
import pytest
from planners import midway, same

LOWER_FLANGE = {"name": "bottom_flange", "box": {"size_m": [8, 0.36, 0.04], "center_m": [0, 0, 3.37]}}
FAR_BOX = {"name": "surprise", "box": {"size_m": [0.3, 0.3, 0.3], "center_m": [2.5, -2, 4]}}


@pytest.fixture(scope="module")
def problem(folder):
    """Under a girder, with a search that takes a moment."""
    girder = downwash.read_problem(folder / "space" / "around_a_girder.yaml").replace({"uncertainty": "none"})
    return girder.replace({"planner.max_iterations": 60, "planner.time_limit_s": None, "planner.seed": 2})


def test_the_first_plan_is_that_of_solve_with_its_safe_stops(problem, planner):
    solution = downwash.solve(problem, threads=1)
    assert same(planner.plan, solution.plan)
    assert planner.problem.sha256 == problem.sha256
    assert solution.record["stops"] is not None


def test_a_start_in_flight_has_all_that_the_vehicle_carries(planner):
    start, tick = midway(planner)
    assert isinstance(start, downwash.SpaceStart)
    assert len(start.joints_rad) == len(start.joint_rates_rad_s) == 3
    assert len(start.rotor_thrust_n) == 6 and len(start.controller_memory) > 10
    assert start.reference == planner.reference_of(planner.plan, tick)
    assert list(start.reference) == list(planner.plan)[1:]
    assert abs(start.x_m - start.reference["x_m"]) < 0.1
    assert np.linalg.norm([start.qw, start.qx, start.qy, start.qz]) == pytest.approx(1)


def test_a_start_comes_from_a_row_of_telemetry(planner, problem):
    flight = downwash.solve(problem).flight
    start, tick = midway(planner)
    row = {name: column[tick] for name, column in flight.columns.items()}
    told = downwash.SpaceStart.from_row(row, planner.reference_of(planner.plan, tick))
    for field in dataclasses.fields(told):
        if field.name not in ("reference", "controller_memory"):  # which no telemetry has
            assert getattr(told, field.name) == pytest.approx(getattr(start, field.name), abs=0.02), field.name
    assert planner.replan(told, tick, max_iterations=20).advice in ("keep", "follow")
    del row["qz"]
    with pytest.raises(downwash.InputError, match="no qz"):
        downwash.SpaceStart.from_row(row)


def test_a_flange_that_turns_out_lower_has_the_same_answers_on_any_number_of_threads(problem):
    plans = []
    for threads in (1, 2):
        planner = downwash.Planner(problem, threads=threads)
        planner.solve()
        start, tick = midway(planner)
        told = []
        answer = planner.replan(start, tick, put=[LOWER_FLANGE], max_iterations=60, on_answer=told.append)
        assert told[0].advice in ("stop", "none") and told[0].solution is None
        assert same(told[-1].plan, answer.plan) and same(planner.latest().plan, answer.plan)
        assert planner.problem["environment.obstacles[3].box.center_m"] == [0, 0, 3.37]
        plans.append(answer.plan)
    assert same(*plans)


def test_goals_move_and_the_new_flight_is_good(planner):
    start, tick = midway(planner)
    place = {"x_m": start.x_m - 0.5, "y_m": start.y_m, "z_m": start.z_m - 0.3}
    goal = {"configuration": {**place, "tolerance_m": 0.1}, "hold_s": 1}
    answer = planner.replan(start, tick, put=[FAR_BOX], removed=["top_flange"], goal=goal, max_iterations=200)
    assert answer.advice == "follow"
    assert answer.solution.flight.outcome == "ok"
    assert downwash.execute(answer.solution.problem, answer.solution).outcome == "ok"
    assert downwash.validate(answer.solution.problem, answer.solution).outcome == "ok"
    assert answer.plan["x_m"][-1] == pytest.approx(start.x_m - 0.5, abs=0.12)
    assert answer.plan["x_m"][0] == start.reference["x_m"]
    names = [each["name"] for each in planner.problem["environment.obstacles"]]
    assert "top_flange" not in names and names[-1] == "surprise"


def test_a_change_or_a_start_that_is_wrong_raises_and_changes_nothing(planner):
    start, tick = midway(planner)
    plan, sha256 = planner.plan, planner.problem.sha256
    changed = {"x_m": 0.5, "y_m": 0, "z_m": 2}
    wrong = [
        ({"removed": ["nothing"]}, "no obstacle 'nothing'"),
        ({"put": [{"name": "flat", "box": {"size_m": [1, -1, 1], "center_m": [0, 0, 0]}}]}, "size_m is -1"),
        ({"goal": [{"configuration": changed}, {"configuration": changed}]}, "one goal"),
        ({"goal": {"configuration": {"x_m": 1e9}}}, "goal"),
    ]
    for change, message in wrong:
        with pytest.raises(downwash.InputError, match=message):
            planner.replan(start, tick, **change)
    starts = [
        ({"controller_memory": (1.0,)}, "controller_memory"),
        ({"x_m": float("nan")}, "finite"),
        ({"joints_rad": (0.0,)}, "joints"),
        ({"qw": 0, "qx": 0, "qy": 0, "qz": 0}, "no direction"),
        ({"reference": {"x_m": 0.0}}, "the reference has no y_m"),
    ]
    for other, message in starts:
        with pytest.raises(downwash.InputError, match=message):
            planner.replan(dataclasses.replace(start, **other), tick)
    with pytest.raises(TypeError, match="start is of the type Start: expected a downwash.SpaceStart"):
        planner.replan(downwash.Start(0, 1, 0), tick)
    with pytest.raises(downwash.InputError, match="plan has no yaw_rad"):
        planner.adopt({name: column for name, column in plan.items() if name != "yaw_rad"})
    assert same(plan, planner.plan) and planner.problem.sha256 == sha256 and planner.latest() is None
