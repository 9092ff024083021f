"""Weierstrass's p and p' at any point of the curve on which the momentum of a gyrostat moves.

Legend: as in pencil; G is a point of the curve, real or complex, and d = G - G(0). Four points of the
curve lie in one plane if their arguments t have one fixed sum. The plane nu.d = 0 that osculates the orbit
at the start meets the curve there three times, and once at an argument c: the sum is c. A plane mu.d = 0
through the start and through c meets it at two more points, t and -t, where p is equal. So p is a linear
function of mu.d/nu.d. The line through 0 and c is rational: it lies on that quadric of the pencil, of
K - s, that holds the tangent of the start. Where c is 0 it is the tangent.

Where that quadric is a pair of planes the orbit is a circle, nu.d is 0 on all of it, and p has a double
root e. With k^2 = 3 e, k coth(k t) is there a linear function of a quotient of two planes.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, Self, final

from taylor_verify.exact.gyrostat.pencil import FreeGyrostat
from taylor_verify.numbers import tensors
from taylor_verify.numbers.rotation import scalar_product
from taylor_verify.numbers.tensors import Vector, cross, dot

Convert = Callable[[Fraction], Any]


@dataclass(frozen=True)
class PointMap(ABC):
    """p and p' as functions of the point, in one arithmetic; ``ratio`` is that of the planes mu and nu."""

    start: Sequence[Any]
    mu: Sequence[Any]
    nu: Sequence[Any]
    scale: Any
    constant: Any
    double_root: Any

    @abstractmethod
    def at(self, point: Sequence[Any], rate: Sequence[Any]) -> tuple[Any, Any]:
        """(p, p') at the point G with its rate G'."""

    @final
    def converted(self, convert: Convert) -> Self:
        """Return the same map in another arithmetic."""
        planes = ([convert(c) for c in v] for v in (self.start, self.mu, self.nu))
        return type(self)(*planes, *map(convert, (self.scale, self.constant, self.double_root)))


@final
class ByPlanes(PointMap):
    """p = scale mu.d/nu.d + constant."""

    def at(self, point: Sequence[Any], rate: Sequence[Any]) -> tuple[Any, Any]:
        d = [p - q for p, q in zip(point, self.start, strict=True)]
        below = scalar_product(self.nu, d)
        ratio = scalar_product(self.mu, d) / below
        slope = (scalar_product(self.mu, rate) - ratio * scalar_product(self.nu, rate)) / below
        return self.scale * ratio + self.constant, self.scale * slope


@final
class OnCircle(PointMap):
    """c = scale mu.d/nu.d + constant is k coth(k t): p = c^2 - 2 e, and c' = 3 e - c^2."""

    def at(self, point: Sequence[Any], rate: Sequence[Any]) -> tuple[Any, Any]:
        d = [p - q for p, q in zip(point, self.start, strict=True)]
        c = self.scale * scalar_product(self.mu, d) / scalar_product(self.nu, d) + self.constant
        return c * c - 2 * self.double_root, 2 * c * (3 * self.double_root - c * c)


def point_map(free: FreeGyrostat) -> PointMap:
    """Return p and p' by the point of a motion that is not steady, in exact numbers."""
    G1, osculating = free.jet[1], free.osculating_plane
    if free.is_circle:
        # Two planes through the start, the second one through its tangent.
        mu, nu = G1, cross(G1, osculating)
        first, constant, _ = _quotient(free, mu, nu)
        return OnCircle(free.momentum, mu, nu, 1 / first, -constant / first, free.double_root)
    mu = cross(_line(free), osculating)
    first, _, constant = _quotient(free, mu, osculating)
    return ByPlanes(free.momentum, mu, osculating, 1 / first, -constant / first, free.double_root)


def _line(free: FreeGyrostat) -> Vector:
    """The other direction a of the osculating plane with a.(K - s) a = 0; the tangent if there is none."""
    G1 = free.jet[1]
    across = cross(free.osculating_plane, G1)
    image = tensors.minus(tensors.apply(free.K, across), tensors.scaled(free.tangent_value, across))
    return tensors.minus(
        tensors.scaled(2 * dot(G1, image), across), tensors.scaled(dot(across, image), G1)
    )


def _quotient(free: FreeGyrostat, mu: Vector, nu: Vector) -> tuple[Fraction, ...]:
    """The first three coefficients of mu.d/nu.d in powers of t, from the first that is not zero."""
    a, b = (_stripped([dot(plane, c) for c in free.jet[1:]]) for plane in (mu, nu))
    terms: list[Fraction] = []
    for k in range(3):
        products = sum((b[k - j] * terms[j] for j in range(k)), Fraction(0))
        terms.append((a[k] - products) / b[0])
    return tuple(terms)


def _stripped(series: Sequence[Fraction]) -> Sequence[Fraction]:
    """The series from its first coefficient that is not zero."""
    return series[next(k for k, c in enumerate(series) if c) :]
