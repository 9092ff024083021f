"""Hydromechanics 49 (23)-(25): Clebsch's body moving along its axis, and whether that is stable.

kappa = (p' - p)/r, lambda = (q' - q)/r      y = x3 - F, the depth below the axis: y <= 0 in motion
A = 4 kappa F^2 + 4 lambda F G - G^2, B = 2 kappa F + lambda G, C = kappa
xi = x1 + i x2, eta = y1 + i y2, in which the equations linearised about x = F e3, y = G e3 are
xi' = a xi + b eta, eta' = c xi + d eta
"""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from typing import Final

from taylor_verify.claims.claim import Claim, Verdict, worse
from taylor_verify.claims.field import Element, Field, Point, cross, identity, plus
from taylor_verify.claims.hydromechanics.clebsch import COEFFICIENTS, kinetic_energy, quartic
from taylor_verify.claims.hydromechanics.spins import (
    bounded_tilt,
    half_swings,
    unbounded_tilt,
    whole_swings,
)

_POINT: Final[Point] = {
    **{"F": 7, "G": 3, "y": Fraction(-5, 2), "x1": 2, "x2": 3, "x3": 6, "y1": 1, "y2": -2, "y3": 4},
    **{"p": 3, "pp": 2, "q": Fraction(1, 2), "qq": Fraction(1, 3), "r": 2, "rr": Fraction(5, 4)},
}


class Axial:
    """F, G and y as free symbols, and the equations of motion with their Jacobian on the axis."""

    def __init__(self) -> None:
        self.field = field = Field(_POINT)
        self.i, self.F, self.G, self.y = (field[name] for name in ("i", "F", "G", "y"))
        self.six = self.p, self.pp, self.q, self.qq, self.r, self.rr = tuple(
            field[name] for name in COEFFICIENTS
        )
        self.kappa, self.lam = (self.pp - self.p) / self.r, (self.qq - self.q) / self.r
        self.A = 4 * self.kappa * self.F**2 + 4 * self.lam * self.F * self.G - self.G**2
        self.B, self.C = 2 * self.kappa * self.F + self.lam * self.G, self.kappa
        self.m1 = -(self.p - self.pp) * self.F**2 - 2 * (self.q - self.qq) * self.F * self.G

    def linearised(self) -> tuple[Element, Element, Element, Element]:
        """a, b, c, d; x3 and y3 stand for F and G."""
        field = self.field
        x, y = field.vector("x"), field.vector("y")
        T = kinetic_energy(self.six, x, y)
        U, Omega = ([field.partial(T, f"{v}{k}") for k in (1, 2, 3)] for v in ("x", "y"))
        dx, dy = cross(x, Omega), plus(cross(y, Omega), cross(x, U))
        rows = dx[0] + self.i * dx[1], dy[0] + self.i * dy[1]
        a, b, c, d = (
            field.without(field.partial(row, name), ("x1", "x2", "y1", "y2"))
            for row in rows
            for name in ("x1", "y1")
        )
        return a, b, c, d

    def put_on_axis(self, element: Element) -> Element:
        """The same with x3 = F and y3 = G."""
        return self.field.renamed(element, {"x3": "F", "y3": "G"})


def repeated(s: Axial, sign: int = 1) -> Iterator[Element]:
    """x3 - F divides X3 only if y3 = G; twice only if m1 has its value besides; then (23)."""
    y3, m1 = s.field["y3"], s.field["x1"]  # any symbols
    yield quartic(s, s.F, s.F, s.G, y3, m1) + s.F**2 * (s.G - y3) ** 2
    z = s.F + s.y
    X3 = quartic(s, z, s.F, s.G, s.G, m1)
    slope = s.field.without(s.field.partial(X3 * s.r, "y"), ("y",))
    yield slope + 2 * s.F * (m1 - s.m1)
    above = z + s.F
    bracket = s.kappa * above**2 + sign * 2 * s.lam * s.G * above - s.G**2
    yield quartic(s, z, s.F, s.G, s.G, s.m1) - s.y**2 * bracket


def depth_rate(s: Axial, power: int = 2, factor: int = 2, sign: int = 1) -> Iterator[Element]:
    """(24), (dy/dt)^2 = r^2 X3; the coefficients are A, 2 B and C."""
    left = s.r**2 * quartic(s, s.F + s.y, s.F, s.G, s.G, s.m1)
    inner = factor * (2 * s.kappa * s.F + s.lam * s.G) * s.y + s.kappa * s.y**2
    A = 4 * s.kappa * s.F**2 + sign * 4 * s.lam * s.F * s.G - s.G**2
    yield left - s.r**power * s.y**2 * (A + inner)


def discriminant(s: Axial, sign: int = 1) -> Iterator[Element]:
    """(25) as a stability criterion: (a - d)^2 + 4 b c = r^2 A, and the mean eigenvalue is imaginary."""
    a, b, c, d = map(s.put_on_axis, s.linearised())
    A = 4 * s.kappa * s.F**2 + sign * 4 * s.lam * s.F * s.G - s.G**2
    yield (a - d) ** 2 + 4 * b * c - s.r**2 * A
    turn = s.q * s.F - s.qq * s.F + s.r * s.G / 2 - s.rr * s.G
    yield a + d - 2 * s.i * turn


