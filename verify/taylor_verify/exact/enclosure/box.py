"""The box that contains the state, and its change in a step.

The state lies in point + { axes u : |u_i| <= radius_i }: an exact point, an exact matrix, exact bounds.
The axes follow the flow, so that a set which the flow stretches one way is not widened every way.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Final

from flint import arb, arb_mat, ctx

from taylor_verify.exact.enclosure.coefficients import Series, value
from taylor_verify.exact.enclosure.system import Balls, column, magnitudes
from taylor_verify.exact.enclosure.tube import (
    BOUND_BITS,
    Tube,
    accumulated,
    is_within,
    partial_tails,
    rates_of_change,
)

# The derivative of the flow is wanted to the leading digits alone. Orders that move the box by less than
# this part of what the orders before them did are bounded, and not computed; some are in any case.
_LITTLE: Final = arb(2) ** -24
_LEAST_ORDER: Final = 8


@dataclass(frozen=True)
class Box:
    """``radius`` is a column of upper bounds; ``axes`` and ``point`` are exact."""

    point: list[arb]
    axes: arb_mat
    radius: arb_mat

    @classmethod
    def about(cls, balls: Sequence[arb]) -> Box:
        """The box of a vector of balls, along the coordinate axes."""
        n = len(balls)
        return cls(
            point=[b.mid() for b in balls],
            axes=identity(n),
            radius=column([arb(b.rad()) for b in balls]),
        )

    @property
    def is_point(self) -> bool:
        return all(r == 0 for r in self.radius.entries())

    @cached_property
    def apart(self) -> arb_mat:
        """A bound of the distance of a state of the box from its point, component by component."""
        with ctx.workprec(BOUND_BITS):
            return magnitudes(magnitudes(self.axes) * self.radius)


@dataclass(frozen=True)
class Flow:
    """The derivative of the flow over one step: V(s) = sum of the terms s^k, and ``defect`` about it.

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
        return widened(total, self.defect)


def flow(
    system: Balls, bounds: Balls, box: Box, state: Series, sizes: Series, h: arb, tube: Tube
) -> Flow:
    """The derivative of the state by the one at the beginning, for every path within the tube.

    V' = h DF(z(s)) V, V(0) = 1. What the polynomial V leaves of this equation is at most

        sum_j |h| Lin(tail_(m - j)) |V_j| + |h| Lin(width of the tube) sum_j |V_j|.
    """
    n = len(state[0])
    second = system.second * h
    jacobians: list[arb_mat] = []
    terms, spread = [identity(n)], [box.apart]
    moved = box.apart
    for k, z in enumerate(state[:-1]):
        jacobians.append(arb_mat(n, n, (second * column(z)).entries()))
        total = jacobians[k] * terms[0]
        for j in range(1, k + 1):
            total = total + jacobians[k - j] * terms[j]
        terms.append(total * (1 / arb(k + 1)))
        spread.append(magnitudes(magnitudes(terms[-1] * box.axes) * box.radius))
        # Up to a term that hardly moves the box.
        if k >= _LEAST_ORDER and is_within(spread[-1], moved * _LITTLE):
            break
        moved = moved + spread[-1]
    return Flow(terms, spread, flow_defect(bounds, terms, sizes, h, tube))


def flow_defect(
    bounds: Balls, terms: Sequence[arb_mat], sizes: Series, h: arb, tube: Tube
) -> arb_mat:
    """A bound of how far V may be from its polynomial: what that leaves out, accumulated in the tube."""
    order = len(terms) - 1
    beyond = [sum(entries, arb(0)) for entries in zip(*sizes[order:], strict=True)]
    tails = partial_tails([*sizes[:order], beyond])
    magnitude = [magnitudes(term) for term in terms]
    everything = magnitude[0]
    left = rates_of_change(bounds, column(tails[order])) * magnitude[0]
    for j in range(1, order + 1):
        everything = everything + magnitude[j]
        left = left + rates_of_change(bounds, column(tails[order - j])) * magnitude[j]
    left = (left + rates_of_change(bounds, tube.width) * everything) * abs(h).upper()
    return accumulated(tube.growth, magnitudes(left), order=1)


def carried(box: Box, state: Series, tube: Tube, flow: Flow | None, spans: list[range]) -> Box:
    """The box at the end of the step."""
    end = [sum(coefficients, arb(0)) for coefficients in zip(*state, strict=True)]
    point = [z.mid() for z in end]
    with ctx.workprec(BOUND_BITS):
        rounding = [abs(z - middle).upper() for z, middle in zip(end, point, strict=True)]
        fresh = magnitudes(column(rounding) + tube.truncation)
        if flow is None:
            return Box(point, identity(len(point)), fresh)
        moved = flow.at(arb(1)) * box.axes
        # Where the tube has no width, the component is that of the polynomial, whatever the start.
        free = [i for i, width in enumerate(tube.width.entries()) if not width.is_zero()]
        axes, inverse = _frame(moved, box.radius, _units(point, fresh, spans), free)
        spread = magnitudes(inverse * moved) * box.radius + magnitudes(inverse) * fresh
        radius = [spread[i, 0] if i in free else fresh[i, 0] for i in range(len(point))]
        return Box(point, axes, magnitudes(column(radius)))


