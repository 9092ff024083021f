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
from taylor_verify.exact.enclosure.tape import Tape
from taylor_verify.exact.enclosure.tube import BOUND_BITS, StepTooLong

_HALVINGS: Final = 12
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

    @property
    def is_sharp(self) -> bool:
        """True if the bound is some last bits of the function."""
        return bool(self.beside <= self.size * arb(2) ** (_SPARE_BITS - ctx.prec))


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

    Raises Domain where a function has no value.
    """
    tape = step.piece.functions
    assert tape is not None
    yield from _parts(tape, step, begin, step.length, step.state, _HALVINGS)


def _parts(
    tape: Tape, step: Step, begin: Fraction, length: Fraction, rows: Rows, halvings: int
) -> Iterator[Part]:
    try:
        functions = _functions(tape, step, begin, length, rows)
    except (StepTooLong, Domain):
        if not halvings:
            raise Domain("the expression may have no value, or too large a rate,") from None
        functions = []
    if functions and (not halvings or all(each.is_sharp for each in functions)):
        yield Part(begin, length, functions)
        return
    half = length / 2
    yield from _parts(tape, step, begin, half, _shifted(rows, 0), halvings - 1)
    yield from _parts(tape, step, begin + half, half, _shifted(rows, 1), halvings - 1)


def _shifted(rows: Rows, which: int) -> Rows:
    """The series of the first half, or of the second one."""
    inner = arb_poly([arb(which) / 2, arb(1) / 2])
    halves = []
    for column in zip(*rows, strict=True):
        entries = arb_poly(list(column))(inner).coeffs()
        halves.append([*entries, *[arb(0)] * (len(rows) - len(entries))])
    return [list(row) for row in zip(*halves, strict=True)]


def _functions(
    tape: Tape, step: Step, begin: Fraction, length: Fraction, rows: Rows
) -> list[Function]:
    flat: frozenset[int] = frozenset()
    while True:
        try:
            series = Series(tape, [], begin, length, len(rows) - 1, flat, rows)
            break
        except Kink as kink:
            flat |= {kink.node}
    with ctx.workprec(BOUND_BITS):
        bounds = Bounds(series)
        bounds.widen(step.tube.width.entries())
        sizes = [bounds.without_cancelling(place, bounds.length) for place in tape.outputs]
    return [
        Function(series.forward[place], bounds.beside[place].abs_upper(), size.abs_upper())
        for place, size in zip(tape.outputs, sizes, strict=True)
    ]
