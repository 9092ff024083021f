"""Experiment: an ensemble of starts followed piece by piece, and the growth of each of its errors."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import replace
from fractions import Fraction
from math import sqrt
from typing import NamedTuple

import numpy as np

from taylor_verify.judge.provenance import command, processor, versions
from taylor_verify.numbers.precision import rung
from taylor_verify.records.json_text import complete, converted
from taylor_verify.records.provenance import Provenance
from taylor_verify.scenes.reading.reader import load
from taylor_verify.solvers.registry import TAYLOR
from taylor_verify.solvers.taylor.ensemble import Ensemble as Lanes
from taylor_verify.solvers.taylor.ensemble import Lane
from taylor_verify.solvers.taylor.numbers import unavailable
from taylor_verify_reports.studies.growth.errors import Measured, lane_errors
from taylor_verify_reports.studies.growth.fit import growth
from taylor_verify_reports.studies.growth.grown import Ensemble, GrowthOfQuantity, GrowthStudy
from taylor_verify_reports.studies.growth.question import Question


def published() -> list[Question]:
    """Return the questions of the published ensembles."""
    axis, f64 = load("euler/about-max-axis"), rung("f64")
    coarse = f"{TAYLOR}?tol=1e-12"
    return [
        Question(axis, f64, 1e6, why="Brouwer's law over four decades"),
        # x87 has no batch mode: a lane takes a minute or two, and six are enough for an interval.
        Question(axis, rung("f80"), 1e6, lanes=6, why="the same with eleven bits more"),
        Question(
            load("euler/generic"),
            f64,
            1e6,
            why="moments 1, 2, 3, whose coefficients are rounded small fractions",
        ),
        Question(
            axis,
            f64,
            1e5,
            solver=coarse,
            why="a bias that is known: truncation at a coarse tolerance",
        ),
        Question(load("kirchhoff/two-real-roots"), f64, 1e5, why="a solid in a fluid"),
    ]


def long() -> list[Question]:
    """Return the question of the long ensemble."""
    axis = load("euler/about-max-axis")
    return [Question(axis, rung("f64"), 1e8, lanes=8, why="a hundred million periods")]


def followed(
    questions: Iterable[Question], finished: Finished, most: float | None = None
) -> GrowthStudy:
    """Follow the ensembles of the questions; those whose rung this machine lacks are named as left out.

    ``most`` is the most periods of an ensemble. Raises ValueError for too few periods.
    """
    runs: list[Ensemble] = []
    left_out: list[str] = []
    for question in questions:
        if missing := unavailable(question.rung):
            left_out.append(f"{question.label}: {missing}")
            continue
        asked = question if most is None else replace(question, periods=min(question.periods, most))
        runs.append(experiment(asked, finished))
    return GrowthStudy(tuple(runs), tuple(left_out), Provenance(versions(), processor(), command()))


# A function that is called after each piece with the ensemble, the pieces done, and their number.
Finished = Callable[[str, int, int], None]

# The state of one lane at one instant and its steps so far; None for a lane that ended before.
Sample = tuple[tuple[Fraction, ...], int] | None


class Course(NamedTuple):
    """The lanes at the end, and their samples: ``samples[k][i]`` is lane i at instant k."""

    lanes: tuple[Lane, ...]
    samples: tuple[tuple[Sample, ...], ...]


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
) -> Ensemble:
    """Follow an ensemble, and return the growth of its errors. Raises the errors of `course`."""
    end = course(question, finished)
    counts = [[sample[1] for sample in row if sample is not None] for row in end.samples]
    steps = tuple(float(np.mean(row)) if row else 0.0 for row in counts)
    return Ensemble(
        scene=question.scene.name,
        digest=question.scene.digest,
        solver=question.solver,
        rung=question.rung.name,
        periods=question.counts[-1],
        lanes=question.lanes,
        seed=question.seed,
        period=question.period,
        lost=sum(not lane.goes_on for lane in end.lanes),
        counts=question.counts,
        steps=steps,
        quantities=tuple(
            _grown(question, steps[-1], measured) for measured in ensemble_errors(question, end)
        ),
        why=question.why,
    )


def ensemble_errors(question: Question, end: Course) -> list[Measured]:
    """Return the errors of all lanes by quantity, each an array (lanes, instants)."""
    by_lane = [
        lane_errors(problem, [sample and sample[0] for sample in samples], question.period)
        for problem, *samples in zip(question.problems, *end.samples, strict=True)
    ]
    kinds = {measured.quantity: measured for lane in by_lane for measured in lane}
    rows = [{measured.quantity: measured.values for measured in lane} for lane in by_lane]
    # A lane without the quantity has NaN.
    nothing = np.full(len(question.counts), np.nan)
    return [
        replace(kind, values=np.array([row.get(name, nothing) for row in rows]))
        for name, kind in kinds.items()
    ]


def _grown(question: Question, steps: float, measured: Measured) -> GrowthOfQuantity:
    """Return the growth of a quantity; None stands for a number that is not finite."""
    u, times = float(question.rung.unit_roundoff), np.array(question.counts)
    grown = growth(times, measured.values, measured.law, u, measured.signed)
    exponent, late = grown.exponent, grown.late
    row = GrowthOfQuantity(
        quantity=measured.quantity,
        rms=grown.rms,
        # Relative to a walk whose steps are single roundoffs.
        in_walks=grown.rms[-1] / (u * sqrt(steps)) if steps else None,
        exponent=exponent.value,
        low=exponent.low,
        high=exponent.high,
        level=exponent.level,
        lanes=exponent.lanes,
        word=exponent.word,
        late=(late.value, late.low, late.high),
        late_word=late.word,
        gate=grown.gate,
    )
    return converted(complete(row), GrowthOfQuantity)
