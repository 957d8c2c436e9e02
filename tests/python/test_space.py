"""Problems in space, from the file to validated flights."""

import json

import downwash
import downwash.figures
import numpy as np
import pytest

AXES = ["x_m", "y_m", "z_m", "yaw_rad", "joint_1_rad", "joint_2_rad", "joint_3_rad"]


@pytest.fixture(scope="module")
def girder(folder):
    return downwash.read_problem(folder / "space" / "around_a_girder.yaml")


@pytest.fixture(scope="module")
def planned(girder):
    """Without an uncertainty: a plan after few flights."""
    certain = girder.replace({"uncertainty": "none"})
    return downwash.solve(certain, seed=2, max_iterations=60)


def test_file_text_and_dict_give_the_same_problem(folder, girder):
    assert girder.is_in_space
    assert girder.joints == ("joint_1", "joint_2", "joint_3")
    assert girder.rotors == 6
    text = (folder / "space" / "around_a_girder.yaml").read_text()
    assert downwash.Problem.from_text(text, folder / "space").sha256 == girder.sha256
    again = downwash.Problem.from_text(girder.to_yaml())
    assert again.sha256 == girder.sha256
    assert again.is_in_space
    assert downwash.Problem.from_dict(girder.to_dict()).to_dict() == girder.to_dict()
    assert not downwash.read_problem(folder / "open_air.yaml").is_in_space


def test_values_are_read_and_replaced_by_key(girder):
    assert girder["environment.bounds.y_m"] == [-2.5, 2.5]
    assert girder["goal.end_effector.direction"] == [0, -1, 0]
    changed = girder.replace(
        {"start.y_m": -1.5, "planner.seed": 7, "goal": {"configuration": {"x_m": 0, "y_m": 1, "z_m": 2}, "hold_s": 2}}
    )
    expected = girder.to_dict()
    expected["start"]["y_m"] = -1.5
    expected["planner"]["seed"] = 7
    expected["goal"] = changed["goal"]
    assert changed.to_dict() == expected
    assert changed["goal.configuration.y_m"] == 1
    assert girder["start.y_m"] == -1.6
    assert downwash.explain("motion.max_yaw_rate_deg_s")


def test_wrong_values_have_their_key_and_place(girder, tmp_path, folder, program):
    with pytest.raises(downwash.ProblemError, match="start.y: is no key of a problem: its unit is missing; expected y_m"):
        girder.replace({"start.y": 1})
    with pytest.raises(downwash.ProblemError, match=r"around_a_girder.yaml:\d+:\d+: start"):
        girder.replace({"start.z_m": 3.42, "start.y_m": 0})
    text = (folder / "space" / "around_a_girder.yaml").read_text().replace("../robots/", f"{folder}/robots/")
    file = tmp_path / "broken.yaml"
    file.write_text(text.replace("hold_s: 5", "hold: 5"))
    with pytest.raises(downwash.ProblemError) as raised:
        downwash.read_problem(file)
    assert str(raised.value) == program("check", file).stderr.strip()


def test_a_plan_is_that_of_the_program(tmp_path, planned, program):
    assert planned.status == "solved"
    assert planned.flight.outcome == "ok"
    planned.write(tmp_path / "written")
    problem = tmp_path / "written" / "effective.yaml"
    done = program("solve", problem, "--seed", 2, "--max-iterations", 60, "--out", tmp_path / "program", "--quiet")
    assert done.returncode == 0, done.stderr
    for name in ("trajectory.csv", "tree.csv"):
        assert (tmp_path / "written" / name).read_bytes() == (tmp_path / "program" / name).read_bytes()


