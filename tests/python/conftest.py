"""What the tests share: the program to compare with, and problems."""

from __future__ import annotations

import json
import os
import pathlib
import subprocess
from typing import Any, Callable

import downwash
import pytest

CAMPAIGN = """
schema: downwash/campaign/v1
name: small
problems: [{folder}/open_air.yaml]
variants: [mp-arm, mp-arm-da]
seeds: {{first: 1, count: 2}}
max_iterations: 30
evaluation_worlds: 3
"""


@pytest.fixture(scope="session")
def folder() -> pathlib.Path:
    """The shipped problems."""
    return pathlib.Path(os.environ["DOWNWASH_PROBLEMS"])


@pytest.fixture(scope="session")
def bridge(folder: pathlib.Path) -> downwash.Problem:
    return downwash.read_problem(folder / "bridge_inspection.yaml")


@pytest.fixture(scope="session")
def open_air(folder: pathlib.Path) -> downwash.Problem:
    return downwash.read_problem(folder / "open_air.yaml")


@pytest.fixture(scope="session")
def program(tmp_path_factory: pytest.TempPathFactory) -> Callable[..., subprocess.CompletedProcess[str]]:
    """Runs the program downwash."""
    cache = tmp_path_factory.mktemp("cache")

    def run(*arguments: object) -> subprocess.CompletedProcess[str]:
        environment = {**os.environ, "XDG_CACHE_HOME": str(cache)}
        command = [os.environ["DOWNWASH_PROGRAM"], *map(str, arguments)]
        return subprocess.run(command, capture_output=True, text=True, env=environment, check=False)

    return run


@pytest.fixture(scope="session")
def json_of(program: Callable[..., subprocess.CompletedProcess[str]]) -> Callable[..., Any]:
    """What the program prints with --json."""

    def run(*arguments: object) -> Any:
        done = program(*arguments, "--json")
        assert done.returncode in (0, 3), done.stderr
        return json.loads(done.stdout)

    return run


@pytest.fixture(scope="session")
def results(
    tmp_path_factory: pytest.TempPathFactory, folder: pathlib.Path, program: Callable[..., Any]
) -> pathlib.Path:
    """The folder of a small campaign."""
    tmp_path = tmp_path_factory.mktemp("campaign")
    (tmp_path / "campaign.yaml").write_text(CAMPAIGN.format(folder=folder))
    done = program("bench", "run", tmp_path / "campaign.yaml", "--out", tmp_path / "out", "--quiet")
    assert done.returncode == 0, done.stderr
    return tmp_path / "out"


@pytest.fixture()
def planner(problem: Any) -> downwash.Planner:
    """One that has solved the problem of the module that asks for it."""
    planner = downwash.Planner(problem, threads=2, finds_stops=True)
    assert planner.solve().status == "solved"
    return planner
