"""Problems: what is to be planned."""

from __future__ import annotations

import copy
import json
import os
import re
from typing import Any, Mapping, Union

from . import _core
from ._arguments import checked
from .errors import InputError, LocatedError, ProblemError

__all__ = ["Problem", "explain", "read_problem"]

Path = Union[str, "os.PathLike[str]"]
_CoreProblem = Union["_core.Problem", "_core.SpaceProblem"]
_STEP = re.compile(r"([^.\[\]]+)|\[(\d+)\]")


def _yaml(value: object) -> str:
    """A value as a problem file may have it. JSON is YAML."""
    return json.dumps(value, default=lambda other: other.tolist(), ensure_ascii=False)


def _steps(key: str) -> list[str | int]:
    """The names and indices in a key: ["environment", "obstacles", 0] for environment.obstacles[0]."""
    return [name or int(index) for name, index in _STEP.findall(key)]


def _at(document: Any, key: str) -> Any:
    for step in _steps(key):
        document = document[step]
    return document


def _put(document: Any, key: str, value: object) -> None:
    """Puts a value into a document. Groups above it that are not there are made."""
    *above, last = _steps(key)
    for step in above:
        if isinstance(step, str) and not isinstance(document.get(step), (dict, list)):
            document[step] = {}
        document = document[step]
    document[last] = value


def _is_group(value: object) -> bool:
    return isinstance(value, Mapping) or (isinstance(value, (list, tuple)) and any(map(_is_group, value)))


def _keys(key: str, value: object) -> list[str]:
    """The keys of all values in a group."""
    if isinstance(value, Mapping):
        return [below for name, of in value.items() for below in _keys(f"{key}.{name}", of)]
    if _is_group(value) and isinstance(value, (list, tuple)):
        return [below for i, of in enumerate(value) for below in _keys(f"{key}[{i}]", of)]
    return [key]


def _parsed(document: Mapping[str, Any], folder: Path, leaves_out_inapplicable: bool) -> _CoreProblem:
    """The problem of a document. Its errors have no lines, which nobody has seen."""
    try:
        return _core.parse_problem(_yaml(document), os.path.join(folder, "<dict>"), leaves_out_inapplicable)
    except ProblemError as error:
        raise _without_lines(error) from None


def _without_lines(error: ProblemError) -> ProblemError:
    """The error of a document, which has lines for nobody."""
    rows = [
        LocatedError(None, None, None, each.message) if (each.file or "").endswith("<dict>") else each
        for each in error.errors
    ]
    return ProblemError("\n".join(map(str, rows)), rows)


