"""Hydromechanics 49 (27)-(29): a motion of the axis that is algebraic in x = tan(theta/2).

a, b, N   constants; X1, X2 the quartics of (28), w1, w2 their square roots
The motion has q = q' (psi is then psi - q F t), (p - p')/r = (G^2 + y3^2)/F^2 and m1 = -2 r G^2. With
a = F (G + y3) and b = F (G - y3), X3 of (8) becomes X1 X2/(1 + x^2)^4; a common factor of a and b is
free, because it is one of X1, X2 and N^3 too.
"""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from functools import partial
from typing import Any, Final

from taylor_verify.claims.claim import Claim, Verdict, worse
from taylor_verify.claims.field import Element, Field, Point, identity
from taylor_verify.claims.hydromechanics.paths import algebraic_path


def quartics(x: Any, a: Any, b: Any, signs: tuple[int, int, int]) -> tuple[Any, Any]:
    """X1 and X2: X2 has the signs given before x^4, x^2 and 1, X1 the opposite ones."""
    found = []
    for half in (-1, 1):
        fourth, second, last = (half * sign for sign in signs)
        found.append(
            fourth * a * x**4 + 2 * a * x**3 + second * 3 * (a + b) * x**2 + 2 * b * x + last * b
        )
    return found[0], found[1]


# The upper sign belongs to X2 (corrected), or to X1 (as transcribed).
_CORRECTED: Final = (1, 1, 1)
_TRANSCRIBED: Final = (-1, -1, -1)

# A point that a real motion passes: X1 and X2 are positive there, and so is N.
_POINT: Final[Point] = {"x": Fraction(5, 2), "F": 1, "G": -1, "y3": 2, "r": Fraction(3, 2)}


class Quartics:
    """x, a and b alone: what (27) says of the modulus."""

    def __init__(self) -> None:
        self.field = field = Field({"x": Fraction(3, 2), "a": 2, "b": Fraction(-5, 3)})
        self.x, self.a, self.b = field["x"], field["a"], field["b"]


class Algebraic:
    """The motion: F, G, y3, r and x free, w1 and w2 the roots of the corrected quartics.

    psi' = r F (F G - x3 y3)/(F^2 - x3^2) by (16), x3 = F (1 - x^2)/(1 + x^2), and x' from (8) with
    sqrt(X3) = -w1 w2/(1 + x^2)^2, which fixes the sign of the product of the roots.
    """

    def __init__(self) -> None:
        self.field = field = Field(_POINT, {"w1": partial(_square, 0), "w2": partial(_square, 1)})
        self.i = field["i"]
        self.x, self.F, self.G, self.y3 = (field[n] for n in ("x", "F", "G", "y3"))
        self.r, self.w1, self.w2 = (field[n] for n in ("r", "w1", "w2"))
        self.a, self.b = _constants(field)
        self.z = self.F * (1 - self.x**2) / (1 + self.x**2)
        self.x_rate = self.r * self.w1 * self.w2 / (4 * self.F * self.x)
        X1, X2 = quartics(self.x, self.a, self.b, _CORRECTED)
        self.X1, self.X2 = X1, X2
        slopes = [field.partial(X, "x") * self.x_rate for X in (X1, X2)]
        field.turn(
            {
                "x": self.x_rate,
                "w1": slopes[0] / (2 * self.w1),
                "w2": slopes[1] / (2 * self.w2),
            }
        )
        across = self.F**2 - self.z**2
        self.psi_rate = self.r * self.F * (self.F * self.G - self.z * self.y3) / across


def _constants(field: Field) -> tuple[Element, Element]:
    F, G, y3 = (field[name] for name in ("F", "G", "y3"))
    return F * (G + y3), F * (G - y3)


def _square(index: int, field: Field) -> Any:
    a, b = _constants(field)
    return quartics(field["x"], a, b, _CORRECTED)[index]


def modulus(
    s: Any, signs: tuple[int, int, int] = _CORRECTED, factor: int = -8
) -> Iterator[Element]:
    """The squared modulus of (27), in which psi does not occur: N^3 x^3, with N^3 from (29)."""
    x, a, b = s.x, s.a, s.b
    X1, X2 = quartics(x, a, b, signs)
    yield factor * (a + b) * x**3 - ((x + 1) ** 2 * X1 + (x - 1) ** 2 * X2)


def angle(s: Algebraic, sign: int = 1, power: Fraction = Fraction(3, 2)) -> Iterator[Element]:
    """(27), differentiated logarithmically along the motion: 3/2 (x'/x + i psi')."""
    right = (s.x + 1) * s.w1 + sign * s.i * (s.x - 1) * s.w2
    yield power * (s.x_rate / s.x + s.i * s.psi_rate) - s.field.rate(right) / right


def motion(s: Algebraic, pull: int = 2) -> Iterator[Element]:
    """That (8) is X1 X2/(1 + x^2)^4 for these constants, and that x' is that of (8)."""
    m1 = -pull * s.r * s.G**2
    linear = s.r * (s.G**2 + s.y3**2) / s.F**2
    X3 = (s.F**2 - s.z**2) * (linear * s.z**2 + m1) / s.r - (s.F * s.G - s.z * s.y3) ** 2
    yield X3 - s.X1 * s.X2 / (1 + s.x**2) ** 4
    yield s.field.rate(s.z) ** 2 - s.r**2 * X3


