"""The derivative of the flow over one step: of the state by the one at its beginning.

V' = h DF(z(s)) V, V(0) = 1. With DF within R of its polynomial, what the polynomial V leaves of this
equation is at most

    |h| sum_(i + j >= m) |DF_i| |V_j| + |h| R sum_j |V_j|.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

from flint import arb, arb_mat

from taylor_verify.exact.enclosure.bounds import Bounds
from taylor_verify.exact.enclosure.box import Box, exponent, identity
from taylor_verify.exact.enclosure.derivative import Jacobian, jacobian
from taylor_verify.exact.enclosure.system import magnitudes
from taylor_verify.exact.enclosure.tube import Tube, accumulated

# The derivative of the flow is wanted to its leading digits alone: orders beyond are bounded, not computed.
_LITTLE_BITS: Final = 24
_LEAST_ORDER: Final = 8


@dataclass(frozen=True)
class Flow:
    """V(s) = sum of the terms s^k, and ``defect`` about it.

    ``spread`` bounds how far each term moves a state of the box from its point.
    """

    terms: list[arb_mat]
    spread: list[arb_mat]
    defect: arb_mat

    def at(self, s: arb) -> arb_mat:
        """V(s), as balls with the defect."""
        total, power = self.terms[0], arb(1)
        for term in self.terms[1:]:
            power = power * s
            total = total + term * power
        return _widened(total, self.defect)


def flow(bounds: Bounds, box: Box, tube: Tube) -> Flow:
    """The derivative of the flow for every path within the tube."""
    h, n = bounds.series.length, bounds.tape.size
    order = _order(tube.growth, bounds.order)
    slopes = jacobian(bounds, tube.width.entries(), order)
    terms, spread = [identity(n)], [box.apart]
    for k in range(order):
        total = slopes.terms[k] * terms[0]
        for j in range(1, k + 1):
            total = total + slopes.terms[k - j] * terms[j]
        terms.append(total * (h / (k + 1)))
        spread.append(magnitudes(magnitudes(terms[-1]) * box.apart))
    left = flow_defect(slopes, terms) * h.abs_upper()
    return Flow(terms, spread, accumulated(tube.growth, magnitudes(left), order=1))


def _order(growth: arb_mat, most: int) -> int:
    """Orders of an exponential that grows as fast: g^m e^g/m! is little, with g the spectral radius."""
    power = growth
    for _ in range(3):
        power = power * power
    trace = power.trace()
    if trace.is_zero():
        return min(_LEAST_ORDER, most - 1)
    g = arb(2) ** (arb(exponent(trace)) / 8)
    term, order = g.exp(), 0
    while order < _LEAST_ORDER or not term < arb(2) ** -_LITTLE_BITS:
        order += 1
        term = term * g / order
    return min(order, most - 1)


def flow_defect(slopes: Jacobian, terms: Sequence[arb_mat]) -> arb_mat:
    """A bound of what the polynomial V leaves of its equation, over h."""
    sizes = [magnitudes(term) for term in terms]
    tails = [sizes[-1]]
    for size in sizes[-2::-1]:
        tails.append(tails[-1] + size)
    left = slopes.beside * tails[-1]
    for slope, tail in zip(slopes.terms, tails, strict=False):
        left = left + magnitudes(slope) * tail
    return left


def _widened(matrix: arb_mat, radii: arb_mat) -> arb_mat:
    """The matrix with balls of these radii about its entries."""
    entries = [e + arb(0, r) for e, r in zip(matrix.entries(), radii.entries(), strict=True)]
    return arb_mat(matrix.nrows(), matrix.ncols(), entries)
