"""Planning from Python, beside the program."""

import json
import os
import re
import signal
import threading
import time

import downwash
import numpy as np
import pytest


def without_times(value):
    """A solution.json without what differs between runs."""
    if isinstance(value, dict):
        return {key: without_times(of) for key, of in value.items() if not key.endswith("wall_s")}
    return [without_times(each) for each in value] if isinstance(value, list) else value


@pytest.mark.parametrize(
    ("name", "variant", "iterations"),
    [("bridge_inspection", "mp-arm-ada", 40), ("pipe_rack", "mp-arm-da", 60), ("girder_mesh", "mp-arm", 40)],
)
def test_a_run_has_the_bytes_of_the_program(tmp_path, folder, program, name, variant, iterations):
    file = folder / f"{name}.yaml"
    options = ("--variant", variant, "--max-iterations", iterations, "--seed", 2, "--threads", 2, "--quiet")
    assert program("solve", file, *options, "--out", tmp_path / "program").returncode in (0, 1, 3)
    solution = downwash.solve(
        downwash.read_problem(file), variant=variant, max_iterations=iterations, seed=2, threads=2
    )
    solution.write(tmp_path / "python")
    names = sorted(path.name for path in (tmp_path / "program").iterdir())
    assert names == sorted(path.name for path in (tmp_path / "python").iterdir())
    for each in ("trajectory.csv", "tree.csv", "effective.yaml"):
        assert (tmp_path / "python" / each).read_bytes() == (tmp_path / "program" / each).read_bytes()
    pages = [(tmp_path / of / "report.html").read_text() for of in ("python", "program") if "report.html" in names]
    assert len({re.sub(r'(wall_s\\?"\s*:\s*)[0-9.e+-]+', r"\1", page) for page in pages}) <= 1
    written = [json.loads((tmp_path / of / "solution.json").read_text()) for of in ("python", "program")]
    assert without_times(written[0]) == without_times(written[1])
    assert written[0]["planning"]["iterations"] == iterations
    del solution.record["files"]
    del written[0]["files"]
    assert solution.record == written[0]


@pytest.fixture(scope="module")
def flown(bridge):
    return downwash.solve(bridge, max_iterations=200, variant="mp-arm-da", stop_at_first=True)


def test_flight_plan_and_tree_are_arrays_with_the_names_of_the_files(tmp_path, flown):
    flown.write(tmp_path)
    table = np.genfromtxt(tmp_path / "trajectory.csv", delimiter=",", names=True)
    assert list(flown.flight.columns) == list(table.dtype.names)
    for name in table.dtype.names:
        assert np.array_equal(flown.flight[name], table[name], equal_nan=True)
    reference = json.loads((tmp_path / "solution.json").read_text())["plan"]["reference"]
    assert list(flown.plan) == list(reference[0])
    for name, column in flown.plan.items():
        assert column.tolist() == [knot[name] for knot in reference]
    tree = np.genfromtxt(tmp_path / "tree.csv", delimiter=",", names=True)
    assert list(flown.tree) == list(tree.dtype.names)
    assert np.array_equal(flown.tree["parent"], tree["parent"], equal_nan=True)


def test_targets_in_any_order_are_flown_again_in_the_order_of_the_plan(open_air):
    x_m, z_m = open_air["start.x_m"], open_air["start.z_m"]
    targets = [{"configuration": {"x_m": x_m + d, "z_m": z_m}, "hold_s": 1} for d in (3, 1, 2)]
    problem = open_air.replace(
        {
            "uncertainty": "none",
            "goal": {"in_any_order": targets},
            "planner.max_iterations": 1500,
            "planner.time_limit_s": None,
        }
    )
    solution = downwash.solve(problem, variant="mp-arm-da")
    assert solution.status == "solved"
    assert [visit["target"] for visit in solution.order["visits"]] == [2, 3, 1]
    assert downwash.execute(problem, solution).outcome == "ok"
    assert downwash.validate(problem, solution).outcome == "ok"
    fewer = problem.replace({"goal": {"in_any_order": targets[:2]}})
    with pytest.raises(downwash.InputError, match="of other targets"):
        downwash.execute(fewer, solution)


def test_a_solution_says_what_its_file_says(flown):
    assert flown.order is None
    assert flown.status == flown.record["status"]
    assert flown.cost == flown.record["cost"]
    assert flown.flight.outcome == flown.record["execution"]["outcome"]
    assert len(flown.flight) == len(flown.flight["t_s"])
    assert flown.certificate == flown.record["certificate"]


def test_an_uncertain_problem_is_solved_with_a_certificate(open_air):
    solution = downwash.solve(open_air, max_iterations=200, stop_at_first=True)
    assert solution.status == "solved"
    assert solution.certificate["given"] is True
    assert solution.certificate["failure_probability"]["high"] <= 0.01


