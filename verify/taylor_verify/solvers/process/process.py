"""A solver that is a program of one's own, in any language: `--solver "process:./my_simulator"`.

The program is asked and answers as protocol.py says. It is stopped when its time is up
or when it says more than any answer needs; whatever it does, the run ends with an outcome. With it
end all the processes it started, also those that left its session: supervisor.py stands
between, and does so even if this process is killed. Where the system cannot do that (Linux can), a
process that left the session goes on, and the detail of the outcome says that it may.
"""

from __future__ import annotations

import json
import os
import shlex
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from math import inf
from time import perf_counter
from typing import Final, final

from taylor_verify.models.problem import Problem
from taylor_verify.scenes.precision import Rung
from taylor_verify.solvers.process import protocol
from taylor_verify.solvers.process.conversation import LIMIT_VARIABLE, converse
from taylor_verify.solvers.solver import Callback, Solver
from taylor_verify.solvers.trajectory import Outcome, Trajectory

PREFIX: Final = "process:"
_MANY: Final = "many"
# Seconds for one scene: a hundred times what rk4.py takes for any shipped one at a step of 0.02.
DEFAULT_LIMIT: Final = 300.0

# A step of any method is many operations, and no processor does one in a tenth of a nanosecond. To
# claim more steps than that is false, and would widen the bound of the judge.
_STEPS_PER_SECOND = 1e10


@final
@dataclass(frozen=True)
class Process(Solver):
    """The program behind ``process:COMMAND``; COMMAND is split as a shell would, and no shell runs.

    It may take ``time_limit`` seconds for a problem, its start included, and runs in ``folder``: in the
    working folder of this process unless one is given.
    """

    name: str
    time_limit: float = DEFAULT_LIMIT
    folder: str | None = None
    setting: str = ""

    @property
    def command(self) -> list[str]:
        return shlex.split(self.name.removeprefix(PREFIX))

    def unavailable(self, rung: Rung) -> str:
        del rung
        return unavailable()

    def solve(self, problem: Problem) -> Trajectory:
        asked = json.dumps(protocol.question(problem)).encode()
        began = perf_counter()
        longest = protocol.longest_answer(problem)
        ended = converse(self.command, asked, self.time_limit, longest, self.folder)
        seconds = perf_counter() - began
        if ended.outcome is not Outcome.FINISHED:
            return Trajectory(ended.outcome, detail=ended.detail(), seconds=seconds)
        try:
            found = _trajectory(ended.answer, problem, ended.seconds)
            return replace(found, detail="; ".join(filter(None, (found.detail, ended.left))))
        except protocol.Unsuited as reason:
            return Trajectory(Outcome.UNSUITED, detail=str(reason), seconds=seconds)
        except protocol.Misanswer as fault:
            outcome, what = Outcome.MISANSWERED, str(fault)
        except protocol.NotFinite as fault:
            outcome, what = Outcome.NON_FINITE, str(fault)
        detail = replace(ended, what=what).detail()
        return Trajectory(outcome, detail=detail, seconds=seconds)


def together(
    words: Sequence[str],
    asked: Sequence[tuple[Sequence[str], Problem]],
    limit: float,
    folder: str | None = None,
) -> list[Trajectory | None]:
    """Return what one process of the command answers to many questions, each with its settings.

    The command knows the argument `many` (solvers/outside/question.py). None stands where it gave no sound
    answer, and for all that came after: these questions have to be asked alone. ``limit`` is for all.
    """
    lines = [
        json.dumps({"settings": [*settings], "question": protocol.question(problem)})
        for settings, problem in asked
    ]
    longest = sum(protocol.longest_answer(problem) for _, problem in asked)
    text = "".join(f"{line}\n" for line in lines).encode()
    ended = converse([*words, _MANY], text, limit, longest, folder)
    # What stands behind the last end of a line is no whole answer.
    answers = [] if ended.left else ended.answer.split(b"\n")[:-1]
    found: list[Trajectory | None] = [None] * len(asked)
    for place, (answer, (_, problem)) in enumerate(zip(answers, asked, strict=False)):
        with suppress(protocol.Misanswer, protocol.NotFinite, protocol.Unsuited):
            found[place] = _trajectory(answer, problem, ended.seconds)
    return found


def unavailable() -> str:
    """Return the reason why this system can run no program of a user; empty where it can."""
    if hasattr(os, "posix_spawnp"):
        return ""
    return (
        "programs are run on Linux and macOS alone: elsewhere nothing ends the processes they start"
    )


def program(words: Sequence[str], limit: float, folder: str | None = None) -> Process:
    """Return the solver that is this command, word by word, in this folder."""
    return Process(f"{PREFIX}{shlex.join(words)}", limit, folder)


def named(name: str) -> Process:
    """Return the solver `process:COMMAND`, its time limit from the environment variable if that is set.

    Raises ValueError for a command that is empty or not closed, and for a limit that is no number.
    """
    try:
        command = shlex.split(name.removeprefix(PREFIX))
    except ValueError as error:
        raise ValueError(
            f"expected a command as a shell reads it, got {name!r} ({error})"
        ) from None
    if not command:
        raise ValueError(f"expected a command after {PREFIX}, got none")
    return Process(name, time_limit())


def time_limit() -> float:
    """Return the seconds for a problem that the environment sets; ValueError where it is no number."""
    text = os.environ.get(LIMIT_VARIABLE)
    if text is None or not text.strip():
        return DEFAULT_LIMIT
    with suppress(ValueError):
        if 0 < float(text) < inf:
            return float(text)
    raise ValueError(f"expected a positive number of seconds, got {text!r} @ {LIMIT_VARIABLE}")


def _trajectory(answer: bytes, problem: Problem, waited: float) -> Trajectory:
    """Return the trajectory; ``waited`` are the seconds of the whole run, start and pipes included."""
    found = protocol.read(answer, problem)
    if not found.steps <= _STEPS_PER_SECOND * waited:
        raise protocol.Misanswer(f"{found.steps} steps in {waited:.3g} seconds @ steps")
    seconds = waited if found.seconds is None else found.seconds
    if not seconds + found.compile_seconds <= waited:
        claimed = f"{seconds:.3g} + {found.compile_seconds:.3g}"
        raise protocol.Misanswer(
            f"expected seconds + compile_seconds within the {waited:.3g} that the whole run took, "
            f"got {claimed} @ seconds"
        )
    # The rows are from here on those of any solver of one's own.
    trajectory = Callback(lambda _: found.states).solve(problem)
    return replace(
        trajectory,
        steps=found.steps,
        evaluations=found.evaluations,
        seconds=seconds,
        compile_seconds=found.compile_seconds,
        detail="; ".join(filter(None, (trajectory.detail, found.remark))),
    )
