"""Order of convergence of each quantity, from files of one solver at several steps.

An order needs errors clearly above roundoff, and steps between which the local order is the same. Other
observations are reported in words: a lower order at smaller steps, a file whose step does not fit, the
step below which roundoff dominates.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from math import sqrt
from typing import TYPE_CHECKING, Final

from taylor_verify.records.answers import Order, OrderPoint
from taylor_verify.records.json_text import finite
from taylor_verify.records.order_of_points import STEP, read_order
from taylor_verify.records.quantities import COMPLETE, INITIAL, SOUND_ATTITUDE
from taylor_verify.records.status import Status
from taylor_verify.words.orders import order_sentence

if TYPE_CHECKING:
    from taylor_verify.judge.files.judgement import FileJudgement
    from taylor_verify.records.verdict import Verdict

_NOT_OF_THE_STEP: Final = (INITIAL, COMPLETE, *SOUND_ATTITUDE)


@dataclass(frozen=True)
class Sample:
    """A file and the step of the integrator that wrote it."""

    judged: FileJudgement
    step: float
    is_step: bool = True

    def row(self, quantity: str) -> Verdict | None:
        """Return the verdict on a quantity; None if its error was not measured."""
        for verdict in self.judged.verdicts:
            if verdict.quantity == quantity and verdict.is_compared:
                return None if verdict.verdict is Status.UNDECIDED else verdict
        return None

    @property
    def times(self) -> tuple[Fraction, ...]:
        """Times of the rows."""
        return self.judged.file.times

    @property
    def roundings(self) -> float:
        """Ratio of the floor for the integrator's steps to that for one step per row; 1 if not known."""
        if not self.is_step:
            return 1.0
        steps = float(abs(self.times[-1] - self.times[0])) / self.step
        return sqrt(max(1.0, steps / len(self.times)))


def orders(samples: Sequence[Sample], knob: str = STEP) -> tuple[Order, ...]:
    """Return the order of every quantity that depends on the step, in the order of the verdicts.

    Raises ValueError for two files with the same step.
    """
    samples = sorted(samples, key=lambda sample: -sample.step)
    verdicts = (v for sample in samples for v in sample.judged.verdicts if v.is_compared)
    names = dict.fromkeys(v.quantity for v in verdicts if v.quantity not in _NOT_OF_THE_STEP)
    return tuple(_order(name, samples, knob) for name in names)


def _order(quantity: str, samples: Sequence[Sample], knob: str) -> Order:
    rows = [sample.row(quantity) for sample in samples]
    unit = next((row.unit for row in rows if row is not None), "")
    points = [_point(sample, row) for sample, row in zip(samples, rows, strict=True)]
    digits = [sample.judged.file.digits for sample in samples]
    order = read_order(quantity, unit, points, knob, digits)
    return replace(order, sentence=order_sentence(order))


def _point(sample: Sample, row: Verdict | None) -> OrderPoint:
    error = finite(row.max) if row is not None else None
    floor = row.attainable if row is not None else None
    floor = None if floor is None else finite(floor * sample.roundings)
    return OrderPoint(sample.judged.file.name, sample.step, error, floor)
