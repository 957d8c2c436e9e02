"""Checks of arguments, so that an error names the argument and not what lies below the package."""

from __future__ import annotations

import functools
import inspect
import operator
import sys
from collections.abc import Iterable
from typing import Any, Callable, Collection, Mapping, TypeVar, cast

import numpy as np
import numpy.typing as npt

from .errors import InputError

_Function = TypeVar("_Function", bound=Callable[..., Any])

_MADE_BY = {
    "AeroMap": "AeroMap.build() and solution.map are",
    "Problem": "read_problem() returns",
    "Solution": "solve() and read_solution() return",
    "SpaceStart": "SpaceStart(...) and SpaceStart.from_row() return",
    "Start": "Start(...) and Start.from_row() return",
}
_RANGES = {
    "count": (0, 10_000_000),
    "runs": (0, 10_000_000),
    "threads": (1, 256),
    # What these may be is said where it is known.
    "rotor": (-(2**31) + 1, 2**31 - 1),
    "tick": (-(2**63) + 1, 2**63 - 1),
    "ticks": (-(2**63) + 1, 2**63 - 1),
}


def _is_truth(value: object) -> bool:
    return type(value).__name__ in ("bool", "bool_")


def _number(name: str, value: object, kind: str) -> None:
    if isinstance(value, (str, bytes)):
        raise TypeError(f"{name} is {value!r}: expected {kind}, not text")
    if _is_truth(value):
        raise TypeError(f"{name} is {value!r}: expected {kind}")
    try:
        if kind == "a number":
            float(cast(Any, value))
        else:
            operator.index(cast(Any, value))
    except TypeError:
        raise TypeError(f"{name} is {value!r}: expected {kind}") from None


def _require_range(name: str, value: object) -> None:
    number = operator.index(cast(Any, value))
    lowest, highest = _RANGES.get(name, (0, 2**64 - 1))
    if not lowest <= number <= highest:
        raise InputError(f"{name}: is {number}: expected a whole number from {lowest} to {highest}")


def _require_list(name: str, value: object, kind: str) -> None:
    things, element = ("names", str) if kind == "Sequence[str]" else ("dicts", Mapping)
    if isinstance(value, (str, bytes, Mapping)) or not isinstance(value, Iterable):
        raise TypeError(f"{name} is {value!r}: expected a list of {things}")
    for each in value:
        if not isinstance(each, element):
            raise TypeError(f"{name} has {each!r}: expected a list of {things}")


def numbers(name: str, value: npt.ArrayLike) -> npt.NDArray[np.float64]:
    """What a user gives for an array of numbers."""
    try:
        return np.asarray(value, dtype=np.float64)
    except (TypeError, ValueError):
        raise TypeError(f"{name}: {value!r} is no array of numbers, with rows that are equally long") from None


def require_made(name: str, value: object, kind: str) -> None:
    """Raises TypeError unless a value is of one of the package's classes."""
    if not isinstance(value, getattr(sys.modules["downwash"], kind)):
        raise TypeError(
            f"{name} is of the type {type(value).__name__}: expected a downwash.{kind}, which {_MADE_BY[kind]}"
        )


def _check(name: str, value: object, kind: str) -> None:
    if kind == "int":
        _number(name, value, "a whole number")
    elif kind == "float":
        _number(name, value, "a number")
    elif kind == "bool" and not _is_truth(value):
        raise TypeError(f"{name} is {value!r}: expected True or False")
    elif kind == "str" and not isinstance(value, str):
        raise TypeError(f"{name} is {value!r}: expected text")
    elif kind.startswith("Sequence["):
        _require_list(name, value, kind)
    elif kind.startswith("Mapping[") and name == "plan" and value is None:
        raise TypeError("plan is None, as planner.plan is before there is one: call solve() first")
    elif kind.startswith("Mapping[") and not isinstance(value, Mapping):
        raise TypeError(f"{name} is {value!r}: expected a dict")
    elif kind in _MADE_BY:
        require_made(name, value, kind)


def checked(elsewhere: Collection[str] = ()) -> Callable[[_Function], _Function]:
    """Makes a function that checks its arguments first, by their annotations.

    elsewhere: names of arguments that are checked elsewhere, but for the types of numbers and texts
    """

    def with_checks(function: _Function) -> _Function:
        signature = inspect.signature(function)
        kinds = {
            name: str(parameter.annotation)
            for name, parameter in signature.parameters.items()
            if parameter.annotation is not inspect.Parameter.empty
        }

        @functools.wraps(function)
        def call(*args: Any, **keywords: Any) -> Any:
            try:
                given = signature.bind(*args, **keywords).arguments
            except TypeError:
                return function(*args, **keywords)  # Python's own error names the function
            for name, value in given.items():
                annotation = kinds.get(name, "")
                kind = annotation.removesuffix(" | None")
                if value is None and kind != annotation:
                    continue
                if name not in elsewhere or kind in ("int", "float", "str"):
                    _check(name, value, kind)
                if name not in elsewhere and kind == "int":
                    _require_range(name, value)
            return function(*args, **keywords)

        return cast(_Function, call)

    return with_checks
