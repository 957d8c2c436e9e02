"""Planning again while the vehicle flies."""

from __future__ import annotations

import os
from dataclasses import dataclass
from typing import Any, Callable, Dict, Mapping, NamedTuple, Optional, Sequence, Tuple, Union

import numpy as np
import numpy.typing as npt

from . import _core
from ._arguments import checked, numbers, require_made
from .errors import InputError, ProblemError
from .problem import Path, Problem, _without_lines, _yaml
from .solution import Columns, Progress, Solution, StopSignal, _teller

__all__ = ["Answer", "Planner", "ReferencePoint", "SpaceStart", "Start"]

_STATE = ("x_m", "z_m", "arm_rad", "pitch_rad", "vx_m_s", "vz_m_s", "pitch_rate_rad_s", "arm_rate_rad_s")

_SPACE_STATE = (
    *("x_m", "y_m", "z_m", "qw", "qx", "qy", "qz"),
    *("vx_m_s", "vy_m_s", "vz_m_s", "wx_rad_s", "wy_rad_s", "wz_rad_s"),
)

_CoreStart = Tuple[
    Sequence[float], Sequence[float], Sequence[float], Optional[Sequence[float]], Sequence[float], Sequence[float]
]


def _numbered(row: Mapping[str, Any], name: str) -> tuple[float, ...]:
    """The values of name(1), name(2), ... as far as a row has them; `name` has a # for the number."""
    values: list[float] = []
    while (key := name.replace("#", str(len(values) + 1))) in row:
        values.append(float(row[key]))
    return tuple(values)


def _require_columns(row: Mapping[str, Any], names: Sequence[str]) -> None:
    missing = [name for name in names if name not in row]
    if missing:
        raise InputError(f"the row has no {', '.join(missing)}: expected the names of trajectory.csv")


class ReferencePoint(NamedTuple):
    """Where vehicle and arm should be at a control tick, with the names of the knots in solution.json."""

    x_m: float
    z_m: float
    arm_rad: float
    vx_m_s: float = 0
    vz_m_s: float = 0
    arm_rate_rad_s: float = 0
    ax_m_s2: float = 0
    az_m_s2: float = 0
    arm_acceleration_rad_s2: float = 0


@dataclass(frozen=True)
class Start:
    """The whole vehicle at a moment, from which a new plan begins. `dataclasses.replace` makes another one."""

    x_m: float
    z_m: float
    arm_rad: float
    pitch_rad: float = 0
    vx_m_s: float = 0
    vz_m_s: float = 0
    pitch_rate_rad_s: float = 0
    arm_rate_rad_s: float = 0
    reference: ReferencePoint | None = None
    """That the vehicle follows at this moment. None: where it is, as it moves."""
    rotor_thrust_n: tuple[float, ...] = ()
    """Free-air thrust that each rotor's lag has reached [N]. Empty: the rotors carry the weight."""
    controller_memory: tuple[float, ...] = ()
    """Of the control law. Empty: that of a vehicle that has hovered for long."""

    @classmethod
    def from_row(cls, row: Mapping[str, Any], reference: ReferencePoint | None = None) -> Start:
        """A vehicle from a row of telemetry with the names of trajectory.csv: pose, speeds, and `rotor_1_lag_n`, ... .

        `x_m`, `z_m` and `arm_rad` are needed, other names are 0 or left out. `reference` is what the vehicle follows:
        `planner.reference_of(plan, tick)`.
        """
        _require_columns(row, _STATE[:3])
        return cls(
            **{name: float(row.get(name, 0)) for name in _STATE},
            reference=reference,
            rotor_thrust_n=_numbered(row, "rotor_#_lag_n"),
            controller_memory=(),
        )

    def _to_core(self, names: Sequence[str]) -> _CoreStart:
        state = [float(getattr(self, name)) for name in _STATE]
        return (state, (), (), self.reference, self.rotor_thrust_n, self.controller_memory)

    @classmethod
    def _of_core(cls, core: _CoreStart, names: Sequence[str]) -> Start:
        state, _, _, reference, rotors, memory = core
        return cls(
            **dict(zip(_STATE, state)),
            reference=None if reference is None else ReferencePoint(*reference),
            rotor_thrust_n=tuple(rotors),
            controller_memory=tuple(memory),
        )


