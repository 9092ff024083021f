"""Hydromechanics 48 (i)-(iii) and (10): what a free solid keeps, and the couple that acts on y.

Symbols as in solid.py; every identity is expanded in exact rationals with all 21 coefficients of T.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from taylor_verify.claims.claim import Claim, Verdict
from taylor_verify.claims.field import Element, apply, cross, dot, identity, minus
from taylor_verify.claims.hydromechanics.solid import Solid, loaded, unloaded

_EXPANDED: Final = "by (3) and (4); exact expansion in x, y and all 21 coefficients of T"
_FREE: Final = "no external force or couple; any T"


def energy(s: Solid, share: int = 1) -> Iterator[Element]:
    """dT/dt, and that U and Omega are the derivatives of T in (i)."""
    yield s.field.rate(s.T) - (share - 1) * dot(s.x, s.U)
    yield from (s.field.partial(s.T, f"x{k + 1}") - s.U[k] for k in range(3))
    yield from (s.field.partial(s.T, f"y{k + 1}") - s.Omega[k] for k in range(3))


def square(s: Solid, sign: int = 1) -> Iterator[Element]:
    """d(x.x)/dt."""
    x1, x2, x3 = s.x
    yield s.field.rate(x1**2 + sign * x2**2 + x3**2)


def product(s: Solid, index: int = 3) -> Iterator[Element]:
    """d(x.y)/dt."""
    yield s.field.rate(s.x[0] * s.y[0] + s.x[1] * s.y[1] + s.x[2] * s.y[index - 1])


def fixed_in_space(s: Solid) -> Iterator[Element]:
    """(R x)'."""
    yield from s.rates(apply(s.R, s.x))


def couple(s: Solid, sign: int = 1) -> Iterator[Element]:
    """y' - y x Omega is the couple (10)."""
    (x1, x2, x3), (U, V, W) = s.x, s.U
    turned = minus(s.rates(s.y), cross(s.y, s.Omega))
    yield from minus(turned, [x2 * W - sign * x3 * V, x3 * U - x1 * W, x1 * V - x2 * U])


def across(s: Solid, sign: int = 1) -> Iterator[Element]:
    """The couple (10) along x."""
    (x1, x2, x3), (U, V, W) = s.x, s.U
    yield dot(s.x, [x2 * W - sign * x3 * V, x3 * U - x1 * W, x1 * V - x2 * U])


def along(s: Solid, factor: int = 1) -> Iterator[Element]:
    """The square of y.x/|x|, the component along OF: its rate, without the root."""
    yield s.field.rate(dot(s.x, s.y) ** 2 / (dot(s.x, s.x) + (factor - 1) * s.x[0] ** 2))


CLAIMS: Final = (
    Claim(
        id="hydromechanics 48 (i)",
        statement=r"T = \text{constant}",
        domain=_FREE,
        method=f"dT/dt = 0, with U = dT/dx and (P, Q, R) = dT/dy; {_EXPANDED}",
        verdict=Verdict.HOLDS,
        check=identity(unloaded, energy),
        mutants={
            "a rate x.U": identity(unloaded, energy, share=2),
            "under a force": identity(loaded, energy),
        },
    ),
    Claim(
        id="hydromechanics 48 (ii)",
        statement=r"x_1^2 + x_2^2 + x_3^2 = F^2",
        domain=f"{_FREE}; F a constant",
        method=_EXPANDED,
        verdict=Verdict.HOLDS,
        check=identity(unloaded, square),
        mutants={"- x2^2": identity(unloaded, square, sign=-1)},
    ),
    Claim(
        id="hydromechanics 48 (iii)",
        statement=r"x_1y_1 + x_2y_2 + x_3y_3 = GF",
        domain=f"{_FREE}; G a constant, not the G of (8)",
        method=_EXPANDED,
        verdict=Verdict.HOLDS,
        check=identity(unloaded, product),
        mutants={"x3 y2 for x3 y3": identity(unloaded, product, index=2)},
        remark="The letter n between the two members means only a constant.",
    ),
    Claim(
        id="hydromechanics 48 constant vector",
        statement=r"x_1, x_2, x_3 \text{ are the components of a constant vector having a fixed "
        r"direction}",
        domain=f"{_FREE}; fixed in space",
        method=f"(R x)' = 0 with R' = R [Omega]x; {_EXPANDED}",
        verdict=Verdict.HOLDS,
        check=identity(unloaded, fixed_in_space),
        mutants={"under a force": identity(loaded, fixed_in_space)},
    ),
    Claim(
        id="hydromechanics 48 (10)",
        statement=r"x_2W - x_3V,\quad x_3U - x_1W,\quad x_1V - x_2U",
        domain=f"{_FREE}; the couple as if subject to which the vector y moves",
        method=f"y' - y x Omega, the rate of y in space, is this vector; {_EXPANDED}",
        verdict=Verdict.HOLDS,
        check=identity(unloaded, couple),
        mutants={"x3 V with the other sign": identity(unloaded, couple, sign=-1)},
    ),
    Claim(
        id="hydromechanics 48 couple perpendicular to F",
        statement=r"x_1(x_2W - x_3V) + x_2(x_3U - x_1W) + x_3(x_1V - x_2U) = 0",
        domain=_FREE,
        method="exact expansion in x, y and all 21 coefficients of T",
        verdict=Verdict.HOLDS,
        check=identity(unloaded, across),
        mutants={"x3 V with the other sign": identity(unloaded, across, sign=-1)},
    ),
    Claim(
        id="hydromechanics 48 component along OF",
        statement=r"\frac{x_1y_1 + x_2y_2 + x_3y_3}{F} = G = \text{constant}",
        domain=f"{_FREE}; F not zero",
        method=f"d/dt of the component squared, (x.y)^2/(x.x); {_EXPANDED}",
        verdict=Verdict.HOLDS,
        check=identity(unloaded, along),
        mutants={
            "x1 counted twice in F": identity(unloaded, along, factor=2),
            "under a force": identity(loaded, along),
        },
    ),
)
