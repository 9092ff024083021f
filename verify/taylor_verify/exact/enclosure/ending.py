"""The end of a motion: a function has no value or no derivative there, or the state has no bound."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from decimal import MAX_EMAX, MIN_EMIN, ROUND_FLOOR, Decimal, localcontext
from fractions import Fraction
from typing import Final

from flint import arb

from taylor_verify.exact.balls import midpoint
from taylor_verify.exact.enclosure.box import Box
from taylor_verify.exact.enclosure.functions import Angle
from taylor_verify.exact.enclosure.kinks import Kink
from taylor_verify.exact.enclosure.operations import ONE, Domain, Operation
from taylor_verify.exact.enclosure.powers import Logarithm, Power, Quotient, Root
from taylor_verify.exact.enclosure.series import Series
from taylor_verify.exact.enclosure.tape import Tape
from taylor_verify.numbers.precision import exact_value

# What is zero within this part of the longest step is at its end; an orbit comes near to a divisor often.
_NEAR: Final = Fraction(1, 1024)
# The share by which a part of the state grows in one step, where its speed is soon infinite.
_GROWING: Final = arb(1) / 1024


def ending(tape: Tape, point: Sequence[arb], now: Fraction, longest: Fraction) -> int | None:
    """Return the step of the loads whose argument, as it goes, is zero first; None of none so near.

    ``longest`` is the longest step of the motion so far, in its direction.
    """
    try:
        series = Series(tape, point, now, longest * _NEAR, 2)
    except Kink:
        return None
    except Domain as end:
        return None if end.node is None else tape.written.get(end.node)
    nearest, first = ONE, None
    for i, operation in enumerate(tape.operations):
        if i in tape.written and (a := _argument(operation, series)) is not None:
            here, change = series.forward[a][:2]
            left = -here / change if here * change < 0 else arb("inf")
            if left < nearest:
                nearest, first = left, tape.written[i]
    return first


def growing(tape: Tape, box: Box, now: Fraction, step: Fraction, named: Mapping[str, range]) -> str:
    """Return the name of the part of the state that grows most in a step, and how large it is.

    The size is proven; that it has no bound is not. Empty where no part grows by as much as it does
    towards an infinite speed.
    """
    try:
        here, change = Series(tape, box.point, now, step, 2).rows[:2]
    except (Kink, Domain):
        return ""
    most, largest = _GROWING, ""
    for name, span in named.items():
        size = sum((here[i] ** 2 for i in span), arb(0))
        share = sum((here[i] * change[i] for i in span), arb(0)) / size
        if share > most:
            most, largest = share, name
    if not largest:
        return ""
    least = sum((box.balls()[i].abs_lower() ** 2 for i in named[largest]), arb(0)).sqrt()
    return (
        f"{largest} seems to grow without bound: steps become ever shorter, and it is proven to be above "
        f"{_rounded_down(least)} near"
    )


def _rounded_down(size: arb) -> str:
    """Two digits of a positive number of any size."""
    value = exact_value(midpoint(size.lower()))
    with localcontext(prec=2, rounding=ROUND_FLOOR, Emax=MAX_EMAX, Emin=MIN_EMIN):
        return f"{Decimal(value.numerator) / Decimal(value.denominator):g}"


def _argument(operation: Operation, series: Series) -> int | None:
    """Return the node at whose zero an operation has no value, or no derivative."""
    match operation:
        case Root(a=a) | Power(a=a) | Logarithm(a=a) | Quotient(a=a):
            return a
        case Angle(y=y, x=x, divisor=divisor):
            return y if series.forward[x][0] < 0 else divisor
    return None
