"""Hydromechanics 49 (27)-(29): a motion of the axis that is algebraic in x = tan(theta/2).

a, b, N   constants; X1, X2 the quartics of (28), w1, w2 their square roots
The motion has q = q' (psi is then psi - q F t), (p - p')/r = (G^2 + y3^2)/F^2 and m1 = -2 r G^2. With
a = F (G + y3) and b = F (G - y3), X3 of (8) becomes X1 X2/(1 + x^2)^4; a common factor of a and b is
free, because it is one of X1, X2 and N^3 too.
"""

from __future__ import annotations

from fractions import Fraction
from typing import Final

from taylor_verify_reports.claims.check import All
from taylor_verify_reports.claims.claim import Claim
from taylor_verify_reports.claims.hydromechanics.paths import algebraic_path
from taylor_verify_reports.claims.setting import Equations, Exact


def quartic(fourth: str, second: str, last: str) -> str:
    """A quartic of (28) with these signs before x^4, x^2 and 1."""
    return f"({fourth} a*x**4 + 2*a*x**3 {second} 3*(a + b)*x**2 + 2*b*x {last} b)"


# x, a and b alone: what (27) says of the modulus.
quartics: Final = Exact({"x": Fraction(3, 2), "a": 2, "b": Fraction(-5, 3)})


def _modulus(X1: str, X2: str) -> Equations:
    """The squared modulus of (27), in which psi does not occur: N^3 x^3, with N^3 from (29)."""
    return quartics(f"-8*(a + b) * x**3 = (x + 1)**2 * {X1} + (x - 1)**2 * {X2}")


_corrected: Final = _modulus(quartic("-", "-", "-"), quartic("+", "+", "+"))
_transcribed: Final = _modulus(quartic("+", "+", "+"), quartic("-", "-", "-"))

# F, G, y3, r and x are free at a point that a real motion passes: X1, X2 and N are positive there.
# psi' is that of (16), z = x3 = F (1 - x^2)/(1 + x^2), and x' that of (8) with the sign of the product of
# the roots: sqrt(X3) = -w1 w2/(1 + x^2)^2.
_algebraic: Final = Exact(
    {"x": Fraction(5, 2), "F": 1, "G": -1, "y3": 2, "r": Fraction(3, 2)},
    """
    z = F * (1 - x**2) / (1 + x**2)
    dx = r*w1*w2 / (4*F*x)
    slope = lambda w: partial(w**2, "x") * dx / (2*w)
    turn(x=dx, w1=slope(w1), w2=slope(w2))
    psi_rate = r*F*(F*G - z*y3) / (F**2 - z**2)
    """,
    roots={
        name: f"(lambda a, b: {text})(F*(G + y3), F*(G - y3))"
        for name, text in {"w1": quartic("-", "-", "-"), "w2": quartic("+", "+", "+")}.items()
    },
)
# (27), differentiated logarithmically along the motion.
_angle: Final = _algebraic(
    "3*(dx/x + i*psi_rate) / 2 = d((x + 1)*w1 + i*(x - 1)*w2) / ((x + 1)*w1 + i*(x - 1)*w2)"
)
# (8) is X1 X2/(1 + x^2)^4 for these constants, and x' is that of (8).
_X3: Final = "((F**2 - z**2) * (r*(G**2 + y3**2)/F**2 * z**2 - 2*r*G**2) / r - (F*G - z*y3)**2)"
_motion: Final = _algebraic(f"{_X3} = (w1*w2)**2 / (1 + x**2)**4", f"d(z)**2 = r**2 * {_X3}")

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
        condition=_PAIRED,
        correction=rf"{_X1},\quad {_X2}",
        counterexample="x = 3/2, a = 2, b = -5/3: see (28)",
        check=All(_corrected, _angle, algebraic_path()),
        transcribed=_transcribed,
        mutants={
            "- i (x - 1)": ("+ i*(x - 1)", "- i*(x - 1)"),
            "the power 1/2": ("3*(dx", "(dx"),
            "X1 for X2, along the trajectory": algebraic_path("X2", "X1"),
        },
    ),
    Claim(
        id="hydromechanics 49 (28)",
        statement=r"X_1, X_2 = \pm ax^4 + 2ax^3 \pm 3(a + b)x^2 + 2bx \pm b",
        domain=f"{_ROOM}; upper signs for X1, lower for X2",
        method=f"the squared modulus of (27) must be N^3 x^3; {_EXACT}",
        correction=rf"{_X1},\quad {_X2}",
        counterexample="x = 3/2, a = 2, b = -5/3: (x + 1)^2 X1 + (x - 1)^2 X2 - N^3 x^3 = 8 x (a x^4 + "
        "3 (a + b) x^2 + b) is not 0 as transcribed",
        check=_corrected,
        transcribed=_transcribed,
        mutants={
            "the signs of x^4 alone": _modulus(quartic("+", "-", "-"), quartic("-", "+", "+")),
            "the signs of x^2 alone": _modulus(quartic("-", "+", "-"), quartic("+", "-", "+")),
            "the signs of b alone": _modulus(quartic("-", "-", "+"), quartic("+", "+", "-")),
        },
        remark="The same is mended by interchanging x + 1 and x - 1 in (27).",
    ),
    Claim(
        id="hydromechanics 49 (29)",
        statement=r"N^3 = -8(a + b)",
        domain=_ROOM,
        method=f"the squared modulus of (27) is N^3 x^3; {_EXACT}",
        condition=_PAIRED,
        correction=rf"{_X1},\quad {_X2}",
        counterexample="with (28) as transcribed the squared modulus is no multiple of x^3",
        check=_corrected,
        transcribed=_transcribed,
        mutants={"8 (a + b)": ("-8*", "8*")},
    ),
    Claim(
        id="hydromechanics 49 algebraic motion",
        statement=r"\text{(27)-(29) will give a possible state of motion of the axis of the body}",
        domain="q = q' (else psi - q F t stands for psi when q' = q is not zero), (p - p')/r = (G^2 + "
        "y3^2)/F^2, m1 = -2 r G^2, a = F (G + y3), b = F (G - y3); real for |y3| > |G| and G < 0",
        method="X3 = X1 X2/(1 + x^2)^4, x' by (8), psi' by (16), put into (27); exact expansion in x, "
        "F, G, y3, r and the roots of X1, X2; a real motion of 60 digits (a = 17, b = -44)",
        condition=_PAIRED,
        correction=rf"{_X1},\quad {_X2}",
        counterexample="with (28) as transcribed |x e^(psi i)| is not x",
        check=All(_motion, _angle, algebraic_path()),
        transcribed=_transcribed,
        mutants={
            "m1 = - r G^2": ("2*r*G**2", "r*G**2"),
            "X1 for X2, along the trajectory": algebraic_path("X2", "X1"),
            "- i (x - 1)": ("+ i*(x - 1)", "- i*(x - 1)"),
        },
    ),
)
