"""The ensemble on its way: piece by piece from instant to instant, with a checkpoint after each."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from taylor_verify.judge.provenance import versions
from taylor_verify.solvers.taylor.ensemble import Ensemble, Lane
from taylor_verify.studies.growth import checkpoint
from taylor_verify.studies.growth.checkpoint import Progress, Sample
from taylor_verify.studies.growth.question import Question

# What the numbers of a course depend on.
_NUMERICAL = ("taylor-verify", "heyoka", "numpy")

# Told after each piece: how many of how many are done.
Finished = Callable[[int, int], None]


@dataclass(frozen=True)
class Course:
    """``samples[k][i]`` is lane i at instant k, in its problem's own units; ``lanes`` is where it ended."""

    question: Question
    lanes: tuple[Lane, ...]
    samples: tuple[tuple[Sample, ...], ...]


def course(
    question: Question, file: Path | None = None, finished: Finished = lambda done, all_: None
) -> Course:
    """Follow the question to its end, from the checkpoint in ``file`` where there is one.

    It ends the same to the last bit however often it was left and taken up. Raises ValueError for a
    checkpoint that is not this question's, and OSError where it cannot be written.
    """
    asked, made_with = question.document(), numerical_versions()
    found = checkpoint.read(file, asked, made_with) if file else None
    ensemble = Ensemble(question.problems, question.tolerance)
    progress = found or Progress(0, ensemble.start())
    pieces = question.pieces
    for k in range(progress.pieces, len(pieces)):
        progress = _next(ensemble, question, progress)
        if file:
            checkpoint.write(file, asked, made_with, progress)
        finished(k + 1, len(pieces))
    return Course(question, progress.lanes, progress.samples)


def numerical_versions() -> dict[str, str]:
    return {name: version for name, version in versions().items() if name in _NUMERICAL}


def _next(ensemble: Ensemble, question: Question, progress: Progress) -> Progress:
    until, is_instant = question.pieces[progress.pieces]
    lanes = ensemble.advance(progress.lanes, until)
    samples = progress.samples
    if is_instant:
        samples += (tuple((one.state, one.steps) if one.goes_on else None for one in lanes),)
    return Progress(progress.pieces + 1, lanes, samples)
