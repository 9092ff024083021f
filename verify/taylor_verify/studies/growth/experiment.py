"""The whole chain, from a question to the growth of each of its errors."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import sqrt
from pathlib import Path
from typing import Any

import numpy as np

from taylor_verify.records.json_text import finite
from taylor_verify.studies.growth.course import Course, Finished, course
from taylor_verify.studies.growth.document import Ensemble, GrowthGate, GrowthOfQuantity
from taylor_verify.studies.growth.errors import Floats, Measured, lane_errors
from taylor_verify.studies.growth.fit import Gate, Growth, growth
from taylor_verify.studies.growth.question import Question


@dataclass(frozen=True)
class Found:
    """One quantity of an ensemble: its signed errors (lanes, instants), and how they grow."""

    quantity: str
    errors: Floats
    growth: Growth


@dataclass(frozen=True)
class Experiment:
    """An answered question; ``steps`` is the mean over the lanes at every instant."""

    course: Course
    steps: tuple[float, ...]
    found: tuple[Found, ...]

    @property
    def lost(self) -> int:
        """How many lanes did not come to the end."""
        return sum(not lane.goes_on for lane in self.course.lanes)

    def ensemble(self, why: str = "") -> Ensemble:
        """Return the ensemble as it is stored; ``why`` says what it is measured for."""
        question = self.course.question
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
            quantities=tuple(map(self._quantity, self.found)),
            why=why,
        )

    def _quantity(self, one: Found) -> GrowthOfQuantity:
        u = float(self.course.question.rung.unit_roundoff)
        grown, exponent = one.growth, one.growth.exponent
        return GrowthOfQuantity(
            quantity=one.quantity,
            rms=_finite(*grown.rms),
            # Of a walk whose every step is one roundoff.
            in_walks=finite(grown.rms[-1] / (u * sqrt(self.steps[-1]))) if self.steps[-1] else None,
            exponent=finite(exponent.value),
            low=finite(exponent.low),
            high=finite(exponent.high),
            level=exponent.level,
            lanes=exponent.lanes,
            word=exponent.word,
            late=_finite(grown.late.value, grown.late.low, grown.late.high),
            late_word=grown.late.word,
            gate=_gate(grown.gate) if grown.gate else None,
        )


def experiment(
    question: Question, file: Path | None = None, finished: Finished = lambda done, all_: None
) -> Experiment:
    """Follow the ensemble and judge it; ``file`` is where its checkpoint is kept."""
    return judged(course(question, file, finished))


def judged(followed: Course) -> Experiment:
    question = followed.question
    by_lane = [
        lane_errors(problem, [_state(row[i]) for row in followed.samples], question.period)
        for i, problem in enumerate(question.problems)
    ]
    u = float(question.rung.unit_roundoff)
    times = np.array(question.counts)
    names = dict.fromkeys(one.quantity for lane in by_lane for one in lane)
    found = []
    for name in names:
        kind, errors = _gathered(name, by_lane, len(times))
        found.append(Found(name, errors, growth(times, errors, kind.law, u, kind.signed)))
    return Experiment(followed, _mean_steps(followed), tuple(found))


def _gathered(
    name: str, by_lane: Sequence[Sequence[Measured]], instants: int
) -> tuple[Measured, Floats]:
    """One quantity of all lanes; a lane that does not have it has no number for it."""
    each = [next((one for one in lane if one.quantity == name), None) for lane in by_lane]
    rows = [np.full(instants, np.nan) if one is None else one.values for one in each]
    return next(one for one in each if one is not None), np.array(rows)


def _state(sample: Any) -> Any:
    return None if sample is None else sample[0]


def _mean_steps(followed: Course) -> tuple[float, ...]:
    counted = [[sample[1] for sample in row if sample is not None] for row in followed.samples]
    return tuple(float(np.mean(row)) if row else 0.0 for row in counted)


def _finite(*values: float) -> tuple[Any, ...]:
    """Return the numbers; None for each that is not finite."""
    return tuple(map(finite, values))


def _gate(found: Gate) -> GrowthGate:
    return GrowthGate(
        verdict=found.verdict,
        law=found.law.value,
        chance=finite(found.chance),
        false_alarm=found.false_alarm,
        because=found.because,
    )
