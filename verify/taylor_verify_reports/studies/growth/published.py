"""Published ensembles, and the long one."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from taylor_verify.judge.provenance import command, processor, versions
from taylor_verify.numbers.precision import rung
from taylor_verify.records.provenance import Provenance
from taylor_verify.scenes.reading.reader import load
from taylor_verify.solvers.registry import TAYLOR
from taylor_verify.solvers.taylor.numbers import unavailable
from taylor_verify_reports.studies.growth.document import Ensemble, GrowthStudy
from taylor_verify_reports.studies.growth.experiment import Finished, experiment
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
