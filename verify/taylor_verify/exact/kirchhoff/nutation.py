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

from taylor_verify.exact.kirchhoff.quartic import (
    Nutation,
    Polynomial,
    derivative,
    value,
)
from taylor_verify.exact.lattice import Lattice, lattice
from taylor_verify.numbers.irrational import ball


class Pole(NamedTuple):
    """N(u) = s(u - w)/s(-w) at many times, for a pole w of z: N, |N|^2 and the real parts of N'/N.

    Without derivatives there are no ``rates``.
    """

    values: list[acb]
    squares: list[arb]
    rates: list[arb]

    @classmethod
    def of(cls, values: list[acb], slopes: Sequence[acb] = ()) -> Self:
        """Return the pole of values N and derivatives N'."""
        parts = [(value.real, value.imag) for value in values]
        squares = [x * x + y * y for x, y in parts]
        # Real numbers cost a third of a division of complex ones.
        rates = [
            (x * slope.real + y * slope.imag) / square
            for (x, y), square, slope in zip(parts, squares, slopes, strict=False)
        ]
        return cls(values, squares, rates)


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
        g2, g3 = nutation.invariants
        self.lattice: Lattice = lattice(g2, g3)
        self._half_g2 = ball(g2 / 2)
        self.z, self.speed = ball(nutation.z), ball(nutation.speed)

    @final
    def places(self, times: Sequence[arb]) -> list[tuple[arb, arb]]:
        """(z, z') at the times u since the start."""
        if self.front is not None:
            return [self.front.at(u) for u in times]
        return [self._at(*self.lattice.real(u)) for u in times]

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
    def integrals(
        self, times: Sequence[arb], speeds: Sequence[arb], poles: Sequence[Pole]
    ) -> list[arb]:
        """int_0^u z du at each time u, where z' is its speed; the poles of a cubic have their rates."""


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

    def integrals(
        self, times: Sequence[arb], speeds: Sequence[arb], poles: Sequence[Pole]
    ) -> list[arb]:
        """Found from the logarithms of N, whose arguments are followed continuously."""
        pace, twice = self._pace, 2 / self._size
        if self.are_conjugate:
            turn, w = self.lattice.turn, self.poles[0]
            grown = [turn(u, w, N) for u, N in zip(times, poles[0].values, strict=True)]
            return [pace * u - twice * angle for u, angle in zip(times, grown, strict=True)]
        # One logarithm, of the square of a quotient.
        squares: Sequence[arb] = poles[0].squares
        if len(poles) == 2:
            squares = [p / q for p, q in zip(squares, poles[1].squares, strict=True)]
        part = self._signs[0] * twice / 4
        return [pace * u - part * square.log() for u, square in zip(times, squares, strict=True)]

    def integrals_of_square(
        self, times: Sequence[arb], poles: Sequence[Pole], integrals: Sequence[arb]
    ) -> list[arb]:
        """int_0^u z^2 du at each time u from N and N', where ``integrals`` are int_0^u z du.

        The latter are not read where f has no cubic term.
        """
        pace, part = self._square_pace, 1 / self._a0
        rates: Sequence[arb] = poles[0].rates
        if self.are_conjugate:
            rates = [2 * rate for rate in rates]
        elif len(poles) == 2:
            rates = [p + q for p, q in zip(rates, poles[1].rates, strict=True)]
        start = self._start_slopes
        squares = [pace * u - (p - start) * part for u, p in zip(times, rates, strict=True)]
        if self._slant.is_zero():
            return squares
        return [square - self._slant * z for square, z in zip(squares, integrals, strict=True)]

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

    def integrals(
        self, times: Sequence[arb], speeds: Sequence[arb], poles: Sequence[Pole]
    ) -> list[arb]:
        pace, start, part = self._pace, self._start_slope, 1 / self._a1
        return [
            pace * u - (rate - start) * part for u, rate in zip(times, poles[0].rates, strict=True)
        ]


@final
class QuadraticCourse(Course):
    """z is an entire function, and f = c2 z^2 + c1 z + c0 gives z'' = c2 z + c1/2."""

    poles = ()

    def __init__(self, nutation: Nutation) -> None:
        super().__init__(nutation)
        self._c2, self._half_c1 = ball(nutation.f[0]), ball(nutation.f[1] / 2)

    def integrals(
        self, times: Sequence[arb], speeds: Sequence[arb], poles: Sequence[Pole]
    ) -> list[arb]:
        part, start, half_c1 = 1 / self._c2, self.speed, self._half_c1
        return [
            (speed - start - half_c1 * u) * part for u, speed in zip(times, speeds, strict=True)
        ]


def _about(f: Polynomial, z: Fraction) -> tuple[Fraction, ...]:
    """(a0, b1, b2, b3, b4) of f about z, by Taylor's formula."""
    coefficients: list[Fraction] = []
    for divisor in (1, 4, 12, 24, 24):
        coefficients.append(value(f, z) / divisor)
        f = derivative(f)
    return tuple(reversed(coefficients))
