"""A user's program in any language as a solver: `--solver "process:./my_simulator"`.

Question and answer follow protocol.py. The program is stopped when its time is up or when its output is
longer than any answer. So every run ends with an outcome. All processes of the program's session end with
it.
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
from taylor_verify.numbers.precision import Rung
from taylor_verify.solvers.callback import of_states
from taylor_verify.solvers.process import protocol
from taylor_verify.solvers.process.conversation import LIMIT_VARIABLE, converse
from taylor_verify.solvers.solver import Solver
from taylor_verify.solvers.trajectory import Outcome, Trajectory

PREFIX: Final = "process:"
_MANY: Final = "many"
# Seconds for one scene: a hundred times what solvers/outside/rk4.py takes for a shipped one, step 0.02.
DEFAULT_LIMIT: Final = 300.0

# A step of any method is many operations, and takes more than a tenth of a nanosecond. A claim of
# more steps is false, and would widen the bound of the judge.
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
    takes_loads = True

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
            return _trajectory(ended.answer, problem, ended.seconds)
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
    """Return the answers of one process of the command to many questions, each with its settings.

    The command must know the argument `many` (solvers/outside/question.py). None marks a question without a
    valid answer, and all questions after it; these have to be asked alone. ``limit`` is for all together.
    """
    lines = [
        json.dumps({"settings": [*settings], "question": protocol.question(problem)})
        for settings, problem in asked
    ]
    longest = sum(protocol.longest_answer(problem) for _, problem in asked)
    text = "".join(f"{line}\n" for line in lines).encode()
    ended = converse([*words, _MANY], text, limit, longest, folder)
    # Text after the last line end is not a complete answer.
    answers = ended.answer.split(b"\n")[:-1]
    trajectories: list[Trajectory | None] = [None] * len(asked)
    for place, (answer, (_, problem)) in enumerate(zip(answers, asked, strict=False)):
        with suppress(protocol.Misanswer, protocol.NotFinite, protocol.Unsuited):
            trajectories[place] = _trajectory(answer, problem, ended.seconds)
    return trajectories


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
    """Return the solver `process:COMMAND`, with the time limit of the environment variable if it is set.

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
    answered = protocol.read(answer, problem)
    if not answered.steps <= _STEPS_PER_SECOND * waited:
        raise protocol.Misanswer(f"{answered.steps} steps in {waited:.3g} seconds @ steps")
    seconds = waited if answered.seconds is None else answered.seconds
    if not seconds + answered.compile_seconds <= waited:
        claimed = f"{seconds:.3g} + {answered.compile_seconds:.3g}"
        raise protocol.Misanswer(
            f"expected seconds + compile_seconds within the {waited:.3g} that the whole run took, "
            f"got {claimed} @ seconds"
        )
    # From here on the rows are treated like those of a callback.
    trajectory = of_states(answered.states, problem)
    return replace(
        trajectory,
        steps=answered.steps,
        evaluations=answered.evaluations,
        seconds=seconds,
        compile_seconds=answered.compile_seconds,
        detail="; ".join(filter(None, (trajectory.detail, answered.remark))),
    )