@dataclass(frozen=True)
class SpaceStart:
    """The whole vehicle in space at a moment, with the names of trajectory.csv: see `Start`."""

    x_m: float
    y_m: float
    z_m: float
    qw: float = 1
    """The attitude: a quaternion from the body to the world, of any length but zero."""
    qx: float = 0
    qy: float = 0
    qz: float = 0
    joints_rad: tuple[float, ...] = ()
    """One for each joint. Empty: all zero."""
    vx_m_s: float = 0
    """In the world."""
    vy_m_s: float = 0
    vz_m_s: float = 0
    wx_rad_s: float = 0
    """About the body's axes."""
    wy_rad_s: float = 0
    wz_rad_s: float = 0
    joint_rates_rad_s: tuple[float, ...] = ()
    """One for each joint. Empty: all zero."""
    reference: Mapping[str, float] | None = None
    """That the vehicle follows at this moment, with the names of a knot in solution.json. None: where it is."""
    rotor_thrust_n: tuple[float, ...] = ()
    """As of `Start`."""
    controller_memory: tuple[float, ...] = ()
    """As of `Start`."""

    @classmethod
    def from_row(cls, row: Mapping[str, Any], reference: Mapping[str, float] | None = None) -> SpaceStart:
        """A vehicle from a row of telemetry with the names of trajectory.csv: see `Start.from_row`.

        `x_m`, `y_m`, `z_m` and the attitude `qw` to `qz` are needed, and `joint_1_rad`, ... of an arm.
        """
        _require_columns(row, _SPACE_STATE[:7])
        return cls(
            **{name: float(row.get(name, 0)) for name in _SPACE_STATE},
            joints_rad=_numbered(row, "joint_#_rad"),
            joint_rates_rad_s=_numbered(row, "joint_#_rate_rad_s"),
            reference=reference,
            rotor_thrust_n=_numbered(row, "rotor_#_lag_n"),
            controller_memory=(),
        )

    def _to_core(self, names: Sequence[str]) -> _CoreStart:
        state = [float(getattr(self, name)) for name in _SPACE_STATE]
        if all(abs(part) < 1e-6 for part in state[3:7]):
            raise InputError("start: the attitude has no direction: expected a quaternion; qw = 1 is level")
        reference = None
        if self.reference is not None:
            missing = [name for name in names if name not in self.reference]
            if missing:
                raise InputError(f"start: the reference has no {', '.join(missing)}: expected the names of a knot")
            reference = [float(self.reference[name]) for name in names]
        return (
            state,
            self.joints_rad,
            self.joint_rates_rad_s,
            reference,
            self.rotor_thrust_n,
            self.controller_memory,
        )

    @classmethod
    def _of_core(cls, core: _CoreStart, names: Sequence[str]) -> SpaceStart:
        state, joints, joint_rates, reference, rotors, memory = core
        values = dict(zip(_SPACE_STATE, state))
        return cls(
            **values,
            joints_rad=tuple(joints),
            joint_rates_rad_s=tuple(joint_rates),
            reference=None if reference is None else dict(zip(names, reference)),
            rotor_thrust_n=tuple(rotors),
            controller_memory=tuple(memory),
        )


AnyStart = Union[Start, SpaceStart]
AnyReference = Union[ReferencePoint, Dict[str, float]]


