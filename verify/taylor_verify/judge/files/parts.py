"""The judgement of a file whose groups of columns have rows of their own: each part by itself."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from taylor_verify.records.quantities import is_state
from taylor_verify.records.status import GRAVITY
from taylor_verify.records.verdict import Verdict
from taylor_verify.solvers.files.file import TrajectoryFile

if TYPE_CHECKING:
    from taylor_verify.judge.files.judgement import FileJudgement

# The judgement of a part, of a file that has these groups in other parts.
Judge = Callable[[TrajectoryFile, Sequence[str]], "FileJudgement"]


def in_parts(file: TrajectoryFile, judge: Judge) -> FileJudgement:
    """Judge each part of a file by itself; a state is judged in the part that has all of its rows."""
    parts = (replace(file, apart=()), *file.apart)
    every = [name for part in parts for name in part.groups]
    judged = [judge(part, every) for part in parts]
    first = judged[0]
    verdicts: dict[str, Verdict] = {}
    for verdict in (verdict for one in judged for verdict in one.verdicts):
        before = verdicts.get(verdict.quantity)
        if before is None or is_state(verdict.quantity) or _is_worse(verdict, before):
            verdicts[verdict.quantity] = verdict
    conventions = {c.sentence: c for one in judged for c in one.conventions}
    causes = {cause.sentence: cause for one in judged for cause in one.causes}
    return replace(
        first,
        file=file,
        verdicts=tuple(verdicts.values()),
        conventions=tuple(conventions.values()),
        causes=tuple(causes.values()),
        notes=tuple(dict.fromkeys(note for one in judged for note in one.notes)),
        missing_load=next((one.missing_load for one in judged if one.missing_load), ()),
    )


def _is_worse(verdict: Verdict, before: Verdict) -> bool:
    return GRAVITY.index(verdict.verdict) < GRAVITY.index(before.verdict)
