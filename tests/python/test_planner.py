"""Planning again in flight, from Python. docs/examples/mission compares answers with those of C++, to the last byte."""

import dataclasses
import os
import signal
import threading
import time

import downwash
import numpy as np
import pytest
from planners import midway, same

BOX = {"name": "surprise", "box": {"size_m": [0.5, 0.5, 0.5], "center_m": [0, 0, 1.5]}}


@pytest.fixture(scope="module")
def problem(bridge):
    """The bridge as it is believed, with a search that takes a moment."""
    return bridge.replace({"uncertainty": "none"}).replace({"planner.max_iterations": 60, "planner.time_limit_s": None})


def test_the_first_plan_is_that_of_solve(problem, planner):
    solution = downwash.solve(problem, threads=1)
    assert same(planner.plan, solution.plan)
    assert planner.problem.sha256 == problem.sha256


def test_answers_come_one_after_the_other_each_better_than_the_last(planner):
    start, tick = midway(planner)
    told = []
    answer = planner.replan(
        start, tick, max_iterations=60, on_answer=lambda now: told.append((now, threading.current_thread()))
    )
    assert [each.advice for each, _ in told][:2] == ["stop", "keep"]
    assert all(thread is threading.main_thread() for _, thread in told)
    assert told[0][0].cost is None and told[0][0].solution is None
    costs = [each.cost for each, _ in told[1:]]
    assert costs == sorted(costs, reverse=True)
    walls = [each.after_wall_s for each, _ in told]
    assert walls == sorted(walls)
    assert same(told[-1][0].plan, answer.plan)
    assert same(planner.latest().plan, answer.plan)
    assert same(planner.plan, answer.plan)


def test_answers_are_the_same_on_any_number_of_threads(problem):
    plans = []
    for threads in (1, 2):
        planner = downwash.Planner(problem, threads=threads)
        planner.solve()
        start, tick = midway(planner)
        deck = {"name": "deck", "box": {"size_m": [30, 8, 1], "center_m": [0, 0, 10.45]}}
        plans.append(planner.replan(start, tick, put=[deck, BOX], max_iterations=60).plan)
        assert planner.problem["environment.obstacles[6].box.center_m"] == [0, 0, 10.45]
    assert same(*plans)


def test_obstacles_come_and_go_and_goals_move(planner):
    start, tick = midway(planner)
    goal = {"configuration": {"x_m": start.x_m + 0.5, "z_m": start.z_m - 1}, "hold_s": 1}
    answer = planner.replan(start, tick, put=[BOX], removed=["walkway"], goal=goal, max_iterations=300)
    assert answer.advice == "follow"
    assert answer.solution.flight.outcome == "ok"
    assert downwash.execute(answer.solution.problem, answer.solution).outcome == "ok"
    names = [each["name"] for each in planner.problem["environment.obstacles"]]
    assert "walkway" not in names and names[-1] == "surprise"
    assert abs(answer.plan["x_m"][-1] - start.x_m - 0.5) < 0.1
    begin = planner.problem["start.reference.x_m"]
    assert begin == answer.plan["x_m"][0] == start.reference.x_m


def test_a_change_that_is_wrong_raises_and_changes_nothing(planner):
    start, tick = midway(planner)
    plan, sha256 = planner.plan, planner.problem.sha256
    flat = {"name": "flat", "box": {"size_m": [1, -1, 1], "center_m": [0, 0, 0]}}
    wrong = [
        ({"removed": ["nothing"]}, r"no obstacle 'nothing'"),
        ({"put": [flat]}, r"^environment.obstacles\[0\].box.size_m is -1"),
        ({"put": [{"nam": "x"}]}, "did you mean 'name'"),
        ({"goal": [{"configuration": {"x_m": 1}}, {"configuration": {"x_m": 2}}]}, "one goal"),
        ({"goal": {"configuration": {"x_m": 1e9}}}, "goal.configuration.x_m"),
        ({"time_limit_s": 0}, "time_limit_s"),
        ({"time_limit_s": float("inf")}, "time_limit_s"),
        ({"max_iterations": 0}, "max_iterations"),
    ]
    for change, message in wrong:
        with pytest.raises(downwash.InputError, match=message):
            planner.replan(start, tick, **change)
    with pytest.raises(downwash.InputError, match="tick"):
        planner.replan(start, -1)
    with pytest.raises(downwash.InputError, match="controller_memory"):
        planner.replan(dataclasses.replace(start, controller_memory=(1.0,)), tick)
    with pytest.raises(downwash.InputError, match="finite"):
        planner.replan(dataclasses.replace(start, x_m=float("nan")), tick)
    assert same(plan, planner.plan)
    assert planner.problem.sha256 == sha256
    assert planner.latest() is None
    planner.replan(start, tick, max_iterations=1)
    answer = planner.latest()
    with pytest.raises(downwash.InputError, match="no obstacle 'nix'"):
        planner.replan(start, tick, removed=["nix"])
    assert planner.latest() is not None and planner.latest().advice == answer.advice


