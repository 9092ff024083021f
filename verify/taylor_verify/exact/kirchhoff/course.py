"""x3 along one nutating motion of Clebsch's body by Weierstrass's functions, in balls.

Legend: z = x3 as a function of the time u since the start, z'^2 = f(z) = a0 z^4 + 4 a1 z^3 + 6 a2 z^2 +
4 a3 z + a4, and about the start z_b, with X = z - z_b, f = a0 X^4 + 4 b1 X^3 + 6 b2 X^2 + 4 b3 X + b4; all
of these are rational. p is Weierstrass's function of the invariants of f; s(u) is that of lattice, and
Z = s'/s. A motion is a walk on the curve of the points (z, z'); the argument of a point is its u.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from fractions import Fraction
from typing import NamedTuple, Self, final

from flint import acb, arb

from taylor_verify.exact.balls import ball
from taylor_verify.exact.kirchhoff.quartic import (
    Nutation,
    Polynomial,
    derivative,
    invariants,
    value,
)
from taylor_verify.exact.lattice import Lattice, lattice
from taylor_verify.exact.line import Line


class Pole(NamedTuple):
    """N(u) = s(u - w)/s(-w) at a pole w of z, |N|^2, and, where it was asked for, N'(u)."""

    value: acb
    square: arb
    slope: acb | None = None

    @classmethod
    def of(cls, jet: Sequence[acb]) -> Self:
        """Return the pole of N and, if it is there, N'."""
        re, im = jet[0].real, jet[0].imag
        return cls(jet[0], re * re + im * im, *jet[1:])

    @property
    def rate(self) -> arb:
        """The real part of N'/N: real numbers cost a third of a division of complex ones."""
        assert self.slope is not None
        value, slope = self.value, self.slope
        return (value.real * slope.real + value.imag * slope.imag) / self.square


class Course(ABC):
    """z(u), z'(u) and their integrals, with numbers of one precision and to be used at that one.

    ``poles`` are the arguments of the poles of z, each of order ``order``, those at a double point
    left out. ``are_conjugate`` says that there are two, and that so also are the quotients N of both: then
    the first one alone is asked for.
    """

    poles: tuple[acb, ...]
    order: int = 1
    front: Front | None = None
    are_conjugate: bool = False

    def __init__(self, nutation: Nutation) -> None:
        b = _about(nutation.f, nutation.z)
        self._b = [ball(entry) for entry in b]
        # Products of rationals, so that what is zero is zero exactly.
        self._half_b2, self._twice_b3 = ball(b[2] / 2), ball(2 * b[3])
        self._half_b4_a0, self._b4_b1 = ball(b[4] * b[0] / 2), ball(b[4] * b[1])
        g2, g3 = invariants(nutation.f)
        self.lattice: Lattice = lattice(g2, g3)
        self._half_g2 = ball(g2 / 2)
        self.z, self.speed = ball(nutation.z), ball(nutation.speed)

    @final
    def places(self, times: Sequence[arb], line: Line) -> list[tuple[arb, arb]]:
        """(z, z') at the times u since the start, which are those of the line."""
        if self.front is not None:
            return [self.front.at(u) for u in times]
        return [self._at(*both) for both in line.p()]

    def _at(self, p: arb, slope: arb) -> tuple[arb, arb]:
        """(z, z') by Weierstrass's formula (Whittaker and Watson 20.6), for u not zero."""
        rise, twice_b3 = p - self._half_b2, self._twice_b3
        twice = rise + rise
        over = 1 / (twice * rise - self._half_b4_a0)
        step = (twice_b3 * rise + self._b4_b1 - self.speed * slope) * over
        change = twice_b3 * slope - self.speed * (6 * (p * p) - self._half_g2)
        return self.z + step, (change - 2 * (step * twice * slope)) * over

    @final
    def argument(self, h: arb, s: acb) -> acb:
        """The u where (z, z') = (h, s), a point of the curve that is neither the start nor double."""
        a0, b1, b2, b3, b4 = self._b
        X, both = h - self.z, s * self.speed
        slope = 2 * a0 * X**3 + 6 * b1 * X**2 + 6 * b2 * X + 2 * b3
        return self.lattice.argument(
            (both + b4) / (2 * X**2) + b3 / X + b2 / 2,
            slope * self.speed / (2 * X**2) - (both + b4) * s / X**3 - b3 * s / X**2,
        )

    @abstractmethod
    def integral(self, u: arb, speed: arb, poles: Sequence[Pole]) -> arb:
        """int_0^u z du, where z' = ``speed`` at u; the poles of a cubic have their slopes."""


@final
class Front:
    """z where f is a square: z' = c (F^2 - z^2), so that F +- z are as p e^{c F u} and m e^{-c F u}.

    Weierstrass's formula becomes 0/0 on the way to the pole, where z is all but F.
    """

    def __init__(self, nutation: Nutation) -> None:
        root = ball(nutation.f[0]).sqrt()
        self.c = root if nutation.speed > 0 else -root
        self._F = ball(nutation.F2).sqrt()
        self._up, self._down = self._F + ball(nutation.z), self._F - ball(nutation.z)

    def at(self, u: arb) -> tuple[arb, arb]:
        """(z, z') at the time u."""
        growth = (self.c * self._F * u).exp()
        up, down = self._up * growth, self._down / growth
        both = up + down
        return self._F * (up - down) / both, 4 * self.c * self._F * self._F * up * down / both**2


