"""Steps that meet a kink: one ends before it, the next goes flat across it.

The operand of a kink is zero at a time that lies in a ball about the zero of its polynomial. A step ends a
little before that zero. The next one is flat, ends as far behind it, and is so short that the square of its
length falls below the last bit: no digit is lost. A kink that the motion touches and does not cross is not
followed.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import Final, NamedTuple

from flint import arb, ctx

from taylor_verify.exact.balls import midpoint
from taylor_verify.exact.enclosure.box import Box
from taylor_verify.exact.enclosure.kinks import Absolute, Norm
from taylor_verify.exact.enclosure.node_bounds import Bounds, minimum, value_at
from taylor_verify.exact.enclosure.operations import ZERO
from taylor_verify.exact.enclosure.series import Series
from taylor_verify.exact.enclosure.tube import BOUND_BITS
from taylor_verify.numbers.irrational import ball
from taylor_verify.numbers.precision import exact_value, floor_log2, power_of_two

# The first zero of a polynomial is looked for on so many parts of the step.
_PARTS: Final = 64
_SPARE_BITS: Final = 4
_KEPT_BITS: Final = 12


class Touched(ArithmeticError):
    """A motion that comes to a kink and may not cross it."""


class Plan(NamedTuple):
    """The length of a step, and the kinks that are flat in it."""

    length: Fraction
    flat: frozenset[int]


class _Ahead(NamedTuple):
    """A kink within the step: how far it is, how near a step may come to it, and its node."""

    distance: Fraction
    nearest: Fraction
    node: int


def least_length(length: Fraction) -> Fraction:
    """The length whose square is a last bit of the square of another one."""
    return abs(length) * power_of_two(-(ctx.prec // 2 + _SPARE_BITS))


def plan(series: Series, box: Box, least: Fraction) -> Plan:
    """The step that a series is for, cut before the next kink or flat across it.

    Steps come no nearer to a kink than ``least``, and those across it are at least so long.

    Raises Touched for a kink that may be no more than touched.
    """
    whole = Fraction(abs(series.step))
    here, ahead = _Kinks(series, box, least).sorted()
    flat = dict(here)
    for kink in ahead:
        if kink.distance <= 2 * max(kink.nearest, *flat.values(), Fraction(0)):
            flat[kink.node] = max(2 * kink.distance, kink.nearest)
    direction = 1 if series.step > 0 else -1
    if flat:
        length = max(flat.values())
        beside = {k.node for k in ahead if k.distance <= 2 * length}
        return Plan(direction * _short(length), frozenset(flat) | beside)
    length = min([whole, *(kink.distance - kink.nearest for kink in ahead)])
    return Plan(series.step if length == whole else direction * _short(length), frozenset())


def _short(length: Fraction) -> Fraction:
    """A length cut to few bits more than half of the precision has."""
    unit = power_of_two(floor_log2(length) - ctx.prec // 2 - _KEPT_BITS)
    return int(length / unit) * unit


class _Kinks:
    """The kinks of a series: those at its beginning, with the length of a step across, and those ahead."""

    def __init__(self, series: Series, box: Box, least: Fraction) -> None:
        self._series, self._box, self._least = series, box, least
        self._length = Fraction(abs(series.step))
        self._apart = self._distances()

    def _distances(self) -> Sequence[arb]:
        """The distance of each node at the beginning from its value at the point."""
        if self._box.is_point:
            return [ZERO] * len(self._series.forward)
        with ctx.workprec(BOUND_BITS):
            bounds = Bounds.at_start(self._series)
            bounds.widen(self._box.apart.entries())
        return bounds.beside

    def sorted(self) -> tuple[dict[int, Fraction], list[_Ahead]]:
        here: dict[int, Fraction] = {}
        ahead: list[_Ahead] = []
        for node, operand in self._operands():
            coefficients, apart = self._series.forward[operand], self._apart[operand]
            is_nothing = self._series.is_nothing(operand)
            if is_nothing and apart.is_zero():
                continue
            first = coefficients[0]
            if is_nothing:
                here[node] = self._length
            elif first.abs_lower() > apart or (first.is_zero() and apart.is_zero()):
                ahead += self._ahead(node, coefficients, apart)
            else:
                here[node] = self._across(coefficients, apart)
        return here, ahead

    def _operands(self) -> list[tuple[int, int]]:
        """The kinks, each with the node whose sign it depends on."""
        operands = []
        for i, operation in enumerate(self._series.tape.operations):
            if self._series.tape.degrees[i] is not None:
                continue
            if isinstance(operation, Absolute):
                operands.append((i, operation.a))
            elif isinstance(operation, Norm) and i in self._series.single:
                operands.append((i, self._series.single[i]))
        return operands

    def _across(self, coefficients: Sequence[arb], apart: arb) -> Fraction:
        """The length of a step across a kink that may be at the beginning."""
        with ctx.workprec(BOUND_BITS):
            rate = coefficients[1].abs_lower()
            if not rate > 0:
                raise Touched
            share = (4 * (coefficients[0].abs_upper() + apart) / rate).abs_upper()
        return max(exact_value(midpoint(share)) * self._length, self._least)

    def _ahead(self, node: int, coefficients: Sequence[arb], apart: arb) -> list[_Ahead]:
        sign = self._series.sign[node]
        signed = [sign * entry for entry in coefficients]
        least = minimum(signed)
        if least > 0 or (least == 0 and coefficients[0].is_zero()):
            return []
        share = _first_zero(signed)
        if share is None:
            return []
        with ctx.workprec(BOUND_BITS):
            slopes = [k * entry for k, entry in enumerate(signed)][1:]
            slope = value_at(slopes, ball(share)).abs_lower()
            if not slope > 0:
                raise Touched
            width = exact_value(midpoint((8 * apart / slope).abs_upper()))
        return [_Ahead(share * self._length, max(width * self._length, self._least), node)]


def _first_zero(coefficients: Sequence[arb]) -> Fraction | None:
    """A number near the first zero in (0, 1]; None if there is none to be seen.

    It is no proof: that a step has one sign is tested on the whole of it.
    """
    high = next(
        (k for k in range(1, _PARTS + 1) if not value_at(coefficients, arb(k) / _PARTS) > 0), None
    )
    if high is None:
        return None
    low, up = Fraction(high - 1, _PARTS), Fraction(high, _PARTS)
    while up - low > power_of_two(-(ctx.prec // 2 + _KEPT_BITS)):
        middle = (low + up) / 2
        if value_at(coefficients, ball(middle)) > 0:
            low = middle
        else:
            up = middle
    return up
