"""Experiment: an ensemble of starts followed piece by piece, and the growth of each of its errors."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import sqrt
from pathlib import Path

import numpy as np

from taylor_verify.judge.provenance import versions
from taylor_verify.records.json_text import complete, converted
from taylor_verify.solvers.taylor.ensemble import Ensemble as Lanes
from taylor_verify_reports.studies.growth import checkpoint
from taylor_verify_reports.studies.growth.checkpoint import Progress
from taylor_verify_reports.studies.growth.document import Ensemble, GrowthOfQuantity
from taylor_verify_reports.studies.growth.errors import lane_errors
from taylor_verify_reports.studies.growth.fit import Floats, Growth, growth
from taylor_verify_reports.studies.growth.question import Question

# The packages that the numbers of an experiment depend on.
_NUMERICAL = ("taylor-verify", "heyoka", "numpy")

# A function that is called after each piece with the number of finished pieces and of all pieces.
Finished = Callable[[int, int], None]


@dataclass(frozen=True)
class QuantityGrowth:
    """A quantity of an ensemble: its errors, an array (lanes, instants), and their growth."""

    quantity: str
    errors: Floats
    growth: Growth


@dataclass(frozen=True)
class Experiment:
    """An answered question.

    ``lost`` is the number of lanes that did not reach the end. ``steps`` are the steps up to each instant,
    a mean over the lanes that reached it.
    """

    question: Question
    lost: int
    steps: tuple[float, ...]
    quantities: tuple[QuantityGrowth, ...]

    def ensemble(self, why: str = "") -> Ensemble:
        """Return the ensemble in its stored form; ``why`` is the reason to measure it."""
        question = self.question
        return Ensemble(
            scene=question.scene.name,
            digest=question.scene.digest,
            solver=question.solver,
            rung=question.rung.name,
            periods=question.counts[-1],
            lanes=question.lanes,
            seed=question.seed,
            period=question.period,
            lost=self.lost,
            counts=question.counts,
            steps=self.steps,
            quantities=tuple(map(self._quantity, self.quantities)),
            why=why,
        )

    def _quantity(self, measured: QuantityGrowth) -> GrowthOfQuantity:
        """Return a quantity in its stored form, in which None stands for a number that is not finite."""
        u, grown = float(self.question.rung.unit_roundoff), measured.growth
        late = grown.late
        row = {
            **complete(grown.exponent),
            "quantity": measured.quantity,
            "rms": grown.rms,
            # Relative to a walk whose steps are single roundoffs.
            "in_walks": grown.rms[-1] / (u * sqrt(self.steps[-1])) if self.steps[-1] else None,
            "exponent": grown.exponent.value,
            "late": (late.value, late.low, late.high),
            "late_word": late.word,
            "gate": grown.gate,
        }
        return converted(complete(row), GrowthOfQuantity)


def course(
    question: Question, file: Path | None = None, finished: Finished = lambda done, total: None
) -> Progress:
    """Follow all lanes of a question to the end, from the checkpoint in ``file`` if there is one.

    The result is the same to the last bit, however often the run was stopped and continued. Raises
    ValueError for a checkpoint of another question, and OSError if a checkpoint cannot be written.
    """
    asked, made_with = question.document(), numerical_versions()
    ensemble = Lanes(question.problems, question.tolerance)
    progress = checkpoint.read(file, asked, made_with) if file else None
    progress = progress or Progress(0, ensemble.start())
    for until, is_instant in question.pieces[progress.pieces :]:
        lanes = ensemble.advance(progress.lanes, until)
        samples = progress.samples
        if is_instant:
            samples += (
                tuple((lane.state, lane.steps) if lane.goes_on else None for lane in lanes),
            )
        progress = Progress(progress.pieces + 1, lanes, samples)
        if file:
            checkpoint.write(file, asked, made_with, progress)
        finished(progress.pieces, len(question.pieces))
    return progress


def numerical_versions() -> dict[str, str]:
    """Return the versions of the packages that the numbers of an experiment depend on."""
    return {name: versions()[name] for name in _NUMERICAL}


def experiment(
    question: Question, file: Path | None = None, finished: Finished = lambda done, total: None
) -> Experiment:
    """Follow an ensemble and measure the growth of its errors; ``file`` is its checkpoint.

    Raises the errors of `course`.
    """
    end = course(question, file, finished)
    by_lane = [
        lane_errors(problem, [sample and sample[0] for sample in samples], question.period)
        for problem, *samples in zip(question.problems, *end.samples, strict=True)
    ]
    u, times = float(question.rung.unit_roundoff), np.array(question.counts)
    grown = []
    for name, kind in {
        measured.quantity: measured for lane in by_lane for measured in lane
    }.items():
        # A lane without the quantity has NaN.
        rows = [{measured.quantity: measured.values for measured in lane} for lane in by_lane]
        errors = np.array([row.get(name, np.full(len(times), np.nan)) for row in rows])
        grown.append(QuantityGrowth(name, errors, growth(times, errors, kind.law, u, kind.signed)))
    counts = [[sample[1] for sample in row if sample is not None] for row in end.samples]
    steps = tuple(float(np.mean(row)) if row else 0.0 for row in counts)
    lost = sum(not lane.goes_on for lane in end.lanes)
    return Experiment(question, lost, steps, tuple(grown))
