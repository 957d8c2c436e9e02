"""The results of a campaign as pandas frames."""

from __future__ import annotations

import contextlib
import os
import pathlib
import sqlite3
from typing import Any

from .errors import InputError
from .problem import Path

__all__ = ["Campaign"]

_APPLICATION_ID = 0x446F776E  # "Down" in ASCII
_LAYOUT = 8
_NAMES = """runs.id AS run, experiments.problem, experiments.objective, plannerConfigs.variant,
    plannerConfigs.algorithm, plannerConfigs.margin_m, runs.seed"""
_OF_RUNS = """runs JOIN experiments ON runs.experimentid = experiments.id
    JOIN plannerConfigs ON runs.plannerid = plannerConfigs.id"""


class Campaign:
    """What `downwash bench run` or `bench merge` left in a folder, finished or not, as frames; these need pandas.

    Every frame begins with the columns `run` (a number), `problem`, `objective`, `variant`, `algorithm`, `margin_m`
    (NaN: the problem's own) and `seed`. `downwash bench report` gives statistics with their intervals.
    """

    def __init__(self, folder: Path) -> None:
        """Raises InputError if the folder holds no results that this version reads."""
        self.folder = os.fspath(folder)
        self._file = os.path.join(self.folder, "campaign.db")
        if not os.path.isfile(self._file):
            raise InputError(f"{self._file} cannot be read: there is no such file; expected the folder of a campaign")
        try:
            with contextlib.closing(self._open()) as database:
                marks = [
                    database.execute(f"PRAGMA {name}").fetchone()[0] for name in ("application_id", "user_version")
                ]
                self.settings: dict[str, str] = dict(
                    database.execute("SELECT name, value FROM campaign ORDER BY place") if marks[1] == _LAYOUT else ()
                )
        except sqlite3.DatabaseError as error:
            raise InputError(f"{self._file} cannot be read: {error}") from None
        if marks[0] != _APPLICATION_ID:
            raise InputError(f"{self._file} holds no results of a campaign; choose another folder")
        if marks[1] != _LAYOUT:
            raise InputError(
                f"{self._file} holds no results that this version can read: its layout is number {marks[1]}, "
                f"not {_LAYOUT}"
            )

    def _open(self) -> sqlite3.Connection:
        return sqlite3.connect(pathlib.Path(self._file).absolute().as_uri() + "?mode=ro", uri=True)

    def _frame(self, columns: str, join: str = "") -> Any:
        import pandas

        query = f"SELECT {_NAMES}, {columns} FROM {_OF_RUNS} {join} ORDER BY runs.id"
        with contextlib.closing(self._open()) as database:
            return pandas.read_sql_query(query, database).astype({"margin_m": float})

    def runs(self) -> Any:
        """A row for every run: the search, and the executed flight of its plan (empty cells without one).

        Columns: status, solved, search_s (wall time), first_solution_s, planned_cost, iterations, edges_simulated,
        discarded_plans; outcome, cost, energy_j, duration_s, length_m, min_clearance_m and goal_error_m of the flight.
        """
        return self._frame(
            """enums.description AS status, runs.solved = 1 AS solved, runs.time AS search_s,
            runs.time_to_first_solution AS first_solution_s, runs.best_cost AS planned_cost, runs.iterations,
            runs.edges_simulated, runs.discarded_plans, flights.outcome, flights.cost, flights.energy_j,
            flights.duration_s, flights.length_m, flights.min_clearance_m, flights.goal_error_m""",
            """LEFT JOIN flights ON flights.runid = runs.id
            LEFT JOIN enums ON enums.name = 'status' AND enums.value = runs.status""",
        ).astype({"solved": bool})

    def progress(self) -> Any:
        """A row for every improvement of a search: time_s, iterations, best_cost, flown_cost."""
        return self._frame(
            "progress.time AS time_s, progress.iterations, progress.best_cost, progress.flown_cost",
            "JOIN progress ON progress.runid = runs.id",
        )

    def certificates(self) -> Any:
        """A row for every plan that was tested for a certificate: given, worlds, failures, attempts,
        first_certified_s."""
        return self._frame(
            """certificates.given = 1 AS given, certificates.worlds, certificates.failures, certificates.attempts,
            certificates.first_certified_s""",
            "JOIN certificates ON certificates.runid = runs.id",
        ).astype({"given": bool})

    def world_flights(self) -> Any:
        """A row for every plan that was flown in the evaluation worlds: worlds, failures."""
        return self._frame(
            "world_flights.worlds, world_flights.failures", "JOIN world_flights ON world_flights.runid = runs.id"
        )

    def rejections(self) -> Any:
        """A row for every cause for which a search rejected edges: cause, edges."""
        return self._frame("rejections.cause, rejections.edges", "JOIN rejections ON rejections.runid = runs.id")

    def machines(self) -> Any:
        """A row for every run: host, processor (its model), instruction_set, and load, the processes that ran or waited
        to run when the run ended."""
        return self._frame(
            "machines.host, machines.processor, machines.instruction_set, run_machines.load",
            """JOIN run_machines ON run_machines.runid = runs.id
            JOIN machines ON machines.id = run_machines.machineid""",
        )

    def __repr__(self) -> str:
        return f"<downwash.Campaign {self.settings.get('campaign', '')} in {self.folder}>"
