"""Planning: from a problem to a plan and its flight."""

from __future__ import annotations

import json
import os
from typing import Any, Callable, Dict, NamedTuple, Protocol

import numpy as np
import numpy.typing as npt

from . import _core
from ._arguments import checked
from .aeromap import AeroMap
from .errors import InputError
from .problem import Path, Problem, explain

__all__ = ["Columns", "Flight", "Progress", "Solution", "execute", "read_solution", "solve"]

Columns = Dict[str, npt.NDArray[np.float64]]
"""Columns of numbers by name, all equally long. `pandas.DataFrame(columns)` makes a frame of them."""


class StopSignal(Protocol):
    """What ends long work early: a threading.Event."""

    def is_set(self) -> bool:
        ...


class Progress(NamedTuple):
    """A glance at a running search."""

    wall_s: float
    iterations: int
    nodes: int
    rejected: int
    """Edges rejected so far, for any reason."""
    best_cost: float | None
    """None before the first solution."""
    worlds: int | None
    """Of the plan that is being flown in worlds: how many so far. None at other times."""
    failures: int
    """In how many of them it failed."""


class Flight:
    """A plan executed from the start to the end of the hover at the goal."""

    def __init__(self, record: dict[str, Any], columns: Columns) -> None:
        self.record = record
        """What solution.json has as `execution`."""
        self.columns = columns
        """The columns of trajectory.csv, one row per control tick. A clearance without obstacles is NaN."""

    @property
    def outcome(self) -> str:
        """ok, collision, unstable, left_flyable_area, goal_missed or over_budget."""
        return str(self.record["outcome"])

    @property
    def cost(self) -> float:
        """By the plan's objective."""
        return float(self.record["cost"])

    @property
    def min_clearance_m(self) -> float | None:
        """None without obstacles."""
        clearance: float | None = self.record["min_clearance_m"]
        return clearance

    def __getitem__(self, name: str) -> npt.NDArray[np.float64]:
        return self.columns[name]

    def __len__(self) -> int:
        return len(self.columns["t_s"])

    def __repr__(self) -> str:
        return f"<downwash.Flight {self.outcome}, {self['t_s'][-1]:.2f} s>"


class Solution:
    """The answer to a problem: the plan, the record of the search and the flight of the plan."""

    def __init__(self, core: _core.Solution | _core.SpaceSolution, problem: Problem) -> None:
        self._core = core
        self._record: dict[str, Any] | None = None
        self.problem = problem
        """With the settings that it was planned with."""

    @property
    def status(self) -> str:
        """solved, approximate or none."""
        return self._core.status

    @property
    def interrupted(self) -> bool:
        """Whether `stop` ended the search."""
        return self._core.interrupted

    @property
    def cost(self) -> float:
        """The planner's own figure; 0 without a plan."""
        return self._core.cost

    @property
    def record(self) -> dict[str, Any]:
        """What solution.json holds, as dicts and lists (docs/results.md)."""
        if self._record is None:
            self._record = json.loads(self._core.json())
        return self._record

    @property
    def certificate(self) -> dict[str, Any] | None:
        """What flights in fresh worlds say about the plan; None without an uncertainty."""
        certificate: dict[str, Any] | None = self.record["certificate"]
        return certificate

    @property
    def order(self) -> dict[str, Any] | None:
        """In which order targets are visited, and what is left out; None where the problem gives the order."""
        order: dict[str, Any] | None = self.record.get("order")
        return order

    @property
    def plan(self) -> Columns | None:
        """The knots of the timed reference, with the names of solution.json; None without a plan."""
        return self._core.plan()

    @property
    def flight(self) -> Flight | None:
        """The plan executed with direct aerodynamics; None if it was not."""
        columns = self._core.flight()
        return None if columns is None else Flight(self.record["execution"], columns)

    @property
    def tree(self) -> Columns:
        """The search tree, with the columns of tree.csv; the parent of a root is NaN."""
        return self._core.tree()

    @property
    def map(self) -> AeroMap | None:
        """The aero map that the search flew in, for the next search in the same world; None if it took none."""
        core: _core.AeroMap | _core.SurfaceVolumes | None
        if isinstance(self._core, _core.SpaceSolution):
            core = _core.SurfaceVolumes.of_solution(self._core)
        else:
            core = _core.AeroMap.of_solution(self._core)
        return None if core is None else AeroMap(core, self.problem)

    @checked()
    def write(self, folder: Path, *, force: bool = False) -> None:
        """Writes the files that `downwash solve` writes.

        Raises OtherRunError if the folder holds the run of another problem and `force` is not given, FolderError if it
        cannot be written.
        """
        self._core.write(os.fspath(folder), force)

    def __repr__(self) -> str:
        return f"<downwash.Solution {self.status}, cost {self.cost:.6g}>"


