"""Errors of arguments name the argument, and nothing that lies below the package."""

import downwash
import downwash.figures
import numpy as np
import pytest


@pytest.fixture(scope="module")
def planned(open_air):
    return downwash.solve(open_air, variant="mp-arm", max_iterations=20)


def test_a_file_is_no_problem_and_no_solution(open_air, planned):
    calls = [
        (lambda: downwash.solve("open_air.yaml"), "problem is of the type str: expected a downwash.Problem, which read"),
        (lambda: downwash.execute("open_air.yaml", planned), "problem is of the type str"),
        (lambda: downwash.execute(open_air, "run"), "solution is of the type str: expected a downwash.Solution"),
        (lambda: downwash.validate(open_air, None), "solution is of the type NoneType"),
        (lambda: downwash.hold({}, [[0, 3]]), "problem is of the type dict"),
        (lambda: downwash.factor("open_air.yaml", [[0, 3]]), "problem is of the type str"),
        (lambda: downwash.Planner("open_air.yaml"), "problem is of the type str"),
        (lambda: downwash.AeroMap.build("open_air.yaml"), "problem is of the type str"),
        (lambda: downwash.solve(open_air, map="map.bin"), "map is of the type str: expected a downwash.AeroMap"),
        (lambda: downwash.Planner(open_air).replan({"x_m": 0}, 0), "start is of the type dict"),
        (lambda: downwash.figures.scene("open_air.yaml"), "problem is of the type str"),
        (lambda: downwash.explain(3), "key is 3: expected text"),
        (lambda: open_air.replace("planner.seed"), "changes is 'planner.seed': expected a dict"),
    ]
    for call, message in calls:
        with pytest.raises(TypeError) as raised:
            call()
        assert str(raised.value).startswith(message)
        assert "_core" not in str(raised.value)


def test_numbers_out_of_range_are_named(open_air, planned):
    calls = [
        (lambda: downwash.validate(open_air, planned, runs=-1), "runs: is -1: expected a whole number from 0"),
        (lambda: downwash.validate(open_air, planned, seed=2**64), "seed: is 18446744073709551616"),
        (lambda: downwash.execute(open_air, planned, world=-2), "world: is -2"),
        (lambda: downwash.solve(open_air, threads=-1), "threads: is -1: expected a whole number from 1 to 256"),
        (lambda: downwash.hold(open_air, [[0, 3]], threads=0), "threads: is 0: expected a whole number from 1 to 256"),
        (lambda: downwash.Planner(open_air, threads=257), "threads: is 257"),
        (lambda: downwash.validate(open_air, planned, runs=10**7 + 1), "runs: is 10000001: expected a whole number from 0 to 10000000"),
        (lambda: downwash.draw_worlds(open_air, -1), "count: is -1"),
        (lambda: downwash.factor(open_air, [[0, 3]], rotor=2**40), "rotor: is 1099511627776"),
    ]
    for call, message in calls:
        with pytest.raises(downwash.InputError) as raised:
            call()
        assert str(raised.value).startswith(message)


def test_values_of_another_type_are_named(open_air, planned):
    planner = downwash.Planner(open_air)
    calls = [
        (lambda: downwash.validate(open_air, planned, runs=2.5), "runs is 2.5: expected a whole number"),
        (lambda: downwash.validate(open_air, planned, runs="ten"), "runs is 'ten': expected a whole number, not text"),
        (lambda: downwash.hold(open_air, [[0, 3]], arm_deg="down"), "arm_deg is 'down': expected a number, not text"),
        (lambda: downwash.execute(open_air, planned, aero="off"), "aero is 'off': expected True or False"),
        (lambda: downwash.validate(open_air, planned, runs=True), "runs is True: expected a whole number"),
        (lambda: downwash.hold(open_air, [[0, 3]], arm_deg=np.True_), f"arm_deg is {np.True_!r}: expected a number"),
        (lambda: downwash.solve(open_air, seed="3"), "seed is '3': expected a whole number, not text"),
        (lambda: downwash.solve(open_air, variant=3), "variant is 3: expected text"),
        (lambda: planner.replan(planner.start, 0, put={"sphere": {}}), "put is {'sphere': {}}: expected a list of dicts"),
        (lambda: planner.replan(planner.start, 0, put=["deck"]), "put has 'deck': expected a list of dicts"),
        (lambda: planner.replan(planner.start, 0, removed="deck"), "removed is 'deck': expected a list of names"),
        (lambda: planner.predicted(planner.start, planner.plan, 5),
         "plan is None, as planner.plan is before there is one: call solve() first"),
        (lambda: downwash.factor(open_air, "a"), "points: 'a' is no array of numbers, with rows that are equally long"),
        (lambda: downwash.hold(open_air, [[0, 3], [1]]),
         "points: [[0, 3], [1]] is no array of numbers, with rows that are equally long"),
    ]
    for call, message in calls:
        with pytest.raises(TypeError) as raised:
            call()
        assert str(raised.value) == message
    # What Python itself says names the function, too.
    with pytest.raises(TypeError, match=r"validate\(\) got an unexpected keyword argument 'sed'"):
        downwash.validate(open_air, planned, sed=1)


def test_a_misspelt_key_has_a_suggestion():
    for wrong, meant in (("sed", "planner.seed"), ("planner.seeed", "planner.seed"), ("time_limit_s", "planner.time_limit_s")):
        with pytest.raises(downwash.InputError, match=f"{wrong}: is no key of a problem file; did you mean '{meant}'\\?"):
            downwash.explain(wrong)
    with pytest.raises(downwash.InputError) as raised:
        downwash.explain("qqqqqq")
    assert str(raised.value) == "qqqqqq: is no key of a problem file"


def test_checked_functions_keep_names_and_documentation():
    assert downwash.solve.__name__ == "solve"
    assert "planner.time_limit_s" not in (downwash.validate.__doc__ or "")
    assert "seed:" in (downwash.solve.__doc__ or "")
