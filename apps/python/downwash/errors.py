"""What downwash raises."""

from __future__ import annotations

import re
from typing import NamedTuple, Optional, Sequence, Tuple

__all__ = ["FolderError", "InputError", "LocatedError", "OtherRunError", "ProblemError", "Stopped"]

_PLACE = re.compile(r"(?P<file>[^\n]+?):(?P<line>\d+):(?:(?P<column>\d+):)? (?P<message>.*)")

_Row = Tuple[Optional[str], Optional[int], Optional[int], str]


class LocatedError(NamedTuple):
    """An error or a warning, and its place. Lines and columns count from 1, columns in bytes."""

    file: str | None
    line: int | None
    column: int | None
    message: str

    def __str__(self) -> str:
        place = [str(part) for part in self[:3] if part is not None]
        return ":".join([*place, " " + self.message]) if place else self.message


def _located(row: _Row) -> LocatedError:
    """The error of a row; its place may stand in the message."""
    found = _PLACE.fullmatch(row[3]) if row[0] is None else None
    if found is None:
        return LocatedError(*row)
    column = found["column"]
    return LocatedError(found["file"], int(found["line"]), int(column) if column else None, found["message"])


class InputError(ValueError):
    """Something that cannot be used. The text has one line for every error that was found, as the program prints it."""

    errors: tuple[LocatedError, ...]
    """Every error, in the order of the text."""
    file: str | None
    """File of the first error; None where it has none."""
    line: int | None
    """Its line, from 1."""
    column: int | None
    """Its column, from 1, in bytes."""

    def __init__(self, text: str, errors: Sequence[_Row] = ()) -> None:
        super().__init__(text)
        self.errors = tuple(_located(error) for error in errors) or (LocatedError(None, None, None, text),)
        self.file, self.line, self.column, _ = self.errors[0]


class ProblemError(InputError):
    """A problem that cannot be planned, or a file that cannot be read."""


class FolderError(OSError):
    """A folder that cannot be written."""

    def __init__(self, text: str, errors: Sequence[_Row] = ()) -> None:
        super().__init__(text)


class OtherRunError(FolderError):
    """A folder that holds the run of another problem. `force=True` replaces it."""


class Stopped(RuntimeError):
    """Work that was stopped before it had a result."""

    def __init__(self, text: str, errors: Sequence[_Row] = ()) -> None:
        super().__init__(text)
