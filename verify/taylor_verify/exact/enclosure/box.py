"""The box that contains the state, and its change in a step.

The state lies in point + { axes u : |u_j| <= radius_j }: an exact point, an exact matrix, exact bounds.
There are more axes than components. A step turns and stretches every axis as the flow does, and each
error that the step adds gets an axis of its own. So an old error is never wrapped into new directions,
until there are too many axes: then the shortest ones are replaced by a frame that holds them.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from math import ceil
from operator import add
from types import MappingProxyType
from typing import TYPE_CHECKING, Final

from flint import arb, arb_mat, ctx

from taylor_verify.exact.enclosure.coefficients import Rows, value
from taylor_verify.exact.enclosure.system import column, mapped, reached
from taylor_verify.exact.enclosure.tube import BOUND_BITS, Tube

if TYPE_CHECKING:
    from taylor_verify.exact.enclosure.flow import Flow

# Axes for each component: as many as there may be, and the longest ones, which stay as they are when there
# are more.
_MOST_AXES: Final = 20
_LONGEST: Final = 10
_ONE: Final = arb(1)

# Axes as columns, and a column of their radii.
Axes = tuple[arb_mat, arb_mat]


@dataclass(frozen=True)
class Box:
    """``axes`` are n x m and ``radius`` has m upper bounds; ``axes`` and ``point`` are exact."""

    point: list[arb]
    axes: arb_mat
    radius: arb_mat

    @classmethod
    def about(cls, balls: Sequence[arb]) -> Box:
        """The box of a vector of balls, along the coordinate axes."""
        return cls([b.mid() for b in balls], *_along(arb(b.rad()) for b in balls))

    def balls(self) -> list[arb]:
        """Balls about the point that contain every state of the box."""
        return [z + arb(0, r) for z, r in zip(self.point, self.apart.entries(), strict=True)]

    @property
    def is_point(self) -> bool:
        return self.axes.ncols() == 0

    @cached_property
    def apart(self) -> arb_mat:
        """A bound of the distance of a state of the box from its point, component by component."""
        with ctx.workprec(BOUND_BITS):
            return reached(self.axes, self.radius)


def carried(
    box: Box,
    state: Rows,
    tube: Tube,
    flow: Flow | None,
    spans: list[range],
    sizes: Mapping[int, float] = MappingProxyType({}),
    share: arb | None = None,
) -> Box:
    """The box at the end of the step, or at a share of it.

    ``sizes`` are log2 of those of single components, by which their errors are counted.
    """
    if share is None:
        end = [sum(coefficients, arb(0)) for coefficients in zip(*state, strict=True)]
    else:
        end = value(state, share)
    point = [z.mid() for z in end]
    with ctx.workprec(BOUND_BITS):
        rounding = column([abs(z - middle).upper() for z, middle in zip(end, point, strict=True)])
        errors = (rounding + tube.truncation).entries()
        rows, radius = box.axes.tolist(), box.radius
        if flow is not None:
            moved = flow.at(_ONE if share is None else share) * box.axes
            middles = mapped(arb.mid, moved)
            rounded = reached(moved - middles, radius).entries()
            rows[: len(rounded)] = middles.tolist()
            errors[: len(rounded)] = map(add, errors, rounded)
        axes, radius = _with_errors(rows, radius, errors)
        if axes.ncols() > _MOST_AXES * len(point):
            units = _units(point, errors, spans)
            for i, size in sizes.items():
                units[i] = arb(2) ** ceil(size) if size > float("-inf") else units[i]
            axes, radius = fewer(axes, radius, units)
        return Box(point, axes, radius)


def _with_errors(rows: list[list[arb]], radius: arb_mat, errors: Sequence[arb]) -> Axes:
    """The axes by their rows, and an axis along each coordinate with an error."""
    added = [i for i, error in enumerate(errors) if not error.is_zero()]
    rows = [row + [arb(int(i == j)) for j in added] for i, row in enumerate(rows)]
    bounds = radius.entries() + [errors[j].abs_upper() for j in added]
    return arb_mat(rows) if bounds else arb_mat(len(rows), 0), column(bounds)


def within(box: Box, state: Rows, tube: Tube, flow: Flow | None, s: arb) -> list[arb]:
    """The state at s as balls, at the ambient precision."""
    at_point = value(state, s)
    with ctx.workprec(BOUND_BITS):
        radii = box.apart.entries()
        if flow is not None:
            moved = reached(flow.at(s) * box.axes, box.radius).entries()
            radii[: len(moved)] = moved
        radii = list(map(add, radii, tube.truncation.entries()))
    return [z + arb(0, r.abs_upper()) for z, r in zip(at_point, radii, strict=True)]


def renewed(box: Box, places: Sequence[int], values: Sequence[arb], slopes: arb_mat) -> Box:
    """The box after some components have become functions of all: values at the point, and slopes.

    Everything else of the box stays as it is, bit by bit.
    """
    point = list(box.point)
    for place, ball in zip(places, values, strict=True):
        point[place] = ball.mid()
    with ctx.workprec(BOUND_BITS):
        moved = slopes * box.axes
        middles = mapped(arb.mid, moved)
        rounded = reached(moved - middles, box.radius).entries()
        rows, errors = box.axes.tolist(), [arb(0)] * len(point)
        for k, (place, row) in enumerate(zip(places, middles.tolist(), strict=True)):
            rows[place] = row
            errors[place] = arb(values[k].rad()) + rounded[k]
        return Box(point, *_with_errors(*_reaching(rows, box.radius), errors))


def _reaching(rows: list[list[arb]], radius: arb_mat) -> tuple[list[list[arb]], arb_mat]:
    """The rows without the axes that are zero."""
    left = [j for j in range(radius.nrows()) if any(not row[j].is_zero() for row in rows)]
    if len(left) == radius.nrows():
        return rows, radius
    return [[row[j] for j in left] for row in rows], column([radius[j, 0] for j in left])


def over_box(box: Box, values: Sequence[arb], slopes: arb_mat) -> list[arb]:
    """Balls of functions over the box, by their values at the point and their slopes."""
    with ctx.workprec(BOUND_BITS):
        spread = reached(slopes * box.axes, box.radius).entries()
    return [v + arb(0, r) for v, r in zip(values, spread, strict=True)]


def identity(n: int) -> arb_mat:
    return arb_mat(n, n, [arb(int(i == j)) for i in range(n) for j in range(n)])


def _units(point: Sequence[arb], errors: Sequence[arb], spans: list[range]) -> list[arb]:
    """A power of two for each component: the size of its block, or of the block's fresh error."""
    units = [arb(1)] * len(point)
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


