"""Clebsch's body, Hydromechanics 49 (1)-(8): the fourth integral and the quartic of x3.

p, p', q, q', r, r'   coefficients of T about the axis of symmetry, body axis 3
x, y                  impulses; F^2 = x.x, G = x.y/F, y3 and T are constant
root                  sqrt(X3), which is x1 y2 - x2 y1 = (dx3/dt)/r by (3) and (9)
"""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from typing import Any, Final

from taylor_verify.claims.claim import Claim, Verdict
from taylor_verify.claims.field import Element, Field, Point, cross, dot, identity, named, plus

COEFFICIENTS: Final = ("p", "pp", "q", "qq", "r", "rr")
_HALF: Final = Fraction(1, 2)
# x has the length 7 and T is positive definite: a body and a state that can be.
_POINT: Final[Point] = {
    **{"x1": 2, "x2": 3, "x3": 6, "F": 7, "y1": 1, "y2": -2, "y3": 4},
    **{"p": 3, "pp": 2, "q": Fraction(1, 2), "qq": Fraction(1, 3), "r": 2, "rr": Fraction(5, 4)},
}
POINT_TEXT: Final = (
    "x = (2, 3, 6), y = (1, -2, 4), p = 3, p' = 2, q = 1/2, q' = 1/3, r = 2, r' = 5/4, so that "
    "F = 7, FG = 20, sqrt(X3) = -7"
)


def kinetic_energy(six: tuple[Any, ...], x: list[Any], y: list[Any]) -> Any:
    """49 (1)."""
    p, pp, q, qq, r, rr = six
    return (
        _HALF * p * (x[0] ** 2 + x[1] ** 2)
        + _HALF * pp * x[2] ** 2
        + q * (x[0] * y[0] + x[1] * y[1])
        + qq * x[2] * y[2]
        + _HALF * r * (y[0] ** 2 + y[1] ** 2)
        + _HALF * rr * y[2] ** 2
    )


class ClebschBody:
    """The symbols of 49, with the rates of 48 (3), (4) for the T of (1)."""

    def __init__(self) -> None:
        self.field = field = Field(_POINT, {"F": _length_squared})
        self.i, self.F = field["i"], field["F"]
        self.x, self.y = field.vector("x"), field.vector("y")
        self.six = self.p, self.pp, self.q, self.qq, self.r, self.rr = tuple(
            field[name] for name in COEFFICIENTS
        )
        self.T = kinetic_energy(self.six, self.x, self.y)
        self.U = [field.partial(self.T, f"x{k}") for k in (1, 2, 3)]
        self.Omega = [field.partial(self.T, f"y{k}") for k in (1, 2, 3)]
        self.FG = dot(self.x, self.y)
        self.G = self.FG / self.F
        self.m1 = 2 * self.T - self.p * self.F**2 - 2 * self.q * self.FG - self.rr * self.y[2] ** 2
        self.root = self.x[0] * self.y[1] - self.x[1] * self.y[0]
        dx = cross(self.x, self.Omega)
        dy = plus(cross(self.y, self.Omega), cross(self.x, self.U))
        field.turn(named("x", dx) | named("y", dy))
        self.xi = self.x[0] + self.i * self.x[1]
        self.eta = self.y[0] + self.i * self.y[1]

    def rate(self, element: Element) -> Element:
        return self.field.rate(element)


def _length_squared(field: Field) -> Any:
    x = field.vector("x")
    return dot(x, x)


def quartic(b: Any, z: Any, F: Any, G: Any, y3: Any, m1: Any) -> Any:
    """X3 as a polynomial in z = x3, from (4)-(7)."""
    p, pp, q, qq, r, _ = b.six
    across = (p - pp) * z**2 + 2 * (q - qq) * z * y3 + m1
    return (F**2 - z**2) * across / r - (F * G - z * y3) ** 2


def fourth_integral(b: ClebschBody, index: int = 3) -> Iterator[Element]:
    yield b.rate(b.y[index - 1])


def axial_rate(b: ClebschBody, sign: int = 1) -> Iterator[Element]:
    """(3), all members."""
    (x1, x2, x3), (y1, y2, _) = b.x, b.y
    rate = b.rate(x3)
    yield rate - (x1 * (b.q * x2 + b.r * y2) - x2 * (b.q * x1 + b.r * y1))
    yield rate - b.r * (x1 * y2 - sign * x2 * y1)


