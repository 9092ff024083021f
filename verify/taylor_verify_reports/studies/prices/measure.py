"""Measurement of the price of each option of a scene, as a multiple of the simplest form of its model.

A price is the processor time of a step, or of a unit of the scene's time, over that of the simplest form of
the model in the same round. The integrator goes from the start to the end of a stretch of time, again and
again, without samples. The time of compiling is left out.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from itertools import chain, pairwise
from math import ceil, exp, log
from statistics import median
from time import process_time
from typing import Final

from taylor_verify.judge.provenance import command, processor, versions
from taylor_verify.models.problem import Problem
from taylor_verify.records.json_text import finite
from taylor_verify.records.provenance import SceneProvenance
from taylor_verify.scenes.precision import Rung
from taylor_verify.scenes.precision import rung as rung_named
from taylor_verify.solvers.taylor.driver import Taylor
from taylor_verify.solvers.taylor.names import at_tolerance
from taylor_verify.solvers.taylor.pace import Pace
from taylor_verify.tradeoff.accuracy import Truth
from taylor_verify.tradeoff.order_statistics import estimate
from taylor_verify_reports.studies.prices.document import (
    PriceAtEqualError,
    PriceMethod,
    PriceRow,
    PricesStudy,
)
from taylor_verify_reports.studies.prices.variants import Variant, variants
from taylor_verify_reports.studies.tradeoff.rounds import in_rounds

# Rounds by rung: the interval of the median needs six, and a wide rung takes long.
RUNGS: Final = {"f64": 31, "f80": 31, "f128": 9, "mp237": 7}
# Wide rungs have only these variants: omega and the impulses alone, with attitude, the whole state.
_ON_WIDE_RUNGS: Final = ("omega", "attitude", "impulse", "whole")
_WIDE: Final = ("f128", "mp237")
_SEED: Final = 1
# So long a measurement is not disturbed by the clock's resolution, a microsecond, or by an interrupt.
_LEAST_SECONDS: Final = 4e-3
# The stretch, in the problem's units of time: some hundreds of steps.
_SPAN: Final = Fraction(128)
_SPAN_ON_WIDE_RUNGS: Final = Fraction(8)
# Costs at the same achieved error are interpolated between tolerances, on f64.
_EQUAL_ERROR: Final = 1e-11
_ROUNDS_AT_EQUAL_ERROR: Final = 9
_TOLERANCES: Final = ("1e-7", "1e-9", "1e-11", "1e-13")


@dataclass
class _Bench:
    """A problem and a solver, ready to run; ``count`` runs of ``steps`` steps make one measurement.

    ``duration`` is that of the stretch in the scene's unit of time. ``taken`` has the seconds of a run in
    each round.
    """

    problem: Problem
    solver: Taylor
    pace: Pace
    duration: float
    steps: int
    count: int = 1
    taken: list[float] = field(default_factory=list)

    @classmethod
    def of(cls, variant: Variant, rung: Rung, solver: Taylor) -> _Bench:
        """Return the bench of a variant, with as many runs as a measurement needs."""
        problem = variant.posed(rung)
        span = _SPAN_ON_WIDE_RUNGS if rung.name in _WIDE else _SPAN
        pace = Pace(problem, span, solver.tolerance, variant.literals)
        # The first run counts the steps and fills caches, and is not timed.
        bench = cls(problem, solver, pace, float(span * problem.units.time), steps=pace.run())
        bench.count = max(1, ceil(_LEAST_SECONDS / max(bench.seconds(), 1e-6)))
        return bench

    def seconds(self) -> float:
        """Return the processor time of one run."""
        began = process_time()
        for _ in range(self.count):
            self.pace.run()
        return (process_time() - began) / self.count

    def error(self) -> float:
        """Return the largest relative error of omega or the impulses over the scene's samples."""
        accuracy = Truth(self.problem).accuracy(self.solver.solve(self.problem))
        return max(accuracy.max[name] for name in ("omega", "impulse") if name in accuracy.max)


