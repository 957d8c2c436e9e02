"""Hover analysis, flights in other worlds, and the independent simulator."""

import json

import downwash
import numpy as np
import pytest


@pytest.fixture(scope="module")
def planned(bridge):
    return downwash.solve(bridge, max_iterations=200, stop_at_first=True)


def test_hold_says_what_the_program_says(bridge, json_of):
    points = [[0.0, 5.0], [2.0, 9.2], [-3.0, 8.6], [2.0, 9.8], [0.0, 10.5]]
    at = [word for x, z in points for word in ("--at", x, z)]
    said = json_of("aeromap", "hold", bridge.file, *at, "--arm-deg", 70)["points"]
    found = downwash.hold(bridge, points, arm_deg=70)
    assert found["verdict"].tolist() == [each["verdict"] for each in said]
    assert len(set(found["verdict"])) > 1
    assert found["limit"].tolist() == [each["limit"] for each in said]
    for i, each in enumerate(said):
        flat = {**(each["effect"] or {}), **(each["stability"] or {})}
        trim = each["trim"] or {}
        flat.update({f"reference_{key}": value for key, value in trim.get("reference", {}).items()})
        flat.update({key: trim[key] for key in ("saturation", "joint_torque_nm", "pitch_reference_deg") if trim})
        for name, column in found.items():
            if name not in ("x_m", "z_m", "verdict", "limit"):
                assert column[i] == flat[name] if name in flat else np.isnan(column[i]), (name, i)
    with pytest.raises(downwash.InputError, match="not finite"):
        downwash.hold(bridge, [[np.nan, 1]])


def test_an_executed_plan_flies_as_it_did(planned, bridge):
    again = downwash.execute(bridge, planned)
    assert again.outcome == "ok"
    for name, column in planned.flight.columns.items():
        assert np.array_equal(again[name], column, equal_nan=True)
    free = downwash.execute(bridge, planned, aero=False)
    assert set(np.unique(free["aero_factor_max"])) == {1.0}


def test_a_plan_is_executed_in_a_world_as_the_program_does(tmp_path, planned, bridge, json_of):
    planned.write(tmp_path / "run")
    said = json_of(
        "execute",
        bridge.file,
        "--plan",
        tmp_path / "run",
        "--world",
        3,
        "--seed",
        9,
        "--quiet",
        "--out",
        tmp_path / "to",
    )
    read = downwash.read_solution(tmp_path / "run", bridge)
    assert read.flight is None
    flight = downwash.execute(bridge, read, world=3, seed=9)
    assert flight.record == said["execution"]
    assert flight.record["energy_j"] != planned.flight.record["energy_j"]
    certain = bridge.replace({"uncertainty": "none"})
    with pytest.raises(downwash.InputError, match="no `uncertainty:`"):
        downwash.execute(certain, planned, world=3)


def test_validate_says_what_the_program_says(tmp_path, planned, bridge, json_of):
    planned.write(tmp_path / "run")
    said = json_of("validate", bridge.file, "--plan", tmp_path / "run", "--runs", 12, "--seed", 4)
    shares = []
    found = downwash.validate(bridge, planned, runs=12, seed=4, on_progress=shares.append)
    said.pop("disagreements")
    for name in found.record:
        if name == "sensitivity":
            assert found.record[name] == [
                {k: each[k] for k in ("parameter", "rank_correlation")} for each in said[name]
            ]
        else:
            assert found.record[name] == json.loads(json.dumps(said[name])), name
    assert found.failure_probability == said["failure_probability"]
    assert found.flights["world"].tolist() == list(range(1, 13))
    assert np.count_nonzero(found.flights["outcome"] != "ok") == found.failures
    assert shares == sorted(shares)


def test_too_many_runs_and_points_nowhere_are_refused(planned, bridge):
    with pytest.raises(downwash.InputError, match="runs: is 1000000000000: expected a whole number from 0 to 10000000"):
        downwash.validate(bridge, planned, runs=10**12)
    with pytest.raises(downwash.InputError, match="points: hold a number that is not finite"):
        downwash.factor(bridge, [[np.nan, 1]])


def test_worlds_are_those_that_the_simulator_flies_in(planned, bridge):
    count = 40
    worlds = downwash.draw_worlds(bridge, count, seed=4)
    found = downwash.validate(bridge, planned, runs=count, seed=4)
    assert worlds["world"].tolist() == found.flights["world"].tolist()
    correlations = {each["parameter"]: each["rank_correlation"] for each in found.record["sensitivity"]}
    assert set(worlds) == {"world", *correlations}

    def ranks(values):
        return np.argsort(np.argsort(values))

    for name, expected in correlations.items():
        if expected is not None:
            own = np.corrcoef(ranks(worlds[name]), ranks(found.flights["min_clearance_m"]))[0, 1]
            assert own == pytest.approx(expected, abs=1e-9), name
    with pytest.raises(downwash.InputError, match="no `uncertainty:`"):
        downwash.draw_worlds(bridge.replace({"uncertainty": "none"}), 3)


def test_one_world_and_none_are_flown_alone(planned, bridge):
    undisturbed = downwash.validate(bridge, planned)
    assert undisturbed.outcome == "ok"
    assert undisturbed.flights is None
    assert undisturbed.failures is None
    assert downwash.validate(bridge, planned, world=2).record["energy_j"] != undisturbed.record["energy_j"]


def test_a_plan_of_another_problem_is_not_flown(planned, bridge):
    quick = bridge.replace({"robot.controller.rate_hz": 200})
    elsewhere = bridge.replace({"start.x_m": bridge["start.x_m"] + 0.5})
    for problem, message in [(quick, "control ticks"), (elsewhere, "begins elsewhere")]:
        with pytest.raises(downwash.InputError, match=message):
            downwash.execute(problem, planned)
        with pytest.raises(downwash.InputError, match=message):
            downwash.validate(problem, planned)


def test_worlds_are_those_of_the_seed_of_the_solution(bridge):
    planned = downwash.solve(bridge, seed=7, max_iterations=60)
    drawn = [downwash.validate(bridge, planned, world=2, **seed).record["energy_j"] for seed in ({}, {"seed": 7})]
    assert drawn[0] == drawn[1]
    assert drawn[0] != downwash.validate(bridge, planned, world=2, seed=1).record["energy_j"]


def test_a_solution_without_a_plan_cannot_be_flown(bridge):
    far = downwash.solve(bridge, max_iterations=1)
    if far.plan is None:
        with pytest.raises(downwash.InputError, match="has no plan"):
            downwash.execute(bridge, far)