def course(nutation: Nutation, heteroclinic: bool) -> Course:
    """The course of a motion whose x3 varies; ``heteroclinic`` if f is a square."""
    degree = len(nutation.f) - 1
    if degree == 4:
        return QuarticCourse(nutation, heteroclinic)
    return CubicCourse(nutation) if degree == 3 else QuadraticCourse(nutation)


@final
class QuarticCourse(Course):
    """z has two poles, w+ and w-, and is as -1/(sqrt(a0) (u - w+)) and 1/(sqrt(a0) (u - w-)) there.

    Where f is a square z has only one of them, and the other lies in a double point.
    """

    def __init__(self, nutation: Nutation, heteroclinic: bool) -> None:
        super().__init__(nutation)
        a0, a1 = nutation.f[0], nutation.f[1] / 4
        self._a0, self._slant = ball(a0), ball(2 * a1 / a0)
        self._size = ball(abs(a0)).sqrt()
        self._root = acb(self._size) if a0 > 0 else acb(0, self._size)
        self._signs: tuple[int, ...] = (1, -1)
        if heteroclinic:
            self.front = Front(nutation)
            self._signs = (-1,) if nutation.speed > 0 else (1,)
        upper = [self._pole(sign) for sign in self._signs]
        if a0 < 0:
            upper[1] = upper[0].conjugate()  # z is real
            self.are_conjugate = True
        self.poles = tuple(upper)
        jets = [self.lattice.jet(-w, order=2) for w in self.poles]
        slopes = [s1 / s0 for s0, s1, _ in jets]
        bends = [s2 / s0 - (s1 / s0) ** 2 for s0, s1, s2 in jets]
        self._start_slopes = sum(slopes, acb(0)).real
        change = sum((sign * Z for sign, Z in zip(self._signs, slopes, strict=True)), acb(0))
        self._pace = self.z + (change / self._root).real
        self._square_pace = self.z**2 + sum(bends, acb(0)).real / self._a0 + self._slant * self.z

    def integral(self, u: arb, speed: arb, poles: Sequence[Pole]) -> arb:
        """Found from the logarithms of N, whose arguments are followed continuously."""
        if self.are_conjugate:
            grown = 2 * self.lattice.turn(u, self.poles[0], poles[0].value)
        elif len(poles) == 2:
            # One logarithm, of the square of a quotient.
            grown = (poles[0].square / poles[1].square).log() / 2
        else:
            grown = self._signs[0] * poles[0].square.log() / 2
        return self._pace * u - grown / self._size

    def integral_of_square(self, u: arb, poles: Sequence[Pole], integral: arb) -> arb:
        """int_0^u z^2 du from N and N', where ``integral`` is int_0^u z du.

        The latter is not read where f has no cubic term.
        """
        rate = sum((pole.rate for pole in poles), arb(0))
        change = (2 * rate if self.are_conjugate else rate) - self._start_slopes
        tilted = arb(0) if self._slant.is_zero() else self._slant * integral
        return self._square_pace * u - change / self._a0 - tilted

    def _pole(self, sign: int) -> acb:
        _, b1, b2, b3, _ = self._b
        root = sign * self._root
        return self.lattice.argument(root * self.speed / 2 + b2 / 2, -self.speed * b1 - b3 * root)


@final
class CubicCourse(Course):
    """z has one double pole w: z = -Z'(u - w)/a1 + a constant."""

    def __init__(self, nutation: Nutation) -> None:
        super().__init__(nutation)
        self.order = 2
        self._a1 = ball(nutation.f[0] / 4)
        _, b1, b2, _, _ = self._b
        self.poles = (self.lattice.argument(acb(b2 / 2), acb(-self.speed * b1)),)
        s0, s1, s2 = self.lattice.jet(-self.poles[0], order=2)
        self._start_slope = (s1 / s0).real
        self._pace = self.z + (s2 / s0 - (s1 / s0) ** 2).real / self._a1

    def integral(self, u: arb, speed: arb, poles: Sequence[Pole]) -> arb:
        return self._pace * u - (poles[0].rate - self._start_slope) / self._a1


@final
class QuadraticCourse(Course):
    """z is an entire function, and f = c2 z^2 + c1 z + c0 gives z'' = c2 z + c1/2."""

    poles = ()

    def __init__(self, nutation: Nutation) -> None:
        super().__init__(nutation)
        self._c2, self._half_c1 = ball(nutation.f[0]), ball(nutation.f[1] / 2)

    def integral(self, u: arb, speed: arb, poles: Sequence[Pole]) -> arb:
        return (speed - self.speed - self._half_c1 * u) / self._c2


def _about(f: Polynomial, z: Fraction) -> tuple[Fraction, ...]:
    """(a0, b1, b2, b3, b4) of f about z, by Taylor's formula."""
    coefficients: list[Fraction] = []
    for divisor in (1, 4, 12, 24, 24):
        coefficients.append(value(f, z) / divisor)
        f = derivative(f)
    return tuple(reversed(coefficients))