def study(finished: Callable[[str], None] = lambda rung: None) -> PricesStudy:
    """Return every row of the published table; ``finished`` is called with each rung as it ends."""
    rows: list[PriceRow] = []
    for name, rounds in RUNGS.items():
        rows += _rows(rung_named(name), rounds)
        finished(name)
    return PricesStudy(
        rows=tuple(rows),
        equal=_at_equal_error(rung_named("f64")),
        method=PriceMethod(dict(RUNGS), _SEED, _LEAST_SECONDS, _EQUAL_ERROR),
        provenance=SceneProvenance(versions(), processor(), command()),
    )


def _rows(rung: Rung, rounds: int) -> list[PriceRow]:
    """Return the rows of a rung; an empty list if this machine does not have it."""
    if Taylor().unavailable(rung):
        return []
    is_wide = rung.name in _WIDE
    asked = [variant for variant in variants() if not is_wide or variant.name in _ON_WIDE_RUNGS]
    benches = {variant.name: _Bench.of(variant, rung, Taylor()) for variant in asked}
    _take([*benches.values()], rounds)
    return [
        _row(variant, rung, benches[variant.name], benches[variant.against]) for variant in asked
    ]


def _take(benches: Sequence[_Bench], rounds: int) -> None:
    """Time every bench once in each round."""
    seconds = in_rounds([bench.seconds for bench in benches], rounds, _SEED)
    for bench, taken in zip(benches, seconds, strict=True):
        bench.taken = taken


def _row(variant: Variant, rung: Rung, bench: _Bench, base: _Bench) -> PriceRow:
    form = bench.problem.form
    rounds = list(zip(bench.taken, base.taken, strict=True))
    return PriceRow(
        rung=rung.name,
        variant=variant.name,
        against=variant.against,
        what=variant.what,
        states=len(form.states),
        parameters=len(form.parameters),
        **form.operations(),
        order=bench.pace.order,
        steps_per_time=bench.steps / bench.duration,
        step_ratio=estimate(a / bench.steps / (b / base.steps) for a, b in rounds),
        time_ratio=estimate(a / bench.duration / (b / base.duration) for a, b in rounds),
        microseconds=1e6 * median(bench.taken) / bench.steps,
        error=finite(bench.error()),
    )


def _at_equal_error(rung: Rung) -> tuple[PriceAtEqualError, ...]:
    """Return the time of each variant over that of its unit, at one error between several tolerances."""
    asked = [variant for variant in variants() if not variant.literals]
    solvers = [at_tolerance(text) for text in _TOLERANCES]
    benches = {
        variant.name: [_Bench.of(variant, rung, solver) for solver in solvers] for variant in asked
    }
    _take([*chain.from_iterable(benches.values())], _ROUNDS_AT_EQUAL_ERROR)
    costs = {
        name: _cost_at_equal_error(
            [bench.error() for bench in own],
            [median(bench.taken) / bench.duration for bench in own],
        )
        for name, own in benches.items()
    }
    rows = []
    for variant in asked:
        own, base = costs[variant.name], costs[variant.against]
        ratio = None if own is None or base is None else own / base
        rows.append(PriceAtEqualError(variant.name, variant.against, ratio))
    return tuple(rows)


def _cost_at_equal_error(errors: Sequence[float], costs: Sequence[float]) -> float | None:
    """Return the cost at the error _EQUAL_ERROR; None if it is outside the range of the errors.

    Logarithms are interpolated linearly.
    """
    points = sorted(zip(errors, costs, strict=True), reverse=True)
    for (coarse, cheap), (fine, dear) in pairwise(points):
        if coarse >= _EQUAL_ERROR >= fine > 0 and coarse > fine:
            share = (log(coarse) - log(_EQUAL_ERROR)) / (log(coarse) - log(fine))
            return exp(log(cheap) + share * (log(dear) - log(cheap)))
    return None
