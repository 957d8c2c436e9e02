"""Pictures with matplotlib."""

import downwash
import downwash.figures as figures
import matplotlib.colors
import matplotlib.pyplot as plt
import numpy as np
import pytest


@pytest.fixture(autouse=True)
def closed():
    yield
    plt.close("all")


def test_a_scene_shows_every_obstacle_where_it_is(bridge):
    ax = figures.scene(bridge)
    shapes = [patch.get_path().get_extents() for patch in ax.patches]
    assert len(shapes) == len(bridge["environment.obstacles"])
    pier = next(each for each in bridge["environment.obstacles"] if each["name"] == "pier")
    (x, _, z), (width, _, height) = pier["box"]["center_m"], pier["box"]["size_m"]
    expected = (x - width / 2, z - height / 2, width, height)
    assert any(np.allclose(shape.bounds, expected) for shape in shapes)
    assert ax.get_xlim() == tuple(bridge["environment.bounds.x_m"])
    # The ground is below the bounds; the girders hang side by side.
    words = {text.get_text(): text for text in ax.texts}
    assert set(words) == {"deck", "pier", "walkway", "cross_girder", "left_girder, right_girder"}
    assert words["pier"].get_color() == "white" and abs(words["pier"].get_position()[0] - x) < 1e-9
    assert words["cross_girder"].get_color() == figures.style["outline"]
    ax.figure.canvas.draw()
    boxes = [text.get_window_extent() for text in ax.texts]
    assert not any(a.overlaps(b) for i, a in enumerate(boxes) for b in boxes[:i])


def test_a_map_shows_k_in_the_colours_of_our_pictures(bridge):
    ax = figures.factor_map(bridge, step_m=0.5)
    (mesh,) = ax.collections
    x, z = 2.0, 9.5
    k = mesh.get_array().reshape(24, 49)  # z from 0.5 to 12, x from -12 to 12
    assert k[18, 28] == downwash.factor(bridge, [[x, z]])[0]
    assert np.ma.is_masked(k[19, 28])  # in the deck nothing flies
    limits = list(mesh.norm.boundaries)
    assert limits[:3] == [1, 1.01, 1.02]
    assert matplotlib.colors.to_hex(mesh.cmap.colors[0]) == "#ffffff"


def test_a_plan_is_drawn_with_its_flight(bridge):
    solution = downwash.solve(bridge, max_iterations=100, variant="mp-arm-da")
    ax = figures.plan(solution, robots=4)
    lines = {line.get_label(): line for line in ax.lines}
    assert lines["executed"].get_xdata().tolist() == solution.flight["x_m"].tolist()
    assert lines["executed"].get_color() == figures.style["flown"]
    assert lines["planned"].get_linestyle() == "--"
    assert lines["planned"].get_zorder() > lines["executed"].get_zorder()
    assert len(ax.collections) == 4
    first_arm = ax.collections[0].get_segments()[-1]
    assert np.allclose(first_arm[-1], [solution.flight["ee_x_m"][0], solution.flight["ee_z_m"][0]])


def test_every_shipped_scene_can_be_drawn(folder):
    for file in sorted(folder.glob("*.yaml")):
        ax = figures.scene(downwash.read_problem(file))
        ax.figure.canvas.draw()