_ROOM: Final = "x = tan(theta/2); constants a and b; X1, X2 by (28), N by (29)"
_EXACT: Final = "exact expansion in x, a and b"
_PAIRED: Final = "the signs of (28) are paired the other way"
_X1: Final = r"X_1 = -ax^4 + 2ax^3 - 3(a + b)x^2 + 2bx - b"
_X2: Final = r"X_2 = ax^4 + 2ax^3 + 3(a + b)x^2 + 2bx + b"

CLAIMS: Final = (
    Claim(
        id="hydromechanics 49 (27)",
        statement=r"(Nx\,e^{\psi i})^{3/2} = (x + 1)\sqrt{X_1} + i(x - 1)\sqrt{X_2}",
        domain=f"{_ROOM}; psi from a suitable zero",
        method="the squared modulus in x, a, b, and the logarithmic derivative along the motion that "
        "(28) belongs to, by (8) and (16), exact expansion; its square along a trajectory of 60 digits",
        verdict=Verdict.ONLY_IF,
        condition=_PAIRED,
        correction=rf"{_X1},\quad {_X2}",
        counterexample="x = 3/2, a = 2, b = -5/3: see (28)",
        check=lambda: worse(
            identity(Quartics, modulus)(), identity(Algebraic, angle)(), algebraic_path()
        ),
        transcribed=identity(Quartics, modulus, signs=_TRANSCRIBED),
        mutants={
            "- i (x - 1)": identity(Algebraic, angle, sign=-1),
            "the power 1/2": identity(Algebraic, angle, power=Fraction(1, 2)),
            "X1 for X2, along the trajectory": partial(algebraic_path, sign=-1),
        },
    ),
    Claim(
        id="hydromechanics 49 (28)",
        statement=r"X_1, X_2 = \pm ax^4 + 2ax^3 \pm 3(a + b)x^2 + 2bx \pm b",
        domain=f"{_ROOM}; upper signs for X1, lower for X2",
        method=f"the squared modulus of (27) must be N^3 x^3; {_EXACT}",
        verdict=Verdict.FALSE,
        correction=rf"{_X1},\quad {_X2}",
        counterexample="x = 3/2, a = 2, b = -5/3: (x + 1)^2 X1 + (x - 1)^2 X2 - N^3 x^3 = 8 x (a x^4 + "
        "3 (a + b) x^2 + b) is not 0 as transcribed",
        check=identity(Quartics, modulus),
        transcribed=identity(Quartics, modulus, signs=_TRANSCRIBED),
        mutants={
            "the signs of x^4 alone": identity(Quartics, partial(modulus, signs=(-1, 1, 1))),
            "the signs of x^2 alone": identity(Quartics, partial(modulus, signs=(1, -1, 1))),
            "the signs of b alone": identity(Quartics, partial(modulus, signs=(1, 1, -1))),
        },
        remark="The same is mended by interchanging x + 1 and x - 1 in (27).",
    ),
    Claim(
        id="hydromechanics 49 (29)",
        statement=r"N^3 = -8(a + b)",
        domain=_ROOM,
        method=f"the squared modulus of (27) is N^3 x^3; {_EXACT}",
        verdict=Verdict.ONLY_IF,
        condition=_PAIRED,
        correction=rf"{_X1},\quad {_X2}",
        counterexample="with (28) as transcribed the squared modulus is no multiple of x^3",
        check=identity(Quartics, modulus),
        transcribed=identity(Quartics, modulus, signs=_TRANSCRIBED),
        mutants={"8 (a + b)": identity(Quartics, modulus, factor=8)},
    ),
    Claim(
        id="hydromechanics 49 algebraic motion",
        statement=r"\text{(27)-(29) will give a possible state of motion of the axis of the body}",
        domain="q = q' (else psi - q F t stands for psi when q' = q is not zero), (p - p')/r = (G^2 + "
        "y3^2)/F^2, m1 = -2 r G^2, a = F (G + y3), b = F (G - y3); real for |y3| > |G| and G < 0",
        method="X3 = X1 X2/(1 + x^2)^4, x' by (8), psi' by (16), put into (27); exact expansion in x, "
        "F, G, y3, r and the roots of X1, X2; a real motion of 60 digits (a = 17, b = -44)",
        verdict=Verdict.ONLY_IF,
        condition=_PAIRED,
        correction=rf"{_X1},\quad {_X2}",
        counterexample="with (28) as transcribed |x e^(psi i)| is not x",
        check=lambda: worse(
            identity(Algebraic, motion)(), identity(Algebraic, angle)(), algebraic_path()
        ),
        transcribed=identity(Quartics, modulus, signs=_TRANSCRIBED),
        mutants={
            "m1 = - r G^2": identity(Algebraic, motion, pull=1),
            "X1 for X2, along the trajectory": partial(algebraic_path, sign=-1),
            "- i (x - 1)": identity(Algebraic, angle, sign=-1),
        },
    ),
)
