"""A chunk of a sweep: the scenes of some numbers, judged where a worker is, and their rows."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any, Final, NamedTuple

from taylor_verify.batch.bodies import judged
from taylor_verify.batch.failure import fault
from taylor_verify.batch.store import package_digest
from taylor_verify.batch.sweeps.questions import Question, Questions
from taylor_verify.records.status import Status
from taylor_verify.records.verdict import Verdict
from taylor_verify.run import run
from taylor_verify.scenes.reading.faults import Refused
from taylor_verify.scenes.scene import Scene
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
    solver: str
    rung: str

    def __str__(self) -> str:
        return f"{self.questions.name}#{self.first} to #{self.stop - 1}"


class Judged(NamedTuple):
    """The rows of a chunk, by columns, and a digest of the code that made them."""

    chunk: int
    scenes: int
    columns: Columns
    package: str


def judge(chunk: Chunk) -> Judged:
    """Solve and judge a chunk. A scene that breaks the code is an undecided row, and stops no other."""
    asked = list(chunk.questions.questions(chunk.first, chunk.stop))
    scenes = [each.scene for each in asked if isinstance(each.scene, Scene)]
    answers = iter(_verdicts(scenes, chunk.solver, chunk.rung))
    rows = [
        next(answers) if isinstance(question.scene, Scene) else [_refused(question, chunk)]
        for question in asked
    ]
    columns = _columns(asked, rows, chunk.questions.drawn)
    return Judged(chunk.number, len(asked), columns, package_digest())


def judge_alone(questions: Questions, points: Sequence[int], solver: str, rung: str) -> Columns:
    """Return the rows of the scenes with these numbers, each judged as `run` judges its file."""
    asked = [question for point in points for question in questions.questions(point, point + 1)]
    rows = [
        _alone(question.scene, solver, rung)
        for question in asked
        if isinstance(question.scene, Scene)
    ]
    return _columns(asked, rows, questions.drawn)


def _columns(
    asked: Sequence[Question], rows: Sequence[Sequence[Verdict]], drawn: Sequence[str]
) -> Columns:
    columns: Columns = {name: [] for name in (*COLUMNS, *(DRAWN + name for name in drawn))}
    for question, verdicts in zip(asked, rows, strict=True):
        for verdict in verdicts:
            for name, value in _row(question, verdict):
                columns[name].append(value)
        for name in drawn:
            columns[DRAWN + name] += [question.drawn.get(name)] * len(verdicts)
    return columns


def _alone(scene: Scene, solver: str, rung: str) -> list[Verdict]:
    try:
        return list(run(scene, solver, rung).verdicts)
    except Exception as error:
        return [_broken(scene, solver, rung, error)]


def _verdicts(scenes: Sequence[Scene], solver: str, rung: str) -> list[list[Verdict]]:
    """Return the verdicts of every scene; one by one where something broke."""
    try:
        return judged(scenes, solver, rung) if scenes else []
    except Exception as error:
        if len(scenes) == 1:
            return [[_broken(scenes[0], solver, rung, error)]]
        return [verdicts for scene in scenes for verdicts in _verdicts([scene], solver, rung)]


def _broken(scene: Scene, solver: str, rung: str, error: Exception) -> Verdict:
    from taylor_verify.records.reason import Cause, stated

    reason = stated(Cause.UNFINISHED, fault(error))
    outcome = Outcome.RAISED.value
    return Verdict(scene.name, solver, rung, "", SCENE, Status.UNDECIDED, outcome, reason=reason)


def _refused(question: Question, chunk: Chunk) -> Verdict:
    """Return the verdict on numbers that make no body."""
    from taylor_verify.records.reason import Cause, stated

    assert isinstance(question.scene, Refused)
    reason = stated(Cause.NOT_POSED, "; ".join(question.scene.faults))
    outcome, status = Outcome.NOT_REPRESENTABLE.value, Status.REFUSED
    return Verdict(
        question.name, chunk.solver, chunk.rung, "", SCENE, status, outcome, reason=reason
    )


def _row(question: Question, verdict: Verdict) -> Iterator[tuple[str, Any]]:
    for name in COLUMNS:
        match name:
            case "point":
                yield name, question.number
            case "verdict":
                yield name, verdict.verdict.value
            case "because":
                # The arithmetic of a bound that was kept would be most of the dataset.
                yield name, "" if verdict.verdict is Status.PASS else verdict.because
            case _:
                yield name, getattr(verdict, name)
