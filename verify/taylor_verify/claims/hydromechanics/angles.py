"""Hydromechanics 49 (14)-(17): Euler's angles of Clebsch's body, the axis of space along F.

theta, phi, psi   R = Rz(psi) Rx(theta) Rz(phi), so that R x is along the third axis of space
st ct sf cf sp cp their sines and cosines: the cosines are roots, ct^2 = 1 - st^2
dtheta ...        their rates, free symbols: the angular velocity follows from R' = R [Omega]x
"""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from functools import partial
from typing import Any, Final

from taylor_verify.claims.claim import Claim, Verdict, worse
from taylor_verify.claims.field import Element, Field, Point, dot, identity, minus, transposed
from taylor_verify.claims.hydromechanics.clebsch import POINT_TEXT, ClebschBody
from taylor_verify.claims.hydromechanics.quadratures import angle_advance

_ANGLES: Final = ("theta", "phi", "psi")
# Sines of Pythagorean angles, so that the cosines are rational too.
_POINT: Final[Point] = {
    **{"s_theta": Fraction(4, 5), "s_phi": Fraction(5, 13), "s_psi": Fraction(8, 17)},
    **{"c_theta": Fraction(3, 5), "c_phi": Fraction(12, 13), "c_psi": Fraction(15, 17)},
    **{"d_theta": Fraction(1, 2), "d_phi": Fraction(2, 3), "d_psi": Fraction(7, 4)},
    **{"F": 7, "y1": 1, "y2": -2, "y3": 4, "q": Fraction(1, 2), "r": 2},
}
_ANGLE_TEXT: Final = "sin theta = 4/5, sin phi = 5/13, sin psi = 8/17, all in the first quadrant"


class Angles:
    """Symbols of a body whose impulse x has the direction of the third axis of space."""

    def __init__(self) -> None:
        roots = {f"c_{a}": partial(_cosine_squared, f"s_{a}") for a in _ANGLES}
        self.field = field = Field(_POINT, roots)
        self.i, self.F = field["i"], field["F"]
        self.s, self.c, self.d = (
            {a: field[f"{letter}_{a}"] for a in _ANGLES} for letter in ("s", "c", "d")
        )
        turned = {f"s_{a}": self.c[a] * self.d[a] for a in _ANGLES}
        field.turn(turned | {f"c_{a}": -1 * self.s[a] * self.d[a] for a in _ANGLES})
        about_z = partial(_about, 2)
        self.R = _product(
            _product(
                about_z(self.s["psi"], self.c["psi"]),
                _about(0, self.s["theta"], self.c["theta"]),
            ),
            about_z(self.s["phi"], self.c["phi"]),
        )
        self.x = [self.F * entry for entry in self.R[2]]
        spin = _product(transposed(self.R), [field.rates(row) for row in self.R])
        self.Omega = [spin[2][1], spin[0][2], spin[1][0]]
        self.y = field.vector("y")


def _cosine_squared(sine: str, field: Field) -> Element:
    return 1 - field[sine] ** 2


def _about(axis: int, s: Element, c: Element) -> list[list[Any]]:
    """The rotation about one axis."""
    j, k = (axis + 1) % 3, (axis + 2) % 3
    matrix: list[list[Any]] = [[int(a == b) for b in range(3)] for a in range(3)]
    matrix[j][j], matrix[k][k], matrix[j][k], matrix[k][j] = c, c, -s, s
    return matrix


def _product(a: list[list[Any]], b: list[list[Any]]) -> list[list[Any]]:
    return [[dot(row, column) for column in transposed(b)] for row in a]


def components(a: Angles, angle: str = "phi") -> Iterator[Element]:
    """(14), all four equations; ``angle`` is that of the exponential."""
    s, c, F = a.s, a.c, a.F
    real = [F * s["theta"] * s["phi"], F * s["theta"] * c["phi"], F * c["theta"]]
    yield from minus(a.x, real)
    exponential = c[angle] - a.i * s[angle]
    yield a.x[0] + a.i * a.x[1] - a.i * F * s["theta"] * exponential


def precession(a: Angles, sign: int = 1) -> Iterator[Element]:
    """(15)."""
    P, Q, _ = a.Omega
    yield a.s["theta"] * a.d["psi"] - (P * a.s["phi"] + sign * Q * a.c["phi"])


def precession_by_energy(a: Angles, sign: int = 1, factor: int = 1) -> Iterator[Element]:
    """(16): the first member for any Omega, the others with dT/dy_k = q x_k + r y_k."""
    (x1, x2, x3), (y1, y2, y3) = a.x, a.y
    q, r = a.field["q"], a.field["r"]
    sine2 = a.s["theta"] ** 2
    yield a.F * sine2 * a.d["psi"] - (a.Omega[0] * x1 + sign * a.Omega[1] * x2)
    second = (q * x1 + r * y1) * x1 + (q * x2 + r * y2) * x2
    yield second - (q * (x1**2 + x2**2) + r * (x1 * y1 + x2 * y2))
    yield second - (factor * q * a.F**2 * sine2 + r * (dot(a.x, a.y) - x3 * y3))


