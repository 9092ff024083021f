"""The polynomial of x3 in Clebsch's body, z'^2 = f(z), in exact rationals.

Legend, Hydromechanics 49: z = x3, F^2 = x.x and FG = x.y; p, p', q, q', r, r' are the
coefficients of T, f = r^2 X3. A polynomial is a tuple of Fractions, the highest power first.

About an axis n of another length than 1, nu = n.n, all of this is of sqrt(nu) x and sqrt(nu) y and of the
coefficients over sqrt(nu) (axis_of_revolution.py): z = n.x, and F^2, FG and m1 are nu times as large.
"""

from __future__ import annotations

from dataclasses import astuple, dataclass, replace
from fractions import Fraction
from functools import cached_property
from typing import Any

from taylor_verify.exact.kirchhoff.axis_of_revolution import UPRIGHT, Axes, body_about
from taylor_verify.numbers import tensors
from taylor_verify.numbers.irrational import Irrational
from taylor_verify.numbers.tensors import dot
from taylor_verify.scenes.bodies import Clebsch, ImmersedBody
from taylor_verify.scenes.motion import Impulse

Polynomial = tuple[Fraction, ...]


@dataclass(frozen=True)
class Nutation:
    """The constants of one motion of Clebsch's body, and the polynomial f that they make.

    ``z`` and ``speed`` are x3 and dx3/dt at the start; ``m1`` is that of Hydromechanics 49 (7).
    ``weight`` s is that of a heavy top, which has s x3 in T; it enters f alone.
    """

    body: Clebsch
    z: Fraction
    speed: Fraction
    F2: Fraction
    FG: Fraction
    y3: Fraction
    m1: Fraction
    axes: Axes = UPRIGHT
    weight: Fraction = Fraction(0)

    @classmethod
    def of(
        cls,
        body: Clebsch,
        start: Impulse,
        axes: Axes = UPRIGHT,
        weight: Fraction = Fraction(0),
    ) -> Nutation:
        """The constants from the initial state; m1 from r (y1^2 + y2^2) at the start."""
        x, y, nu = start.linear, start.angular, axes.nu
        z, y3 = dot(axes.n, x), dot(axes.n, y)
        linear, screw = body.p - body.p_prime, body.q - body.q_prime
        return cls(
            body=body,
            z=z,
            speed=body.r * dot(axes.n, tensors.cross(x, y)),
            F2=nu * dot(x, x),
            FG=nu * dot(x, y),
            y3=y3,
            m1=body.r * (nu * dot(y, y) - y3**2) - linear * z**2 - 2 * (screw * y3 - weight) * z,
            axes=axes,
            weight=weight,
        )

    @cached_property
    def f(self) -> Polynomial:
        """f(z) = r (F^2 - z^2) [(p-p') z^2 + 2 ((q-q') y3 - s) z + m1] - r^2 (FG - y3 z)^2."""
        r, F2, FG, y3, m1 = self.body.r, self.F2, self.FG, self.y3, self.m1
        linear = self.body.p - self.body.p_prime
        screw = 2 * ((self.body.q - self.body.q_prime) * y3 - self.weight)
        of_body = (
            -r * linear,
            -r * screw,
            r * (F2 * linear - m1) - (r * y3) ** 2,
            r * F2 * screw + 2 * r**2 * FG * y3,
            r * F2 * m1 - (r * FG) ** 2,
        )
        return stripped(tensors.scaled(1 / self.axes.nu, of_body))

    @cached_property
    def invariants(self) -> tuple[Fraction, Fraction]:
        """g2 and g3 of f: long products where the constants are irrational."""
        return invariants(self.f)

    @cached_property
    def solid(self) -> ImmersedBody:
        """The body in the axes of the scene."""
        return body_about(self.body, self.axes.n)

    @cached_property
    def turn_rate(self) -> Fraction:
        """The rate at which (x1, x2) turns about axis 3 at the start; zero where it vanishes.

        If all of x is zero, the rate at which (y1, y2) does. In multiples of n: its rate over sqrt(nu).
        """
        body, z, nu = self.body, self.z, self.axes.nu
        if self.F2 == 0:
            return (body.r - body.r_prime) * self.y3 / nu
        if self.is_axial:
            return Fraction(0)
        pull = body.r * (self.FG * z - self.F2 * self.y3) / (self.F2 - z**2)
        return ((body.r - body.r_prime) * self.y3 - (body.q_prime - body.q) * z + pull) / nu

    def near(self, bits: int) -> Nutation:
        """Return the constants with rationals near the irrational ones, to so many bits."""

        def rational(value: Fraction) -> Fraction:
            return value.near(bits) if isinstance(value, Irrational) else value

        of_body = Clebsch(*map(rational, astuple(self.body)))
        names = ("z", "speed", "F2", "FG", "y3", "m1", "weight")
        constants: dict[str, Any] = {name: rational(getattr(self, name)) for name in names}
        return replace(self, body=of_body, **constants)

    @property
    def is_axial(self) -> bool:
        """True if x is along axis 3 at the start."""
        return self.F2 == self.z**2

    def drift(self, z: Fraction) -> Fraction:
        """r F Z' where x3 = z, with Z the way of the centre along F: Hydromechanics 49 (20)."""
        body = self.body
        steady = body.p * self.F2 + body.q * self.FG
        screw = (body.q_prime - body.q) * self.y3
        return body.r * (steady + (body.p_prime - body.p) * z**2 + screw * z) / self.axes.nu

    def touches_pole(self, side: int) -> bool:
        """Return True if f vanishes at x3 = F (side 1) or x3 = -F (side -1), that is G = side y3."""
        same_size = self.F2 * self.y3**2 == self.FG**2
        return same_size and side * self.FG * self.y3 >= 0


