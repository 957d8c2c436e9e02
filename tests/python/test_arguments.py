"""Errors of arguments name the argument, and nothing that lies below the package."""

import pytest

import downwash
import downwash.figures


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
        (lambda: downwash.solve(open_air, threads=-1), "threads: is -1"),
        (lambda: downwash.draw_worlds(open_air, -1), "count: is -1"),
        (lambda: downwash.factor(open_air, [[0, 3]], rotor=2**40), "rotor: is 1099511627776"),
    ]
    for call, message in calls:
        with pytest.raises(downwash.InputError) as raised:
            call()
        assert str(raised.value).startswith(message)


def test_values_of_another_type_are_named(open_air, planned):
    calls = [
        (lambda: downwash.validate(open_air, planned, runs=2.5), "runs is 2.5: expected a whole number"),
        (lambda: downwash.validate(open_air, planned, runs="ten"), "runs is 'ten': expected a whole number, not text"),
        (lambda: downwash.hold(open_air, [[0, 3]], arm_deg="down"), "arm_deg is 'down': expected a number, not text"),
        (lambda: downwash.execute(open_air, planned, aero="off"), "aero is 'off': expected True or False"),
    ]
    for call, message in calls:
        with pytest.raises(TypeError) as raised:
            call()
        assert str(raised.value) == message
    # What Python itself says names the function, too.
    with pytest.raises(TypeError, match=r"validate\(\) got an unexpected keyword argument 'sed'"):
        downwash.validate(open_air, planned, sed=1)


def test_checked_functions_keep_names_and_documentation():
    assert downwash.solve.__name__ == "solve"
    assert "planner.time_limit_s" not in (downwash.validate.__doc__ or "")
    assert "seed:" in (downwash.solve.__doc__ or "")
