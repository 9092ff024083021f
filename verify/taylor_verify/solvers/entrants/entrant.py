"""The integrators of other libraries: `outside:LIBRARY-METHOD?rtol=NUMBER&atol=NUMBER`.

Each library has a script in solvers/outside that answers by the protocol of a program of one's
own, and runs in an environment of its own with the versions that the script names. An environment is
made when an entrant is asked to solve, or by `prepare`: neither the standard run nor a list of what
there is makes one. The table that makes a script an entrant is in its metadata:

    [tool.taylor-verify]
    methods = ["adams", "bdf"]
    rungs = ["f64"]
    from-source = []                  optional: the requirements that have no wheels
"""

from __future__ import annotations

import logging
import shlex
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Final, final

from taylor_verify.models.problem import Problem
from taylor_verify.scenes.precision import Rung
from taylor_verify.solvers.entrants.environment import Environment, NotMade, Tell, metadata
from taylor_verify.solvers.options import options
from taylor_verify.solvers.process import process
from taylor_verify.solvers.solver import Lack, Solver
from taylor_verify.solvers.trajectory import Outcome, Trajectory

PREFIX: Final = "outside:"
SCRIPTS: Final = Path(__file__).parents[1] / "outside"
_TABLE: Final = "taylor-verify"
_RTOL: Final = "1e-9"

# What would be entered if it could be installed as the others are, and why it cannot.
_NUMBALSODA: Final = (
    "numbalsoda 0.3.4 has no wheels, and to build it takes a Fortran compiler: its LSODA and DOP853 "
    "are entered by CyRK, as outside:cyrk-lsoda and outside:cyrk-dop853"
)

_log = logging.getLogger(__name__)
# Environments that could not be made, with the reason: not tried again for every scene of a run.
_failed: dict[Path, str] = {}


@dataclass(frozen=True)
class Entrant:
    """One method of a library that may be asked: what it needs, and why it cannot be had.

    ``script`` is None where it cannot be installed at all. ``unavailable`` is empty where it is
    ready, or would be after a download.
    """

    library: str
    method: str
    requirements: tuple[str, ...]
    rungs: tuple[str, ...] = ("f64",)
    script: Path | None = None
    unavailable: str = ""

    @property
    def name(self) -> str:
        return f"{self.library}-{self.method}"

    @property
    def environment(self) -> Environment | None:
        if self.script is None:
            return None
        about = metadata(self.script)
        from_source = tuple(about.tools[_TABLE].get("from-source", ()))
        return Environment(self.library, about, from_source)


@cache
def entrants() -> tuple[Entrant, ...]:
    """All there are, by name, those that cannot be had included; no environment is made for it."""
    found = [one for script in sorted(SCRIPTS.glob("with_*.py")) for one in _of(script)]
    found += [
        Entrant("numbalsoda", method, ("numbalsoda==0.3.4",), unavailable=_NUMBALSODA)
        for method in ("dop853", "lsoda")
    ]
    return tuple(found)


def _of(script: Path) -> list[Entrant]:
    """The methods of one script, named for its library: with_cvode.py has cvode-adams, cvode-bdf."""
    about = metadata(script)
    table, library = about.tools[_TABLE], script.stem.removeprefix("with_")
    return [
        Entrant(
            library,
            method,
            about.requirements,
            tuple(table["rungs"]),
            script,
            unavailable=about.unfit(),
        )
        for method in table["methods"]
    ]


def prepare(name: str, tell: Tell = _log.warning) -> None:
    """Make the environment of an entrant, by `cvode-bdf` or a solver's whole name, if it is not there.

    ``tell`` hears what is being done: it may take minutes. Raises NotMade with the reason, and
    ValueError for a name that is none.
    """
    _prepare(named(name if name.startswith(PREFIX) else f"{PREFIX}{name}").entrant, tell)


def _prepare(entrant: Entrant, tell: Tell) -> Environment:
    environment = entrant.environment
    if environment is None:
        raise NotMade(entrant.unavailable)
    try:
        environment.make(tell)
    except NotMade as reason:
        command = shlex.join(["pip", "install", *entrant.requirements])
        sentence = f"its environment could not be made: {reason}; it takes: {command}"
        _failed[environment.folder] = Lack(sentence, Outcome.NO_PACKAGE)
        raise
    _failed.pop(environment.folder, None)
    return environment


@final
@dataclass(frozen=True)
class Outside(Solver):
    """An entrant at one pair of tolerances; atol counts in the scene's own units."""

    entrant: Entrant
    name: str
    rtol: float
    atol: float
    time_limit: float = process.DEFAULT_LIMIT
    setting: str = ""

    def unavailable(self, rung: Rung) -> str:
        if reason := self.entrant.unavailable or process.unavailable():
            return reason
        if rung.name not in self.entrant.rungs:
            return f"{self.name} is made for {' and '.join(self.entrant.rungs)} alone"
        environment = self.entrant.environment
        return _failed.get(environment.folder, "") if environment else ""

    def unsuited(self, problem: Problem) -> str:
        if problem.given.body.manufactured is not None:
            return f"{self.name} is made for constant loads, and not for a manufactured motion"
        return ""

    def solve(self, problem: Problem) -> Trajectory:
        if reason := self.unavailable(problem.rung):
            outcome = reason.outcome if isinstance(reason, Lack) else Outcome.NOT_STARTED
            return Trajectory(outcome, detail=str(reason))
        try:
            environment = _prepare(self.entrant, _log.warning)
        except NotMade:
            # Remembered, so that it is the reason of what is unavailable from here on.
            return self.solve(problem)
        command = shlex.join([*_interpreter(environment), *self._script_and_arguments()])
        return process.Process(f"{process.PREFIX}{command}", self.time_limit).solve(problem)

    def _script_and_arguments(self) -> list[str]:
        return [str(self.entrant.script), self.entrant.method, repr(self.rtol), repr(self.atol)]


def _interpreter(environment: Environment) -> list[str]:
    """Without what the user has set for another Python, and leaving no files beside the script."""
    return [str(environment.python), "-B", "-E", "-s"]


def named(name: str) -> Outside:
    """The entrant of that name at its tolerances; atol is rtol where it is not set.

    Raises ValueError for an entrant that there is not, and for tolerances that are not positive.
    """
    known: Mapping[str, Entrant] = {one.name: one for one in entrants()}
    asked = options(name, known, ["rtol", "atol"])
    rtol = asked.positive("rtol", _RTOL)
    atol = asked.positive("atol", asked.values.get("rtol", _RTOL))
    return Outside(known[asked.method], name, float(rtol), float(atol), process.time_limit())
