"""Experiment: an ensemble of starts followed piece by piece, and the growth of each of its errors."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from math import sqrt
from typing import NamedTuple

import numpy as np

from taylor_verify.records.json_text import complete, converted
from taylor_verify.solvers.taylor.ensemble import Ensemble as Lanes
from taylor_verify.solvers.taylor.ensemble import Lane
from taylor_verify_reports.studies.growth.document import Ensemble, GrowthOfQuantity
from taylor_verify_reports.studies.growth.errors import lane_errors
from taylor_verify_reports.studies.growth.fit import Floats, Growth, growth
from taylor_verify_reports.studies.growth.question import Question

# A function that is called after each piece with the ensemble, the pieces done, and their number.
Finished = Callable[[str, int, int], None]

# The state of one lane at one instant and its steps so far; None for a lane that ended before.
Sample = tuple[tuple[Fraction, ...], int] | None


class Course(NamedTuple):
    """The lanes at the end, and their samples: ``samples[k][i]`` is lane i at instant k."""

    lanes: tuple[Lane, ...]
    samples: tuple[tuple[Sample, ...], ...]


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

    def ensemble(self) -> Ensemble:
        """Return the ensemble in its stored form."""
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
            why=question.why,
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


def course(question: Question, finished: Finished = lambda label, done, total: None) -> Course:
    """Follow all lanes of a question to the end. Raises ValueError for lanes that do not fit together."""
    ensemble = Lanes(question.problems, question.tolerance)
    lanes, samples = ensemble.start(), list[tuple[Sample, ...]]()
    for done, (until, is_instant) in enumerate(question.pieces, start=1):
        lanes = ensemble.advance(lanes, until)
        if is_instant:
            states = ((lane.state, lane.steps) if lane.goes_on else None for lane in lanes)
            samples.append(tuple(states))
        finished(question.label, done, len(question.pieces))
    return Course(lanes, tuple(samples))


def experiment(
    question: Question, finished: Finished = lambda label, done, total: None
) -> Experiment:
    """Follow an ensemble and measure the growth of its errors. Raises the errors of `course`."""
    end = course(question, finished)
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
