"""The function at which a motion ends: its argument comes to zero, where it has no derivative."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import Final

from flint import arb

from taylor_verify.exact.enclosure.functions import Angle
from taylor_verify.exact.enclosure.kinks import Kink
from taylor_verify.exact.enclosure.operations import ONE, Domain, Operation
from taylor_verify.exact.enclosure.powers import Logarithm, Power, Quotient, Root
from taylor_verify.exact.enclosure.series import Series
from taylor_verify.exact.enclosure.tape import Tape

# What is zero within this part of the longest step is at its end; an orbit comes near to a divisor often.
_NEAR: Final = Fraction(1, 1024)


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


def _argument(operation: Operation, series: Series) -> int | None:
    """Return the node at whose zero an operation has no value, or no derivative."""
    match operation:
        case Root(a=a) | Power(a=a) | Logarithm(a=a) | Quotient(a=a):
            return a
        case Angle(y=y, x=x, divisor=divisor):
            return y if series.forward[x][0] < 0 else divisor
    return None