class Answer:
    """An answer to where to fly from a moment on."""

    def __init__(self, core: _core.Answer | _core.SpaceAnswer) -> None:
        self._core = core

    @property
    def advice(self) -> str:
        """What to do.

        keep: follow what is left of the last plan, which is safe in the scene as it is now
        follow: follow a new plan to the goal
        stop: brake and hover, which is safe
        none: nothing is known to be safe; brake in the way that fails in the fewest worlds
        """
        return self._core.advice

    @property
    def plan(self) -> Columns:
        """The knots of what to follow, from the start on; of `stop` and `none` the way to brake.

        Where every way to brake leaves the bounds, that of `none` is what is left of the last plan.
        """
        return self._core.plan()

    @property
    def cost(self) -> float | None:
        """Of the flight with direct aerodynamics, by the problem's objective; None unless `keep` or `follow`."""
        return self._core.cost if self.advice in ("keep", "follow") else None

    @property
    def after_wall_s(self) -> float:
        """Since `replan` was called."""
        return self._core.after_wall_s

    @property
    def solution(self) -> Solution | None:
        """Of the search; None unless `follow`."""
        core = self._core.solution()
        return None if core is None else _solution_of(core)

    def __repr__(self) -> str:
        return f"<downwash.Answer {self.advice} after {self.after_wall_s:.3f} s>"


def _solution_of(core: _core.Solution | _core.SpaceSolution) -> Solution:
    return Solution(core, Problem(core.problem()))


def _knots(plan: Mapping[str, npt.ArrayLike], names: Sequence[str]) -> npt.NDArray[np.float64]:
    """The rows of a plan's knots."""
    missing = [name for name in names if name not in plan]
    if missing:
        raise InputError(f"the plan has no {', '.join(missing)}: expected the columns of solution.plan")
    columns = [np.atleast_1d(numbers(f"plan[{name!r}]", plan[name])) for name in names]
    if any(column.shape != columns[0].shape or column.ndim != 1 for column in columns):
        raise InputError("the columns of the plan are not equally long")
    return np.column_stack(columns)


