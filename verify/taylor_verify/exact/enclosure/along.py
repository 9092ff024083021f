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

from taylor_verify.exact.enclosure.bounds import Bounds, value_at
from taylor_verify.exact.enclosure.coefficients import Rows
from taylor_verify.exact.enclosure.kinks import Kink
from taylor_verify.exact.enclosure.operations import Domain
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

    ``size`` is that of its terms, none cancelled.
    """

    polynomial: Sequence[arb]
    beside: arb
    size: arb

    def over(self, s: arb) -> arb:
        """A ball of all values on a ball of s."""
        return value_at(self.polynomial, s) + arb(0, self.beside)

    def gains_little(self, before: Function | None) -> bool:
        """True if the bound is some last bits of the function, or was not halved with the part."""
        if before is not None and before.beside < 2 * self.beside:
            return True
        return bool(self.beside <= self.size * arb(2) ** (_SPARE_BITS - ctx.prec))


_UNKNOWN: Final = Function([], arb("inf"), arb(0))


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

    def parts(
        self,
        begin: Fraction,
        length: Fraction,
        rows: Rows,
        halvings: int,
        before: Sequence[Function] = (),
    ) -> Iterator[Part]:
        """Yield the functions on a part of the step, which has this series of the state."""
        functions = self._functions(begin, length, rows)
        if not halvings or _are_final(functions, before):
            yield Part(begin, length, functions or [_UNKNOWN] * len(self._tape.outputs))
            return
        half = length / 2
        for k, time in enumerate((begin, begin + half)):
            yield from self.parts(time, half, _shifted(rows, k), halvings - 1, functions)

    def _functions(self, begin: Fraction, length: Fraction, rows: Rows) -> list[Function]:
        """The functions; none where one of them has no bound."""
        try:
            series = self._series(begin, length, rows)
            with ctx.workprec(BOUND_BITS):
                bounds = Bounds(series)
                bounds.widen(self._around)
                return [_function(bounds, place) for place in self._tape.outputs]
        except (StepTooLong, Domain):
            return []

    def _series(self, begin: Fraction, length: Fraction, rows: Rows) -> Series:
        flat: frozenset[int] = frozenset()
        while True:
            try:
                return Series(self._tape, [], begin, length, len(rows) - 1, flat, rows)
            except Kink as kink:
                flat |= {kink.node}


def _are_final(functions: Sequence[Function], before: Sequence[Function]) -> bool:
    """True if no shorter part is asked for."""
    pairs = zip(functions, before or [None] * len(functions), strict=True)
    return bool(functions) and all(each.gains_little(earlier) for each, earlier in pairs)


def _function(bounds: Bounds, place: int) -> Function:
    size = bounds.without_cancelling(place, bounds.length).abs_upper()
    return Function(bounds.series.forward[place], bounds.beside[place].abs_upper(), size)


def _shifted(rows: Rows, which: int) -> Rows:
    """The series of the first half, or of the second one."""
    inner = arb_poly([arb(which) / 2, arb(1) / 2])
    halves = []
    for column in zip(*rows, strict=True):
        entries = arb_poly(list(column))(inner).coeffs()
        halves.append([*entries, *[arb(0)] * (len(rows) - len(entries))])
    return [list(row) for row in zip(*halves, strict=True)]
