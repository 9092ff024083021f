"""Attitude and centre along the steps: R' = R G and c' = c + R b, with errors that only add up.

Over one step dG/ds = h G [Omega]x and db/ds = h G U. Let G_p and b_p be the polynomials, |.|_F the
Frobenius norm. All bounds hold for every s in [0, 1].

    dG = |d_G| + sqrt(2) dW >= |G - G_p|_F,      d_G the products that the polynomials leave out,
    dW >= int |h| |Omega - Omega_p|,             db = |d_b| + |h| dG sum |U_j| + dU >= |b - b_p|.

Proof. Delta = G - G_p obeys Delta' = h Delta [Omega_p]x + h G [Omega - Omega_p]x + d_G. The first term
turns the rows of Delta and changes no length; |G [w]x|_F = sqrt(2) |w|, as G is a rotation. For the path,
G U - G_p U_p = G (U - U_p) + (G - G_p) U_p.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from flint import arb, arb_mat, ctx

from taylor_verify.exact.balls import balls
from taylor_verify.exact.enclosure.box import Box, Flow
from taylor_verify.exact.enclosure.series import Series, frame_series, value
from taylor_verify.exact.enclosure.system import Balls, Bounds, column, magnitudes
from taylor_verify.exact.enclosure.tube import BOUND_BITS, Tube
from taylor_verify.scenes.tensors import Matrix, Vector


@dataclass(frozen=True)
class Place:
    """The frame of the body: ``turn`` (nine entries, exact) within ``turn_error`` of R, by Frobenius.

    ``centre`` (exact) is within ``centre_error`` of the centre, by length; None where it is not asked.
    """

    turn: list[arb]
    turn_error: arb
    centre: list[arb] | None
    centre_error: arb

    @classmethod
    def of(cls, attitude: Matrix, centre: Vector | None) -> Place:
        """The place at the start, at the ambient precision."""
        turn = balls([entry for row in attitude for entry in row])
        point = None if centre is None else balls(centre)
        return cls(
            turn=[b.mid() for b in turn],
            turn_error=_radius(turn),
            centre=None if point is None else [b.mid() for b in point],
            centre_error=_radius(point or ()),
        )

    def balls(self) -> tuple[list[arb], list[arb] | None]:
        """Attitude (nine entries) and centre, each entry with the whole bound as its radius."""
        return _about(self.turn, self.turn_error), (
            None if self.centre is None else _about(self.centre, self.centre_error)
        )


@dataclass(frozen=True)
class Leg:
    """The turn and the path of one step: the polynomials, and bounds of what they miss."""

    turns: list[list[arb]]
    path: Series
    turn_error: arb
    path_error: arb

    def place(self, begin: Place, s: arb) -> Place:
        """The place at s; its entries are balls, and its bounds are of their further errors."""
        turn = product(begin.turn, value(self.turns, s))
        with ctx.workprec(BOUND_BITS):
            turn_error = begin.turn_error + (1 + begin.turn_error) * self.turn_error
        if begin.centre is None:
            return Place(turn, turn_error.abs_upper(), None, arb(0))
        way = value(self.path, s)
        moved = product(begin.turn, way)
        centre = [c + m for c, m in zip(begin.centre, moved, strict=True)]
        with ctx.workprec(BOUND_BITS):
            error = begin.centre_error + begin.turn_error * norm(way) + self.path_error
        return Place(turn, turn_error.abs_upper(), centre, error.abs_upper())

    def carried(self, begin: Place) -> Place:
        """The place at the end of the step, its roundings counted."""
        end = self.place(begin, arb(1))
        with ctx.workprec(BOUND_BITS):
            rounded, moved = (_radius(entries) for entries in (end.turn, end.centre or ()))
            return Place(
                turn=[t.mid() for t in end.turn],
                turn_error=(end.turn_error + rounded).abs_upper(),
                centre=None if end.centre is None else [c.mid() for c in end.centre],
                centre_error=(end.centre_error + moved).abs_upper(),
            )

    def within(self, begin: Place, s: arb) -> tuple[list[arb], list[arb] | None]:
        """Attitude (nine entries) and centre at s, each entry with the whole bound as its radius."""
        return self.place(begin, s).balls()


def leg(
    system: Balls,
    bounds: Bounds,
    state: Series,
    h: arb,
    tube: Tube,
    flow: Flow | None,
    box: Box,
    with_centre: bool,
) -> Leg:
    """The turn and the path of one step, at the ambient precision."""
    turns, path = frame_series(system, state, h, with_centre)
    with ctx.workprec(BOUND_BITS):
        size = h.abs_upper()
        deviations = _deviations(box, flow, tube)
        lengths = [norm(turn) for turn in turns]
        spins = [norm((system.spin * column(z)).entries()) for z in state]
        turn_error = _left_out(lengths, spins) * size
        turn_error += arb(2).sqrt() * size * _accumulated(bounds.spin, deviations)
        path_error = arb(0)
        if with_centre:
            assert system.velocity is not None
            assert bounds.velocity is not None
            speeds = [norm((system.velocity * column(z)).entries()) for z in state]
            path_error = _left_out(lengths, speeds) * size
            path_error += size * turn_error.abs_upper() * sum(speeds, arb(0))
            path_error += size * _accumulated(bounds.velocity, deviations)
        return Leg(turns, path, turn_error.abs_upper(), path_error.abs_upper())


def _deviations(box: Box, flow: Flow | None, tube: Tube) -> tuple[list[arb_mat], arb_mat]:
    """Bounds e_k and e with |z(s) - p(s)| <= sum_k e_k s^k + e, component by component."""
    if flow is None:
        return [], tube.truncation
    spread = [magnitudes(term * box.axes) * box.radius for term in flow.terms]
    constant = flow.defect * (magnitudes(box.axes) * box.radius) + tube.truncation
    return spread, magnitudes(constant)


def _accumulated(form: arb_mat, deviations: tuple[list[arb_mat], arb_mat]) -> arb:
    """A bound of int_0^1 |W (z - p)| ds. Each order has a norm of its own.

    The norm of the sum would be smaller than the integral of the norm, and no bound.
    """
    spread, constant = deviations
    total = norm((form * constant).entries())
    for k, part in enumerate(spread):
        total += norm((form * part).entries()) / (k + 1)
    return total


def _left_out(lengths: Sequence[arb], others: Sequence[arb]) -> arb:
    """The products of two coefficients whose orders reach the polynomial's: it has none of them."""
    total = tail = arb(0)
    for length, other in zip(lengths, reversed(others), strict=True):
        tail += other
        total += length * tail
    return total


def _radius(entries: Sequence[arb]) -> arb:
    """An upper bound of the distance of any point of these balls from their midpoints."""
    return norm([arb(entry.rad()) for entry in entries])


def _about(entries: Sequence[arb], error: arb) -> list[arb]:
    return [entry + arb(0, error) for entry in entries]


def product(matrix: Sequence[arb], other: Sequence[arb]) -> list[arb]:
    """A 3 x 3 matrix times a matrix or a column, all as flat lists."""
    entries: list[arb] = (
        arb_mat(3, 3, list(matrix)) * arb_mat(3, len(other) // 3, list(other))
    ).entries()
    return entries


def norm(entries: Sequence[arb]) -> arb:
    """An upper bound of the root of the sum of squares."""
    return sum((e * e for e in map(arb.abs_upper, entries)), arb(0)).sqrt().abs_upper()