def squared_rate(b: ClebschBody, power: int = 2, sign: int = 1) -> Iterator[Element]:
    """(4), all members."""
    (x1, x2, x3), (y1, y2, y3) = b.x, b.y
    left = b.rate(x3) ** 2 / b.r**power
    flat = (x1**2 + x2**2) * (y1**2 + y2**2)
    yield left - (flat - (x1 * y1 + x2 * y2) ** 2)
    yield left - (flat - (b.FG - sign * x3 * y3) ** 2)
    whole = y1**2 + y2**2 + y3**2 - b.G**2
    yield left - ((x1**2 + x2**2) * whole - (b.G * x3 - b.F * y3) ** 2)


def projections(b: ClebschBody, sign: int = 1) -> Iterator[Element]:
    """(5)."""
    (x1, x2, x3), (y1, y2, y3) = b.x, b.y
    yield x1**2 + x2**2 - (b.F**2 - sign * x3**2)
    yield x1 * y1 + x2 * y2 - (b.F * b.G - x3 * y3)


def across_energy(b: ClebschBody, sign: int = 1, m1: Any = None) -> Iterator[Element]:
    """(6), both members, with m1 from (7)."""
    (x1, x2, x3), (y1, y2, y3) = b.x, b.y
    left = b.r * (y1**2 + y2**2)
    yield left - (
        2 * b.T
        - b.p * (x1**2 + x2**2)
        - b.pp * x3**2
        - 2 * b.q * (x1 * y1 + x2 * y2)
        - 2 * b.qq * x3 * y3
        - b.rr * y3**2
    )
    constant = b.m1 if m1 is None else m1(b)
    yield left - ((b.p - b.pp) * x3**2 + sign * 2 * (b.q - b.qq) * x3 * y3 + constant)


def first_constant(b: ClebschBody, energy: int = 2, prime: bool = True) -> Iterator[Element]:
    """(7): m1 is constant, and it is the constant of (6)."""
    axial = b.rr if prime else b.r
    m1 = energy * b.T - b.p * b.F**2 - 2 * b.q * b.F * b.G - axial * b.y[2] ** 2
    yield b.rate(m1)
    yield list(across_energy(b, m1=lambda _: m1))[1]


def elliptic_rate(b: ClebschBody, power: int = 2, sign: int = 1) -> Iterator[Element]:
    """(8), with X3 expanded as a quartic in x3 whose coefficients are constant."""
    X3 = quartic(b, b.x[2], b.F, b.G, sign * b.y[2], b.m1)
    yield b.rate(b.x[2]) ** 2 / b.r**power - X3


def moved_origin(b: ClebschBody, sign: int = 1, lowered: bool = True) -> Iterator[Element]:
    """With s (x1 y2 - x2 y1) in T, y3 is constant too; O' = O - (s/r) e3 takes that term away.

    At O' = O + b the impulses are x' = x and y' = y - b x x; T is the same number. Any coefficient
    serves for s: that of p here.
    """
    T, s = b.T + b.p * b.root, b.p
    (x1, x2, _), (y1, y2, y3) = b.x, b.y
    moved = [y1 - sign * s / b.r * x2, y2 + sign * s / b.r * x1, y3]
    p = b.p - s**2 / b.r if lowered else b.p
    yield T - kinetic_energy((p, *b.six[1:]), b.x, moved)
    U, Omega = ([b.field.partial(T, f"{v}{k}") for k in (1, 2, 3)] for v in ("x", "y"))
    yield plus(cross(b.y, Omega), cross(b.x, U))[2]


def unmoved_origin(b: ClebschBody) -> Iterator[Element]:
    """What (1) misses of the T of such a body seen from another point of its axis."""
    yield b.T + b.p * b.root - kinetic_energy(b.six, b.x, b.y)


_ROOM: Final = "T of the form (1); any free motion"
_EXACT: Final = "by 48 (3), (4); exact expansion in x, y and the six coefficients"

