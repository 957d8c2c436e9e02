"""Pictures with matplotlib that look like those of `downwash report` and `downwash aeromap plot`.

Every function draws into `ax`, or into a new figure, and returns the axes. Coordinates are those of the plane of
motion.
"""

from __future__ import annotations

from typing import Any, Sequence

import numpy as np
import numpy.typing as npt

from . import _core
from ._arguments import checked
from .aeromap import factor, is_flyable
from .problem import Problem, in_plane
from .solution import Solution

__all__ = ["factor_map", "plan", "scene", "style"]

style: dict[str, str] = _core.figure_style()
"""The colours and the font of all our figures: flown, planned, end_effector, goal, obstacle, outline; font."""


def _new_axes(problem: Problem, ax: Any) -> Any:
    """The axes, over the problem's bounds and to scale. Raises InputError for a problem in space."""
    in_plane(problem, "downwash.figures")
    if ax is None:
        import matplotlib.pyplot

        with matplotlib.pyplot.rc_context({"font.family": style["font"]}):
            _, ax = matplotlib.pyplot.subplots(figsize=(9, 5), layout="constrained")
    bounds = problem["environment.bounds"]
    ax.set(xlim=bounds["x_m"], ylim=bounds["z_m"], xlabel="x [m]", ylabel="z [m]", aspect="equal")
    return ax


def _path(rings: Sequence[npt.NDArray[np.float64]]) -> Any:
    """Closed rings as one path. Those that run in the opposite sense are holes."""
    from matplotlib.path import Path

    return Path.make_compound_path(*(Path(np.vstack([ring, ring[:1]]), closed=True) for ring in rings))


def _add_names(outlines: Sequence[Any], ax: Any) -> None:
    """The name of every obstacle that is seen, within it or beside it; those with the same outline share a place."""
    low, high = (np.array(limits) for limits in zip(ax.get_xlim(), ax.get_ylim()))
    points_per_m = np.min(ax.get_window_extent().size / ax.figure.dpi * 72 / (high - low))
    boxes: dict[tuple[bool, float, float, float, float], list[str]] = {}
    for name, is_cut, rings, lines in outlines:
        corners = np.vstack([*rings, *lines]) if rings or lines else np.empty((0, 2))
        if name and len(corners):
            seen = np.clip(corners, low, high)
            if np.all(np.ptp(seen, axis=0) > 0):
                x_from, z_from, x_to, z_to = np.round([*seen.min(axis=0), *seen.max(axis=0)], 4).tolist()
                boxes.setdefault((is_cut and len(rings) > 0, x_from, z_from, x_to, z_to), []).append(name)
    taken = [(np.array(box[1:3]), np.array(box[3:])) for box in boxes if box[0]]
    for box, names in boxes.items():
        text = ", ".join(names)
        half = np.array([2.5 * len(text) + 2, 5]) / points_per_m
        is_filled, least, most = box[0], np.array(box[1:3]), np.array(box[3:])
        middle, room = (least + most) / 2, (most - least) / 2 - half
        within = [middle + [share * room[0], 0] for share in (0, -0.5, 0.5)] if np.all(room > 0) else []
        beside = [np.array([middle[0], z]) for z in (least[1] - half[1], most[1] + half[1])]
        for at in [*within, *beside]:
            is_within = any(at is each for each in within)
            others = [each for each in taken if not (is_within and np.array_equal(each, (least, most)))]
            covers = any(np.all(at - half < top) and np.all(bottom < at + half) for bottom, top in others)
            if not covers and np.all(at - half >= low) and np.all(at + half <= high):
                color = "white" if is_filled and is_within else style["outline"]
                ax.text(*at, text, ha="center", va="center", color=color, fontsize=8, family=style["font"], zorder=2.5)
                taken.append((at - half, at + half))
                break


@checked()
def scene(problem: Problem, ax: Any = None) -> Any:
    """Draws obstacles with their names: filled where the plane of motion cuts them, dashed where they are beside it."""
    from matplotlib.patches import PathPatch

    ax = _new_axes(problem, ax)
    looks: dict[bool, dict[str, Any]] = {
        True: {"label": "obstacle", "facecolor": style["obstacle"], "edgecolor": style["outline"], "zorder": 2},
        False: {"label": "obstacle beside the plane, projected", "fill": False, "linestyle": "--"},
    }
    outlines = _core.outlines(in_plane(problem, "downwash.figures"))
    for _, is_cut, rings, lines in outlines:
        for line in lines:
            ax.plot(line[:, 0], line[:, 1], color=style["outline"], linewidth=1)
        if rings:
            ax.add_patch(PathPatch(_path(rings), **looks[is_cut]))
            looks[is_cut]["label"] = None  # once in the legend
    _add_names(outlines, ax)
    return ax