def stripped(polynomial: Polynomial) -> Polynomial:
    """Return the polynomial without leading zeros; () is the zero polynomial."""
    for k, coefficient in enumerate(polynomial):
        if coefficient != 0:
            return polynomial[k:]
    return ()


def value(polynomial: Polynomial, z: Fraction) -> Fraction:
    total = Fraction(0)
    for coefficient in polynomial:
        total = total * z + coefficient
    return total


def derivative(polynomial: Polynomial) -> Polynomial:
    degree = len(polynomial) - 1
    return tuple((degree - k) * c for k, c in enumerate(polynomial[:-1]))


def invariants(polynomial: Polynomial) -> tuple[Fraction, Fraction]:
    """g2 and g3 of a quartic, or of a polynomial of lower degree as one; a translation leaves them."""
    a0, a1, a2, a3, a4 = (Fraction(0),) * (5 - len(polynomial)) + polynomial
    a1, a2, a3 = a1 / 4, a2 / 6, a3 / 4
    g2 = a0 * a4 - 4 * a1 * a3 + 3 * a2**2
    g3 = a0 * a2 * a4 + 2 * a1 * a2 * a3 - a2**3 - a0 * a3**2 - a1**2 * a4
    return g2, g3


def repeated_root(polynomial: Polynomial) -> Fraction | None:
    """The one root that is repeated, which is rational; None if there is none, or more than one."""
    # The greatest common divisor of f and f': (z - d)^n up to a factor, if d is the only one.
    common, rest = polynomial, derivative(polynomial)
    while rest:
        # A factor keeps the numbers short.
        rest = tensors.scaled(1 / rest[0], rest)
        common, rest = rest, _remainder(common, rest)
    times = len(common) - 1
    if times == 0:
        return None
    root = -common[1] / times
    while len(common) > 1:
        if value(common, root) != 0:
            return None
        common = derivative(common)
    return root


def _remainder(a: Polynomial, b: Polynomial) -> Polynomial:
    """The remainder of a division by a polynomial that begins with 1."""
    rest = list(a)
    while len(rest) >= len(b):
        first = rest[0]
        rest = [c - first * d for c, d in zip(rest, b + (Fraction(0),) * len(rest), strict=False)]
        del rest[0]
    return stripped(tuple(rest))
