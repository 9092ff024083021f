"""Measurement of the price of each option of a scene, as a multiple of the simplest form of its model.

A price is the processor time of a step, over that of the simplest form of the model in the same round. The
integrator goes from the start to the end of a stretch of time, again and again, without samples. The time
of compiling is left out.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from fractions import Fraction
from math import ceil
from time import process_time
from typing import Final

from taylor_verify.judge.provenance import command, processor, versions
from taylor_verify.models.form import Form
from taylor_verify.records.provenance import SceneProvenance
from taylor_verify.scenes.precision import Rung
from taylor_verify.scenes.precision import rung as rung_named
from taylor_verify.solvers.taylor.driver import Taylor
from taylor_verify.solvers.taylor.pace import Pace
from taylor_verify.tradeoff.order_statistics import estimate
from taylor_verify_reports.studies.prices.document import PriceMethod, PriceRow, PricesStudy
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


@dataclass
class _Bench:
    """A variant, ready to run; ``count`` runs of ``steps`` steps make one measurement.

    ``taken`` has the seconds of a run in each round.
    """

    form: Form
    pace: Pace
    steps: int
    count: int = 1
    taken: list[float] = field(default_factory=list)

    @classmethod
    def of(cls, variant: Variant, rung: Rung) -> _Bench:
        """Return the bench of a variant, with as many runs as a measurement needs."""
        problem = variant.posed(rung)
        span = _SPAN_ON_WIDE_RUNGS if rung.name in _WIDE else _SPAN
        pace = Pace(problem, span, Taylor().tolerance, variant.literals)
        # The first run counts the steps and fills caches, and is not timed.
        bench = cls(problem.form, pace, steps=pace.run())
        bench.count = max(1, ceil(_LEAST_SECONDS / max(bench.seconds(), 1e-6)))
        return bench

    def seconds(self) -> float:
        """Return the processor time of one run."""
        began = process_time()
        for _ in range(self.count):
            self.pace.run()
        return (process_time() - began) / self.count


def study(finished: Callable[[str], None] = lambda rung: None) -> PricesStudy:
    """Return every row of the published table; ``finished`` is called with each rung as it ends."""
    rows: list[PriceRow] = []
    for name, rounds in RUNGS.items():
        rows += _rows(rung_named(name), rounds)
        finished(name)
    return PricesStudy(
        rows=tuple(rows),
        method=PriceMethod(dict(RUNGS), _SEED, _LEAST_SECONDS),
        provenance=SceneProvenance(versions(), processor(), command()),
    )


def _rows(rung: Rung, rounds: int) -> list[PriceRow]:
    """Return the rows of a rung; an empty list if this machine does not have it."""
    if Taylor().unavailable(rung):
        return []
    is_wide = rung.name in _WIDE
    asked = [variant for variant in variants() if not is_wide or variant.name in _ON_WIDE_RUNGS]
    benches = {variant.name: _Bench.of(variant, rung) for variant in asked}
    timed = in_rounds([bench.seconds for bench in benches.values()], rounds, _SEED)
    for bench, taken in zip(benches.values(), timed, strict=True):
        bench.taken = taken
    return [
        _row(variant, rung, benches[variant.name], benches[variant.against]) for variant in asked
    ]


def _row(variant: Variant, rung: Rung, bench: _Bench, base: _Bench) -> PriceRow:
    rounds = zip(bench.taken, base.taken, strict=True)
    return PriceRow(
        rung=rung.name,
        variant=variant.name,
        against=variant.against,
        what=variant.what,
        states=len(bench.form.states),
        **bench.form.operations(),
        order=bench.pace.order,
        step_ratio=estimate(a / bench.steps / (b / base.steps) for a, b in rounds),
    )