def _along(bounds: Iterable[arb]) -> Axes:
    """An axis along each coordinate whose bound is not zero, with that bound as its radius."""
    sizes = list(bounds)
    touched = [i for i, size in enumerate(sizes) if not size.is_zero()]
    unit = [arb(int(i == j)) for i in range(len(sizes)) for j in touched]
    return arb_mat(len(sizes), len(touched), unit), column([sizes[j] for j in touched])


def _beside(first: Axes, second: Axes) -> Axes:
    """All axes of both."""
    rows = zip(first[0].tolist(), second[0].tolist(), strict=True)
    return arb_mat([a + b for a, b in rows]), column(first[1].entries() + second[1].entries())


def fewer(axes: arb_mat, radius: arb_mat, units: list[arb]) -> Axes:
    """The longest axes as they are, and a frame about the set of all others.

    Any invertible frame is sound: the others lie in frame { |u_j| <= (|frame^-1 others| radius)_j }. A
    component that none of the others reaches is no part of it, and no rounding of the others reaches it.
    """
    columns, bounds = axes.transpose().tolist(), radius.entries()
    edges = [
        [entry / unit * bound for entry, unit in zip(axis, units, strict=True)]
        for axis, bound in zip(columns, bounds, strict=True)
    ]
    lengths = [_dot(edge, edge).mid() for edge in edges]
    order = sorted(range(len(edges)), key=lengths.__getitem__, reverse=True)
    most = _LONGEST * len(units)
    longest, others = order[:most], order[most:]
    touched = [i for i in range(len(units)) if any(not columns[j][i].is_zero() for j in others)]
    # Units are powers of two: nothing is rounded by them.
    rest = arb_mat([[columns[j][i] / units[i] for j in others] for i in touched])
    frame, inverse = _frame([[edges[j][i].mid() for i in touched] for j in others])
    about = reached(inverse * rest, column([bounds[j] for j in others]))
    wide = arb_mat(len(units), len(touched))
    for row, i in enumerate(touched):
        for j in range(len(touched)):
            wide[i, j] = units[i] * frame[row, j]
    same = arb_mat(len(longest), len(units), [e for j in longest for e in columns[j]]).transpose()
    return _beside((same, column([bounds[j] for j in longest])), (wide, about))


def _frame(edges: Sequence[list[arb]]) -> tuple[arb_mat, arb_mat]:
    """An exact square matrix whose columns are along the edges, nearly orthogonal; its inverse in balls.

    The unit matrix where the edges do not reach every dimension.
    """
    size = len(edges[0])
    columns = directions(edges)
    if len(columns) == size:
        turned = arb_mat(columns).transpose()
        try:
            return turned, inverted(turned)
        except ZeroDivisionError:
            pass
    return identity(size), identity(size)


def directions(edges: Sequence[list[arb]]) -> list[list[arb]]:
    """Exact vectors, nearly orthogonal and nearly unit: each along the longest rest of an edge."""
    columns: list[list[arb]] = []
    left = list(edges)
    while len(columns) < len(edges[0]):
        direction = max(left, key=lambda rest: _dot(rest, rest).mid())
        # Again, because one pass loses digits for nearly parallel edges.
        direction = _across(direction, columns)
        length = _dot(direction, direction).sqrt().mid()
        if not length > 0:
            break
        columns.append([(entry / length).mid() for entry in direction])
        left = [_across(rest, columns[-1:]) for rest in left]
    return columns


def _across(vector: list[arb], columns: Sequence[list[arb]]) -> list[arb]:
    """The part of a vector that is orthogonal to each of the columns, rounded."""
    for other in columns:
        share = _dot(vector, other).mid()
        vector = [(v - share * o).mid() for v, o in zip(vector, other, strict=True)]
    return vector


def inverted(matrix: arb_mat) -> arb_mat:
    """The inverse in balls. Raises ZeroDivisionError where these do not exclude a singular matrix."""
    inverse: arb_mat = matrix.inv()
    return inverse


def _dot(a: Sequence[arb], b: Sequence[arb]) -> arb:
    return sum((x * y for x, y in zip(a, b, strict=True)), arb(0))
