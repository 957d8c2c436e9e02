"""Checks of arguments, so that an error names the argument and not what lies below the package."""

from __future__ import annotations

import functools
import inspect
import operator
import sys
from typing import Any, Callable, Collection, Mapping, TypeVar, cast

from .errors import InputError

_Function = TypeVar("_Function", bound=Callable[..., Any])

_MADE_BY = {
    "AeroMap": "AeroMap.build() and solution.map are",
    "Problem": "read_problem() returns",
    "Solution": "solve() and read_solution() return",
    "Start": "Start(...) and Start.from_row() return",
}
_HIGHEST = {"threads": 2**31 - 1, "rotor": 2**31 - 1, "tick": 2**63 - 1, "ticks": 2**63 - 1}
_MAY_BE_NEGATIVE = ("rotor", "tick", "ticks")
"""What these may be is said where it is known."""


def _number(name: str, value: object, kind: str) -> None:
    if isinstance(value, (str, bytes)):
        raise TypeError(f"{name} is {value!r}: expected {kind}, not text")
    try:
        if kind == "a number":
            float(cast(Any, value))
        else:
            operator.index(cast(Any, value))
    except TypeError:
        raise TypeError(f"{name} is {value!r}: expected {kind}") from None


def _whole_number(name: str, value: object) -> None:
    _number(name, value, "a whole number")
    number = operator.index(cast(Any, value))
    highest = _HIGHEST.get(name, 2**64 - 1)
    lowest = -highest if name in _MAY_BE_NEGATIVE else 0
    if not lowest <= number <= highest:
        raise InputError(f"{name}: is {number}: expected a whole number from {lowest} to {highest}")


def _check(name: str, value: object, kind: str) -> None:
    if kind == "int":
        _whole_number(name, value)
    elif kind == "float":
        _number(name, value, "a number")
    elif kind == "bool" and type(value).__name__ not in ("bool", "bool_"):
        raise TypeError(f"{name} is {value!r}: expected True or False")
    elif kind == "str" and not isinstance(value, str):
        raise TypeError(f"{name} is {value!r}: expected text")
    elif kind.startswith("Mapping[") and not isinstance(value, Mapping):
        raise TypeError(f"{name} is {value!r}: expected a dict")
    elif kind in _MADE_BY and not isinstance(value, getattr(sys.modules["downwash"], kind)):
        raise TypeError(
            f"{name} is of the type {type(value).__name__}: expected a downwash.{kind}, which {_MADE_BY[kind]}"
        )


def checked(unchecked: Collection[str] = ()) -> Callable[[_Function], _Function]:
    """Makes a function that checks its arguments first, by their annotations.

    unchecked: names of arguments that are checked elsewhere
    """

    def with_checks(function: _Function) -> _Function:
        signature = inspect.signature(function)
        kinds = {
            name: str(parameter.annotation)
            for name, parameter in signature.parameters.items()
            if name not in unchecked and parameter.annotation is not inspect.Parameter.empty
        }

        @functools.wraps(function)
        def call(*args: Any, **keywords: Any) -> Any:
            try:
                given = signature.bind(*args, **keywords).arguments
            except TypeError:
                return function(*args, **keywords)  # Python's own error names the function
            for name, value in given.items():
                kind = kinds.get(name, "")
                if value is not None or not kind.endswith(" | None"):
                    _check(name, value, kind.removesuffix(" | None"))
            return function(*args, **keywords)

        return cast(_Function, call)

    return with_checks
