"""Functions of the state along one step: polynomials, and bounds of how far they are from the true values.

The polynomial of the state over a part of a step is that of the whole step, shifted. So a function whose
series converges slowly is enclosed on halves of the step, and on halves of these.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Final

from flint import arb, arb_poly, ctx

from taylor_verify.exact.enclosure.coefficients import Rows
from taylor_verify.exact.enclosure.kinks import Kink
from taylor_verify.exact.enclosure.node_bounds import Bounds, value_at
from taylor_verify.exact.enclosure.operations import ZERO, Domain
from taylor_verify.exact.enclosure.series import Series
from taylor_verify.exact.enclosure.step import Step
from taylor_verify.exact.enclosure.tube import BOUND_BITS, StepTooLong
from taylor_verify.numbers.precision import float_text

_HALVINGS: Final = 12
_MOST_UNKNOWN: Final = 2
# A bound of so many last bits of its function asks for no shorter part.
_SPARE_BITS: Final = 24


@dataclass(frozen=True)
class Function:
    """A function on a part of the motion, s in [0, 1]: within ``beside`` of its ``polynomial``.

    ``missed`` is what it would be within if the state were its polynomial, and ``size`` is that of its
    terms, none cancelled.
    """

    polynomial: Sequence[arb]
    beside: arb
    missed: arb
    size: arb

    def over(self, s: arb) -> arb:
        """A ball of all values on a ball of s."""
        return value_at(self.polynomial, s) + arb(0, self.beside)

    @property
    def is_sharp(self) -> bool:
        """True if halves of the part would be known little better."""
        least = self.size * arb(2) ** (_SPARE_BITS - ctx.prec)
        return bool(self.missed <= least or 2 * self.missed <= self.beside)


_UNKNOWN: Final = Function([], arb("inf"), arb("inf"), arb(0))


@dataclass(frozen=True)
class Part:
    """Functions from a time on, for a length of time."""

    begin: Fraction
    length: Fraction
    functions: Sequence[Function]

    @property
    def end(self) -> Fraction:
        return self.begin + self.length


def parts(begin: Fraction, step: Step) -> Iterator[Part]:
    """Yield the functions of a step that begins at a time, on the parts on which they are sharp.

    On a short part they may be unknown, as beside a kink. Raises Domain where they are on several.
    """
    unknown = 0
    for part in _Halves(step).parts(begin, step.length, step.state, _HALVINGS):
        unknown = 0 if part.functions[0].polynomial else unknown + 1
        if unknown > _MOST_UNKNOWN:
            raise Domain(f"the expression may have no value near t = {float_text(part.begin)}")
        yield part


class _Halves:
    """The functions of one step, on halves of it where it is too long for them."""

    def __init__(self, step: Step) -> None:
        assert step.piece.functions is not None
        self._tape = step.piece.functions
        self._around = step.tube.width.entries()

    def parts(self, begin: Fraction, length: Fraction, rows: Rows, halvings: int) -> Iterator[Part]:
        """Yield the functions on a part of the step, which has this series of the state."""
        functions = self._functions(begin, length, rows)
        if not halvings or (functions and all(each.is_sharp for each in functions)):
            yield Part(begin, length, functions or [_UNKNOWN] * len(self._tape.outputs))
            return
        half = length / 2
        for k, time in enumerate((begin, begin + half)):
            yield from self.parts(time, half, _shifted(rows, k), halvings - 1)

    def _functions(self, begin: Fraction, length: Fraction, rows: Rows) -> list[Function]:
        """The functions; none where one of them has no bound."""
        try:
            series = self._series(begin, length, rows)
            with ctx.workprec(BOUND_BITS):
                bounds = Bounds(series)
                bounds.widen([ZERO] * self._tape.size)
                missed = [bounds.beside[place] for place in self._tape.outputs]
                bounds.widen(self._around)
            pairs = zip(self._tape.outputs, missed, strict=True)
            return [_function(bounds, place, least) for place, least in pairs]
        except (StepTooLong, Domain):
            return []

    def _series(self, begin: Fraction, length: Fraction, rows: Rows) -> Series:
        flat: frozenset[int] = frozenset()
        while True:
            try:
                return Series(self._tape, [], begin, length, len(rows) - 1, flat, rows)
            except Kink as kink:
                flat |= {kink.node}


def _function(bounds: Bounds, place: int, missed: arb) -> Function:
    size = bounds.without_cancelling(place, bounds.length)
    limits = (bounds.beside[place], missed, size)
    return Function(bounds.series.forward[place], *(limit.abs_upper() for limit in limits))


def _shifted(rows: Rows, which: int) -> Rows:
    """The series of the first half, or of the second one."""
    inner = arb_poly([arb(which) / 2, arb(1) / 2])
    halves = []
    for column in zip(*rows, strict=True):
        entries = arb_poly(list(column))(inner).coeffs()
        halves.append([*entries, *[arb(0)] * (len(rows) - len(entries))])
    return [list(row) for row in zip(*halves, strict=True)]
