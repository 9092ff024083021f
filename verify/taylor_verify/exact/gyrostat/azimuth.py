"""The azimuth of a body axis about the momentum of a gyrostat: its rate, and the poles of that rate.

Legend: as in pencil; (a, b, c) is a right-handed orthonormal frame of the body, f = a + i b, N = |G|. With

    M = [m1 m2 m3],    m3 = G/N,    m1 along c - (c.m3) m3,    m2 = m3 x m1,
    R(t) = R(0) M(0) Rz(phi(t)) M(t)^T,    phi' = N (G.w - (G.c)(w.c))/(N^2 - (G.c)^2),    phi(0) = 0.

As a function of complex t, phi' has a pole with the residue sigma/2i, sigma = 1 or -1, where the point
G = sigma N c + rho f is on the curve, and another one where G is its conjugate.
"""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from typing import Any, Final, NamedTuple

from flint import acb, arb

from taylor_verify.exact.balls import balls
from taylor_verify.exact.gyrostat.curve_point import PointMap
from taylor_verify.exact.gyrostat.pencil import FreeGyrostat
from taylor_verify.numbers import tensors
from taylor_verify.numbers.irrational import ball
from taylor_verify.numbers.rotation import rotation_matrix, scalar_product
from taylor_verify.numbers.tensors import Vector, cross, dot


class Pole(NamedTuple):
    """A pole of phi': sigma, and Weierstrass's p and p' of its argument."""

    sigma: int
    p: acb
    slope: acb


class Frame(NamedTuple):
    """Three axes of the body, c the one whose azimuth is followed."""

    a: Vector
    b: Vector
    c: Vector


def _frames() -> Iterator[tuple[Frame, Frame, Frame]]:
    """Three rational frames of each attitude: the momentum may pass the axes of one, and not all."""
    for quaternion in ((1, 0, 0, 0), (3, 1, 1, 1), (4, 3, -2, 1)):
        scalar, *vector = map(Fraction, quaternion)
        x, y, z = rotation_matrix((scalar, vector[0], vector[1], vector[2]))
        yield Frame(x, y, z), Frame(y, z, x), Frame(z, x, y)


FRAMES: Final = tuple(_frames())


def poles(free: FreeGyrostat, place: PointMap, frame: Frame) -> list[Pole]:
    """Return one pole of each pair of conjugates; ZeroDivisionError for a frame that has too few.

    ``place`` is the point map of the motion in balls.
    """
    a, b, c = map(balls, frame)
    K, g = [balls(row) for row in free.K], balls(free.g)
    N = ball(free.n).sqrt()
    f = [acb(p, q) for p, q in zip(a, b, strict=True)]
    result = []
    for sigma in (1, -1):
        for rho in _feet(free, frame, sigma, N):
            point: list[Any] = [sigma * N * p + rho * q for p, q in zip(c, f, strict=True)]
            omega = [scalar_product(row, point) - entry for row, entry in zip(K, g, strict=True)]
            result.append(Pole(sigma, *place.at(point, cross(point, omega))))
    return result


def _feet(free: FreeGyrostat, frame: Frame, sigma: int, N: arb) -> list[acb]:
    """Return all rho for which sigma N c + rho f is a point of the orbit's curve."""

    def along_f(vector: Vector) -> acb:
        return acb(ball(dot(vector, frame.a)), ball(dot(vector, frame.b)))

    if free.is_circle:
        nu = free.osculating_plane
        away = ball(dot(nu, free.momentum)) - sigma * N * ball(dot(nu, frame.c))
        return [away / along_f(nu)]
    images = [tensors.apply(free.K, axis) for axis in frame]
    K_a, K_b, K_c = images
    lead = acb(ball(dot(frame.a, K_a) - dot(frame.b, K_b)), ball(2 * dot(frame.a, K_b)))
    half = sigma * N * along_f(K_c) - along_f(free.g)
    last = ball(free.n * dot(frame.c, K_c) - free.E) - 2 * sigma * N * ball(dot(free.g, frame.c))
    root = (half * half - lead * last).sqrt()
    # The smaller rho from the product of both: where lead is small it would be a difference.
    larger = half + root if abs(half + root) > abs(half - root) else half - root
    return [-larger / lead, -last / larger]


def rate_at_start(free: FreeGyrostat, c: Vector, N: arb) -> arb:
    """phi' at the start: N times a rational number."""
    G, w = free.momentum, free.omega
    return N * ball((dot(G, w) - dot(G, c) * dot(w, c)) / (free.n - dot(G, c) ** 2))
