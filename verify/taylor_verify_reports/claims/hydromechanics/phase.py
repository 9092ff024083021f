"""Hydromechanics 49 (9)-(13): the angle of (x1, x2) about the axis of Clebsch's body.

Symbols as in clebsch.py. Logarithms and square roots enter by their derivatives alone, so that every
identity is one of rational functions and i.
"""

from __future__ import annotations

from typing import Final

from taylor_verify_reports.claims.claim import Claim
from taylor_verify_reports.claims.hydromechanics.clebsch import STATE_TEXT, clebsch

_ROOM: Final = "T of the form (1); any free motion; off the axis, x1 + i x2 not zero"
_EXACT: Final = "by 48 (3), (4); exact expansion in x, y, the six coefficients, F and i"

CLAIMS: Final = (
    Claim(
        id="hydromechanics 49 (9)",
        statement=r"(x_1 - x_2i)(y_1 + y_2i) = x_1y_1 + x_2y_2 + i(x_1y_2 - x_2y_1) "
        r"= FG - x_3y_3 + i\sqrt{X_3}",
        domain="T of the form (1); any free motion. It fixes the sign of the root: sqrt(X3) = x1 y2 - "
        "x2 y1 = (dx3/dt)/r",
        method=_EXACT,
        lost="`xy3y3` stands for x3 y3",
        check=clebsch("(x1 - i*x2)*eta = x1*y1 + x2*y2 + i*(x1*y2 - x2*y1) = F*G - x3*y3 + i*root"),
        mutants={"- i sqrt(X3)": ("+ i*root", "- i*root")},
    ),
    Claim(
        id="hydromechanics 49 (10)",
        statement=r"\frac{y_1 + y_2i}{x_1 + x_2i} = \frac{FG - x_3y_3 + i\sqrt{X_3}}{x_1^2 + x_2^2}",
        domain=_ROOM,
        method=_EXACT,
        lost="both fraction bars",
        check=clebsch("eta / xi = (F*G - x3*y3 + i*root) / (x1**2 + x2**2)"),
        mutants={"- i sqrt(X3)": ("+ i*root", "- i*root")},
    ),
    Claim(
        id="hydromechanics 49 (11)",
        statement=r"\frac{d}{dt}(x_1 + x_2i) = -i[(q' - q)x_3 + r'y_3] + irx_3(y_1 + y_2i)",
        domain="T of the form (1); any free motion",
        method=_EXACT,
        correction=r"\frac{d}{dt}(x_1 + x_2i) = -i[(q' - q)x_3 + r'y_3](x_1 + x_2i) "
        r"+ irx_3(y_1 + y_2i)",
        counterexample=f"{STATE_TEXT}: the left side is 36 + 4 i by the equations of motion, the right "
        "side 24 + 8 i; its two terms are not even of one dimension",
        check=clebsch("d(xi) = -i*((qq - q)*x3 + rr*y3)*xi + i*r*x3*eta"),
        transcribed=(")*xi", ")"),
        mutants={"i r x3 with the other sign": ("+ i*r", "- i*r")},
    ),
    Claim(
        id="hydromechanics 49 (12)",
        statement=r"\frac{d}{i\,dt}\log(x_1 + x_2i) = -(q' - q)x_3 - r'y_3 "
        r"+ rx_3\frac{FG - x_3y_3 + i\sqrt{X_3}}{F^2 - x_3^2}",
        domain=_ROOM,
        method=_EXACT,
        lost="the fraction bars; d/i dt is torn apart",
        check=clebsch(
            "d(xi) / (i*xi) = -(qq - q)*x3 - rr*y3 + r*x3*(F*G - x3*y3 + i*root) / (F**2 - x3**2)"
        ),
        mutants={
            "- i sqrt(X3)": ("+ i*root", "- i*root"),
            "r^2 for r": ("+ r*x3", "+ r**2*x3"),
        },
        remark="From the corrected (11) it follows; from (11) as transcribed it does not.",
    ),
    Claim(
        id="hydromechanics 49 (13)",
        statement=r"\frac{d}{i\,dt}\log\sqrt{\frac{x_1 + x_2i}{x_1 - x_2i}} = -(q' - q)x_3 "
        r"- (r' - r)y_3 - Fr\frac{Fy_3 - Gx_3}{F^2 - x_3^2}",
        domain=_ROOM,
        method=_EXACT,
        lost="the fraction bars, and the quotient under the root",
        check=clebsch(
            "(d(xi) / xi - d(x1 - i*x2) / (x1 - i*x2)) / (2*i)"
            " = -(qq - q)*x3 - (rr - r)*y3 - F*r*(F*y3 - G*x3) / (F**2 - x3**2)"
        ),
        mutants={
            "F y3 + G x3": ("F*y3 - G*x3", "F*y3 + G*x3"),
            "r for F r": ("F*r*", "r*"),
        },
    ),
)
