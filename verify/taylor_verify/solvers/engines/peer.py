"""A peer: an integrator of another library that answers many questions in one separate process.

It is an engine (`outside:NAME`) whose script stays running (`serves` in its metadata). It gets the same
equations as heyoka, as lines of + - * /, in the problem's own units, and compiles them once. So its times
do not include starting a process, compiling or reading questions, and can be measured alternately with
solvers in this process. Tolerances are in the problem's own units.
"""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from fractions import Fraction
from typing import Any, Final, final

from taylor_verify.models.problem import Problem
from taylor_verify.numbers.precision import Rung, hexadecimal
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.engines.engine import Outside, command_of
from taylor_verify.solvers.engines.session import Broken, end_sessions, session
from taylor_verify.solvers.solver import Lack, Solver, not_started, refused
from taylor_verify.solvers.straight_line import lines
from taylor_verify.solvers.trajectory import Outcome, Trajectory, of_rows

_FLOAT64: Final = "f64"


@final
@dataclass(frozen=True)
class Peer(Solver):
    """An engine that stays, with its settings; it has the name of the engine that is asked once."""

    engine: Outside
    name: str = field(init=False)
    setting: str = ""

    def __post_init__(self) -> None:
        object.__setattr__(self, "name", self.engine.name)

    def unavailable(self, rung: Rung) -> str:
        if rung.name != _FLOAT64:
            return f"{self.name} is asked on {_FLOAT64} alone"
        return self.engine.unavailable(rung)

    def problem(self, scene: Scene, rung: Rung) -> Problem:
        return self.engine.problem(scene, rung)

    def solve(self, problem: Problem) -> Trajectory:
        """Return the trajectory; its seconds are those of the processor, and compiling is apart."""
        if reason := self.unsuited(problem):
            return refused(reason)
        if reason := self.unavailable(problem.rung):
            return not_started(reason)
        command = command_of(self.engine)
        if isinstance(command, Lack):
            return not_started(command)
        try:
            answer = session(command).ask(self._request(problem), self.engine.time_limit)
            return self._trajectory(problem, answer)
        except Broken as end:
            # The next question begins anew.
            end_sessions(command)
            return Trajectory(end.outcome, detail=str(end))

    def seconds(self, problem: Problem, count: int) -> float | None:
        """Return the processor's seconds of a solve, the mean of so many; None where there is no answer."""
        command = command_of(self.engine)
        if isinstance(command, Lack):
            return None
        request = {**self._request(problem), "count": count}
        try:
            return float(session(command).ask(request, self.engine.time_limit)["seconds"])
        except (Broken, KeyError):
            end_sessions(command)
            return None

    def _request(self, problem: Problem) -> dict[str, Any]:
        settings: dict[str, float | str] = {}
        for key, value in self.engine.settings:
            settings[key] = value
            with suppress(ValueError):
                settings[key] = float(value)
        if method := self.engine.engine.method:
            settings["method"] = method
        return {"problem": document(problem), "settings": settings}

    def _trajectory(self, problem: Problem, answer: Mapping[str, Any]) -> Trajectory:
        if "fault" in answer:
            return Trajectory(Outcome.RAISED, detail=str(answer["fault"]))
        rows = [[float.fromhex(value) for value in row] for row in answer["states"]]
        rows = rows[len(rows) - len(problem.times) :]
        return of_rows(
            problem,
            rows,
            steps=answer["steps"],
            evaluations=answer["evaluations"],
            seconds=answer["seconds"],
            compile_seconds=answer["setup_seconds"],
        )


def document(problem: Problem) -> dict[str, Any]:
    """Return a problem as the service of a script reads it (solvers/outside/service.py)."""
    code, times = lines(problem.form), list(problem.times)
    if times[0] != 0:
        times.insert(0, Fraction(0))
    return {
        "lines": code.lines,
        "rates": code.rates,
        "constants": {name: float(value).hex() for name, value in code.constants.items()},
        "parameters": [hexadecimal(value) for value in problem.parameters],
        "state": [hexadecimal(value) for value in problem.initial_momenta],
        "instants": [hexadecimal(abs(t)) for t in times],
        "sign": -1.0 if times[-1] < 0 else 1.0,
    }
