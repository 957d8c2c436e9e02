"""Downwash: motion planning for aerial manipulators that know their own downwash.

    import downwash
    problem = downwash.read_problem("problems/bridge_inspection.yaml")
    solution = downwash.solve(problem, seed=3, max_iterations=2000)
    solution.write("downwash-out/bridge")

docs/python.md explains the package.
"""

from ._core import version as __version__
from .aeromap import AeroMap, factor, is_flyable
from .analysis import Validation, draw_worlds, hold, validate
from .campaign import Campaign
from .errors import FolderError, InputError, LocatedError, OtherRunError, ProblemError, Stopped
from .planner import Answer, Planner, ReferencePoint, SpaceStart, Start
from .problem import Problem, explain, read_problem
from .solution import Columns, Flight, Progress, Solution, execute, read_solution, solve

__all__ = [
    "AeroMap",
    "Answer",
    "Campaign",
    "Columns",
    "Flight",
    "FolderError",
    "InputError",
    "LocatedError",
    "OtherRunError",
    "Planner",
    "Problem",
    "ProblemError",
    "Progress",
    "ReferencePoint",
    "Solution",
    "SpaceStart",
    "Start",
    "Stopped",
    "Validation",
    "__version__",
    "draw_worlds",
    "execute",
    "explain",
    "factor",
    "hold",
    "is_flyable",
    "read_problem",
    "read_solution",
    "solve",
    "validate",
]
