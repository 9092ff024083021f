"""Hydromechanics 48 (i)-(iii) and (10): the integrals of a free solid, and the couple that acts on y.

Symbols as in solid.py; every identity is expanded in exact rationals with all 21 coefficients of T.
"""

from __future__ import annotations

from typing import Final

from taylor_verify_reports.claims.claim import Claim
from taylor_verify_reports.claims.hydromechanics.solid import loaded, unloaded

_EXPANDED: Final = "by (3) and (4); exact expansion in x, y and all 21 coefficients of T"
_FREE: Final = "no external force or couple; any T"

CLAIMS: Final = (
    Claim(
        id="hydromechanics 48 (i)",
        statement=r"T = \text{constant}",
        domain=_FREE,
        method=f"dT/dt = 0, with U = dT/dx and (P, Q, R) = dT/dy; {_EXPANDED}",
        check=unloaded("d(T) = 0", "grad(T, 'x') = vel", "grad(T, 'y') = Omega"),
        mutants={
            "a rate x.U": ("d(T) = 0", "d(T) = x @ vel"),
            "under a force": loaded("d(T) = 0"),
        },
    ),
    Claim(
        id="hydromechanics 48 (ii)",
        statement=r"x_1^2 + x_2^2 + x_3^2 = F^2",
        domain=f"{_FREE}; F a constant",
        method=_EXPANDED,
        check=unloaded("d(x1**2 + x2**2 + x3**2) = 0"),
        mutants={"- x2^2": ("+ x2**2", "- x2**2")},
    ),
    Claim(
        id="hydromechanics 48 (iii)",
        statement=r"x_1y_1 + x_2y_2 + x_3y_3 = GF",
        domain=f"{_FREE}; G a constant, not the G of (8)",
        method=_EXPANDED,
        check=unloaded("d(x1*y1 + x2*y2 + x3*y3) = 0"),
        mutants={"x3 y2 for x3 y3": ("x3*y3", "x3*y2")},
        remark="The letter n between the two members means only a constant.",
    ),
    Claim(
        id="hydromechanics 48 constant vector",
        statement=r"x_1, x_2, x_3 \text{ are the components of a constant vector having a fixed "
        r"direction}",
        domain=f"{_FREE}; fixed in space",
        method=f"(R x)' = 0 with R' = R [Omega]x; {_EXPANDED}",
        check=unloaded("d(rot @ x) = 0"),
        mutants={"under a force": loaded("d(rot @ x) = 0")},
    ),
    Claim(
        id="hydromechanics 48 (10)",
        statement=r"x_2W - x_3V,\quad x_3U - x_1W,\quad x_1V - x_2U",
        domain=f"{_FREE}; the couple as if subject to which the vector y moves",
        method=f"y' - y x Omega, the rate of y in space, is this vector; {_EXPANDED}",
        check=unloaded("d(y) - cross(y, Omega) = [x2*W - x3*V, x3*U - x1*W, x1*V - x2*U]"),
        mutants={"x3 V with the other sign": ("- x3*V", "+ x3*V")},
    ),
    Claim(
        id="hydromechanics 48 couple perpendicular to F",
        statement=r"x_1(x_2W - x_3V) + x_2(x_3U - x_1W) + x_3(x_1V - x_2U) = 0",
        domain=_FREE,
        method="exact expansion in x, y and all 21 coefficients of T",
        check=unloaded("x1*(x2*W - x3*V) + x2*(x3*U - x1*W) + x3*(x1*V - x2*U) = 0"),
        mutants={"x3 V with the other sign": ("- x3*V", "+ x3*V")},
    ),
    Claim(
        id="hydromechanics 48 component along OF",
        statement=r"\frac{x_1y_1 + x_2y_2 + x_3y_3}{F} = G = \text{constant}",
        domain=f"{_FREE}; F not zero",
        method=f"d/dt of the component squared, (x.y)^2/(x.x); {_EXPANDED}",
        check=unloaded("d((x @ y)**2 / (x @ x)) = 0"),
        mutants={
            "x1 counted twice in F": ("/ (x @ x)", "/ (x @ x + x1**2)"),
            "under a force": loaded("d((x @ y)**2 / (x @ x)) = 0"),
        },
    ),
)
