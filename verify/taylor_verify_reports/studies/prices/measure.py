"""Measurement of the price of each option of a scene, as a multiple of the simplest form of its model.

A price is the processor time of a step in float64, over that of the simplest form of the model in the same
round. The integrator goes from the start to the end of a stretch of time, again and again, without samples.
The time of compiling is left out.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Final

from taylor_verify.judge.provenance import command, processor, versions
from taylor_verify.models.form import Form
from taylor_verify.numbers.precision import rung
from taylor_verify.records.provenance import SceneProvenance
from taylor_verify.solvers.taylor.driver import Taylor
from taylor_verify.solvers.taylor.pace import Pace
from taylor_verify.tradeoff.timing import calls_to_time, estimate, in_rounds, seconds_of
from taylor_verify_reports.studies.prices.document import PriceMethod, PriceRow, PricesStudy
from taylor_verify_reports.studies.prices.variants import Variant, variants

ROUNDS: Final = 31
_RUNG: Final = rung("f64")
_SEED: Final = 1
# So long a measurement is not disturbed by the clock's resolution, a microsecond, or by an interrupt.
_LEAST_SECONDS: Final = 4e-3
# The stretch, in the problem's units of time: some hundreds of steps.
_SPAN: Final = Fraction(128)


@dataclass(frozen=True)
class _Bench:
    """A variant, ready to run; ``count`` runs of ``steps`` steps make one measurement."""

    form: Form
    pace: Pace
    steps: int
    count: int

    @classmethod
    def of(cls, variant: Variant) -> _Bench:
        """Return the bench of a variant, with as many runs as a measurement needs."""
        problem = variant.posed(_RUNG)
        pace = Pace(problem, _SPAN, Taylor().tolerance, variant.literals)
        # The first run counts the steps and fills caches, and is not timed.
        steps = pace.run()
        return cls(
            problem.form, pace, steps, calls_to_time(seconds_of(pace.run, 1), _LEAST_SECONDS)
        )

    def seconds_of_step(self) -> float:
        """Return the processor time of one step."""
        return seconds_of(self.pace.run, self.count) / self.steps


def study(finished: Callable[[str], None] = lambda part: None, rounds: int = ROUNDS) -> PricesStudy:
    """Return every row of the published table; ``finished`` is called with each part as it ends."""
    benches = {variant.name: _Bench.of(variant) for variant in variants()}
    finished("every variant is compiled")
    timed = in_rounds([bench.seconds_of_step for bench in benches.values()], rounds, _SEED)
    seconds = dict(zip(benches, timed, strict=True))
    finished("every variant is timed")
    return PricesStudy(
        rows=tuple(
            _row(variant, benches[variant.name], seconds[variant.name], seconds[variant.against])
            for variant in variants()
        ),
        method=PriceMethod(rounds, _SEED, _LEAST_SECONDS),
        provenance=SceneProvenance(versions(), processor(), command()),
    )


def _row(
    variant: Variant, bench: _Bench, seconds: Sequence[float], base: Sequence[float]
) -> PriceRow:
    return PriceRow(
        variant=variant.name,
        against=variant.against,
        what=variant.what,
        states=len(bench.form.states),
        **bench.form.operations(),
        order=bench.pace.order,
        step_ratio=estimate(a / b for a, b in zip(seconds, base, strict=True)),
    )
