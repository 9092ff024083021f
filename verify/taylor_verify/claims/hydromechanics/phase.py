"""Hydromechanics 49 (9)-(13): the angle of (x1, x2) about the axis of Clebsch's body.

xi = x1 + i x2, eta = y1 + i y2; the other symbols as in clebsch.py. Logarithms and square roots enter
by their derivatives alone, so that every identity is one of rational functions and i.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, Final

from taylor_verify.claims.claim import Claim, Verdict
from taylor_verify.claims.field import Element, identity
from taylor_verify.claims.hydromechanics.clebsch import POINT_TEXT, ClebschBody

_ROOM: Final = "T of the form (1); any free motion; off the axis, x1 + i x2 not zero"
_EXACT: Final = "by 48 (3), (4); exact expansion in x, y, the six coefficients, F and i"


def _pole(b: ClebschBody, sign: int = 1) -> Any:
    return b.F * b.G - b.x[2] * b.y[2] + sign * b.i * b.root


def product(b: ClebschBody, sign: int = 1) -> Iterator[Element]:
    """(9), all members; the last fixes sqrt(X3) = x1 y2 - x2 y1."""
    (x1, x2, _), (y1, y2, _) = b.x, b.y
    left = (x1 - b.i * x2) * b.eta
    yield left - (x1 * y1 + x2 * y2 + b.i * (x1 * y2 - x2 * y1))
    yield left - _pole(b, sign)


def quotient(b: ClebschBody, sign: int = 1) -> Iterator[Element]:
    """(10)."""
    x1, x2, _ = b.x
    yield b.eta / b.xi - _pole(b, sign) / (x1**2 + x2**2)


def turning(b: ClebschBody, with_xi: bool = True, sign: int = 1) -> Iterator[Element]:
    """(11)."""
    bracket = (b.qq - b.q) * b.x[2] + b.rr * b.y[2]
    turned = bracket * b.xi if with_xi else bracket
    yield b.rate(b.xi) - (-b.i * turned + sign * b.i * b.r * b.x[2] * b.eta)


def log_rate(b: ClebschBody, sign: int = 1, power: int = 1) -> Iterator[Element]:
    """(12): d log(xi) / (i dt)."""
    x3, y3 = b.x[2], b.y[2]
    right = -(b.qq - b.q) * x3 - b.rr * y3 + b.r**power * x3 * _pole(b, sign) / (b.F**2 - x3**2)
    yield b.rate(b.xi) / (b.i * b.xi) - right


def angle_rate(b: ClebschBody, sign: int = 1, with_F: bool = True) -> Iterator[Element]:
    """(13): d log sqrt(xi / conj xi) / (i dt)."""
    x3, y3 = b.x[2], b.y[2]
    conjugate = b.x[0] - b.i * b.x[1]
    left = (b.rate(b.xi) / b.xi - b.rate(conjugate) / conjugate) / (2 * b.i)
    torn = b.r * (b.F * y3 - sign * b.G * x3) / (b.F**2 - x3**2)
    yield left - (-(b.qq - b.q) * x3 - (b.rr - b.r) * y3 - (b.F * torn if with_F else torn))


CLAIMS: Final = (
    Claim(
        id="hydromechanics 49 (9)",
        statement=r"(x_1 - x_2i)(y_1 + y_2i) = x_1y_1 + x_2y_2 + i(x_1y_2 - x_2y_1) "
        r"= FG - x_3y_3 + i\sqrt{X_3}",
        domain="T of the form (1); any free motion. It fixes the sign of the root: sqrt(X3) = x1 y2 - "
        "x2 y1 = (dx3/dt)/r",
        method=_EXACT,
        verdict=Verdict.RESTORED,
        lost="`xy3y3` stands for x3 y3",
        check=identity(ClebschBody, product),
        mutants={"- i sqrt(X3)": identity(ClebschBody, product, sign=-1)},
    ),
    Claim(
        id="hydromechanics 49 (10)",
        statement=r"\frac{y_1 + y_2i}{x_1 + x_2i} = \frac{FG - x_3y_3 + i\sqrt{X_3}}{x_1^2 + x_2^2}",
        domain=_ROOM,
        method=_EXACT,
        verdict=Verdict.RESTORED,
        lost="both fraction bars",
        check=identity(ClebschBody, quotient),
        mutants={"- i sqrt(X3)": identity(ClebschBody, quotient, sign=-1)},
    ),
    Claim(
        id="hydromechanics 49 (11)",
        statement=r"\frac{d}{dt}(x_1 + x_2i) = -i[(q' - q)x_3 + r'y_3] + irx_3(y_1 + y_2i)",
        domain="T of the form (1); any free motion",
        method=_EXACT,
        verdict=Verdict.FALSE,
        correction=r"\frac{d}{dt}(x_1 + x_2i) = -i[(q' - q)x_3 + r'y_3](x_1 + x_2i) "
        r"+ irx_3(y_1 + y_2i)",
        counterexample=f"{POINT_TEXT}: the left side is 36 + 4 i by the equations of motion, the right "
        "side 24 + 8 i; its two terms are not even of one dimension",
        check=identity(ClebschBody, turning),
        transcribed=identity(ClebschBody, turning, with_xi=False),
        mutants={"i r x3 with the other sign": identity(ClebschBody, turning, sign=-1)},
    ),
    Claim(
        id="hydromechanics 49 (12)",
        statement=r"\frac{d}{i\,dt}\log(x_1 + x_2i) = -(q' - q)x_3 - r'y_3 "
        r"+ rx_3\frac{FG - x_3y_3 + i\sqrt{X_3}}{F^2 - x_3^2}",
        domain=_ROOM,
        method=_EXACT,
        verdict=Verdict.RESTORED,
        lost="the fraction bars; d/i dt is torn apart",
        check=identity(ClebschBody, log_rate),
        mutants={
            "- i sqrt(X3)": identity(ClebschBody, log_rate, sign=-1),
            "r^2 for r": identity(ClebschBody, log_rate, power=2),
        },
        remark="From the corrected (11) it follows; from (11) as transcribed it does not.",
    ),
    Claim(
        id="hydromechanics 49 (13)",
        statement=r"\frac{d}{i\,dt}\log\sqrt{\frac{x_1 + x_2i}{x_1 - x_2i}} = -(q' - q)x_3 "
        r"- (r' - r)y_3 - Fr\frac{Fy_3 - Gx_3}{F^2 - x_3^2}",
        domain=_ROOM,
        method=_EXACT,
        verdict=Verdict.RESTORED,
        lost="the fraction bars, and the quotient under the root",
        check=identity(ClebschBody, angle_rate),
        mutants={
            "F y3 + G x3": identity(ClebschBody, angle_rate, sign=-1),
            "r for F r": identity(ClebschBody, angle_rate, with_F=False),
        },
    ),
)