CLAIMS: Final = (
    Claim(
        id="hydromechanics 49 (1)",
        statement=r"T = \tfrac12p(x_1^2 + x_2^2) + \tfrac12p'x_3^2 + q(x_1y_1 + x_2y_2) + q'x_3y_3 "
        r"+ \tfrac12r(y_1^2 + y_2^2) + \tfrac12r'y_3^2",
        domain="a definition: the T for which y3 is constant in every free motion, axis 3 through O",
        method="y3' vanishes for (1) and for s (x1 y2 - x2 y1) besides, and a move of the origin by "
        "-(s/r) e3 takes that term away; exact expansion",
        verdict=Verdict.ONLY_IF,
        condition="the origin is put at the right point of the axis; about any other there is a "
        "seventh term s (x1 y2 - x2 y1)",
        correction=r"T + s(x_1y_2 - x_2y_1),\quad O' = O - \tfrac{s}{r}e_3,\quad p \to p - s^2/r",
        check=identity(ClebschBody, moved_origin),
        transcribed=identity(ClebschBody, unmoved_origin),
        counterexample="the same body seen from another point of its axis: s is not zero",
        mutants={
            "a move of the other sign": identity(ClebschBody, moved_origin, sign=-1),
            "p left as it was": identity(ClebschBody, moved_origin, lowered=False),
        },
    ),
    Claim(
        id="hydromechanics 49 (2)",
        statement=r"\frac{dy_3}{dt} = 0,\quad y_3 = \text{constant}",
        domain=_ROOM,
        method=_EXACT,
        verdict=Verdict.HOLDS,
        check=identity(ClebschBody, fourth_integral),
        mutants={"y2 for y3": identity(ClebschBody, fourth_integral, index=2)},
    ),
    Claim(
        id="hydromechanics 49 (3)",
        statement=r"\frac{dx_3}{dt} = x_1(qx_2 + ry_2) - x_2(qx_1 + ry_1) = r(x_1y_2 - x_2y_1)",
        domain=_ROOM,
        method=_EXACT,
        verdict=Verdict.RESTORED,
        lost="the fraction is torn apart",
        check=identity(ClebschBody, axial_rate),
        mutants={"x2 y1 with the other sign": identity(ClebschBody, axial_rate, sign=-1)},
    ),
    Claim(
        id="hydromechanics 49 (4)",
        statement=r"\frac1{r^2}\Big(\frac{dx_3}{dt}\Big)^2 = (x_1^2 + x_2^2)(y_1^2 + y_2^2) "
        r"- (x_1y_1 + x_2y_2)^2 = (x_1^2 + x_2^2)(y_1^2 + y_2^2) - (FG - x_3y_3)^2 "
        r"= (x_1^2 + x_2^2)(y_1^2 + y_2^2 + y_3^2 - G^2) - (Gx_3 - Fy_3)^2",
        domain=_ROOM,
        method=_EXACT,
        verdict=Verdict.RESTORED,
        lost="the fractions are torn apart",
        check=identity(ClebschBody, squared_rate),
        mutants={
            "r for r^2": identity(ClebschBody, squared_rate, power=1),
            "FG + x3 y3": identity(ClebschBody, squared_rate, sign=-1),
        },
    ),
    Claim(
        id="hydromechanics 49 (5)",
        statement=r"x_1^2 + x_2^2 = F^2 - x_3^2,\quad x_1y_1 + x_2y_2 = FG - x_3y_3",
        domain=_ROOM,
        method="48 (ii), (iii); exact expansion in x and y",
        verdict=Verdict.HOLDS,
        check=identity(ClebschBody, projections),
        mutants={"F^2 + x3^2": identity(ClebschBody, projections, sign=-1)},
    ),
    Claim(
        id="hydromechanics 49 (6)",
        statement=r"r(y_1^2 + y_2^2) = 2T - p(x_1^2 + x_2^2) - p'x_3^2 - 2q(x_1y_1 + x_2y_2) "
        r"- 2q'x_3y_3 - r'y_3^2 = (p - p')x_3^2 + 2(q - q')x_3y_3 + m_1",
        domain=f"{_ROOM}; m1 from (7)",
        method="exact expansion in x, y and the six coefficients",
        verdict=Verdict.HOLDS,
        check=identity(ClebschBody, across_energy),
        mutants={"q' - q for q - q'": identity(ClebschBody, across_energy, sign=-1)},
    ),
    Claim(
        id="hydromechanics 49 (7)",
        statement=r"m_1 = 2T - pF^2 - 2qFG - r'y_3^2",
        domain=_ROOM,
        method=f"it is constant, and it is what (6) needs; {_EXACT}",
        verdict=Verdict.RESTORED,
        lost="a minus stands where the equality sign was, and r1 where r' was",
        check=identity(ClebschBody, first_constant),
        mutants={
            "T for 2T": identity(ClebschBody, first_constant, energy=1),
            "r for r'": identity(ClebschBody, first_constant, prime=False),
        },
    ),
    Claim(
        id="hydromechanics 49 (8)",
        statement=r"\frac1{r^2}\Big(\frac{dx_3}{dt}\Big)^2 = X_3,\quad X_3 = (F^2 - x_3^2)"
        r"\frac{(p - p')x_3^2 + 2(q - q')x_3y_3 + m_1}{r} - (FG - x_3y_3)^2",
        domain=f"{_ROOM}; the text says only that X3 is a quartic, which follows from (4)-(7)",
        method=_EXACT,
        verdict=Verdict.RESTORED,
        lost="the fractions are torn apart",
        check=identity(ClebschBody, elliptic_rate),
        mutants={
            "r for r^2": identity(ClebschBody, elliptic_rate, power=1),
            "-y3 in X3": identity(ClebschBody, elliptic_rate, sign=-1),
        },
    ),
)
