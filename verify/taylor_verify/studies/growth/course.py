"""The ensemble on its way: piece by piece from instant to instant, with a checkpoint after each."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from taylor_verify.judge.provenance import versions
from taylor_verify.solvers.taylor.ensemble import Ensemble
from taylor_verify.studies.growth import checkpoint
from taylor_verify.studies.growth.checkpoint import Progress
from taylor_verify.studies.growth.question import Question

# What the numbers of a course depend on.
_NUMERICAL = ("taylor-verify", "heyoka", "numpy")

# Called after each piece with the number of pieces done, and of all.
Finished = Callable[[int, int], None]


def course(
    question: Question, file: Path | None = None, finished: Finished = lambda done, all_: None
) -> Progress:
    """Follow the question to its end, from the checkpoint in ``file`` where there is one.

    It ends the same to the last bit however often it was left and taken up. Raises ValueError for a
    checkpoint that is not this question's, and OSError where it cannot be written.
    """
    asked, made_with = question.document(), numerical_versions()
    ensemble = Ensemble(question.problems, question.tolerance)
    progress = checkpoint.read(file, asked, made_with) if file else None
    progress = progress or Progress(0, ensemble.start())
    for until, is_instant in question.pieces[progress.pieces :]:
        lanes = ensemble.advance(progress.lanes, until)
        samples = progress.samples
        if is_instant:
            samples += (tuple((one.state, one.steps) if one.goes_on else None for one in lanes),)
        progress = Progress(progress.pieces + 1, lanes, samples)
        if file:
            checkpoint.write(file, asked, made_with, progress)
        finished(progress.pieces, len(question.pieces))
    return progress


def numerical_versions() -> dict[str, str]:
    """Return the versions that the numbers of a course depend on."""
    return {name: versions()[name] for name in _NUMERICAL}