def within(box: Box, state: Series, tube: Tube, flow: Flow | None, s: arb) -> list[arb]:
    """The state at s as balls, at the ambient precision."""
    at_point = value(state, s)
    with ctx.workprec(BOUND_BITS):
        spread = tube.truncation
        if flow is not None:
            spread = magnitudes(flow.at(s) * box.axes) * box.radius + spread
        radii = magnitudes(spread).entries()
    return [z + arb(0, r) for z, r in zip(at_point, radii, strict=True)]


def widened(matrix: arb_mat, radii: arb_mat) -> arb_mat:
    """The matrix with balls of these radii about its entries."""
    entries = [e + arb(0, r) for e, r in zip(matrix.entries(), radii.entries(), strict=True)]
    return arb_mat(matrix.nrows(), matrix.ncols(), entries)


def identity(n: int) -> arb_mat:
    return arb_mat(n, n, [arb(int(i == j)) for i in range(n) for j in range(n)])


def _units(point: Sequence[arb], fresh: arb_mat, spans: list[range]) -> list[arb]:
    """A power of two for each component: the size of its block, or of the block's fresh error."""
    units = [arb(1)] * len(point)
    errors = fresh.entries()
    for span in spans:
        for values in ([point[i] for i in span], [errors[i] for i in span]):
            exponents = [exponent(z) for z in values if not z.is_zero()]
            if exponents:
                for i in span:
                    units[i] = arb(2) ** max(exponents)
                break
    return units


def exponent(value: arb) -> int:
    """The exponent of the power of two next above an upper bound that is not zero."""
    mantissa, power = value.abs_upper().man_exp()
    return int(power) + int(mantissa).bit_length()


def _frame(
    moved: arb_mat, radius: arb_mat, units: list[arb], free: list[int]
) -> tuple[arb_mat, arb_mat]:
    """Exact axes near those that the flow makes of the old ones, orthogonal in units; their inverse.

    Any invertible axes are sound. The longest edge comes first, so that it keeps its direction. A
    component that is not ``free`` keeps an axis of its own, and no rounding of the others reaches it.
    """
    edges = [[(moved[i, j] / units[i]).mid() for i in free] for j in range(len(units))]
    lengths = [_dot(edge, edge).sqrt() * r for edge, r in zip(edges, radius.entries(), strict=True)]
    columns = directions(edges, lengths, len(free))
    count = len(columns)
    turned = arb_mat(count, len(free), [c for direction in columns for c in direction]).transpose()
    try:
        back = inverted(turned) if count == len(free) else None
    except ZeroDivisionError:
        back = None
    if back is None or not all(entry.is_finite() for entry in back.entries()):
        return identity(len(units)), identity(len(units))
    axes, inverse = identity(len(units)), identity(len(units))
    for row, i in enumerate(free):
        for place, j in enumerate(free):
            # Units are powers of two: nothing is rounded here.
            axes[i, j] = units[i] * turned[row, place]
            inverse[i, j] = back[row, place] / units[j]
    return axes, inverse


def directions(edges: Sequence[list[arb]], lengths: Sequence[arb], most: int) -> list[list[arb]]:
    """Exact vectors, nearly orthogonal and nearly unit, along the edges; the longest one comes first."""
    columns: list[list[arb]] = []
    for j in sorted(range(len(edges)), key=lambda j: -_logarithm(lengths[j])):
        direction = edges[j]
        # Twice, because one pass loses digits for nearly parallel edges.
        for _ in range(2):
            for other in columns:
                share = _dot(direction, other).mid()
                direction = [(d - share * o).mid() for d, o in zip(direction, other, strict=True)]
        length = _dot(direction, direction).sqrt().mid()
        if length > 0 and len(columns) < most:
            columns.append([(d / length).mid() for d in direction])
    return columns


def inverted(matrix: arb_mat) -> arb_mat:
    """The inverse in balls. Raises ZeroDivisionError where these do not exclude a singular matrix."""
    inverse: arb_mat = matrix.inv()
    return inverse


def _dot(a: Sequence[arb], b: Sequence[arb]) -> arb:
    return sum((x * y for x, y in zip(a, b, strict=True)), arb(0))


def _logarithm(value: arb) -> float:
    return float("-inf") if value.abs_upper().is_zero() else exponent(value)
