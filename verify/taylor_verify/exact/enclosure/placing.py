"""Attitude and centre along the steps: q -> q g and c -> c + R d, with errors that only add up.

R = R_0 R(q) with R_0 the attitude at the start, and R(q) v = q v q* for a quaternion q of any length. Over
one step g is the turn and d the way since its beginning, in body axes:

    dg/ds = h g Omega/2,        dd/ds = h (U + d x Omega).

Let g_p and d_p be their polynomials. All bounds hold for every s in [0, 1].

    dg = (|d_g| + dW)/2 >= |g - g_p|,                     d_g, d_d the products that the polynomials
    dd = |d_d| + dU + dW sum_k |d_k| >= |d - d_p|,        leave out,
    dW >= int |h| |Omega - Omega_p|,                      dU >= int |h| |U - U_p|.

Proof. Delta = g - g_p obeys Delta' = h Delta Omega_p/2 + h g (Omega - Omega_p)/2 + d_g/2. The first term is
at right angles to Delta and changes no length; |g| = 1. Likewise delta = d - d_p obeys
delta' = h delta x Omega + h (U - U_p) + h d_p x (Omega - Omega_p) + d_d.

At s, with p = q_p g_p for the quaternion of which |q - q_p| <= rho,

    |q g - p| <= rho (1 + dg) + dg =: e,
    |R(q g) - R(p)| <= e (2 + e) as an operator, and sqrt(3) of it by Frobenius,
    |R(q g) d - R(p) d_p| <= dd + e (2 + e) |d_p|.

Proof. q g - q_p g_p = (q - q_p) g_p + q (g - g_p). For unit quaternions r, r v r* - p v p* =
(r - p) v r* + p v (r - p)*, and |p| <= 1 + e.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from operator import add

from flint import arb, arb_mat, ctx

from taylor_verify.exact.balls import balls
from taylor_verify.exact.enclosure.box import Box
from taylor_verify.exact.enclosure.coefficients import Rows, value
from taylor_verify.exact.enclosure.flow import Flow
from taylor_verify.exact.enclosure.system import Forms, column, magnitudes, reached
from taylor_verify.exact.enclosure.tube import BOUND_BITS, Tube
from taylor_verify.exact.rotation import product, rotation_rows
from taylor_verify.numbers.tensors import Matrix, Vector


@dataclass(frozen=True)
class Place:
    """The frame of the body: R is ``start`` R(q), with q within ``turn_error`` of ``turn``.

    ``start`` are balls about the attitude at the start. ``centre`` is within ``centre_error`` of the
    centre, by length; None where it is not asked. Between steps ``turn`` and ``centre`` are exact.
    """

    start: arb_mat
    turn: list[arb]
    turn_error: arb
    centre: list[arb] | None
    centre_error: arb

    @classmethod
    def of(cls, attitude: Matrix, centre: Vector | None) -> Place:
        """The place at the start, at the ambient precision."""
        point = None if centre is None else balls(centre)
        return cls(
            start=arb_mat([balls(row) for row in attitude]),
            turn=[arb(1), arb(0), arb(0), arb(0)],
            turn_error=arb(0),
            centre=None if point is None else [b.mid() for b in point],
            centre_error=_radius(point or ()),
        )

    def balls(self) -> tuple[list[arb], list[arb] | None]:
        """Attitude (nine entries) and centre, each entry with the whole bound as its radius."""
        with ctx.workprec(BOUND_BITS):
            error = (arb(3).sqrt() * _turning(self.turn_error)).abs_upper()
        attitude = self.start * arb_mat(rotation_rows(self.turn))
        return _about(attitude.entries(), error), (
            None if self.centre is None else _about(self.centre, self.centre_error)
        )


@dataclass(frozen=True)
class Leg:
    """The turn and the way of one step: their polynomials, and bounds of what these miss."""

    frame: Rows
    turn_error: arb
    path_error: arb

    def place(self, begin: Place, s: arb) -> Place:
        """The place at s; its entries are balls, and its bounds are of their further errors."""
        frame = value(self.frame, s)
        turn, way = product(begin.turn, frame[:4]), frame[4:]
        with ctx.workprec(BOUND_BITS):
            error = begin.turn_error * (1 + self.turn_error) + self.turn_error
        if begin.centre is None:
            return Place(begin.start, turn, error.abs_upper(), None, arb(0))
        moved = begin.start * (arb_mat(rotation_rows(turn)) * column(way))
        centre = [c + m for c, m in zip(begin.centre, moved.entries(), strict=True)]
        with ctx.workprec(BOUND_BITS):
            missed = begin.centre_error + self.path_error + _turning(error) * norm(way)
        return Place(begin.start, turn, error.abs_upper(), centre, missed.abs_upper())

    def carried(self, begin: Place) -> Place:
        """The place at the end of the step, its roundings counted."""
        end = self.place(begin, arb(1))
        with ctx.workprec(BOUND_BITS):
            rounded, moved = (_radius(entries) for entries in (end.turn, end.centre or ()))
            return Place(
                start=begin.start,
                turn=[t.mid() for t in end.turn],
                turn_error=(end.turn_error + rounded).abs_upper(),
                centre=None if end.centre is None else [c.mid() for c in end.centre],
                centre_error=(end.centre_error + moved).abs_upper(),
            )


def leg(
    forms: Forms,
    sizes: Forms,
    state: Rows,
    frame: Rows,
    h: arb,
    tube: Tube,
    flow: Flow | None,
    box: Box,
) -> Leg:
    """The turn and the way of one step, whose polynomials are those of the ``frame``."""
    with ctx.workprec(BOUND_BITS):
        size = h.abs_upper()
        deviations = _deviations(box, flow, tube)
        spins = [norm((forms.spin * column(z)).entries()) for z in state]
        turned = _accumulated(sizes.spin, deviations) * size
        left_out = _left_out([norm(row[:4]) for row in frame], spins) * size
        turn_error = ((left_out + turned) / 2).abs_upper()
        path_error = arb(0)
        if len(frame[0]) > 4:
            ways = [norm(row[4:]) for row in frame]
            path_error = _left_out(ways, spins) * size + turned * sum(ways, arb(0))
            path_error += norm((forms.velocity * column(state[-1])).entries()) * size
            path_error += _accumulated(sizes.velocity, deviations) * size
        return Leg(frame, turn_error, path_error.abs_upper())


def _deviations(box: Box, flow: Flow | None, tube: Tube) -> tuple[list[arb_mat], arb_mat]:
    """Bounds e_k and e with |z(s) - p(s)| <= sum_k e_k s^k + e, component by component."""
    if flow is None:
        return [], tube.truncation
    return flow.spread, _beside(reached(flow.defect, box.apart), tube.truncation)


def _beside(moved: arb_mat, truncation: arb_mat) -> arb_mat:
    """The sums of two bounds, the first of which has the components that move."""
    sums = truncation.entries()
    sums[: moved.nrows()] = map(add, sums, moved.entries())
    return magnitudes(column(sums))


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


def _turning(error: arb) -> arb:
    """A bound of |R(r) - R(p)| as an operator, for a unit quaternion r within ``error`` of p."""
    return error * (2 + error)


def _about(entries: Sequence[arb], error: arb) -> list[arb]:
    return [entry + arb(0, error) for entry in entries]


def norm(entries: Sequence[arb]) -> arb:
    """An upper bound of the root of the sum of squares."""
    return sum((e * e for e in map(arb.abs_upper, entries)), arb(0)).sqrt().abs_upper()