def test_arrays_have_the_names_and_numbers_of_the_files(tmp_path, planned):
    planned.write(tmp_path)
    table = np.genfromtxt(tmp_path / "trajectory.csv", delimiter=",", names=True)
    assert list(planned.flight.columns) == list(table.dtype.names)
    for name in table.dtype.names:
        assert np.array_equal(planned.flight[name], table[name], equal_nan=True)
    reference = json.loads((tmp_path / "solution.json").read_text())["plan"]["reference"]
    assert list(planned.plan) == list(reference[0])
    assert list(planned.plan)[: 1 + len(AXES)] == ["t_s", *AXES]
    for name, column in planned.plan.items():
        assert column.tolist() == [knot[name] for knot in reference]
    tree = np.genfromtxt(tmp_path / "tree.csv", delimiter=",", names=True)
    assert list(planned.tree) == list(tree.dtype.names) == [*AXES, "parent"]
    assert np.array_equal(planned.tree["parent"], tree["parent"], equal_nan=True)
    attitude = np.stack([planned.flight[name] for name in ("qw", "qx", "qy", "qz")])
    assert np.allclose(np.linalg.norm(attitude, axis=0), 1)
    assert planned.cost == planned.record["cost"]
    assert planned.map is None


def test_a_plan_flies_again_and_in_worlds(tmp_path, girder, planned):
    again = downwash.execute(planned.problem, planned)
    assert all(np.array_equal(again[name], planned.flight[name]) for name in again.columns)
    free = downwash.execute(planned.problem, planned, aero=False)
    assert free.record["aero"] is False
    assert not np.array_equal(free["z_m"], again["z_m"])
    third = downwash.execute(girder, planned, world=3, seed=9)
    assert third.record["world"] == {"index": 3, "seed": 9}
    assert not np.array_equal(third["x_m"], again["x_m"])
    with pytest.raises(downwash.InputError, match="uncertain"):
        downwash.execute(planned.problem, planned, world=3)
    planned.write(tmp_path)
    saved = downwash.read_solution(tmp_path, planned.problem)
    assert saved.flight is None
    assert all(np.array_equal(saved.plan[name], planned.plan[name]) for name in saved.plan)
    assert np.array_equal(downwash.execute(planned.problem, saved)["x_m"], again["x_m"])


def test_the_judge_flies_it_as_the_program_does(tmp_path, girder, planned, json_of):
    found = downwash.validate(girder, planned, runs=3, seed=5, threads=1)
    assert found.outcome == "ok"
    assert found.record["min_clearance_m"] == pytest.approx(planned.flight.min_clearance_m, abs=1e-3)
    assert list(found.flights["world"]) == [1, 2, 3]
    (tmp_path / "girder.yaml").write_text(girder.to_yaml(tmp_path))
    planned.write(tmp_path / "run")
    said = json_of("validate", tmp_path / "girder.yaml", "--plan", tmp_path / "run", "--runs", 3, "--seed", 5, "--quiet")
    assert said["failures"] == found.failures
    assert said["clearance_m"]["p50"] == found.record["clearance_m"]["p50"]
    one = downwash.validate(girder, planned, world=2, seed=5)
    assert one.record["min_clearance_m"] == found.flights["min_clearance_m"][1]


def test_worlds_have_columns_for_every_axis(girder):
    worlds = downwash.draw_worlds(girder, 4, seed=3)
    assert list(worlds["world"]) == [1, 2, 3, 4]
    assert {"aero.scene_offset_m.y", "sensing.joint_offset_deg.joint_3"} & set(worlds) or len(worlds) > 20
    assert all(len(np.unique(column)) > 1 for name, column in worlds.items() if name.startswith("aero.scene"))


def test_what_is_not_for_space_says_so(girder, planned, open_air):
    calls = [
        lambda: downwash.Planner(girder),
        lambda: downwash.hold(girder, [[0, 3]]),
        lambda: downwash.factor(girder, [[0, 0, 3]]),
        lambda: downwash.AeroMap.build(girder),
        lambda: downwash.figures.scene(girder),
        lambda: downwash.figures.plan(planned, with_scene=False),
    ]
    for call in calls:
        with pytest.raises(downwash.InputError, match="environment.bounds.y_m makes this a problem in space"):
            call()
    with pytest.raises(downwash.InputError, match="of a problem in space, and the problem is one in a vertical plane"):
        downwash.execute(open_air, planned)
    with pytest.raises(downwash.InputError, match="begins elsewhere"):
        downwash.execute(girder.replace({"start.x_m": -1.9}), planned)
    with pytest.raises(downwash.ProblemError, match=r"planner.parameters.passage_share is above 0"):
        downwash.solve(girder.replace({"planner.parameters.passage_share": 0.2}))
