"""The thrust ratio K at many points, and maps of it."""

import os
import signal
import threading
import time

import downwash
import numpy as np
import pytest


@pytest.fixture(scope="module")
def points(bridge):
    generator = np.random.default_rng(4)
    (x_low, x_high), (z_low, z_high) = (bridge[f"environment.bounds.{axis}"] for axis in ("x_m", "z_m"))
    return generator.uniform([x_low, z_low], [x_high, z_high], size=(400, 2))


@pytest.fixture(scope="module")
def built(bridge):
    return downwash.AeroMap.build(bridge, threads=2)


def test_k_in_the_world_is_that_of_the_program(tmp_path, bridge, points, json_of):
    in_world = np.column_stack([points[:, 0], np.full(len(points), 0.4), points[:, 1]])
    np.savetxt(tmp_path / "points.txt", in_world, fmt="%r")
    said = json_of("aeromap", "query", bridge.file, "--points", tmp_path / "points.txt", "--no-cache")["points"]
    flyable = downwash.is_flyable(bridge, in_world)
    assert flyable.tolist() == [each["flyable"] for each in said]
    k = downwash.factor(bridge, in_world)
    assert k[flyable].tolist() == [each["factor"] for each in said if each["flyable"]]
    assert k[flyable].max() > 1.02


def test_points_of_the_plane_are_where_the_rotor_is(bridge, points):
    for rotor, (_, lateral_m, _) in enumerate(bridge["robot.rotors.positions_m"], start=1):
        world = np.column_stack([points[:, 0], np.full(len(points), lateral_m), points[:, 1]])
        assert np.array_equal(downwash.factor(bridge, points, rotor=rotor), downwash.factor(bridge, world, rotor=rotor))


def test_threads_and_memory_order_change_nothing(bridge, points, built):
    k = downwash.factor(bridge, points, threads=1)
    assert np.array_equal(downwash.factor(bridge, np.asfortranarray(points), threads=3), k)
    assert np.array_equal(downwash.factor(bridge, points[::-1], threads=2), k[::-1])
    assert np.array_equal(built.factor(points.tolist(), threads=2), built.factor(points, threads=1))
    assert downwash.factor(bridge, np.empty((0, 2))).shape == (0,)


def test_a_map_is_within_its_bound_of_direct_evaluation(bridge, points, built):
    flyable = downwash.is_flyable(bridge, points)
    assert np.array_equal(built.is_flyable(points), flyable)
    difference = np.abs(built.factor(points) - downwash.factor(bridge, points))[flyable]
    assert 0 < difference.max() <= 0.01


def test_the_arrays_of_a_map_are_made_once(bridge, points):
    built = downwash.AeroMap.build(bridge)
    arrays = built.arrays()
    assert all(not array.flags.owndata and not array.flags.writeable for array in arrays.values())
    assert all(np.shares_memory(arrays[name], again) for name, again in built.arrays().items())
    k = built.factor(points)
    x_low, _, z_low, _ = built.extent
    cell_m = built.cell_m
    del built  # the views keep it
    for (x_m, z_m), expected in zip(points, k):
        u, w = (x_m - x_low) / cell_m, (z_m - z_low) / cell_m
        cell = arrays["cells"][int(w), int(u)]
        width, height = int(cell["steps_x"]) + 1, int(cell["steps_z"]) + 1
        first = int(cell["first_node"])
        nodes = arrays["nodes"][first : first + width * height].reshape(height, width).astype(float)
        a, b = (u % 1) * (width - 1), (w % 1) * (height - 1)
        i, j, s, t = int(a), int(b), a % 1, b % 1
        low = nodes[j, i] * (1 - s) + nodes[j, i + 1] * s
        high = nodes[j + 1, i] * (1 - s) + nodes[j + 1, i + 1] * s
        assert low * (1 - t) + high * t == pytest.approx(expected, abs=1e-9)


def test_a_map_comes_back_from_its_file(tmp_path, bridge, open_air, points, built):
    file = tmp_path / "bridge.map"
    built.write(file)
    again = downwash.AeroMap.read(file, bridge)
    assert again.extent == built.extent
    assert np.array_equal(again.factor(points), built.factor(points))
    solution = downwash.solve(bridge, variant="mp-arm-ada", max_iterations=5, map=again)
    assert solution.record["planning"]["map_wall_s"] < 0.05
    with pytest.raises(downwash.InputError, match="holds no aero map of this problem"):
        downwash.AeroMap.read(file, open_air)
    file.write_bytes(file.read_bytes()[:-1])
    with pytest.raises(downwash.InputError, match="damaged"):
        downwash.AeroMap.read(file, bridge)
    with pytest.raises(downwash.InputError, match="no such file"):
        downwash.AeroMap.read(tmp_path / "none", bridge)


def test_the_map_of_a_search_is_filled_where_it_flew_and_answers_everywhere(tmp_path, bridge, points, built):
    searched = downwash.solve(bridge, variant="mp-arm-ada", max_iterations=5).map
    assert searched.memory_bytes < built.memory_bytes
    searched.write(tmp_path / "part.map")
    assert (tmp_path / "part.map").stat().st_size < built.memory_bytes
    part = downwash.AeroMap.read(tmp_path / "part.map", bridge)
    assert part.memory_bytes == searched.memory_bytes
    for again in (searched, part):
        assert np.array_equal(again.factor(points, threads=2), built.factor(points))
        assert np.array_equal(again.arrays()["nodes"], built.arrays()["nodes"])
    assert part.memory_bytes == built.memory_bytes


def test_wrong_arguments_are_input_errors(bridge, built):
    for wrong in ([1.0, 2.0], [[1.0]], np.zeros((2, 4)), np.zeros((2, 2, 2))):
        with pytest.raises(downwash.InputError, match="points: is an array of shape"):
            downwash.factor(bridge, wrong)
    with pytest.raises(downwash.InputError, match=r"expected \(n, 2\)"):
        built.factor(np.zeros((2, 3)))
    for rotor in (0, bridge.rotors + 1):
        with pytest.raises(downwash.InputError, match=f"rotor: is {rotor}: expected a number from 1 to"):
            downwash.factor(bridge, [[0, 1]], rotor=rotor)


def test_a_map_can_be_stopped(bridge):
    stop = threading.Event()
    stop.set()
    with pytest.raises(downwash.Stopped):
        downwash.AeroMap.build(bridge, threads=1, stop=stop)


def test_control_c_ends_many_evaluations(bridge):
    points = np.tile([[2.0, 9.5]], (20_000_000, 1))
    sent = []

    def interrupt():
        sent.append(time.monotonic())
        os.kill(os.getpid(), signal.SIGINT)

    threading.Timer(0.3, interrupt).start()
    with pytest.raises(KeyboardInterrupt):
        downwash.factor(bridge, points, threads=1)
    assert time.monotonic() - sent[0] < 1
