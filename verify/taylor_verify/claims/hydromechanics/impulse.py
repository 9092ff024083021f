"""Hydromechanics 48 (3)-(9): how linear and angular impulse change under force and couple.

The law behind them is that of space: the impulse R x grows by the force, its moment R y + c x R x
about a fixed point by the moment of the loads. Symbols as in solid.py; every identity is expanded in
exact rationals with all 21 coefficients of T as symbols.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, Final

from taylor_verify.claims.claim import Claim, Verdict
from taylor_verify.claims.field import Element, apply, cross, dot, identity, minus, plus, transposed
from taylor_verify.claims.hydromechanics.solid import Solid, loaded, unposed

_EXPANDED: Final = "exact expansion in x, y, the quaternion and all 21 coefficients of T"
_DOMAIN: Final = "body axes through any origin O of the body; any T; any force and couple"


def linear_law(s: Solid, sign: int = 1, factor: int = 1) -> Iterator[Element]:
    """R^T [(R x)' - R X], with x' free, is the left side of (3) minus its right side."""
    P, Q, R = s.Omega
    x1, x2, x3 = s.x
    law = apply(transposed(s.R), minus(s.rates(apply(s.R, s.x)), apply(s.R, s.X)))
    yield law[0] - (s.dx[0] - sign * x2 * R + x3 * Q - factor * s.X[0])
    yield law[1] - (s.dx[1] - x3 * P + x1 * R - s.X[1])
    yield law[2] - (s.dx[2] - x1 * Q + x2 * P - s.X[2])


def angular_law(s: Solid, arm: int = 1, sign: int = 1) -> Iterator[Element]:
    """The moment about a fixed point grows by that of the loads: (4), where (3) is granted."""
    P, Q, R = s.Omega
    U, V, W = s.U
    (x1, x2, x3), (y1, y2, y3) = s.x, s.y
    impulse, force = apply(s.R, s.x), apply(s.R, s.X)
    moment = s.rates(plus(apply(s.R, s.y), cross(s.c, impulse)))
    loads = plus(apply(s.R, s.L), cross(s.c, force))
    granted = cross(s.c, minus(s.rates(impulse), force))
    law = apply(transposed(s.R), minus(minus(moment, loads), granted))
    yield law[0] - (s.dy[0] - y2 * R + y3 * Q - sign * x2 * W + arm * x3 * V - s.L[0])
    yield law[1] - (s.dy[1] - y3 * P + y1 * R - x3 * U + x1 * W - s.L[1])
    yield law[2] - (s.dy[2] - y1 * Q + y2 * P - x1 * V + x2 * U - s.L[2])


def fixed_line(s: Solid, sign: int = 1, third: int = 2) -> Iterator[Element]:
    """(5): the direction cosines l, m, n in body axes of a line fixed in space."""
    P, Q, R = s.Omega
    l, m, n = s.l
    dl, dm, dn = s.rates(s.l)
    yield dl - (sign * m * R - n * Q)
    yield dm - (n * P - l * R)
    yield dn - (l * Q - s.l[third - 1] * P)


def impulse_along(s: Solid, index: int = 2) -> Iterator[Element]:
    """(6) is one number for every set of axes: that of R x along the fixed n."""
    yield dot(s.n, apply(s.R, s.x)) - (s.l[0] * s.x[0] + s.l[1] * s.x[index - 1] + s.l[2] * s.x[2])


def impulse_along_rate(s: Solid, sign: int = 1, factor: int = 1) -> Iterator[Element]:
    """(7), first and second member for free x', then the third by (3)."""
    P, Q, R = s.Omega
    x1, x2, x3 = s.x
    brackets = [
        s.dx[0] - sign * x2 * R + x3 * Q,
        s.dx[1] - x3 * P + x1 * R,
        s.dx[2] - x1 * Q + x2 * P,
    ]
    yield s.field.rate(dot(s.l, s.x)) - dot(s.l, brackets)
    moving = loaded()
    yield moving.field.rate(dot(moving.l, moving.x)) - factor * dot(moving.l, moving.X)


def _moment(s: Solid, sign: int = 1) -> Any:
    """(8) as written, r = (x, y, z) the body components of O from the fixed origin."""
    x, y, z = apply(transposed(s.R), s.c)
    x1, x2, x3 = s.x
    about = [
        s.y[0] - sign * x2 * z + x3 * y,
        s.y[1] - x3 * x + x1 * z,
        s.y[2] - x1 * y + x2 * x,
    ]
    return dot(s.l, about)


def moment_about(s: Solid, sign: int = 1) -> Iterator[Element]:
    """(8) is the component along n of the moment R y + c x R x about the fixed origin."""
    yield dot(s.n, plus(apply(s.R, s.y), cross(s.c, apply(s.R, s.x)))) - _moment(s, sign)


def moment_rate(s: Solid, sign: int = 1, moved: bool = True, members: int = 2) -> Iterator[Element]:
    """(9), for free x', y' and then by (3), (4), with the fixed origin moved up to O.

    Elsewhere the arm of the force adds l.(r x X) and the first member changes: at any origin the
    difference is l.(r x (x' - x x Omega)), which vanishes with r alone.
    """
    P, Q, R = s.Omega
    U, V, W = s.U
    (x1, x2, x3), (y1, y2, y3) = s.x, s.y
    r = apply(transposed(s.R), s.c)
    brackets = [
        s.dy[0] - y2 * R + y3 * Q - sign * x2 * W + x3 * V,
        s.dy[1] - y3 * P + y1 * R - x3 * U + x1 * W,
        s.dy[2] - y1 * Q + y2 * P - x1 * V + x2 * U,
    ]
    arm = dot(s.l, cross(r, minus(s.dx, cross(s.x, s.Omega)))) if moved else 0
    yield s.field.rate(_moment(s)) - arm - dot(s.l, brackets)
    moving = loaded()
    at = apply(transposed(moving.R), moving.c)
    lever = dot(moving.l, cross(at, moving.X)) if moved else 0
    yield moving.field.rate(_moment(moving)) - lever - (members - 1) * dot(moving.l, moving.L)


CLAIMS: Final = (
    Claim(
        id="hydromechanics 48 (3)",
        statement=r"\dot x_1 - x_2R + x_3Q = X,\quad \dot x_2 - x_3P + x_1R = Y,\quad "
        r"\dot x_3 - x_1Q + x_2P = Z",
        domain=_DOMAIN,
        method=f"equivalent to (R x)' = R X in space for any x'; {_EXPANDED}",
        verdict=Verdict.RESTORED,
        lost="the equation stands above the first line of the scan; its brackets return in (7)",
        check=identity(unposed, linear_law),
        mutants={
            "x2 R with the other sign": identity(unposed, linear_law, sign=-1),
            "twice the force": identity(unposed, linear_law, factor=2),
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
        verdict=Verdict.RESTORED,
        lost="the equation stands above the first line of the scan; its brackets return in (9)",
        check=identity(unposed, angular_law),
        mutants={
            "without x3 V (no Munk moment)": identity(unposed, angular_law, arm=0),
            "x2 W with the other sign": identity(unposed, angular_law, sign=-1),
        },
    ),
    Claim(
        id="hydromechanics 48 (5)",
        statement=r"\dot l = mR - nQ,\quad \dot m = nP - lR,\quad \dot n = lQ - mP",
        domain="l, m, n: body components of a direction fixed in space",
        method=f"l = R^T n with n constant and R' = R [Omega]x; {_EXPANDED}",
        verdict=Verdict.RESTORED,
        lost="the three fractions are run together",
        check=identity(loaded, fixed_line),
        mutants={
            "m R with the other sign": identity(loaded, fixed_line, sign=-1),
            "l for m in the third": identity(loaded, fixed_line, third=1),
        },
    ),
    Claim(
        id="hydromechanics 48 (6)",
        statement=r"P = lx_1 + mx_2 + nx_3",
        domain="a definition; this P is the impulse along (l, m, n), not the P of (P, Q, R)",
        method="consistent: the same number for every set of axes, the component of R x along the "
        f"fixed line; its rate is (7); {_EXPANDED}",
        verdict=Verdict.HOLDS,
        check=identity(loaded, impulse_along),
        mutants={"m x1 for m x2": identity(loaded, impulse_along, index=1)},
    ),
    Claim(
        id="hydromechanics 48 (7)",
        statement=r"\frac{dP}{dt} = l(\dot x_1 - x_2R + x_3Q) + m(\dot x_2 - x_3P + x_1R) "
        r"+ n(\dot x_3 - x_1Q + x_2P) = lX + mY + nZ",
        domain=_DOMAIN,
        method=f"the first two members for any x', the last by (3); {_EXPANDED}",
        verdict=Verdict.RESTORED,
        lost="fractions and lines are run together",
        check=identity(unposed, impulse_along_rate),
        mutants={
            "x2 R with the other sign": identity(unposed, impulse_along_rate, sign=-1),
            "twice the force": identity(unposed, impulse_along_rate, factor=2),
        },
    ),
    Claim(
        id="hydromechanics 48 (8)",
        statement=r"G = l(y_1 - x_2z + x_3y) + m(y_2 - x_3x + x_1z) + n(y_3 - x_1y + x_2x)",
        domain="a definition; x, y, z: body components of O seen from a fixed origin. This G is a "
        "moment along (l, m, n), not the constant of (iii)",
        method="consistent: the component along the fixed line of R y + c x R x; its rate is (9); "
        f"{_EXPANDED}",
        verdict=Verdict.HOLDS,
        check=identity(loaded, moment_about),
        mutants={"x2 z with the other sign": identity(loaded, moment_about, sign=-1)},
    ),
    Claim(
        id="hydromechanics 48 (9)",
        statement=r"\frac{dG}{dt} = l(\dot y_1 - y_2R + y_3Q - x_2W + x_3V) "
        r"+ m(\dot y_2 - y_3P + y_1R - x_3U + x_1W) + n(\dot y_3 - y_1Q + y_2P - x_1V + x_2U) "
        r"= lL + mM + nN",
        domain=f"{_DOMAIN}; the fixed origin moved up to O, x = y = z = 0 but their rates U, V, W",
        method="the first two members for any x', y', the last by (3), (4); the terms with r = (x, y, "
        f"z) are found, l.(r x X) in the last member, and vanish with r; {_EXPANDED}",
        verdict=Verdict.RESTORED,
        lost="fractions and lines are run together",
        check=identity(unposed, moment_rate),
        mutants={
            "x2 W with the other sign": identity(unposed, moment_rate, sign=-1),
            "a fixed origin left behind": identity(unposed, moment_rate, moved=False),
            "twice the couple": identity(unposed, moment_rate, members=3),
        },
        remark="About a fixed origin elsewhere the right side is l.(L + r x X).",
    ),
)