def test_obstacles_without_a_name_come_beside_each_other(planner):
    start, tick = midway(planner)
    before = len(planner.problem["environment.obstacles"])
    pebbles = [{"box": {"size_m": [0.1, 0.1, 0.1], "center_m": [x_m, 3, 0.05]}} for x_m in (0, 1)]
    planner.replan(start, tick, put=pebbles, max_iterations=1)
    assert len(planner.problem["environment.obstacles"]) == before + 2
    with pytest.raises(downwash.InputError, match="no obstacle ''"):
        planner.replan(start, tick, removed=[""], max_iterations=1)


def test_targets_in_any_order_are_those_of_the_solution(problem, tmp_path):
    places = [{"configuration": {"x_m": x_m, "z_m": 6}, "hold_s": 1} for x_m in (-5, -8)]
    several = problem.replace({"goal": {"in_any_order": places}}).replace({"planner.max_iterations": 300})
    solution = downwash.Planner(several).solve()
    assert solution.status == "solved"
    assert solution.problem.sha256 == several.sha256
    solution.write(tmp_path / "run")
    read = downwash.read_solution(tmp_path / "run", downwash.read_problem(tmp_path / "run" / "effective.yaml"))
    assert read.record["order"] == solution.record["order"]


def test_a_plan_that_is_none_is_refused(planner):
    plan = dict(planner.plan)
    for name, values, message in [
        ("t_s", plan["t_s"] + 0.004, "control ticks"),
        ("t_s", plan["t_s"][::-1], "rise from 0"),
        ("x_m", plan["x_m"] * np.nan, "not finite"),
        ("x_m", plan["x_m"][1:], "equally long"),
    ]:
        with pytest.raises(downwash.InputError, match=message):
            planner.adopt({**plan, name: values})
    del plan["z_m"]
    with pytest.raises(downwash.InputError, match="no z_m"):
        planner.reference_of(plan, 0)


def test_a_start_comes_from_a_row_of_telemetry(planner, problem):
    flight = downwash.solve(problem).flight
    plan, tick = planner.plan, len(flight) // 3
    row = {name: column[tick] for name, column in flight.columns.items()}
    reference = planner.reference_of(plan, tick)
    assert reference[:3] == pytest.approx((row["ref_x_m"], row["ref_z_m"], row["ref_arm_rad"]), abs=1e-12)
    start = downwash.Start.from_row(row, reference)
    model = planner.predicted(planner.start, plan, tick)
    for field in dataclasses.fields(downwash.Start):
        if field.name not in ("reference", "controller_memory"):  # which no telemetry has
            assert getattr(start, field.name) == pytest.approx(getattr(model, field.name), abs=0.02), field.name
    assert len(start.rotor_thrust_n) == problem.rotors
    assert planner.replan(start, tick, max_iterations=20).advice in ("keep", "follow")
    with pytest.raises(downwash.InputError, match="no arm_rad"):
        downwash.Start.from_row({"x_m": 0, "z_m": 1})


def test_another_thread_reads_the_latest_answer_and_no_second_call_runs(planner):
    start, tick = midway(planner)
    seen, refused = set(), []
    is_over = threading.Event()

    def watch():
        while not is_over.is_set():
            answer = planner.latest()
            if answer is not None:
                seen.add(answer.advice)
                try:
                    planner.solve()
                except RuntimeError as error:
                    refused.append(str(error))
            time.sleep(0.001)

    watcher = threading.Thread(target=watch)
    watcher.start()
    planner.replan(start, tick, time_limit_s=1)
    is_over.set()
    watcher.join()
    assert seen
    assert refused and "another call" in refused[0]


def test_control_c_and_a_stop_event_end_a_replan(planner):
    start, tick = midway(planner)
    threading.Timer(0.3, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
    begin = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        planner.replan(start, tick, time_limit_s=60)
    assert time.monotonic() - begin < 3
    stop = threading.Event()
    threading.Timer(0.3, stop.set).start()
    assert planner.replan(start, tick, time_limit_s=60, stop=stop).advice in ("keep", "follow")
    assert time.monotonic() - begin < 6

    def refuse(_):
        raise LookupError("enough")

    with pytest.raises(LookupError, match="enough"):
        planner.replan(start, tick, time_limit_s=60, on_answer=refuse)
    assert time.monotonic() - begin < 9
