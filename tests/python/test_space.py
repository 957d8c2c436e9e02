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
    assert planned.record["stops"] is not None


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


UNDER_GIRDER = [[0.0, 0.0, 3.2], [0.5, 0.1, 3.0], [-1.0, -0.3, 2.5], [0.0, 0.0, 0.7]]


def test_thrust_ratios_in_space_are_those_of_a_volume_that_fills_where_it_is_asked(girder, planned):
    k = downwash.factor(girder, UNDER_GIRDER, yaw_deg=30)
    assert k.shape == (4,) and k[0] > k[1] > 1 and k[3] > 1  # a flange above, then the ground below
    volumes = downwash.AeroMap.build(girder)
    before = volumes.memory_bytes
    assert volumes.factor(UNDER_GIRDER, yaw_deg=30) == pytest.approx(k, abs=0.03)
    assert volumes.memory_bytes > before
    assert len(volumes.extent) == 6 and volumes.extent[0] < -3 < 3 < volumes.extent[1]
    assert planned.map.factor(UNDER_GIRDER, rotor=6, threads=2) == pytest.approx(
        downwash.factor(girder, UNDER_GIRDER, rotor=6), abs=0.03
    )
    inside = [*UNDER_GIRDER, [0, 0, 3.42]]
    for flyable in (downwash.is_flyable(girder, inside), volumes.is_flyable(inside)):
        assert flyable.tolist() == [True, True, True, True, False]
    for points, message in [([[0, 3]], r"expected \(n, 3\), world coordinates"), ([[0, 0, float("nan")]], "not finite")]:
        with pytest.raises(downwash.InputError, match=message):
            downwash.factor(girder, points)
    with pytest.raises(downwash.InputError, match="expected a number from 1 to 6"):
        downwash.factor(girder, UNDER_GIRDER, rotor=7)


def test_a_map_is_for_the_next_search_in_the_same_world(girder, planned):
    settings = {"seed": 2, "max_iterations": 60}
    again = downwash.solve(planned.problem, map=planned.map, **settings)
    assert all(np.array_equal(again.plan[name], planned.plan[name]) for name in again.plan)
    other = planned.problem.replace({"environment.obstacles[1].box.center_m": [0.1, 0, 4]})
    with pytest.raises(downwash.InputError, match="map: is of another scene"):
        downwash.solve(other, map=planned.map, **settings)


def test_hovers_are_those_of_the_program(folder, girder, json_of):
    places = [[0, 0, 2.5], [1.5, -1, 3.0], [0, 0, 4.0]]
    hover = downwash.hold(girder, places, yaw_deg=20, threads=2)
    options = [word for place in places for word in ("--place", *place)]
    said = json_of(
        "aeromap", "hold", folder / "space" / "around_a_girder.yaml", *options, "--yaw-deg", 20
    )["points"]
    assert hover["verdict"].tolist() == [each["verdict"] for each in said]
    assert hover["verdict"][2] != "stable" and np.isnan(hover["tilt_deg"][2])
    for i, each in enumerate(said[:2]):
        trim, stability = each["trim"], each["stability"]
        assert hover["slowest_loop"][i] == stability["slowest_loop"]
        expected = {
            "reference_z_m": trim["reference"]["z_m"],
            "reference_joint_2_deg": trim["reference"]["joints_deg"][1],
            "qw": trim["attitude"][0],
            "rotor_3_cmd_n": trim["rotor_commands_n"][2],
            "joint_1_torque_nm": trim["joint_torques_nm"][0],
            "saturation": trim["saturation"],
            "growth_rate_1_s": stability["growth_rate_1_s"],
            "roll_slope_nm_rad": stability["roll_slope_nm_rad"],
        }
        for name, value in expected.items():
            assert hover[name][i] == pytest.approx(value, rel=1e-9, abs=1e-12), name
    with pytest.raises(downwash.InputError, match="joints_deg: has 1 numbers"):
        downwash.hold(girder, places, joints_deg=[3])


def test_what_is_not_for_space_says_so(girder, planned, open_air):
    calls = [
        lambda: downwash.AeroMap.read("map.bin", girder),
        lambda: downwash.figures.scene(girder),
        lambda: downwash.figures.plan(planned, with_scene=False),
    ]
    for call in calls:
        with pytest.raises(downwash.InputError, match="environment.bounds.y_m makes this a problem in space"):
            call()
    for call, message in [
        (lambda: downwash.hold(girder, [[0, 0, 3]], arm_deg=0), "arm_deg: is for problems in a vertical plane"),
        (lambda: downwash.hold(open_air, [[0, 3]], yaw_deg=0), "joints_deg: are for problems in space"),
        (lambda: downwash.factor(open_air, [[0, 3]], yaw_deg=90), "yaw_deg: is for problems in space"),
        (lambda: planned.map.arrays(), "AeroMap.arrays is for maps in a vertical plane"),
        (lambda: planned.map.write("map.bin"), "AeroMap.write is for maps in a vertical plane"),
    ]:
        with pytest.raises(downwash.InputError, match=message):
            call()
    with pytest.raises(downwash.InputError, match="of a problem in space, and the problem is one in a vertical plane"):
        downwash.execute(open_air, planned)
    with pytest.raises(downwash.InputError, match="begins elsewhere"):
        downwash.execute(girder.replace({"start.x_m": -1.9}), planned)
    with pytest.raises(downwash.ProblemError, match=r"planner.parameters.passage_share is above 0"):
        downwash.solve(girder.replace({"planner.parameters.passage_share": 0.2}))