def test_a_map_can_be_used_again_in_the_same_world(tmp_path, bridge, open_air):
    bridge = bridge.replace({"uncertainty": "none"})
    first = downwash.solve(bridge, max_iterations=50, cache=tmp_path)
    assert len(list(tmp_path.iterdir())) > 0
    again = downwash.solve(bridge, max_iterations=50, map=first.map)
    assert again.record["planning"]["map_wall_s"] < 0.01
    assert all(np.array_equal(again.plan[name], first.plan[name]) for name in first.plan)
    with pytest.raises(ValueError, match="map"):
        downwash.solve(open_air, max_iterations=50, map=first.map)


def test_keywords_take_the_place_of_keys(bridge):
    solution = downwash.solve(bridge, variant="mp-arm", seed=5, objective="time", max_iterations=40)
    assert solution.record["variant"] == "mp-arm"
    assert solution.record["seed"] == 5
    assert solution.record["objective"] == "time"
    assert solution.problem["planner.time_limit_s"] is None
    with pytest.raises(downwash.ProblemError, match="planner.time_limit_s"):
        downwash.solve(bridge, time_limit_s=-1)


def test_threads_run_and_progress_is_told_while_a_search_runs(bridge):
    counted = 0
    is_over = threading.Event()

    def count():
        nonlocal counted
        while not is_over.is_set():
            counted += 1
            time.sleep(0.001)

    worker = threading.Thread(target=count)
    worker.start()
    told = []
    downwash.solve(bridge, time_limit_s=1, on_progress=lambda now: told.append((now, threading.current_thread())))
    is_over.set()
    worker.join()
    assert counted > 100
    assert len(told) >= 5
    assert all(thread is threading.main_thread() for _, thread in told)
    walls = [now.wall_s for now, _ in told]
    assert walls == sorted(walls)
    assert told[-1][0].nodes > 0


def test_a_stop_event_ends_a_search_with_its_best_plan(bridge):
    stop = threading.Event()
    threading.Timer(0.5, stop.set).start()
    begin = time.monotonic()
    solution = downwash.solve(bridge, time_limit_s=60, stop=stop)
    assert 0.4 < time.monotonic() - begin < 3
    assert solution.interrupted


def test_control_c_raises_keyboard_interrupt_promptly(bridge):
    sent = []

    def interrupt():
        sent.append(time.monotonic())
        os.kill(os.getpid(), signal.SIGINT)

    threading.Timer(0.4, interrupt).start()
    with pytest.raises(KeyboardInterrupt):
        downwash.solve(bridge, time_limit_s=60)
    assert time.monotonic() - sent[0] < 1


def test_what_a_callback_raises_ends_the_search(bridge):
    def refuse(_):
        raise LookupError("enough")

    begin = time.monotonic()
    with pytest.raises(LookupError, match="enough"):
        downwash.solve(bridge, time_limit_s=60, on_progress=refuse)
    assert time.monotonic() - begin < 5


def test_a_folder_with_the_run_of_another_problem_is_kept(tmp_path, folder, flown, open_air):
    other = downwash.solve(open_air, variant="mp-arm", max_iterations=30)
    other.write(tmp_path / "run")
    before = (tmp_path / "run" / "solution.json").read_bytes()
    with pytest.raises(downwash.OtherRunError, match="holds a run of another problem"):
        flown.write(tmp_path / "run")
    assert (tmp_path / "run" / "solution.json").read_bytes() == before
    flown.write(tmp_path / "run", force=True)
    assert json.loads((tmp_path / "run" / "solution.json").read_text())["problem"]["name"] == "bridge_inspection"
    (tmp_path / "file").write_text("")
    with pytest.raises(downwash.FolderError):
        flown.write(tmp_path / "file" / "run")


def memory_kb():
    with open("/proc/self/statm", encoding="ascii") as statm:
        return int(statm.read().split()[1]) * os.sysconf("SC_PAGE_SIZE") // 1024


def test_many_searches_leak_nothing(open_air):
    """DOWNWASH_SOLVES sets how many; .ci/full runs ten thousand."""
    problem = open_air.replace(
        {"uncertainty": "none", "planner.variant": "mp-arm", "planner.max_iterations": 1, "planner.time_limit_s": None}
    )

    def search():
        solution = downwash.solve(problem, threads=1, on_progress=lambda _: None)
        assert len(solution.tree["x_m"]) >= 0
        assert solution.record["status"] == solution.status
        with pytest.raises(downwash.ProblemError):
            problem.replace({"planner.seed": -1})

    count = int(os.environ.get("DOWNWASH_SOLVES", "40"))
    for _ in range(count // 4):  # allocators keep what they need once
        search()
    before = memory_kb()
    for _ in range(count):
        search()
    assert memory_kb() - before < 1024 + count / 10
