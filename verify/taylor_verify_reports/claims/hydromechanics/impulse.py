"""Hydromechanics 48 (3)-(9): the change of linear and angular impulse under force and couple.

The law behind them is that of space: the impulse R x grows by the force, its moment R y + c x R x
about a fixed point by the moment of the loads. Symbols as in solid.py; every identity is expanded in
exact rationals with all 21 coefficients of T as symbols.
"""

from __future__ import annotations

from typing import Final

from taylor_verify_reports.claims.check import All
from taylor_verify_reports.claims.claim import Claim
from taylor_verify_reports.claims.hydromechanics.solid import loaded, unposed

_EXPANDED: Final = "exact expansion in x, y, the quaternion and all 21 coefficients of T"
_DOMAIN: Final = "body axes through any origin O of the body; any T; any force and couple"

# The left sides of (3) and (4); (8), with r the body components of O from the fixed origin.
_LINEAR: Final = "array([dx1 - x2*R + x3*Q, dx2 - x3*P + x1*R, dx3 - x1*Q + x2*P])"
_ANGULAR: Final = (
    "array([dy1 - y2*R + y3*Q - x2*W + x3*V, dy2 - y3*P + y1*R - x3*U + x1*W,"
    " dy3 - y1*Q + y2*P - x1*V + x2*U])"
)
_MOMENT: Final = (
    "(l*(y1 - x2*r[2] + x3*r[1]) + m*(y2 - x3*r[0] + x1*r[2]) + n*(y3 - x1*r[1] + x2*r[0]))"
)

CLAIMS: Final = (
    Claim(
        id="hydromechanics 48 (3)",
        statement=r"\dot x_1 - x_2R + x_3Q = X,\quad \dot x_2 - x_3P + x_1R = Y,\quad "
        r"\dot x_3 - x_1Q + x_2P = Z",
        domain=_DOMAIN,
        method=f"equivalent to (R x)' = R X in space for any x'; {_EXPANDED}",
        lost="the equation stands above the first line of the scan; its brackets return in (7)",
        check=unposed(f"rot.T @ (d(rot @ x) - rot @ force) = {_LINEAR} - force"),
        mutants={
            "x2 R with the other sign": ("- x2*R", "+ x2*R"),
            "twice the force": ("]) - force", "]) - 2*force"),
        },
    ),
    Claim(
        id="hydromechanics 48 (4)",
        statement=r"\dot y_1 - y_2R + y_3Q - x_2W + x_3V = L,\quad "
        r"\dot y_2 - y_3P + y_1R - x_3U + x_1W = M,\quad "
        r"\dot y_3 - y_1Q + y_2P - x_1V + x_2U = N",
        domain=_DOMAIN,
        method="equivalent, where (3) is granted, to the balance of the moment R y + c x R x about "
        f"a fixed point, for any y'; {_EXPANDED}",
        lost="the equation stands above the first line of the scan; its brackets return in (9)",
        # Where (3) is granted: its moment about the fixed point is taken away.
        check=unposed(
            "rot.T @ (d(rot @ y + cross(c, rot @ x)) - rot @ couple - cross(c, rot @ force)"
            f" - cross(c, d(rot @ x) - rot @ force)) = {_ANGULAR} - couple"
        ),
        mutants={
            "without x3 V (no Munk moment)": (" + x3*V", ""),
            "x2 W with the other sign": ("- x2*W", "+ x2*W"),
        },
    ),
    Claim(
        id="hydromechanics 48 (5)",
        statement=r"\dot l = mR - nQ,\quad \dot m = nP - lR,\quad \dot n = lQ - mP",
        domain="l, m, n: body components of a direction fixed in space",
        method=f"l = R^T n with n constant and R' = R [Omega]x; {_EXPANDED}",
        lost="the three fractions are run together",
        check=loaded("d(line) = [m*R - n*Q, n*P - l*R, l*Q - m*P]"),
        mutants={
            "m R with the other sign": ("[m*R", "[-m*R"),
            "l for m in the third": ("- m*P", "- l*P"),
        },
    ),
    Claim(
        id="hydromechanics 48 (6)",
        statement=r"P = lx_1 + mx_2 + nx_3",
        domain="a definition; this P is the impulse along (l, m, n), not the P of (P, Q, R)",
        method="consistent: the same number for every set of axes, the component of R x along the "
        f"fixed line; its rate is (7); {_EXPANDED}",
        check=loaded("u @ rot @ x = l*x1 + m*x2 + n*x3"),
        mutants={"m x1 for m x2": ("m*x2", "m*x1")},
    ),
    Claim(
        id="hydromechanics 48 (7)",
        statement=r"\frac{dP}{dt} = l(\dot x_1 - x_2R + x_3Q) + m(\dot x_2 - x_3P + x_1R) "
        r"+ n(\dot x_3 - x_1Q + x_2P) = lX + mY + nZ",
        domain=_DOMAIN,
        method=f"the first two members for any x', the last by (3); {_EXPANDED}",
        lost="fractions and lines are run together",
        check=All(
            unposed(f"d(line @ x) = line @ {_LINEAR}"), loaded("d(line @ x) = l*X + m*Y + n*Z")
        ),
        mutants={
            "x2 R with the other sign": ("- x2*R", "+ x2*R"),
            "twice the force": ("l*X + m*Y + n*Z", "2*(l*X + m*Y + n*Z)"),
        },
    ),
    Claim(
        id="hydromechanics 48 (8)",
        statement=r"G = l(y_1 - x_2z + x_3y) + m(y_2 - x_3x + x_1z) + n(y_3 - x_1y + x_2x)",
        domain="a definition; x, y, z: body components of O seen from a fixed origin. This G is a "
        "moment along (l, m, n), not the constant of (iii)",
        method="consistent: the component along the fixed line of R y + c x R x; its rate is (9); "
        f"{_EXPANDED}",
        check=loaded(f"u @ (rot @ y + cross(c, rot @ x)) = {_MOMENT}"),
        mutants={"x2 z with the other sign": ("- x2*r[2]", "+ x2*r[2]")},
    ),
    Claim(
        id="hydromechanics 48 (9)",
        statement=r"\frac{dG}{dt} = l(\dot y_1 - y_2R + y_3Q - x_2W + x_3V) "
        r"+ m(\dot y_2 - y_3P + y_1R - x_3U + x_1W) + n(\dot y_3 - y_1Q + y_2P - x_1V + x_2U) "
        r"= lL + mM + nN",
        domain=f"{_DOMAIN}; the fixed origin moved up to O, x = y = z = 0 but their rates U, V, W",
        method="the first two members for any x', y', the last by (3), (4); the terms with r = (x, y, "
        f"z) are found, l.(r x X) in the last member, and vanish with r; {_EXPANDED}",
        lost="fractions and lines are run together",
        # The fixed origin is moved up to O: elsewhere the arm of the force adds l.(r x X), and the first
        # member changes by l.(r x (x' - x x Omega)), which vanishes with r alone.
        check=All(
            unposed(f"d({_MOMENT}) = line @ {_ANGULAR} + line @ cross(r, dx - cross(x, Omega))"),
            loaded(f"d({_MOMENT}) = l*L + m*M + n*N + line @ cross(r, force)"),
        ),
        mutants={
            "x2 W with the other sign": ("- x2*W", "+ x2*W"),
            "a fixed origin left behind": (" + line @ cross(r, dx - cross(x, Omega))", ""),
            "twice the couple": ("l*L + m*M + n*N", "2*(l*L + m*M + n*N)"),
        },
        remark="About a fixed origin elsewhere the right side is l.(L + r x X).",
    ),
)
