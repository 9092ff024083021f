"""Motions that stay in a plane of the body, and their kinds, decided in rationals.

Legend: body axes i, j, k in cyclic order, k across the plane; T holds p_i x_i^2 + p_j x_j^2 + r y_k^2
of the plane (halved) and nothing that leads out of it. Of the two axes, a is the one with the smaller
p, b the other, and side = 1 if a is i, -1 if it is j. F = |x|, omega0^2 = r (p_b - p_a) F^2, and with

    x_a = F cos alpha,  x_b = -F sin alpha,  alpha' = side r y_k,
    (2 alpha)'' = -omega0^2 sin 2 alpha,     h = alpha'^2 + omega0^2 sin^2 alpha constant,

the angle 2 alpha is a pendulum's, broadside on (x along a) its lower and end on its upper rest.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any

from mpmath import mp, mpf

from taylor_verify.exact.carried import Back
from taylor_verify.exact.kirchhoff.displaced import about, moved, symmetric_origin
from taylor_verify.exact.kirchhoff.integrable import CYCLIC
from taylor_verify.exact.kirchhoff.isotropic import less_coupling
from taylor_verify.exact.kirchhoff.reduced import Reduced
from taylor_verify.exact.kirchhoff.solid import solid
from taylor_verify.exact.solution import Number, Time
from taylor_verify.numbers import tensors
from taylor_verify.scenes.bodies import ImmersedBody
from taylor_verify.scenes.scene import Scene


@dataclass(frozen=True)
class Plane:
    """A motion in a plane: the axes a, b and k counted from 0, and the numbers of the legend.

    ``p`` are p_a and p_b, ``x`` are x_a and x_b and ``y`` is y_k at the start.
    """

    a: int
    b: int
    k: int
    side: int
    p: tuple[Fraction, Fraction]
    r: Fraction
    x: tuple[Fraction, Fraction]
    y: Fraction

    @property
    def F2(self) -> Fraction:
        return self.x[0] ** 2 + self.x[1] ** 2

    @property
    def spread(self) -> Fraction:
        """omega0^2/F^2."""
        return self.r * (self.p[1] - self.p[0])

    @property
    def omega0_squared(self) -> Fraction:
        return self.spread * self.F2

    @property
    def rate(self) -> Fraction:
        """alpha' at the start."""
        return self.side * self.r * self.y

    @property
    def h(self) -> Fraction:
        return self.rate**2 + self.spread * self.x[1] ** 2

    @property
    def lack(self) -> Fraction:
        """omega0^2 - h, formed without it: zero on the border of swing and turn."""
        return self.spread * self.x[0] ** 2 - self.rate**2


def planar(reduced: Reduced) -> tuple[Reduced, Plane] | None:
    """Return the plane in which a free body moves, about a point of it and less a multiple of 1 in B.

    Where B is symmetric, a motion across k may have Omega_k = r y_k + B_ik x_i + B_jk x_j. About the point
    of the plane at (-B_jk, B_ik)/r from there these terms of x are gone. None for any other motion.
    """
    body, _ = solid(reduced.scene)
    centre = symmetric_origin(body)
    middle, start = solid(moved(reduced.scene, centre))
    for i, j, k in CYCLIC:
        if any((start.linear[k], start.angular[i], start.angular[j])):
            continue
        B, r = middle.coupling, middle.angular[k][k]
        rest = dict(zip((i, j, k), (-B[j][k] / r, B[i][k] / r, Fraction(0)), strict=True))
        place = tensors.plus(centre, tuple(rest[n] for n in range(3)))
        inner = about(reduced, place, "the point of its plane where Omega is r y")
        inner = less_coupling(inner, B[k][k])
        flat = plane(inner.scene)
        if flat is not None:
            return inner, flat
    return None


def plane(scene: Scene) -> Plane | None:
    """The plane in which a free body without an axis of symmetry moves about its own origin, or None.

    Decided in rationals: nothing of the start points out of the plane, and nothing of T leads out.
    """
    body, start = solid(scene)
    if not body.is_free or body.axis_of_symmetry is not None:
        return None
    for i, j, k in CYCLIC:
        outside = (start.linear[k], start.angular[i], start.angular[j])
        if not any(outside) and _keeps_to_plane(body, i, j, k):
            swapped = body.linear[i][i] > body.linear[j][j]
            a, b = (j, i) if swapped else (i, j)
            return Plane(
                a=a,
                b=b,
                k=k,
                side=-1 if swapped else 1,
                p=(body.linear[a][a], body.linear[b][b]),
                r=body.angular[k][k],
                x=(start.linear[a], start.linear[b]),
                y=start.angular[k],
            )
    return None


def _keeps_to_plane(body: ImmersedBody, i: int, j: int, k: int) -> bool:
    """Return True if Omega_i = Omega_j = U_k = 0 all over the plane, and U and Omega_k are the legend's."""
    A, B, C = body.linear, body.coupling, body.angular
    in_the_way = (A[i][j], A[i][k], A[j][k], C[i][k], C[j][k], B[k][k])
    return not any(in_the_way) and not any(B[row][n] for row in (i, j) for n in range(3))


def regime(place: Plane) -> str:
    """Return the word for a motion in a plane, decided in rationals.

    - planar-steady: x and y are constant, the body moves straight on or not at all;
    - planar-uniform: p_a = p_b or F = 0, and the body turns at a constant rate;
    - planar-swing: it swings about the position broadside on;
    - planar-turn: it turns over and over;
    - planar-front: exactly between these, it turns once from end on to end on, the other way round.
    """
    if place.omega0_squared == 0:
        return "planar-uniform" if place.rate else "planar-steady"
    if place.rate == 0 and 0 in place.x:
        return "planar-steady"
    if place.lack == 0:
        return "planar-front"
    return "planar-swing" if place.lack > 0 else "planar-turn"


def swing(place: Plane) -> dict[str, mpf]:
    """The period after which x and y recur, where they do, with rate and parameters: a pendulum's.

    A swing takes 4 K of its argument, and so does a turn to bring x back.
    """
    kind = regime(place)
    if kind == "planar-uniform":
        return {"period": 2 * mp.pi / abs(mp.convert(place.rate))}
    if kind in ("planar-steady", "planar-front"):
        return {}
    smaller, larger = sorted((place.h, place.omega0_squared))
    m, m_prime = mp.convert(smaller / larger), mp.convert(abs(place.lack) / larger)
    rate, quarter = mp.sqrt(mp.convert(larger)), mp.pi / (2 * mp.agm(1, mp.sqrt(m_prime)))
    return {"period": 4 * quarter / rate, "rate": rate, "m": m, "m_prime": m_prime}


# The body of revolution that moves alike.


def of_revolution(scene: Scene, place: Plane) -> Scene:
    """The scene with the body of revolution about the axis a whose T has the same p_i, p_j and r."""
    along, across = place.p
    body = ImmersedBody(
        linear=tensors.diagonal(tuple(along if n == place.a else across for n in range(3))),
        coupling=tensors.ZERO_MATRIX,
        angular=tensors.diagonal((place.r,) * 3),
    )
    return replace(scene, body=body)


def in_plane(place: Plane) -> Back:
    """Return the way back from ``of_revolution``, by the zeros that the plane makes, exactly."""

    def back(rows: dict[str, Any], elapsed: Sequence[Time], number: Number) -> None:
        rows["linear_impulse"][:, place.k] = number(Fraction(0))
        rows["angular_impulse"][:, [place.a, place.b]] = number(Fraction(0))

    return back
