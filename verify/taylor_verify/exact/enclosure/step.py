"""A step from a box: its length, the polynomial, the tube about it, the derivative, and the frame."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import ceil, log2
from typing import Final

from flint import arb, ctx

from taylor_verify.exact.enclosure.box import Box, exponent
from taylor_verify.exact.enclosure.coefficients import Rows
from taylor_verify.exact.enclosure.crossing import least_length, plan
from taylor_verify.exact.enclosure.flow import Flow, flow
from taylor_verify.exact.enclosure.kinks import Kink
from taylor_verify.exact.enclosure.node_bounds import Bounds
from taylor_verify.exact.enclosure.series import Series
from taylor_verify.exact.enclosure.system import Piece, System
from taylor_verify.exact.enclosure.tape import Tape
from taylor_verify.exact.enclosure.tube import BOUND_BITS, StepTooLong, Tube, tube
from taylor_verify.numbers.precision import floor_log2, power_of_two

# If the convolutions dominate the cost, the cheapest steps are the radius of convergence over e^2, with
# bits ln 2/2 orders. Work that is done once per order or once per step makes higher orders cheaper.
_ORDERS_PER_BIT: Final = 0.42
_STEP_BITS: Final = 8
# Near a steady motion the series converges everywhere, and the bounds do not close.
_MOST_GROWTH: Final = 5.0
_LEAST_CUT: Final = 0.25
_HALVINGS: Final = 80
_LEAST_ORDER: Final = 6
# The last orders of a state may happen to be small beside those of the products that it comes from.
SPARE_BITS: Final = 12
# A step that nearly reaches the end is extended to the end.
_NEARLY: Final = Fraction(63, 64)
# Powers of two by which one step may be longer or shorter than a guess.
_MOST_POWERS: Final = 1_000_000


@dataclass(frozen=True)
class Step:
    """A step of length h from a box, and everything that is known about the motion within it.

    ``terms`` are the sizes of the rates at its beginning if none of their terms cancelled; a step that
    ``is_flat`` goes across a kink. ``reach`` is log2 of the radius of convergence as far as it is seen, and
    ``piece`` is that of its time.
    """

    length: Fraction
    state: Rows
    tube: Tube
    flow: Flow | None
    terms: list[arb]
    is_flat: bool
    reach: float | None
    piece: Piece


@dataclass(frozen=True)
class Stepper:
    """Makes steps of a system at the ambient precision."""

    system: System

    @property
    def order(self) -> int:
        return ceil(_ORDERS_PER_BIT * ctx.prec) + 2

    def step(
        self, box: Box, now: Fraction, guess: Fraction, left: Fraction, reach: float | None = None
    ) -> Step:
        """A step of at most the time that is left, and within one piece of it.

        ``reach`` is that of a step before. Raises StepTooLong where none closes, Touched at a kink that may
        not be crossed, and Domain where a function has no value.
        """
        piece = self.system.pieces(now, left > 0)
        if piece.end is not None and abs(piece.end - now) < abs(left):
            left = piece.end - now
        order = self._enough(reach, guess, left)
        series = self._fitted(piece.tape, box, now, guess, left, order)
        for _ in range(_HALVINGS):
            with ctx.workprec(BOUND_BITS):
                bounds = Bounds(series)
                try:
                    around = tube(bounds, box.apart)
                    moving = None if box.is_point else flow(bounds, box, around)
                except StepTooLong:
                    around = None
            excess = 0.0 if around is None or series.flat else self._excess(series, around)
            if around is not None and excess <= 0:
                terms, is_flat = bounds.terms(), bool(series.flat)
                radius = reach if is_flat else self._reach(series)
                state, step = series.rows, series.step
                return Step(step, state, around, moving, terms, is_flat, radius, piece)
            share = Fraction(1, 2) if around is None else _cut(Fraction(1), -excess / self.order)
            series.rescale(series.step * share)
        raise StepTooLong

    def _enough(self, reach: float | None, guess: Fraction, left: Fraction) -> int:
        """The orders that a step needs; fewer where it ends long before its usual length."""
        if reach is None or abs(left) >= abs(guess):
            return self.order
        gain = reach - _log2(left)
        return self.order if gain <= 0 else min(self.order, ceil(ctx.prec / gain) + _LEAST_ORDER)

    def _reach(self, series: Series) -> float | None:
        """log2 of the radius of convergence; None where the series has ended."""
        factor = self._root_test_of(series.rows)
        if factor == float("inf"):
            return None
        return factor + ctx.prec / series.order + _log2(series.step)

    def _excess(self, series: Series, around: Tube) -> float:
        """The bits by which what is left out of the series exceeds some last bits of the state."""
        rows, missed = series.rows, around.truncation.entries()
        excess = float("-inf")
        for span in self.system.spans:
            size = _moved_by(rows, span)
            lost = size_of(missed, span)
            # A block that is zero throughout has no last bits.
            if min(lost, size) > float("-inf"):
                excess = max(excess, lost - size + ctx.prec - SPARE_BITS)
        return excess

    # The length.

    def _fitted(
        self, tape: Tape, box: Box, now: Fraction, guess: Fraction, left: Fraction, order: int
    ) -> Series:
        """The series of a step at whose end it falls below the last bit."""
        first = self._first(tape, box, now, guess, left)
        try:
            series = Series(tape, box.point, now, first, order)
            while order < self.order and self._root_test_of(series.rows) < 0:
                order = min(self.order, order + max(_LEAST_ORDER, order // 4))
                series = Series(tape, box.point, now, first, order)
        except Kink as kink:
            # It lies within the rounding of the start.
            least = least_length(self._usual(tape, box, now, guess))
            return self._flat(tape, box, now, left, frozenset((kink.node,)), least)
        length = self._length(box, series, left)
        if length != first:
            series.rescale(length)
        if tape.has_kinks:
            usual = abs(length)
            if length == left:
                # What is left may be next to nothing.
                usual = max(usual, self._usual(tape, box, now, guess))
            ahead = plan(series, box, least_length(usual))
            if ahead.flat:
                return self._flat(tape, box, now, left, ahead.flat, abs(ahead.length))
            if ahead.length != length:
                series.rescale(ahead.length)
        return series

    def _flat(
        self,
        tape: Tape,
        box: Box,
        now: Fraction,
        left: Fraction,
        flat: frozenset[int],
        length: Fraction,
    ) -> Series:
        """The series of a short step across kinks, with fewer orders."""
        step = min(length, abs(left)) * (1 if left > 0 else -1)
        order = max(_LEAST_ORDER, self.order // 4)
        while True:
            try:
                return Series(tape, box.point, now, step, order, flat)
            except Kink as kink:
                flat |= {kink.node}

    def _first(
        self, tape: Tape, box: Box, now: Fraction, guess: Fraction, left: Fraction
    ) -> Fraction:
        """A length at which the coefficients are no giants: no guess can make a result wrong."""
        length = guess if abs(guess) < abs(left) else left
        try:
            with ctx.workprec(BOUND_BITS):
                growth = _growth(Series(tape, box.point, now, length, 1), 0)
        except Kink:
            return length
        if growth is None or growth == float("-inf"):
            return length
        limit = power_of_two(ceil(_log2(length) - growth))
        return length if abs(length) <= limit else limit * (1 if left > 0 else -1)

    def _usual(self, tape: Tape, box: Box, now: Fraction, guess: Fraction) -> Fraction:
        """Return a guess of the length of a step that no end cuts short."""
        return abs(self._first(tape, box, now, guess, guess))

    def _length(self, box: Box, series: Series, left: Fraction) -> Fraction:
        rows = series.rows
        tests = [self._root_test_of(rows)]
        if timed := series.of_time():
            tests.append(self.root_test(timed, [range(len(timed[0]))]))
        factor = min(*tests, _log2(left) - _log2(series.step))
        is_constant = all(entry.is_zero() for row in rows[1:] for entry in row)
        if not (box.is_point and is_constant):
            with ctx.workprec(BOUND_BITS):
                factor = _bounded(series, factor)
        fitted = _cut(series.step, factor)
        return left if abs(fitted) >= abs(left) * _NEARLY else fitted

    def _root_test_of(self, rows: Rows) -> float:
        """The root test of all blocks of the state.

        An own state is as large as it moves by, too: a number passes through zero alone.
        """
        own = [_growing(rows, span, _moved_by(rows, span)) for span in self.system.own.values()]
        return min([self.root_test(rows, self.system.others), *own])

    def root_test(self, rows: Rows, spans: Sequence[range]) -> float:
        """log2 of the factor by which the length may grow; infinite where the series has ended."""
        factors = [float("inf")]
        for span in spans:
            # The size of the block, or of its first change.
            factors.append(_growing(rows, span, _first_size(rows, span)))
        return min(factors)


def _first_size(rows: Rows, span: range) -> float:
    """log2 of the size of a block, or of its first change; -inf where it is zero throughout."""
    sizes = (size_of(row, span) for row in rows)
    return next((size for size in sizes if size > float("-inf")), float("-inf"))


def _moved_by(rows: Rows, span: range) -> float:
    """log2 of the size of a block and of its first two orders, or of its first change."""
    largest = max(size_of(row, span) for row in rows[:3])
    return largest if largest > float("-inf") else _first_size(rows, span)


def _growing(rows: Rows, span: range, size: float) -> float:
    """log2 of the factor by which a step may grow until the last orders of a block of this size count."""
    factor, order = float("inf"), len(rows) - 1
    for k in range(max(1, order - 2), order + 1):
        last = size_of(rows[k], span)
        if last > float("-inf"):
            factor = min(factor, (size - ctx.prec - last) / k)
    return factor


def _bounded(series: Series, factor: float) -> float:
    """The factor, or less where the linearised motion would outgrow the bounds within the step."""
    least = factor - _HALVINGS
    while factor > least:
        growth = _growth(series, factor)
        if growth is None:
            factor -= 1
            continue
        excess = growth - log2(_MOST_GROWTH)
        if excess <= 0:
            break
        # The reach may itself grow with the length.
        factor -= max(excess / 2, _LEAST_CUT)
    return factor


def _growth(series: Series, factor: float) -> float | None:
    """log2 of the spectral radius of |h dF/dz| over a step longer by 2^factor, within n^(1/8).

    -inf of none; None where a function has no bound over so long a step. The trace of an eighth power does
    not depend on the units of the components.
    """
    bounds = Bounds.rough(series, _power(factor))
    try:
        power = bounds.rates_of_change([arb(0)] * series.tape.size)
    except StepTooLong:
        return None
    for _ in range(3):
        power = power * power
    trace = power.trace()
    if trace.is_zero():
        return float("-inf")
    return exponent(trace) / 8 + _log2(series.step) + factor


def _log2(length: Fraction) -> float:
    """log2 of a magnitude that no float needs to hold."""
    return log2(abs(length.numerator)) - log2(length.denominator)


def _power(exponent: float) -> arb:
    """An exact number near 2^exponent, of any size."""
    whole = int(exponent // 1)
    return arb(2.0 ** (exponent - whole)) * arb(2) ** whole


def _cut(length: Fraction, log2_factor: float) -> Fraction:
    """The length times 2^log2_factor, cut to so few bits that sums of lengths stay short.

    Raises StepTooLong for a length beside which the motion stands still.
    """
    whole = int(log2_factor // 1)
    if abs(whole) > _MOST_POWERS:
        raise StepTooLong
    wide = length * power_of_two(whole) * Fraction(2.0 ** (log2_factor - whole))
    unit = power_of_two(floor_log2(abs(wide)) - _STEP_BITS + 1)
    return int(wide / unit) * unit


def size_of(entries: Sequence[arb], span: range) -> float:
    """log2 of the largest entry, rounded upwards; -inf of zeros."""
    sizes = [exponent(entries[i]) for i in span if not entries[i].abs_upper().is_zero()]
    return float(max(sizes, default=float("-inf")))
