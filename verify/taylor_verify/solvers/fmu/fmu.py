"""A simulator in an FMU, as Modelica tools and Simulink export it: `fmu:PATH.fmu?step=NUMBER&KEY=NAMES`.

It is stepped by fmpy in a process of its own (runner.py), which speaks the protocol of `process:`; so
a crash, an endless step and a time limit end as they do there. What of the scene is set in the FMU and
what is read of it goes by names: those of the table in docs/formats.md, or those given here.

    step=0.01              the longest communication step; by default that of the FMU
    omega=w[1],w[2],w[3]   the FMU's variables of a quantity; one name of a vector stands for all
    fixed=inertia,moment   quantities that are built into the FMU and are not set
"""

from __future__ import annotations

import json
import re
import sys
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Final, final

from taylor_verify.models.problem import Problem
from taylor_verify.numbers.precision import Rung
from taylor_verify.solvers.options import options
from taylor_verify.solvers.process import process
from taylor_verify.solvers.solver import Lack, Solver, float64_alone, not_started, refused
from taylor_verify.solvers.trajectory import Outcome, Trajectory

PREFIX: Final = "fmu:"
_RUNNER: Final = Path(__file__).with_name("runner.py")
_SET: Final = (
    "inertia",
    "inverse_inertia",
    "moment",
    "rotor",
    "damping",
    "linear",
    "coupling",
    "angular",
    "force",
    "couple",
    "omega_start",
    "angular_momentum_start",
    "linear_impulse_start",
    "angular_impulse_start",
    "attitude_start",
    "centre_start",
)
_READ: Final = ("omega", "linear_impulse", "angular_impulse", "attitude", "centre")
_STEP, _FIXED = "step", "fixed"
_INSTALL: Final = "pip install 'taylor-verify[fmu]'"
# A comma in brackets is part of a name: I[1,2].
_COMMA: Final = re.compile(r",(?![^\[]*\])")


@final
@dataclass(frozen=True)
class Fmu(Solver):
    """The FMU in a file; ``settings`` is the JSON that runner.py is started with."""

    name: str
    file: Path
    settings: str
    time_limit: float = process.DEFAULT_LIMIT

    def unavailable(self, rung: Rung) -> str:
        if reason := float64_alone(self.name, rung):
            return reason
        if find_spec("fmpy") is None:
            return Lack(f"FMPy is not installed: {_INSTALL}", Outcome.NO_PACKAGE)
        return process.unavailable()

    def unsuited(self, problem: Problem) -> str:
        if reason := super().unsuited(problem):
            return reason
        if min(problem.given.clock.elapsed) < 0:
            return f"{self.name} steps forwards in time, and the scene runs backwards"
        return ""

    def solve(self, problem: Problem) -> Trajectory:
        if reason := self.unsuited(problem):
            return refused(reason)
        if reason := self.unavailable(problem.rung):
            return not_started(reason)
        with TemporaryDirectory(ignore_cleanup_errors=True) as folder:
            # Without the folder of the script in the path: modules in it have the names of libraries.
            runner = [sys.executable, "-P", str(_RUNNER)]
            command = [*runner, str(self.file), folder, self.settings]
            return process.program(command, self.time_limit).solve(problem)


def named(name: str) -> Fmu:
    """Return the solver of that name.

    Raises ValueError for a file that there is not, and for a key that means nothing.
    """
    path = name.removeprefix(PREFIX).partition("?")[0]
    if not Path(path).is_file():
        raise ValueError(f"expected an FMU, got no such file @ {path or PREFIX}")
    asked = options(name, [path], [_STEP, _FIXED, *_SET, *_READ])
    step = repr(float(asked.positive(_STEP, ""))) if _STEP in asked else None
    fixed = _names(asked.values.get(_FIXED, ""))
    if strange := [name for name in fixed if name not in _SET]:
        raise ValueError(f"expected a quantity ({', '.join(_SET)}), got {strange[0]!r} @ {_FIXED}")
    names = {key: _names(asked.values[key]) for key in (*_SET, *_READ) if key in asked}
    settings = {"step": step, "names": names, "fixed": fixed}
    return Fmu(name, Path(path), json.dumps(settings), process.time_limit())


def _names(text: str) -> list[str]:
    return [part.strip() for part in _COMMA.split(text) if part.strip()]
