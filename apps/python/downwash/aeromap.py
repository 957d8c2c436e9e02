"""How surfaces change the thrust of rotors: the thrust ratio K at points, and maps of it."""

from __future__ import annotations

import os
from typing import Any, Callable, Dict

import numpy as np
import numpy.typing as npt

from . import _core
from ._arguments import checked, numbers
from .errors import InputError
from .problem import Path, Problem, in_plane

__all__ = ["AeroMap", "factor", "is_flyable"]


def _no_yaw(yaw_deg: float) -> None:
    if yaw_deg != 0:
        raise InputError("yaw_deg: is for problems in space: in a vertical plane the heading is the plane's")


@checked()
def factor(
    problem: Problem, points: npt.ArrayLike, *, rotor: int = 1, yaw_deg: float = 0, threads: int | None = None
) -> npt.NDArray[np.float64]:
    """The thrust ratio K of a level rotor, averaged over its disc and evaluated directly, at every point.

    points: of the rotor's hub [m]: (n, 3) world coordinates x, y, z or, in a vertical plane, also (n, 2) plane
        coordinates x, z, beside the plane where the rotor is. K means nothing where `is_flyable` is False
    rotor: number of the rotor, from 1
    yaw_deg: in space, heading of the vehicle, which matters where the other rotors do
    threads: number of threads; default: one per processor
    """
    at = numbers("points", points)
    if isinstance(problem._core, _core.SpaceProblem):
        return _core.factor(problem._core, at, rotor, float(yaw_deg), threads or 0)
    _no_yaw(yaw_deg)
    return _core.factor(problem._core, at, rotor, threads or 0)


@checked()
def is_flyable(
    problem: Problem, points: npt.ArrayLike, *, rotor: int = 1, threads: int | None = None
) -> npt.NDArray[np.bool_]:
    """Whether the disc of a level rotor keeps its distance from every obstacle. Parameters as of `factor`."""
    return _core.is_flyable(problem._core, numbers("points", points), rotor, threads or 0)


class AeroMap:
    """K stored over every rotor position that a vehicle within the bounds of a problem can reach.

    In a vertical plane a layer is a grid of square cells, and each cell a regular grid of nodes, between which K is
    bilinear. In space the map is a volume of boxes, between whose nodes K is quadratic. A map that a search made is
    filled where its flights asked for it, and fills further where `factor` or `is_flyable` ask. That of a problem in
    space always is: there is no need to fill all of it. `cache=` keeps its parts from one run to the next.
    """

    def __init__(self, core: _core.AeroMap | _core.SurfaceVolumes, problem: Problem) -> None:
        self._core = core
        self._problem = problem

    @classmethod
    @checked()
    def build(
        cls,
        problem: Problem,
        *,
        threads: int | None = None,
        cache: Path | None = None,
        on_progress: Callable[[float], object] | None = None,
        stop: object | None = None,
    ) -> AeroMap:
        """Builds the whole map of a problem; of one in space a map that fills where it is asked.

        threads: number of threads, on which the map does not depend; default: one per processor
        cache: folder in which maps are kept from one run to the next; default: none
        on_progress: called with the share that is built, by the calling thread
        stop: a threading.Event; when it ends the work, Stopped is raised
        """
        folder = os.fspath(cache) if cache is not None else ""
        if isinstance(problem._core, _core.SpaceProblem):
            return cls(_core.SurfaceVolumes.make(problem._core, folder), problem)
        return cls(_core.AeroMap.build(problem._core, threads or 0, folder, on_progress, stop), problem)

    @classmethod
    @checked()
    def read(cls, file: Path, problem: Problem) -> AeroMap:
        """Reads what `write` wrote. Raises InputError unless it is the map of this problem, or for one in space."""
        return cls(_core.AeroMap.read(os.fspath(file), in_plane(problem, "AeroMap.read")), problem)

    def write(self, file: Path) -> None:
        """Writes what is filled of the map: all of it, unless a search filled it. Not of a map in space.

        Machines of the same byte order can read it; `downwash aeromap build` writes for others.
        """
        self._planar("write").write(os.fspath(file))

    @checked()
    def factor(
        self, points: npt.ArrayLike, *, rotor: int = 1, yaw_deg: float = 0, threads: int | None = None
    ) -> npt.NDArray[np.float64]:
        """K, interpolated within 0.01 of the direct evaluation, at hubs.

        points: (n, 2) plane coordinates x, z or, in space, (n, 3) world coordinates x, y, z [m]
        yaw_deg: as of the function `factor`. K of several rotors, which is put together, is within 0.03

        Outside the extent it is evaluated directly. K means nothing where `is_flyable` is False.
        """
        at = numbers("points", points)
        if isinstance(self._core, _core.SurfaceVolumes):
            return self._core.factor(at, rotor, float(yaw_deg), threads or 0)
        _no_yaw(yaw_deg)
        return self._core.factor(at, rotor, threads or 0)

    @checked()
    def is_flyable(self, points: npt.ArrayLike, *, rotor: int = 1, threads: int | None = None) -> npt.NDArray[np.bool_]:
        """Whether hubs are inside the flyable area. Parameters as of `factor`."""
        return self._core.is_flyable(numbers("points", points), rotor, threads or 0)

    @checked()
    def arrays(self, rotor: int = 1) -> Dict[str, npt.NDArray[np.generic]]:
        """The values of a rotor's layer: read-only arrays, made once, which keep the map alive. Fills the whole map.

        Not of a map in space.

        cells: (rows, columns) of first_node, steps_x, steps_z: the cell's nodes begin at `nodes[first_node]`, and there
            are (steps_x + 1) (steps_z + 1) of them, x running fastest
        flyability: (rows, columns): 0 flyable throughout, 1 forbidden throughout, 2 both
        sides: (rows, columns): which surfaces matter: 0 those below, 1 those above, 2 both
        nodes: K; where both sides matter, as many values of the surfaces above alone follow those of a cell
        """
        return self._planar("arrays").arrays(rotor)

    @property
    def extent(self) -> tuple[float, ...]:
        """x_low, x_high, z_low, z_high [m] of the rotors' hubs, in plane coordinates; in space of x, y and z."""
        return tuple(self._core.extent())

    @property
    def cell_m(self) -> float:
        """Side of a cell [m]. Not of a map in space."""
        return 1 / self._planar("cell_m").cells_per_m()

    @property
    def memory_bytes(self) -> int:
        """The memory that the map takes now."""
        return self._core.memory_bytes()

    def _planar(self, what: str) -> _core.AeroMap:
        """The core of a map in a vertical plane. Raises InputError for one in space."""
        if isinstance(self._core, _core.SurfaceVolumes):
            raise InputError(f"AeroMap.{what} is for maps in a vertical plane, and this is one in space")
        return self._core

    def _for(self, problem: Problem) -> _core.AeroMap | _core.SurfaceVolumes:
        """The core, for a search. Raises InputError if it is known to be of another world."""
        is_other = problem.is_in_space != self._problem.is_in_space
        if problem.is_in_space and not is_other:  # in a plane, the search looks
            is_other = _world_of(problem) != _world_of(self._problem)
        if is_other:
            raise InputError(
                "map: is of another scene, robot, model or bounds: expected a map of the same problem"
            )
        return self._core


def _world_of(problem: Problem) -> list[Any]:
    whole = problem.to_dict("")
    return [whole.get(key) for key in ("robot", "environment", "aero")]
