"""How surfaces change the thrust of rotors: the thrust ratio K at points, and maps of it."""

from __future__ import annotations

import os
from typing import Callable, Dict

import numpy as np
import numpy.typing as npt

from . import _core
from ._arguments import checked, numbers
from .problem import Path, Problem, in_plane

__all__ = ["AeroMap", "factor", "is_flyable"]


@checked()
def factor(
    problem: Problem, points: npt.ArrayLike, *, rotor: int = 1, threads: int | None = None
) -> npt.NDArray[np.float64]:
    """The thrust ratio K of a level rotor, averaged over its disc and evaluated directly, at every point.

    points: of the rotor's hub [m]: (n, 2) plane coordinates x, z, beside the plane where the rotor is, or (n, 3) world
        coordinates x, y, z. K means nothing where `is_flyable` is False
    rotor: number of the rotor, from 1
    threads: number of threads; default: one per processor
    """
    return _core.factor(in_plane(problem, "factor"), numbers("points", points), rotor, threads or 0)


@checked()
def is_flyable(
    problem: Problem, points: npt.ArrayLike, *, rotor: int = 1, threads: int | None = None
) -> npt.NDArray[np.bool_]:
    """Whether the disc of a level rotor keeps its distance from every obstacle. Parameters as of `factor`."""
    return _core.is_flyable(in_plane(problem, "is_flyable"), numbers("points", points), rotor, threads or 0)


class AeroMap:
    """K stored over every rotor position that a vehicle within the bounds of a problem can reach.

    A layer is a grid of square cells, and each cell a regular grid of nodes, between which K is bilinear. A map that a
    search made is filled where its flights asked for it, and fills further where `factor` or `is_flyable` ask.
    """

    def __init__(self, core: _core.AeroMap) -> None:
        self._core = core

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
        """Builds the whole map of a problem.

        threads: number of threads, on which the map does not depend; default: one per processor
        cache: folder in which maps are kept from one run to the next; default: none
        on_progress: called with the share that is built, by the calling thread
        stop: a threading.Event; when it ends the work, Stopped is raised
        """
        folder = os.fspath(cache) if cache is not None else ""
        return cls(_core.AeroMap.build(in_plane(problem, "AeroMap"), threads or 0, folder, on_progress, stop))

    @classmethod
    @checked()
    def read(cls, file: Path, problem: Problem) -> AeroMap:
        """Reads what `write` wrote. Raises InputError unless it is the map of this problem."""
        return cls(_core.AeroMap.read(os.fspath(file), in_plane(problem, "AeroMap")))

    def write(self, file: Path) -> None:
        """Writes what is filled of the map: all of it, unless a search filled it. Machines of the same byte order can read it; `downwash aeromap build` writes for others."""
        self._core.write(os.fspath(file))

    @checked()
    def factor(self, points: npt.ArrayLike, *, rotor: int = 1, threads: int | None = None) -> npt.NDArray[np.float64]:
        """K, interpolated within 0.01 of the direct evaluation, at hubs in plane coordinates x, z: (n, 2) [m].

        Outside the extent it is evaluated directly. K means nothing where `is_flyable` is False.
        """
        return self._core.factor(numbers("points", points), rotor, threads or 0)

    @checked()
    def is_flyable(self, points: npt.ArrayLike, *, rotor: int = 1, threads: int | None = None) -> npt.NDArray[np.bool_]:
        """Whether hubs in plane coordinates are inside the flyable area."""
        return self._core.is_flyable(numbers("points", points), rotor, threads or 0)

    @checked()
    def arrays(self, rotor: int = 1) -> Dict[str, npt.NDArray[np.generic]]:
        """The values of a rotor's layer: read-only arrays, made once, which keep the map alive. Fills the whole map.

        cells: (rows, columns) of first_node, steps_x, steps_z: the cell's nodes begin at `nodes[first_node]`, and there
            are (steps_x + 1) (steps_z + 1) of them, x running fastest
        flyability: (rows, columns): 0 flyable throughout, 1 forbidden throughout, 2 both
        sides: (rows, columns): which surfaces matter: 0 those below, 1 those above, 2 both
        nodes: K; where both sides matter, as many values of the surfaces above alone follow those of a cell
        """
        return self._core.arrays(rotor)

    @property
    def extent(self) -> tuple[float, float, float, float]:
        """x_low, x_high, z_low, z_high [m] of the rotors' hubs, in plane coordinates."""
        return self._core.extent()

    @property
    def cell_m(self) -> float:
        """Side of a cell [m]."""
        return 1 / self._core.cells_per_m()

    @property
    def memory_bytes(self) -> int:
        """The memory that the map takes now."""
        return self._core.memory_bytes()
