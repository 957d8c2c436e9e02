"""Problems as objects."""

import pathlib

import downwash
import numpy as np
import pytest


def test_file_text_and_dict_give_the_same_problem(folder, bridge):
    text = (folder / "bridge_inspection.yaml").read_text()
    assert downwash.Problem.from_text(text, folder).sha256 == bridge.sha256
    again = downwash.Problem.from_text(bridge.to_yaml())
    assert again.sha256 == bridge.sha256
    assert downwash.Problem.from_dict(bridge.to_dict()).to_dict() == bridge.to_dict()


def test_values_are_read_by_key_in_the_units_of_the_file(bridge):
    assert bridge["planner.variant"] == "mp-arm-ada"
    assert bridge["environment.obstacles[0].name"] == "ground"
    assert bridge["start.arm_deg"] == 90
    assert bridge["goal"]["hold_s"] == bridge["goal.hold_s"]
    with pytest.raises(KeyError, match=r"planner\.sed is no key"):
        bridge["planner.sed"]


def test_what_a_key_gives_is_a_copy(bridge):
    goal = bridge["goal"]
    goal["hold_s"] = 99
    assert bridge["goal"]["hold_s"] == bridge["goal.hold_s"] != 99


def test_a_replaced_value_changes_nothing_else(bridge):
    faster = bridge.replace({"planner.seed": 7, "start.arm_deg": 60, "environment.obstacles[0].name": "floor"})
    expected = bridge.to_dict()
    expected["planner"]["seed"] = 7
    expected["start"]["arm_deg"] = 60
    expected["environment"]["obstacles"][0]["name"] = "floor"
    assert faster.to_dict() == expected
    assert bridge["planner.seed"] == 1


def test_a_replaced_group_has_the_defaults_of_what_is_left_out(bridge):
    changed = bridge.replace({"goal": {"configuration": {"x_m": 0, "z_m": 5}}, "uncertainty": {}})
    assert changed["goal"] == {
        "configuration": {
            "x_m": 0,
            "z_m": 5,
            "arm_deg": None,
            "tolerance_m": 0.1,
            "tolerance_x_m": None,
            "tolerance_z_m": None,
            "tolerance_deg": 5,
        },
        "hold_s": 5,
    }
    assert changed["start"] == bridge["start"]


def test_keys_that_lose_their_meaning_go_and_new_ones_without_are_errors(bridge):
    certain = bridge.replace({"uncertainty": "none", "planner.seed": 2})
    assert certain["uncertainty"] == "none"
    assert certain["planner.seed"] == 2
    with pytest.raises(KeyError):
        certain["planner.confidence"]
    with pytest.raises(downwash.ProblemError, match="goal.hold_s has no meaning in this problem"):
        certain.replace({"goal": {"any_of": [{"end_effector": {"x_m": 2, "z_m": 8}}], "hold_s": 3}})


def test_numbers_of_numpy_are_numbers(bridge):
    changed = bridge.replace(
        {"planner.seed": np.int64(3), "environment.obstacles[1].box.size_m": np.array([9.0, 2, 1])}
    )
    assert changed["planner.seed"] == 3
    assert changed["environment.obstacles[1].box.size_m"] == [9, 2, 1]


def test_errors_of_a_file_are_those_of_the_program(tmp_path, folder, program):
    text = (folder / "open_air.yaml").read_text().replace("robots/", f"{folder}/robots/")
    broken = text.replace("hold_s: 5", "hold: 5").replace("z_m: 3", "z_m: three")
    assert broken != text
    file = tmp_path / "broken.yaml"
    file.write_text(broken)
    with pytest.raises(downwash.ProblemError) as raised:
        downwash.read_problem(file)
    assert str(raised.value) == program("check", file).stderr.strip()
    first = raised.value.errors[0]
    assert (raised.value.file, raised.value.line, raised.value.column) == first[:3]
    assert first.file == str(file)
    assert "three" in broken.splitlines()[first.line - 1][first.column - 1 :]
    assert len(raised.value.errors) == 2

    with pytest.raises(downwash.ProblemError) as of_text:
        downwash.Problem.from_text(broken)
    assert str(of_text.value) == str(raised.value).replace(str(file), "<text>")
    with pytest.raises(downwash.ProblemError, match="there is no such file"):
        downwash.read_problem(tmp_path / "none.yaml")


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"planner.sed": 1}, "planner.sed: is no key of a problem: did you mean 'seed'"),
        ({"planner.seed": -1}, "planner.seed: is '-1': expected a whole number"),
        ({"planner.seed": "3"}, "text in quotes"),
        ({"planner.variant": "mp-arm-adda"}, "did you mean 'mp-arm-ada'"),
        ({"start": 3}, "start is '3': expected a group of keys"),
        ({"goal.configuration.x_m": 1}, "its group is not there"),
        ({"environment.obstacles[99].name": "x"}, "no key of this problem"),
    ],
)
def test_a_wrong_change_names_its_key(bridge, changes, message):
    with pytest.raises(downwash.ProblemError) as raised:
        bridge.replace(changes)
    assert message in str(raised.value)
    assert raised.value.line is None


def test_a_change_that_makes_the_problem_impossible_is_located_in_its_file(bridge):
    with pytest.raises(downwash.ProblemError) as raised:
        bridge.replace({"start.z_m": 10.5})
    lines = pathlib.Path(bridge.file).read_text().splitlines()
    assert raised.value.file == bridge.file
    assert lines[raised.value.line - 1].startswith("start:")


def test_warnings_have_places(tmp_path, folder):
    text = (folder / "open_air.yaml").read_text().replace("robots/", f"{folder}/robots/")
    problem = downwash.Problem.from_text(text + "\nplanner: {safety_margin_m: 0}\n")
    (warning,) = problem.warnings
    assert warning.file == "<text>"
    assert warning.line == text.count("\n") + 2
    assert "planner.safety_margin_m" in warning.message


def test_docstrings_come_from_the_parameter_table(program):
    for key in ("seed", "objective", "max_iterations", "safety_margin_m"):
        said = program("explain", f"planner.{key}").stdout.splitlines()[1].strip()
        assert said in downwash.solve.__doc__
        assert said in downwash.explain(f"planner.{key}")
    with pytest.raises(downwash.InputError, match="no key"):
        downwash.explain("planner.sed")