class Planner:
    """A planner that stays with a vehicle in the air, and keeps scene, aero map, plan and what its last search found.

    It is one for a vehicle in a vertical plane or, for a problem in space, for one in space: starts are then
    `SpaceStart`, and references dicts with the names of a knot.

    One call runs at a time: a call from another thread, or from a callback, raises RuntimeError. `latest` may be called
    from any thread at any time.

    problem: what is planned first; its planner settings hold for `solve`, but for its limits also for `replan`
    threads: number of threads, on which results do not depend; default: one per processor
    stop_at_first: end searches with the first plan that is accepted
    finds_stops: prefer plans that can be left for a hover at more of their time, as `downwash.solve` does; takes a moment
    cache: folder in which aero maps are kept; default: none
    """

    @checked()
    def __init__(
        self,
        problem: Problem,
        *,
        threads: int | None = None,
        stop_at_first: bool = False,
        finds_stops: bool = False,
        cache: Path | None = None,
    ) -> None:
        settings = (threads or 0, stop_at_first, finds_stops, os.fspath(cache) if cache is not None else "")
        self._core: _core.Planner | _core.SpacePlanner
        self._start_class: type[Start] | type[SpaceStart]
        if isinstance(problem._core, _core.SpaceProblem):
            self._core, self._start_class = _core.SpacePlanner(problem._core, *settings), SpaceStart
        else:
            self._core, self._start_class = _core.Planner(problem._core, *settings), Start
        self._names = self._core.knot_names  # t_s, then the numbers of a point of the reference
        # What a change is read with: values beside obstacles and goal that are right.
        whole = problem.to_dict("")
        self._frame = {key: whole[key] for key in ("schema", "name", "robot", "start", "goal")}
        self._bounds = whole["environment"]["bounds"]

    def solve(
        self, *, on_progress: Callable[[Progress], object] | None = None, stop: StopSignal | None = None
    ) -> Solution:
        """Plans from the problem's start, and keeps the plan.

        Threads, Ctrl-C, `on_progress` and `stop` are as for `downwash.solve`.
        """
        return _solution_of(self._core.solve(None if on_progress is None else _teller(on_progress), stop))

    def _core_of(self, start: AnyStart) -> _CoreStart:
        require_made("start", start, self._start_class.__name__)
        return start._to_core(self._names[1:])

    @checked(("goal", "max_iterations"))
    def replan(
        self,
        start: AnyStart,
        tick: int,
        *,
        put: Sequence[Mapping[str, Any]] = (),
        removed: Sequence[str] = (),
        goal: Mapping[str, Any] | None = None,
        time_limit_s: float | None = None,
        max_iterations: int | None = None,
        on_answer: Callable[[Answer], object] | None = None,
        stop: StopSignal | None = None,
    ) -> Answer:
        """Takes up changes and says what to do from a start on: a safe stop first, then better answers. Returns the best.

        The plan of the last answer, if it leads to the goal, is kept as the last plan. With `max_iterations` alone the
        result is repeatable bit for bit. Without any limit a search takes 10 s. Other Python threads run meanwhile.
        Ctrl-C ends the search and raises KeyboardInterrupt.
        Raises InputError, and changes nothing, when the problem with the changes has errors apart from its start.

        start: the whole vehicle at the moment from which the answer counts
        tick: of the last plan at that moment
        put: obstacles as a problem file has them; one with a name takes the place of the obstacle of that name
        removed: names of obstacles that are gone
        goal: as a problem file has it, in place of all goals that were not visited yet
        time_limit_s: wall time of all, at most 10^6
        max_iterations: of the search
        on_answer: called with every Answer that is better than the one before, by the thread that called `replan`
        stop: a threading.Event, which ends the call early, once it is known how to stop
        """
        begin = self._core_of(start)
        text = ""
        if put or goal is not None:
            document = {**self._frame, "environment": {"bounds": self._bounds, "obstacles": list(put)}}
            text = _yaml({**document, "goal": goal} if goal is not None else document)
        tell = None if on_answer is None else _answer_teller(on_answer)
        changes = (text, goal is not None, list(removed))
        try:
            core = self._core.replan(begin, tick, *changes, time_limit_s, max_iterations, tell, stop)
        except ProblemError as error:
            raise _without_lines(error) from None
        return Answer(core)

    def latest(self) -> Answer | None:
        """The best answer so far to the last call of `replan`; None before its first answer."""
        core = self._core.latest()
        return None if core is None else Answer(core)

    @checked()
    def predicted(self, start: AnyStart, plan: Mapping[str, npt.ArrayLike], ticks: int) -> AnyStart:
        """The vehicle as it will be some ticks later, by the planner's own model without noise.

        plan: columns of knots that it follows from its start on
        """
        knots = _knots(plan, self._names)
        return self._start_class._of_core(self._core.predicted(self._core_of(start), knots, ticks), self._names[1:])

    @checked()
    def reference_of(self, plan: Mapping[str, npt.ArrayLike], tick: int) -> AnyReference:
        """The reference of a plan at a tick; after its last knot that one."""
        point = self._core.reference_of(_knots(plan, self._names), tick)
        return dict(zip(self._names[1:], point)) if self._start_class is SpaceStart else ReferencePoint(*point)

    @checked()
    def adopt(self, plan: Mapping[str, npt.ArrayLike]) -> None:
        """Takes a plan for the last one, from the problem's start to its goals, as one that was made before."""
        self._core.adopt(_knots(plan, self._names))

    @property
    def plan(self) -> Columns | None:
        """The knots of the last plan to the goal; None before there is one."""
        return self._core.plan()

    @property
    def start(self) -> AnyStart:
        """The start of the last call."""
        return self._start_class._of_core(self._core.start(), self._names[1:])

    @property
    def problem(self) -> Problem:
        """The problem as it is now: with all changes, from the last start to the goals that are left."""
        return Problem(self._core.problem())

    @property
    def tick_s(self) -> float:
        """Length of a control tick [s]."""
        return self._core.tick_s

    def __repr__(self) -> str:
        return "<downwash.Planner>"


def _answer_teller(on_answer: Callable[[Answer], object]) -> Callable[[_core._AnyAnswer], object]:
    return lambda core: on_answer(Answer(core))
