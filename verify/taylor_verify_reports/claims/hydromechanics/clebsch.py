"""Clebsch's body, Hydromechanics 49 (1)-(8): the fourth integral and the quartic of x3.

p, p', q, q', r, r'   coefficients of T about the axis of symmetry, body axis 3; primes are doubled letters
x, y                  impulses; F^2 = x.x, G = x.y/F, y3 and T are constant
xi, eta               x1 + i x2 and y1 + i y2
root                  sqrt(X3), which is x1 y2 - x2 y1 = (dx3/dt)/r by (3) and (9)
quartic               X3 as a polynomial in z = x3, from (4)-(7)
"""

from __future__ import annotations

from fractions import Fraction
from typing import Final

from taylor_verify_reports.claims.claim import Claim
from taylor_verify_reports.claims.field import Point
from taylor_verify_reports.claims.setting import Exact

COEFFICIENTS: Final[Point] = {
    **{"p": 3, "pp": 2, "q": Fraction(1, 2), "qq": Fraction(1, 3), "r": 2, "rr": Fraction(5, 4)}
}
# x has the length 7 and T is positive definite: a body and a state that can be.
STATE: Final[Point] = {
    **{"x1": 2, "x2": 3, "x3": 6, "F": 7, "y1": 1, "y2": -2, "y3": 4},
    **COEFFICIENTS,
}
STATE_TEXT: Final = (
    "x = (2, 3, 6), y = (1, -2, 4), p = 3, p' = 2, q = 1/2, q' = 1/3, r = 2, r' = 5/4, so that "
    "F = 7, FG = 20, sqrt(X3) = -7"
)
QUARTIC: Final = (
    "lambda z, F, G, y3, m1: "
    "(F**2 - z**2) * ((p - pp)*z**2 + 2*(q - qq)*z*y3 + m1) / r - (F*G - z*y3)**2"
)
FORMS: Final = f"""
energy = lambda p, x, y: (
    p*(x[0]**2 + x[1]**2)/2 + pp*x[2]**2/2 + q*(x[0]*y[0] + x[1]*y[1]) + qq*x[2]*y[2]
    + r*(y[0]**2 + y[1]**2)/2 + rr*y[2]**2/2
)
quartic = {QUARTIC}
"""

