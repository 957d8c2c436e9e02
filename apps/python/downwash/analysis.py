"""Whether a vehicle can hover, and what an independent simulator says about a plan."""

from __future__ import annotations

from typing import Any, Callable, Dict

import numpy as np
import numpy.typing as npt

from . import _core
from ._arguments import checked, numbers
from .errors import InputError
from .problem import Problem
from .solution import Solution, StopSignal, _require_same_family

__all__ = ["Validation", "draw_worlds", "hold", "validate"]


@checked()
def hold(
    problem: Problem,
    points: npt.ArrayLike,
    *,
    arm_deg: float | None = None,
    yaw_deg: float | None = None,
    joints_deg: npt.ArrayLike | None = None,
    threads: int | None = None,
) -> Dict[str, npt.NDArray[Any]]:
    """Analyses whether the vehicle can hover with its centre of mass at points [m].

    points: (n, 2) plane coordinates x, z, or for a problem in space (n, 3) world coordinates x, y, z
    arm_deg: in a plane, arm angle relative to the multirotor [deg]; default: that of the problem's start
    yaw_deg: in space, heading [deg]; default: that of the start
    joints_deg: in space, one angle for each joint [deg]; default: those of the start
    threads: number of threads; default: one per processor

    Returns the figures of `downwash aeromap hold --json` (docs/hold.md) as columns: `verdict`, `limit`, the trim
    (`reference_x_m`, ...) and the stability; in a plane also the effect of the surfaces, in space `slowest_loop`, the
    attitude `qw` to `qz`, and `rotor_1_cmd_n`, ... What a verdict leaves undefined is NaN, or an empty text.
    """
    at = numbers("points", points)
    texts: Dict[str, list[str]] = {}
    if isinstance(problem._core, _core.SpaceProblem):
        if arm_deg is not None:
            raise InputError("arm_deg: is for problems in a vertical plane: expected joints_deg for one in space")
        joints = None if joints_deg is None else np.atleast_1d(numbers("joints_deg", joints_deg)).tolist()
        columns, texts["verdict"], texts["limit"], texts["slowest_loop"] = _core.hold_in_space(
            problem._core, at, yaw_deg, joints, threads or 0
        )
    else:
        if yaw_deg is not None or joints_deg is not None:
            raise InputError(
                "yaw_deg and joints_deg: are for problems in space: expected arm_deg for one in a vertical plane"
            )
        columns, texts["verdict"], texts["limit"] = _core.hold(problem._core, at, arm_deg, threads or 0)
    table: Dict[str, npt.NDArray[Any]] = dict(columns)
    table.update({name: np.array(column, dtype=str) for name, column in texts.items()})
    return table


@checked()
def draw_worlds(problem: Problem, count: int, *, seed: int | None = None) -> Dict[str, npt.NDArray[Any]]:
    """What the worlds 1 to `count` of the problem's uncertainty have otherwise than the nominal one.

    seed: of the worlds; default: that of the problem

    Returns the column `world`, and one for every parameter that worlds draw, with its name in `validate`'s sensitivity:
    differences, or relative changes, in SI units and radians. The rows are those of `Validation.flights` of the same
    seed.
    """
    table: Dict[str, npt.NDArray[Any]] = dict(_core.draw_worlds(problem._core, count, seed))
    table["world"] = table["world"].astype(np.int64)
    return table


class Validation:
    """What an independent simulator says about a plan."""

    def __init__(self, record: dict[str, Any], flights: Dict[str, npt.NDArray[Any]] | None) -> None:
        self.record = record
        """With names of `downwash validate --json`: outcome and figures of the flight, and the statistics of worlds."""
        self.flights = flights
        """Columns world, outcome, min_clearance_m, max_tracking_error_m, energy_j; None without worlds."""

    @property
    def outcome(self) -> str:
        """Of the undisturbed flight, or of that in the one world that was asked for."""
        return str(self.record["outcome"])

    @property
    def failures(self) -> int | None:
        """Worlds in which the flight failed; None without worlds."""
        failures: int | None = self.record.get("failures")
        return failures

    @property
    def failure_probability(self) -> dict[str, float] | None:
        """estimate, low and high: the share of failures and its 95 % interval; None without worlds."""
        probability: dict[str, float] | None = self.record.get("failure_probability")
        return probability

    def __repr__(self) -> str:
        return f"<downwash.Validation {self.outcome}, {self.failures} failures of {self.record.get('runs', 0)}>"


@checked()
def validate(
    problem: Problem,
    solution: Solution,
    *,
    runs: int = 0,
    world: int | None = None,
    seed: int | None = None,
    threads: int | None = None,
    on_progress: Callable[[float], object] | None = None,
    stop: StopSignal | None = None,
) -> Validation:
    """Flies the plan of a solution in the independent simulator of `downwash validate`.

    runs: fly in the worlds 1 to `runs` of the problem's uncertainty as well
    world: the one world to fly in; default: the undisturbed one
    seed: of the worlds; default: that of the solution
    threads: number of threads, on which the result does not depend; default: one per processor
    on_progress: called with the share of the worlds that is done, by the calling thread
    stop: a threading.Event; when it ends the runs, there are no statistics
    """
    _require_same_family(problem, solution)
    record, flights = _core.validate(problem._core, solution._core, runs, world, seed, threads or 0, on_progress, stop)
    if flights is None:
        return Validation(record, None)
    columns, outcomes = flights
    table: Dict[str, npt.NDArray[Any]] = dict(columns)
    table["world"] = table["world"].astype(np.int64)
    table["outcome"] = np.array(outcomes, dtype=str)
    return Validation(record, table)
