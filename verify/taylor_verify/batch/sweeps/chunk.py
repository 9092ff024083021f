"""A chunk of a sweep: the scenes of some numbers, judged where a worker is, and their rows."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Final, NamedTuple

from taylor_verify.batch.failure import failing, fault
from taylor_verify.batch.finished_jobs import package_digest
from taylor_verify.batch.sweeps.questions import Question, Questions
from taylor_verify.chain import judge_scene
from taylor_verify.judge.tolerances import Tolerances
from taylor_verify.records.faults import Refused
from taylor_verify.records.reason import Cause, Reason, stated
from taylor_verify.records.status import Status
from taylor_verify.records.verdict import Verdict
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.registry import as_solver
from taylor_verify.solvers.solver import Solver
from taylor_verify.solvers.trajectory import Outcome

# Of a scene that no solver was asked.
SCENE: Final = "scene"
# The columns of a dataset, and what pyarrow calls their types. Drawn numbers follow, as doubles.
COLUMNS: Final = {
    "point": "int64",
    **dict.fromkeys(("scene", "quantity", "verdict", "outcome"), "string"),
    **dict.fromkeys(("max", "mean", "final", "at", "bound", "attainable", "ratio"), "float64"),
    **dict.fromkeys(("ratio_at", "time_shift", "roundoff"), "float64"),
    **dict.fromkeys(("steps", "evaluations"), "int64"),
    **dict.fromkeys(("unit", "because"), "string"),
}
DRAWN: Final = "drawn."
Columns = dict[str, list[Any]]


@dataclass(frozen=True)
class Chunk:
    """The scenes with numbers from ``first`` to before ``stop``; ``number`` is that of their part."""

    number: int
    first: int
    stop: int
    questions: Questions
    solver: Solver | str
    rung: str
    tolerances: Tolerances

    def __str__(self) -> str:
        return f"{self.questions.name}#{self.first} to #{self.stop - 1}"


class Judged(NamedTuple):
    """The rows of a chunk, by columns, and a digest of the code that made them."""

    chunk: int
    scenes: int
    columns: Columns
    package: str


def judge(chunk: Chunk) -> Judged:
    """Solve and judge a chunk. A scene that breaks the code is an undecided row, and stops no other.

    Raises Failed where there is no solver of that name, such as a module that a worker lacks.
    """
    with failing(f"{chunk}, where it is judged", ValueError):
        as_solver(chunk.solver)
    asked = chunk.questions.questions(chunk.first, chunk.stop)
    rows = [_row(question, verdict) for question in asked for verdict in _verdicts(question, chunk)]
    names = (*COLUMNS, *(DRAWN + name for name in chunk.questions.drawn))
    columns = {name: [row[name] for row in rows] for name in names}
    return Judged(chunk.number, chunk.stop - chunk.first, columns, package_digest())


def explain(chunk: Chunk) -> tuple[int, tuple[str, ...]]:
    """Return the number of the one scene of a chunk, and the likely causes of its failures in words."""
    (question,) = chunk.questions.questions(chunk.first, chunk.stop)
    assert isinstance(question.scene, Scene)
    try:
        judged = judge_scene(question.scene, chunk.solver, chunk.rung, chunk.tolerances)
    except Exception:
        # Its row is undecided, and says what broke.
        return chunk.first, ()
    return chunk.first, tuple(cause.sentence for cause in judged.causes)


def _verdicts(question: Question, chunk: Chunk) -> Sequence[Verdict]:
    """Return the verdicts on a scene, without the causes of failures: a dataset has no place for them."""
    if isinstance(question.scene, Refused):
        reason = stated(Cause.NOT_POSED, "; ".join(question.scene.faults))
        return [_unjudged(question, chunk, Status.REFUSED, Outcome.NOT_REPRESENTABLE, reason)]
    try:
        return judge_scene(
            question.scene, chunk.solver, chunk.rung, chunk.tolerances, causes=False
        ).verdicts
    except Exception as error:
        reason = stated(Cause.UNFINISHED, fault(error))
        return [_unjudged(question, chunk, Status.UNDECIDED, Outcome.RAISED, reason)]


def _unjudged(
    question: Question, chunk: Chunk, status: Status, outcome: Outcome, reason: Reason
) -> Verdict:
    """Return the verdict on a scene as a whole."""
    solver = chunk.solver if isinstance(chunk.solver, str) else chunk.solver.name
    run_of = question.name, solver, chunk.rung, ""
    return Verdict(*run_of, SCENE, status, outcome.value, reason=reason)


def _row(question: Question, verdict: Verdict) -> dict[str, Any]:
    return {
        **vars(verdict),
        **{DRAWN + name: number for name, number in question.drawn.items()},
        "point": question.number,
        "verdict": verdict.verdict.value,
        # The arithmetic of a bound that was kept would be most of the dataset.
        "because": "" if verdict.verdict is Status.PASS else verdict.because,
    }
