"""The results of a campaign as pandas frames."""

from __future__ import annotations

import os
import sqlite3
from typing import TYPE_CHECKING

from .errors import InputError
from .problem import Path

if TYPE_CHECKING:
    import pandas

__all__ = ["Campaign"]

_APPLICATION_ID = 0x446F776E
_LAYOUT = 6
_NAMES = """SELECT runs.id AS run, experiments.problem, experiments.objective, plannerConfigs.variant,
plannerConfigs.algorithm, plannerConfigs.margin_m, runs.seed"""
_TABLES = """FROM runs JOIN experiments ON runs.experimentid = experiments.id
JOIN plannerConfigs ON runs.plannerid = plannerConfigs.id"""


class Campaign:
    """What `downwash bench run` left in a folder, finished or not. Frames need pandas."""

    def __init__(self, folder: Path) -> None:
        self.folder = os.fspath(folder)
        self._file = os.path.join(self.folder, "results.db")
        if not os.path.isfile(self._file):
            raise InputError(f"{self._file} is not there: expected a folder that `downwash bench run` wrote to")
        with self._open() as database:
            try:
                found = [database.execute(f"PRAGMA {name}").fetchone()[0] for name in ("application_id", "user_version")]
            except sqlite3.DatabaseError as error:
                raise InputError(f"{self._file} cannot be read: {error}") from None
        if found != [_APPLICATION_ID, _LAYOUT]:
            raise InputError(f"{self._file} holds no results of a campaign that this version can read")

    def _open(self) -> sqlite3.Connection:
        return sqlite3.connect(f"file:{os.path.abspath(self._file)}?mode=ro", uri=True)