def advance(b: ClebschBody, power: int = 0, sign: int = 1) -> Iterator[Element]:
    """(17), differentiated: psi' by (16), and dx3 = r sqrt(X3) dt by (3) and (9).

    ``power`` is that of the factor r before dx3.
    """
    x1, x2, x3 = b.x
    across = b.F**2 - x3**2
    psi = b.F * (b.Omega[0] * x1 + b.Omega[1] * x2) / across
    integrand = (b.FG - sign * x3 * b.y[2]) / across * b.F * b.r**power / b.root
    yield psi - b.q * b.F - integrand * b.rate(x3)


CLAIMS: Final = (
    Claim(
        id="hydromechanics 49 (14)",
        statement=r"x_1 = F\sin\theta\sin\phi,\quad x_2 = F\sin\theta\cos\phi,\quad "
        r"x_1 + x_2i = iF\sin\theta\,e^{-\psi i},\quad x_3 = F\cos\theta",
        domain="Z along F; R = Rz(psi) Rx(theta) Rz(phi)",
        method="the third row of R in the sines and cosines of the angles; exact expansion",
        verdict=Verdict.FALSE,
        correction=r"x_1 + x_2i = iF\sin\theta\,e^{-\phi i}",
        counterexample=f"F = 7, {_ANGLE_TEXT}: x1 + i x2 = 28/65 (5 + 12 i), and 28/85 (8 + 15 i) as "
        "transcribed; psi does not enter x1 and x2 of the same line",
        check=identity(Angles, components),
        transcribed=identity(Angles, components, angle="psi"),
        mutants={"theta in the exponent": identity(Angles, components, angle="theta")},
    ),
    Claim(
        id="hydromechanics 49 (15)",
        statement=r"\sin\theta\frac{d\psi}{dt} = P\sin\phi + Q\cos\phi",
        domain="any motion; R = Rz(psi) Rx(theta) Rz(phi)",
        method="P, Q, R from R^T R' with free rates of the angles; exact expansion",
        verdict=Verdict.RESTORED,
        lost="the fraction is torn apart",
        check=identity(Angles, precession),
        mutants={"- Q cos phi": identity(Angles, precession, sign=-1)},
    ),
    Claim(
        id="hydromechanics 49 (16)",
        statement=r"F\sin^2\theta\frac{d\psi}{dt} = \frac{dT}{dy_1}x_1 + \frac{dT}{dy_2}x_2 "
        r"= (qx_1 + ry_1)x_1 + (qx_2 + ry_2)x_2 = q(x_1^2 + x_2^2) + r(x_1y_1 + x_2y_2) "
        r"= qF^2\sin^2\theta + r(FG - x_3y_3)",
        domain="T of the form (1); Z along F",
        method="the kinematics as in (15), the rest exact expansion in the angles and y",
        verdict=Verdict.RESTORED,
        lost="the fractions are torn apart, and q reads g in the last member",
        check=identity(Angles, precession_by_energy),
        mutants={
            "- x2 dT/dy2": identity(Angles, precession_by_energy, sign=-1),
            "2 q": identity(Angles, precession_by_energy, factor=2),
        },
    ),
    Claim(
        id="hydromechanics 49 (17)",
        statement=r"\psi - qFt = \int\frac{FG - x_3y_3}{F^2 - x_3^2}\,\frac{Fr\,dx_3}{\sqrt{X_3}}",
        domain="T of the form (1); Z along F; off the axis. X3 as in (8), (dx3/dt)^2 = r^2 X3",
        method="differentiated: psi' from (16), dx3/dt = r sqrt(X3), exact expansion; and the integral "
        "itself against the angle of a trajectory of 40 digits",
        verdict=Verdict.FALSE,
        correction=r"\psi - qFt = \int\frac{FG - x_3y_3}{F^2 - x_3^2}\,\frac{F\,dx_3}{\sqrt{X_3}}",
        counterexample=f"{POINT_TEXT}: the rate of the left side is -56/13, of the right side -112/13; "
        "the two agree for r = 1 alone",
        check=lambda: worse(identity(ClebschBody, advance)(), angle_advance()),
        transcribed=identity(ClebschBody, advance, power=1),
        mutants={
            "FG + x3 y3": identity(ClebschBody, advance, sign=-1),
            "r^2": identity(ClebschBody, advance, power=2),
            "r in the integral along the trajectory": partial(angle_advance, power=1),
        },
        remark="With r it is right if sqrt(X3) is read as dx3/dt, against (8) and (9).",
    ),
)