_PLANNER_KEYS = ("variant", "algorithm", "objective", "seed", "time_limit_s", "max_iterations", "safety_margin_m")


@checked(_PLANNER_KEYS)
def solve(
    problem: Problem,
    *,
    variant: str | None = None,
    algorithm: str | None = None,
    objective: str | dict[str, float] | None = None,
    seed: int | None = None,
    time_limit_s: float | None = None,
    max_iterations: int | None = None,
    safety_margin_m: float | None = None,
    threads: int | None = None,
    stop_at_first: bool = False,
    cache: Path | None = None,
    map: AeroMap | None = None,
    on_progress: Callable[[Progress], object] | None = None,
    stop: StopSignal | None = None,
) -> Solution:
    """Plans, and executes the plan with direct aerodynamics.

    Other Python threads run meanwhile. Ctrl-C ends the search and raises KeyboardInterrupt; `stop.set()` ends it with
    the best plan so far. Either takes 0.1 s. With `max_iterations` a run is repeatable bit for bit.

    The following keywords take the place of keys of the problem. `max_iterations` without `time_limit_s` lifts the
    problem's time limit.

    {planner}

    The others:

    threads: number of threads, on which the result does not depend; default: one per processor
    stop_at_first: end with the first plan that is accepted
    cache: folder in which the searches' parts of aero maps are kept; default: none
    map: aero map of the same world: `solution.map` or an AeroMap of the problem; default: a new one
    on_progress: called with a Progress ten times a second, by the thread that called `solve`
    stop: a threading.Event
    """
    given = {
        "variant": variant,
        "algorithm": algorithm,
        "objective": objective,
        "seed": seed,
        "time_limit_s": time_limit_s,
        "max_iterations": max_iterations,
        "safety_margin_m": safety_margin_m,
    }
    changes: dict[str, object] = {f"planner.{name}": value for name, value in given.items() if value is not None}
    if max_iterations is not None and time_limit_s is None:
        changes["planner.time_limit_s"] = None
    if changes:
        problem = problem.replace(changes)
    tell = None if on_progress is None else _teller(on_progress)
    core = _core.solve(
        problem._core,
        threads or 0,
        stop_at_first,
        os.fspath(cache) if cache is not None else "",
        None if map is None else map._for(problem),
        tell,
        stop,
    )
    return Solution(core, problem)


if solve.__doc__:  # not with python -OO
    solve.__doc__ = solve.__doc__.replace(
        "{planner}", "\n    ".join(f"{name}: {explain('planner.' + name)}" for name in _PLANNER_KEYS)
    )


def _teller(on_progress: Callable[[Progress], object]) -> Callable[..., object]:
    return lambda *figures: on_progress(Progress(*figures))


@checked()
def read_solution(file: Path, problem: Problem) -> Solution:
    """Reads the plan in a solution.json, or in the folder of a run, to fly it: `execute` makes its flight again.

    `flight` is None and `tree` empty: only solution.json is read, not the files beside it.
    """
    path = os.path.join(file, "solution.json") if os.path.isdir(file) else os.fspath(file)
    return Solution(_core.read_solution(path, problem._core), problem)


def _require_same_family(problem: Problem, solution: Solution) -> None:
    """Plans in a vertical plane and in space have other axes."""
    if problem.is_in_space != solution.problem.is_in_space:
        kinds = {True: "in space", False: "in a vertical plane"}
        raise InputError(
            f"the solution is of a problem {kinds[solution.problem.is_in_space]}, and the problem is one "
            f"{kinds[problem.is_in_space]}"
        )


@checked()
def execute(
    problem: Problem,
    solution: Solution,
    *,
    aero: bool = True,
    world: int | None = None,
    seed: int | None = None,
    stop: StopSignal | None = None,
) -> Flight:
    """Executes the plan of a solution again.

    aero: whether surfaces act on the rotors
    world: index of the world of the problem's uncertainty to fly in; default: the nominal one
    seed: of the worlds; default: that of the solution
    stop: a threading.Event; when it ends the flight, Stopped is raised
    """
    _require_same_family(problem, solution)
    flown = Solution(_core.execute(solution._core, problem._core, aero, world, seed, stop), problem)
    flight = flown.flight
    assert flight is not None
    return flight
