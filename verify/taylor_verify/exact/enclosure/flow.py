"""The derivative of the flow over one step: of the state by the one at its beginning.

V' = h DF(z(s)) V, V(0) = 1. With DF within R of its polynomial, what the polynomial V leaves of this
equation is at most

    |h| sum_(i + j >= m) |DF_i| |V_j| + |h| R sum_j |V_j|.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import exp
from operator import mul
from typing import Final

from flint import arb, arb_mat

from taylor_verify.exact.enclosure.box import Box, exponent, identity
from taylor_verify.exact.enclosure.coefficients import Rows
from taylor_verify.exact.enclosure.derivative import Jacobian, jacobian
from taylor_verify.exact.enclosure.node_bounds import Bounds
from taylor_verify.exact.enclosure.system import intervals, magnitudes
from taylor_verify.exact.enclosure.tube import Tube, accumulated

# The derivative of the flow is wanted to its leading digits alone: orders beyond are bounded, not computed.
_LITTLE_BITS: Final = 24
_LEAST_ORDER: Final = 8
# With more all orders are taken.
_MOST_GROWTH: Final = 100.0


@dataclass(frozen=True)
class Flow:
    """V(s) = sum of the terms s^k, and ``defect`` about it: the rows of the components that move."""

    terms: list[arb_mat]
    defect: arb_mat

    def at(self, s: arb) -> arb_mat:
        """V(s), as balls with the defect."""
        total, power = self.terms[0], arb(1)
        for term in self.terms[1:]:
            power = power * s
            total = total + term * power
        return total + intervals(self.defect)

    def whole(self, s: arb) -> arb_mat:
        """V(s) with the rows of the components that do not move, which are those of the unit matrix."""
        return _with_unit_rows(self.at(s))


def flow(bounds: Bounds, box: Box, tube: Tube) -> Flow:
    """The derivative of the flow for every path within the tube."""
    h, n, moving = bounds.series.length, bounds.tape.size, bounds.tape.moving
    order = min(_order(tube.growth, bounds.series.rows), bounds.order - 1)
    slopes = jacobian(bounds, tube.width.entries(), order)
    inner = [_part(term, moving, moving) for term in slopes.terms]
    terms = [_part(identity(n), moving, n)]
    for k in range(order):
        total = slopes.terms[k]
        for j in range(1, k + 1):
            total = total + inner[k - j] * terms[j]
        terms.append(total * (h / (k + 1)))
    left = flow_defect(slopes, terms) * h.abs_upper()
    growth = _part(tube.growth, moving, moving)
    return Flow(terms, accumulated(growth, magnitudes(left), order=1))


def _part(matrix: arb_mat, rows: int, columns: int) -> arb_mat:
    """The first rows and columns of a matrix."""
    if (rows, columns) == (matrix.nrows(), matrix.ncols()):
        return matrix
    return arb_mat(rows, columns, [e for row in matrix.tolist()[:rows] for e in row[:columns]])


def _order(growth: arb_mat, rows: Rows) -> int:
    """Orders of V beyond which little is left of it.

    V is about as large as v with v' = g(s) v, v(0) = 1: g(1) is the spectral radius of the growth, and the
    orders of g are in proportion to those of the state.
    """
    power = growth
    for _ in range(3):
        power = power * power
    trace, sizes = power.trace(), [sum(map(abs, row), arb(0)) for row in rows]
    if trace.is_zero():
        return _LEAST_ORDER
    radius, whole = 2 ** (exponent(trace) / 8), sum(sizes, arb(0))
    rates = [radius * float((size / whole).mid()) for size in sizes]
    left = exp(min(sum(rate / k for k, rate in enumerate(rates, 1)), _MOST_GROWTH))
    terms = [1.0]
    while len(terms) < _LEAST_ORDER or (left >= 2**-_LITTLE_BITS and len(terms) < len(rows)):
        left -= terms[-1]
        terms.append(sum(map(mul, rates, reversed(terms))) / len(terms))
    return len(terms)


def flow_defect(slopes: Jacobian, terms: Sequence[arb_mat]) -> arb_mat:
    """A bound of what the polynomial V leaves of its equation, over h.

    V has the rows of the components that move; the others, those of the unit matrix, belong to order 0.
    """
    sizes = [intervals(magnitudes(term)) for term in terms]
    tails = [sizes[-1]]
    for size in sizes[-2::-1]:
        tails.append(tails[-1] + size)
    moving = terms[0].nrows()
    left = slopes.beside * _with_unit_rows(tails[-1])
    for slope, tail in zip(slopes.terms, tails, strict=False):
        left = left + _part(slope, moving, moving) * tail
    return magnitudes(left)


def _with_unit_rows(moving: arb_mat) -> arb_mat:
    """The matrix with those rows of the unit matrix that it lacks at its end."""
    still = identity(moving.ncols()).tolist()[moving.nrows() :]
    return arb_mat([*moving.tolist(), *still]) if still else moving