# The symbols of 49, with the rates of 48 (3), (4) for the T of (1); z is any number.
clebsch: Final = Exact(
    {**STATE, "z": 1},
    f"""{FORMS}
T = energy(p, x, y)
U, Omega = grad(T, "x"), grad(T, "y")
turn(x=cross(x, Omega), y=cross(y, Omega) + cross(x, U))
FG, F4 = x @ y, F**4
G = FG / F
m1 = 2*T - p*F**2 - 2*q*FG - rr*y3**2
root = x1*y2 - x2*y1
xi, eta = x1 + i*x2, y1 + i*y2
# With s (x1 y2 - x2 y1) in T, y3 is constant too; O' = O - (s/r) e3 takes that term away. At O' = O + b
# the impulses are x' = x and y' = y - b x x; T is the same number. Any coefficient serves for s.
s = p
seven = T + s*root
""",
    roots={"F": "x @ x"},
)

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
        condition="the origin is put at the right point of the axis; about any other there is a "
        "seventh term s (x1 y2 - x2 y1)",
        correction=r"T + s(x_1y_2 - x_2y_1),\quad O' = O - \tfrac{s}{r}e_3,\quad p \to p - s^2/r",
        check=clebsch(
            "seven = energy(p - s**2/r, x, [y1 - s/r*x2, y2 + s/r*x1, y3])",
            "(cross(y, grad(seven, 'y')) + cross(x, grad(seven, 'x')))[2] = 0",
        ),
        transcribed=clebsch("seven = T"),
        counterexample="the same body seen from another point of its axis: s is not zero",
        mutants={
            "a move of the other sign": ("- s/r*x2, y2 + s/r*x1", "+ s/r*x2, y2 - s/r*x1"),
            "p left as it was": ("p - s**2/r", "p"),
        },
    ),
    Claim(
        id="hydromechanics 49 (2)",
        statement=r"\frac{dy_3}{dt} = 0,\quad y_3 = \text{constant}",
        domain=_ROOM,
        method=_EXACT,
        check=clebsch("d(y3) = 0"),
        mutants={"y2 for y3": ("y3", "y2")},
    ),
    Claim(
        id="hydromechanics 49 (3)",
        statement=r"\frac{dx_3}{dt} = x_1(qx_2 + ry_2) - x_2(qx_1 + ry_1) = r(x_1y_2 - x_2y_1)",
        domain=_ROOM,
        method=_EXACT,
        lost="the fraction is torn apart",
        check=clebsch("d(x3) = x1*(q*x2 + r*y2) - x2*(q*x1 + r*y1) = r*(x1*y2 - x2*y1)"),
        mutants={"x2 y1 with the other sign": ("- x2*y1", "+ x2*y1")},
    ),
    Claim(
        id="hydromechanics 49 (4)",
        statement=r"\frac1{r^2}\Big(\frac{dx_3}{dt}\Big)^2 = (x_1^2 + x_2^2)(y_1^2 + y_2^2) "
        r"- (x_1y_1 + x_2y_2)^2 = (x_1^2 + x_2^2)(y_1^2 + y_2^2) - (FG - x_3y_3)^2 "
        r"= (x_1^2 + x_2^2)(y_1^2 + y_2^2 + y_3^2 - G^2) - (Gx_3 - Fy_3)^2",
        domain=_ROOM,
        method=_EXACT,
        lost="the fractions are torn apart",
        check=clebsch(
            "d(x3)**2 / r**2 = (x1**2 + x2**2)*(y1**2 + y2**2) - (x1*y1 + x2*y2)**2"
            " = (x1**2 + x2**2)*(y1**2 + y2**2) - (FG - x3*y3)**2"
            " = (x1**2 + x2**2)*(y1**2 + y2**2 + y3**2 - G**2) - (G*x3 - F*y3)**2"
        ),
        mutants={
            "r for r^2": ("/ r**2", "/ r"),
            "FG + x3 y3": ("FG - x3*y3", "FG + x3*y3"),
        },
    ),
    Claim(
        id="hydromechanics 49 (5)",
        statement=r"x_1^2 + x_2^2 = F^2 - x_3^2,\quad x_1y_1 + x_2y_2 = FG - x_3y_3",
        domain=_ROOM,
        method="48 (ii), (iii); exact expansion in x and y",
        check=clebsch("x1**2 + x2**2 = F**2 - x3**2", "x1*y1 + x2*y2 = F*G - x3*y3"),
        mutants={"F^2 + x3^2": ("F**2 - x3**2", "F**2 + x3**2")},
    ),
    Claim(
        id="hydromechanics 49 (6)",
        statement=r"r(y_1^2 + y_2^2) = 2T - p(x_1^2 + x_2^2) - p'x_3^2 - 2q(x_1y_1 + x_2y_2) "
        r"- 2q'x_3y_3 - r'y_3^2 = (p - p')x_3^2 + 2(q - q')x_3y_3 + m_1",
        domain=f"{_ROOM}; m1 from (7)",
        method="exact expansion in x, y and the six coefficients",
        check=clebsch(
            "r*(y1**2 + y2**2)"
            " = 2*T - p*(x1**2 + x2**2) - pp*x3**2 - 2*q*(x1*y1 + x2*y2) - 2*qq*x3*y3 - rr*y3**2"
            " = (p - pp)*x3**2 + 2*(q - qq)*x3*y3 + m1"
        ),
        mutants={"q' - q for q - q'": ("+ 2*(q - qq)", "- 2*(q - qq)")},
    ),
    Claim(
        id="hydromechanics 49 (7)",
        statement=r"m_1 = 2T - pF^2 - 2qFG - r'y_3^2",
        domain=_ROOM,
        method=f"it is constant, and it is what (6) needs; {_EXACT}",
        lost="a minus stands where the equality sign was, and r1 where r' was",
        check=clebsch(
            "2*T - p*F**2 - 2*q*F*G - rr*y3**2"
            " = r*(y1**2 + y2**2) - (p - pp)*x3**2 - 2*(q - qq)*x3*y3",
            "d(m1) = 0",
        ),
        mutants={
            "T for 2T": ("2*T", "T"),
            "r for r'": ("rr*y3", "r*y3"),
        },
    ),
    Claim(
        id="hydromechanics 49 (8)",
        statement=r"\frac1{r^2}\Big(\frac{dx_3}{dt}\Big)^2 = X_3,\quad X_3 = (F^2 - x_3^2)"
        r"\frac{(p - p')x_3^2 + 2(q - q')x_3y_3 + m_1}{r} - (FG - x_3y_3)^2",
        domain=f"{_ROOM}; the text says only that X3 is a quartic, which follows from (4)-(7)",
        method=_EXACT,
        lost="the fractions are torn apart",
        check=clebsch("d(x3)**2 / r**2 = quartic(x3, F, G, y3, m1)"),
        mutants={
            "r for r^2": ("/ r**2", "/ r"),
            "-y3 in X3": ("y3", "-y3"),
        },
    ),
)
