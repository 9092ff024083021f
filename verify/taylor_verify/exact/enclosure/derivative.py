"""The derivative of the rates by the state along one step: polynomials, and bounds of what they miss."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from typing import NamedTuple

from flint import arb, arb_mat, arb_poly, arb_series, ctx

from taylor_verify.exact.enclosure.node_bounds import Bounds
from taylor_verify.exact.enclosure.operations import ONE, ZERO, Part, State


class Slope(NamedTuple):
    """The derivative of a node by one component: within ``beside`` of a polynomial of this ``length``."""

    polynomial: arb_poly
    length: arb
    beside: arb


_NOTHING = arb_poly([])
_UNIT = Slope(arb_poly([1]), ONE, ZERO)


@dataclass(frozen=True)
class Jacobian:
    """DF(z(s)) is within ``beside`` of the sum of terms[k] s^k, by entries, on all paths in the tube.

    There are rows of the components that move alone.
    """

    terms: list[arb_mat]
    beside: arb_mat


class _Slopes:
    """The slopes of all nodes to fewer than ``count`` orders, in the tube that the bounds are of."""

    def __init__(self, bounds: Bounds, count: int) -> None:
        self._bounds, self._count = bounds, count
        self._series, self._tape = bounds.series, bounds.tape
        self._polynomials: dict[int, arb_poly] = {}
        self.of_node: list[Mapping[int, Slope]] = []
        for i, operation in enumerate(self._tape.operations):
            if isinstance(operation, State):
                self.of_node.append({operation.component: _UNIT})
            else:
                self.of_node.append(self._of(i) if self._tape.moves[i] else {})

    def _of(self, i: int) -> dict[int, Slope]:
        differential = self._tape.operations[i].differential(i, self._bounds)
        totals: dict[int, tuple[arb_poly, arb]] = {}
        for part in differential.parts:
            for component, slope in self.of_node[part.operand].items():
                polynomial, beside = self._times(part, slope)
                before, apart = totals.get(component, (_NOTHING, ZERO))
                totals[component] = before + polynomial, apart + beside
        if differential.divisor is not None:
            totals = {
                component: self._divided(*entry, differential.divisor, differential.least)
                for component, entry in totals.items()
            }
        for operand in differential.rough:
            for component, slope in self.of_node[operand].items():
                before, apart = totals.get(component, (_NOTHING, ZERO))
                totals[component] = before, apart + slope.length + slope.beside
        return {
            component: Slope(polynomial, _length(polynomial), beside.abs_upper())
            for component, (polynomial, beside) in totals.items()
        }

    def _times(self, part: Part, slope: Slope) -> tuple[arb_poly, arb]:
        """The slope of an operand times factor D2."""
        size = part.factor.abs_upper()
        if part.node is None:
            return slope.polynomial * part.factor, size * slope.beside
        polynomial, cut = self._cut(self._polynomial(part.node) * slope.polynomial)
        within = sum(self._bounds.sizes[part.node][: self._count], ZERO)
        missed = self._missed(part.node) * (slope.length + slope.beside)
        return polynomial * part.factor, size * (cut + within * slope.beside + missed)

    def _divided(
        self, polynomial: arb_poly, beside: arb, divisor: int, least: arb
    ) -> tuple[arb_poly, arb]:
        """The quotient by D1, as a series; what it leaves of the equation is divided by the least D1."""
        with _orders(self._count):
            below = self._series.forward[divisor][: self._count]
            series = arb_series(polynomial.coeffs(), self._count) / arb_series(below, self._count)
        quotient = arb_poly(series.coeffs())
        _, cut = self._cut(self._polynomial(divisor) * quotient)
        missed = self._missed(divisor) * _length(quotient)
        return quotient, (beside + cut + missed) / least

    def _polynomial(self, i: int) -> arb_poly:
        if i not in self._polynomials:
            self._polynomials[i] = arb_poly(self._series.forward[i][: self._count])
        return self._polynomials[i]

    def _missed(self, i: int) -> arb:
        """A bound of how far a node is from its first orders."""
        return sum(self._bounds.sizes[i][self._count :], self._bounds.beside[i])

    def _cut(self, polynomial: arb_poly) -> tuple[arb_poly, arb]:
        """The first orders, and the size of the others."""
        entries = polynomial.coeffs()
        size = sum((entry.abs_upper() for entry in entries[self._count :]), ZERO)
        return arb_poly(entries[: self._count]), size


def jacobian(bounds: Bounds, around: Sequence[arb], count: int) -> Jacobian:
    """The derivative to fewer than ``count`` orders, for the states around the polynomial."""
    bounds.widen(around)
    slopes, tape = _Slopes(bounds, count).of_node, bounds.tape
    shape = tape.moving, tape.size
    terms, beside = [arb_mat(*shape) for _ in range(count)], arb_mat(*shape)
    for row, rate in enumerate(tape.rates[: tape.moving]):
        for component, slope in slopes[rate].items():
            beside[row, component] = slope.beside
            for k, entry in enumerate(slope.polynomial.coeffs()):
                terms[k][row, component] = entry
    return Jacobian(terms, beside)


@contextmanager
def _orders(count: int) -> Iterator[None]:
    """Set the orders of python-flint's power series, which are one number for the whole process."""
    before, ctx.cap = ctx.cap, count
    try:
        yield
    finally:
        ctx.cap = before


def _length(polynomial: arb_poly) -> arb:
    return sum((entry.abs_upper() for entry in polynomial.coeffs()), ZERO)