@checked()
def factor_map(
    problem: Problem, ax: Any = None, *, rotor: int = 1, step_m: float | None = None, with_scene: bool = True
) -> Any:
    """Draws the thrust ratio K of a rotor, evaluated directly, over the place of its hub. White where nothing flies.

    rotor: number of the rotor, from 1
    step_m: distance of the points at which K is evaluated [m]; default: 1/300 of the width of the bounds
    """
    from matplotlib.colors import BoundaryNorm, ListedColormap

    ax = _new_axes(problem, ax)
    (x_low, x_high), (z_low, z_high) = (problem["environment.bounds"][key] for key in ("x_m", "z_m"))
    step_m = step_m or (x_high - x_low) / 300
    x = np.linspace(x_low, x_high, max(2, round((x_high - x_low) / step_m) + 1))
    z = np.linspace(z_low, z_high, max(2, round((z_high - z_low) / step_m) + 1))
    points = np.stack(np.meshgrid(x, z), axis=-1).reshape(-1, 2)
    k = factor(problem, points, rotor=rotor)
    k[~is_flyable(problem, points, rotor=rotor)] = np.nan
    limits, colors = _core.factor_colors(float(np.nanmin(k)), float(np.nanmax(k)))
    mesh = ax.pcolormesh(
        x,
        z,
        k.reshape(len(z), len(x)),
        cmap=ListedColormap(colors),
        norm=BoundaryNorm(limits, len(colors)),
        shading="nearest",
        rasterized=True,
    )
    ax.figure.colorbar(mesh, ax=ax, label="thrust ratio K", shrink=0.8, spacing="uniform", ticks=limits)
    return scene(problem, ax) if with_scene else ax


def _robot(problem: Problem, x_m: float, z_m: float, pitch_rad: float, arm_rad: float) -> list[Any]:
    """The lines of vehicle and arm at a place."""
    robot = problem["robot"]
    sine, cosine = np.sin(pitch_rad), np.cos(pitch_rad)

    def placed(points: Any) -> Any:
        forward, up = np.asarray(points, dtype=np.float64).T
        return np.column_stack([x_m + forward * cosine + up * sine, z_m - forward * sine + up * cosine])

    lines = [placed(np.vstack([ring, ring[:1]])) for ring in _core.body_outlines(in_plane(problem, "downwash.figures"))]
    radius = robot["rotors"]["radius_m"]
    lines += [placed([[x - radius, z], [x + radius, z]]) for x, _, z in robot["rotors"]["positions_m"]]
    joint = placed([robot["arm"]["joint_m"]])[0]
    direction = pitch_rad + arm_rad
    reach = robot["arm"]["length_m"] * np.array([np.cos(direction), -np.sin(direction)])
    return [*lines, np.array([joint, joint + reach])]


@checked()
def plan(solution: Solution, ax: Any = None, *, robots: int = 8, with_scene: bool = True) -> Any:
    """Draws the plan (dashed, on top) and its executed flight, with the vehicle and its arm at equal intervals of time.

    robots: how many times the vehicle is drawn
    """
    from matplotlib.collections import LineCollection

    ax = scene(solution.problem, ax) if with_scene else _new_axes(solution.problem, ax)
    planned, flight = solution.plan, solution.flight
    if planned is not None:
        way = (flight["ref_x_m"], flight["ref_z_m"]) if flight is not None else (planned["x_m"], planned["z_m"])
        ax.plot(*way, color=style["planned"], linestyle="--", linewidth=1.2, label="planned", zorder=4)
    if flight is not None:
        ax.plot(flight["x_m"], flight["z_m"], color=style["flown"], linewidth=1.5, label="executed", zorder=3)
        ax.plot(
            flight["ee_x_m"], flight["ee_z_m"], color=style["end_effector"], linewidth=1, label="end effector, executed"
        )
        for row in np.unique(np.linspace(0, len(flight) - 1, robots).astype(int)):
            at = [flight[name][row] for name in ("x_m", "z_m", "pitch_rad", "arm_rad")]
            ax.add_collection(LineCollection(_robot(solution.problem, *at), colors=style["flown"], linewidths=0.8))
    goal = solution.problem["goal"]
    for place in goal if isinstance(goal, list) else goal.get("any_of", [goal]):
        if "end_effector" in place:
            point = place["end_effector"]
            ax.plot(
                point["x_m"], point["z_m"], "x", color=style["goal"], markersize=8, label="goal of the end effector"
            )
    ax.legend(loc="best", fontsize="small", frameon=True)
    return ax