class Problem:
    """A motion planning problem for an aerial manipulator: robot, scene, start, goals and planner settings.

    It is one in a vertical plane or, where its bounds have `y_m`, one in space.

    A problem is checked when it is made and never changes; `replace` makes another one. `problem[key]` is the value of
    a key of problem files, in the units of the file, also within lists: `problem["environment.obstacles[0].name"]`.
    """

    def __init__(self, core: _CoreProblem) -> None:
        self._core = core
        self._document: dict[str, Any] | None = None

    @classmethod
    @checked()
    def from_text(cls, text: str, folder: Path = "") -> Problem:
        """Reads the text of a problem file. Paths in it are relative to `folder`; messages call it `<text>`."""
        return cls(_core.parse_problem(text, os.path.join(folder, "<text>"), False))

    @classmethod
    @checked()
    def from_dict(cls, document: Mapping[str, Any], folder: Path = "") -> Problem:
        """Makes a problem from what a problem file holds, as dicts and lists. Errors name keys and no lines."""
        return cls(_parsed(document, folder, False))

    @checked()
    def replace(self, changes: Mapping[str, object]) -> Problem:
        """The same problem with other values: `problem.replace({"planner.seed": 3, "start.x_m": -4})`.

        A key of one value keeps everything else. A dict, or a list of dicts, takes the place of a whole group, in which
        keys that are left out get their defaults, and keys elsewhere that have no meaning beside it are left out:
        `problem.replace({"uncertainty": {"wind": {"gust_m_s": {"sd": 0.5}}}})`.
        Raises ProblemError if a change is none, or the changed problem cannot be planned.
        """
        groups = {key: value for key, value in changes.items() if _is_group(value) or self._is_group_now(key)}
        base = self._with_groups(groups) if groups else self
        values = [(key, _yaml(value)) for key, value in changes.items() if key not in groups]
        try:
            return Problem(base._core.changed(values))
        except ProblemError:
            raise
        except InputError as error:
            raise ProblemError(str(error), error.errors) from None

    def _with_groups(self, groups: Mapping[str, object]) -> Problem:
        """The problem with other groups. Keys elsewhere that have no meaning beside them are left out."""
        document = self.to_dict()
        for key, value in groups.items():
            try:
                _put(document, key, value)
            except (AttributeError, IndexError, KeyError, TypeError):
                raise ProblemError(f"{key} is no key of this problem as it is") from None
        changed = Problem(_parsed(document, "", True))
        lost = [each for key, value in groups.items() for each in _keys(key, value) if not changed._has(each)]
        if lost:
            raise ProblemError("\n".join(f"{key} has no meaning in this problem: remove it" for key in lost))
        return changed

    def __getitem__(self, key: str) -> Any:
        if self._document is None:
            self._document = self.to_dict()
        try:
            return copy.deepcopy(_at(self._document, key))
        except (IndexError, KeyError, TypeError):
            raise KeyError(f"{key} is no key of this problem; docs/keys.md lists the keys of problem files") from None

    def _has(self, key: str) -> bool:
        try:
            self[key]
        except KeyError:
            return False
        return True

    def _is_group_now(self, key: str) -> bool:
        return self._has(key) and _is_group(self[key])

    def to_dict(self, folder: Path = ".") -> dict[str, Any]:
        """Everything that a problem file holds, with all defaults filled in and the robot inline.

        Paths of files are relative to `folder`. `Problem.from_dict` makes the same problem of it, up to the rounding of
        angles; `to_yaml` is exact.
        """
        document: dict[str, Any] = json.loads(self._core.json(os.fspath(folder)))
        return document

    def to_yaml(self, folder: Path = ".") -> str:
        """The same as the text of a problem file that stands in `folder`: effective.yaml."""
        return self._core.yaml(os.fspath(folder))

    @property
    def name(self) -> str:
        """The problem's name."""
        return self._core.name

    @property
    def file(self) -> str:
        """Where it was read from; `<text>` or `<dict>` if from none, or after a group of keys was replaced."""
        return self._core.file

    @property
    def is_in_space(self) -> bool:
        """Whether the vehicle flies in space, not in a vertical plane."""
        return isinstance(self._core, _core.SpaceProblem)

    @property
    def joints(self) -> tuple[str, ...]:
        """Names of the arm's joints: with `_rad` they are columns of plans and flights."""
        return tuple(self._core.joints)

    @property
    def rotors(self) -> int:
        """How many rotors the robot has."""
        return self._core.rotors

    @property
    def sha256(self) -> str:
        """A digest of everything that makes up the problem, as 64 hexadecimal digits."""
        return self._core.sha256()

    @property
    def warnings(self) -> tuple[LocatedError, ...]:
        """What can be planned but is likely not meant."""
        return tuple(LocatedError(*each) for each in self._core.warnings)

    @property
    def outdated(self) -> tuple[LocatedError, ...]:
        """Keys that the file calls by a former name."""
        return tuple(LocatedError(*each) for each in self._core.outdated)

    def __repr__(self) -> str:
        return f"<downwash.Problem {self.name} from {self.file}>"


def in_plane(problem: Problem, what: str) -> _core.Problem:
    """The core of a problem in a vertical plane. Raises InputError for one in space, which `what` does not take."""
    if isinstance(problem._core, _core.SpaceProblem):
        raise InputError(
            f"problem: {problem.file}: environment.bounds.y_m makes this a problem in space, and {what} takes problems "
            "in a vertical plane"
        )
    return problem._core


def read_problem(file: Path) -> Problem:
    """Reads a problem file and the robot that it refers to. Raises ProblemError with the place of every error."""
    return Problem(_core.read_problem(os.fspath(file)))


@checked()
def explain(key: str) -> str:
    """What a key of problem files means, which values it takes, and its default."""
    known = _core.explained(key)
    return f"{known['description']}: {known['expected']}; default {known['default']}"