def squares(s: Axial, factor: int = 4) -> Iterator[Element]:
    """A and B^2 - A C by squares."""
    root = s.kappa + s.lam**2
    yield s.A - (factor * s.F**2 * root - (s.G - 2 * s.lam * s.F) ** 2)
    yield s.B**2 - s.A * s.C - s.G**2 * root


_ROOM: Final = "T of the form (1); the motion x = F e3, y = G e3 along and about the axis, F > 0"
_EXACT: Final = "exact expansion in F, G, y and the six coefficients"
_A: Final = r"A = 4\frac{p' - p}{r}F^2 + 4\frac{q' - q}{r}FG - G^2"

CLAIMS: Final = (
    Claim(
        id="hydromechanics 49 (23)",
        statement=r"y_3 = G,\quad X_3 = (x_3 - F)^2\Big[\frac{p' - p}{r}(x_3 + F)^2 "
        r"+ 2\frac{q' - q}{r}G(x_3 + F) - G^2\Big]",
        domain="T of the form (1); x3 - F a repeated factor of X3; F not zero",
        method=f"X3(F) = -F^2 (G - y3)^2, and its slope there gives m1; {_EXACT}",
        verdict=Verdict.RESTORED,
        lost="the fraction bars",
        check=identity(Axial, repeated),
        mutants={"q - q'": identity(Axial, repeated, sign=-1)},
    ),
    Claim(
        id="hydromechanics 49 (24)",
        statement=r"\Big(\frac{dy}{dt}\Big)^2 = r^2y^2\Big[4\frac{p' - p}{r}F^2 "
        r"+ 4\frac{q' - q}{r}FG - G^2 + 2\Big(2\frac{p' - p}{r}F + \frac{q' - q}{r}G\Big)y "
        r"+ \frac{p' - p}{r}y^2\Big]",
        domain="as in (23); y = x3 - F",
        method=f"(8) with the X3 of (23); {_EXACT}",
        verdict=Verdict.RESTORED,
        lost="the fraction bars",
        check=identity(Axial, depth_rate),
        mutants={
            "r for r^2": identity(Axial, depth_rate, power=1),
            "1 for 2 before the middle term": identity(Axial, depth_rate, factor=1),
        },
    ),
    Claim(
        id="hydromechanics 49 (25)",
        statement=_A,
        domain=f"a definition; {_ROOM}",
        method="consistent: the bracket of (24) at y = 0, and r^2 A is the discriminant of the equations "
        f"linearised about this motion; A = 4 F^2 (kappa + lambda^2) - (G - 2 lambda F)^2; {_EXACT}",
        verdict=Verdict.RESTORED,
        lost="the fraction bars",
        check=lambda: worse(
            identity(Axial, depth_rate)(),
            identity(Axial, discriminant)(),
            identity(Axial, squares)(),
        ),
        mutants={
            "q - q'": identity(Axial, depth_rate, sign=-1),
            "q - q' in the discriminant": identity(Axial, discriminant, sign=-1),
            "2 F^2 (kappa + lambda^2)": identity(Axial, squares, factor=2),
        },
    ),
    Claim(
        id="hydromechanics 49 stable if A is negative",
        statement=r"\text{the stability of this axial movement is secured if } A \text{ is negative}",
        domain=f"{_ROOM}; stable: x and y stay near x = F e3, y = G e3",
        method="the linearised equations have the eigenvalues i(qF - q'F + rG/2 - r'G) +- (r/2) sqrt(A), "
        "by exact expansion, imaginary for A < 0; X3 < 0 on both sides of x3 = F shuts the motion in, "
        "and a trajectory of 60 digits stays within the tilt that the linear equations allow",
        verdict=Verdict.HOLDS,
        check=lambda: worse(
            identity(Axial, discriminant)(), identity(Axial, depth_rate)(), bounded_tilt()
        ),
        mutants={
            "q - q'": identity(Axial, discriminant, sign=-1),
            "a body with A > 0": unbounded_tilt,
        },
        remark="For A > 0 the movement is unstable. For A = 0, of which the text says nothing, (24) has "
        "r^2 y^3 (2B + Cy) on the right, and y <= 0: B < 0 lets the motion go, B > 0 does not.",
    ),
    Claim(
        id="hydromechanics 49 nutations per second",
        statement=r"\text{the axis makes } r\sqrt{-A}/\pi \text{ nutations per second}",
        domain=f"{_ROOM}; A < 0; small tilts; a nutation is a whole one, there and back",
        method="the eigenvalues differ by r sqrt(A), so that x3 has the period 2 pi/(r sqrt(-A)); that "
        "period on a trajectory of 40 digits with a tilt of 10^-8",
        verdict=Verdict.FALSE,
        correction=r"\frac{r\sqrt{-A}}{2\pi} \text{ nutations per second}",
        counterexample="p = 2, p' = 3/2, q = q' = 0, r = 1, r' = 5/4, F = 1, G = 1: A = -3, and x3 "
        "returns after 2 pi/sqrt(3) = 3.63, in which the text counts two. It counts half-swings",
        check=lambda: worse(identity(Axial, discriminant)(), whole_swings()),
        transcribed=half_swings,
        mutants={"r sqrt(-A)/pi": half_swings},
    ),
)
