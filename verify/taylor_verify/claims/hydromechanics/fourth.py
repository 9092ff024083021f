"""Hydromechanics 48 and 49: which bodies have a fourth integral, and what it is good for.

A polynomial integral splits into homogeneous ones, because the right sides of 48 (3), (4) are
homogeneous quadratic: those of one degree are the null space of a matrix of rationals.

z = (x, y)   v(z)   the right side, z' = v(z)
"""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from functools import partial
from itertools import combinations_with_replacement
from typing import Any, Final

from taylor_verify.claims.claim import Check, Claim, Residual, Verdict, worse
from taylor_verify.claims.field import Element, Field, apply, cross, dot, identity, plus, symbols_of
from taylor_verify.claims.hydromechanics.poles import branching
from taylor_verify.claims.hydromechanics.solid import Solid, unloaded
from taylor_verify.scenes import tensors
from taylor_verify.scenes.bodies import Clebsch, ImmersedBody

_NAMES: Final = ("x1", "x2", "x3", "y1", "y2", "y3")
_COUNTED: Final = "dimensions of null spaces, by exact elimination over the rationals"


def _diagonal(*entries: Fraction | int) -> tensors.Matrix:
    return tensors.diagonal(tuple(Fraction(entry) for entry in entries))


def _matrix(*rows: tuple[int, int, int]) -> tensors.Matrix:
    return tuple(tuple(Fraction(entry, 7) for entry in row) for row in rows)


# No two of the 21 coefficients stand in a relation that a symmetry would make.
GENERIC: Final = ImmersedBody(
    linear=_matrix((17, 1, 2), (1, 23, -3), (2, -3, 31)),
    coupling=_matrix((2, 1, -1), (3, -2, 1), (1, 2, 4)),
    angular=_matrix((13, 2, 1), (2, 19, 3), (1, 3, 29)),
)
SYMMETRIC: Final = Clebsch(*map(Fraction, (3, 2, 0, 1, 2, 1))).body()
# Clebsch's second case: p_i = p0 + theta r_j r_k with theta = 1/2.
SECOND_CASE: Final = ImmersedBody(
    linear=_diagonal(4, Fraction(5, 2), 2),
    coupling=_diagonal(0, 0, 0),
    angular=_diagonal(1, 2, 3),
)
# Steklov's: b_i = mu r_j r_k, p_i = mu^2 r_i (r_j - r_k)^2 + p0, with mu = 1/2 and r = (1, 2, 4).
STEKLOV: Final = ImmersedBody(
    linear=_diagonal(31, 30 + Fraction(9, 2), 31),
    coupling=_diagonal(4, 2, 1),
    angular=_diagonal(1, 2, 4),
)


def integrals(body: ImmersedBody, degree: int) -> int:
    """The dimension of the homogeneous polynomials of this degree that every free motion conserves."""
    from flint import fmpq_mat

    field = Field(dict.fromkeys(_NAMES, 1))
    x, y = field.vector("x"), field.vector("y")
    U = plus(apply(body.linear, x), apply(body.coupling, y))
    Omega = plus(apply(tensors.transpose(body.coupling), x), apply(body.angular, y))
    rates = cross(x, Omega) + plus(cross(y, Omega), cross(x, U))
    field.turn(dict(zip(_NAMES, rates, strict=True)))
    monomials = [_product(field, names) for names in combinations_with_replacement(_NAMES, degree)]
    columns = [field.rate(monomial).num.to_dict() for monomial in monomials]
    rows = sorted({exponents for column in columns for exponents in column})
    entries = [[column.get(exponents, 0) for column in columns] for exponents in rows]
    return len(monomials) - (int(fmpq_mat(entries).rank()) if entries else 0)


def _product(field: Field, names: tuple[str, ...]) -> Element:
    result = field.element(1)
    for name in names:
        result = result * field[name]
    return result


# T, F^2 and FG, of degree 2, and their products make these many and no more.
_OF_THREE: Final = {1: 0, 2: 3, 3: 0, 4: 6}


def no_further(body: ImmersedBody) -> Check:
    """How many polynomial integrals of degree up to 4 there are besides T, F^2, FG and their products."""

    def check() -> Residual:
        extra = sum(abs(integrals(body, d) - known) for d, known in _OF_THREE.items())
        return Residual(float(extra), 0.0, f"integrals beyond those of T, F^2 and FG; {_COUNTED}")

    return check


def known_families() -> Residual:
    """That the bodies named have exactly one more: of degree 1, 2 and 2."""
    found = (integrals(SYMMETRIC, 1), integrals(SECOND_CASE, 2), integrals(STEKLOV, 2))
    missed = sum(abs(a - b) for a, b in zip(found, (1, 4, 4), strict=True))
    return Residual(float(missed), 0.0, f"integrals of the known families; {_COUNTED}")


# Jacobi's last multiplier.


def divergence(s: Solid, transposed: bool = True) -> Iterator[Element]:
    """div v = 0 for every T: the last multiplier is constant.

    ``transposed`` False takes B for B^T in Omega, which is no derivative of T.
    """
    dx, dy = s.dx, s.dy
    if not transposed:
        Omega = plus(apply(s.coupling, s.x), apply(s.angular, s.y))
        dx, dy = cross(s.x, Omega), plus(cross(s.y, Omega), cross(s.x, s.U))
    partials = [
        s.field.partial(dx[k], f"x{k + 1}") + s.field.partial(dy[k], f"y{k + 1}") for k in range(3)
    ]
    yield sum(partials, start=s.field.element(0))


def independent(fourth: str) -> Check:
    """How many of four gradients depend on the others, at a point: T, F^2, FG and a fourth integral."""

    def check() -> Residual:
        from flint import fmpq, fmpq_mat

        from taylor_verify.claims.hydromechanics.clebsch import ClebschBody

        b = symbols_of(ClebschBody)
        four = [b.T, dot(b.x, b.x), b.FG, b.y[2] if fourth == "y3" else dot(b.x, b.x) ** 2]
        rows = []
        for integral in four:
            slopes = [b.field.partial(b.field.element(integral), name) for name in _NAMES]
            values = [b.field.value(slope) for slope in slopes]
            rows.append([fmpq(v.numerator, v.denominator) for v in values])
        missing = 4 - int(fmpq_mat(rows).rank())
        return Residual(
            float(missing), 0.0, "4 less the rank of four gradients at a rational point"
        )

    return check


# The energy with a linear integral.


def coefficients_left(kept: int = 7) -> Residual:
    """The number of coefficients of T that y3' = 0 leaves free, less those of (1) and of s."""
    from flint import fmpq_mat

    s = unloaded()
    rate = plus(cross(s.y, s.Omega), cross(s.x, s.U))[2]
    names = [n for n in s.field.names if n[0] in "ABC"]
    columns = [s.field.partial(rate, name).num.to_dict() for name in names]
    rows = sorted({exponents for column in columns for exponents in column})
    entries = [[column.get(exponents, 0) for column in columns] for exponents in rows]
    left = len(names) - int(fmpq_mat(entries).rank())
    return Residual(
        float(abs(left - kept)), 0.0, f"free coefficients of T beyond seven; {_COUNTED}"
    )


class Planar:
    """Three planes of symmetry, p1 != p2, moving with x3 = y1 = y2 = 0: y3 is not constant."""

    def __init__(self) -> None:
        point = {"x1": 2, "x2": 3, "y3": 4, "p1": 2, "p2": 3, "r3": 1}
        self.field = field = Field(point)
        zero = field.element(0)
        x1, x2, y3, p1, p2, self.r = (field[name] for name in point)
        x, y = [x1, x2, zero], [zero, zero, y3]
        U, Omega = [p1 * x1, p2 * x2, zero], [zero, zero, self.r * y3]
        self.dx, self.dy = cross(x, Omega), plus(cross(y, Omega), cross(x, U))
        field.turn({"x1": self.dx[0], "x2": self.dx[1], "y3": self.dy[2]})
        self.p1, self.p2, self.y3 = p1, p2, y3
        self.F2 = x1**2 + x2**2
        self.twice_T = p1 * x1**2 + p2 * x2**2 + self.r * y3**2


def swing(s: Planar, factor: int = 1) -> Iterator[Element]:
    """The plane is kept, and y3'^2 is a quartic in y3 with constant coefficients."""
    yield from (s.dx[2], s.dy[0], s.dy[1])
    yield from (s.field.rate(s.twice_T), s.field.rate(s.F2))
    level = s.twice_T - factor * s.r * s.y3**2
    yield s.field.rate(s.y3) ** 2 - (level - s.p1 * s.F2) * (s.p2 * s.F2 - level)


def swing_rate(s: Planar) -> Iterator[Element]:
    yield s.field.rate(s.y3)


def _both(*checks: Any) -> Check:
    return lambda: worse(*(check() for check in checks))


CLAIMS: Final = (
    Claim(
        id="hydromechanics 48 reducible to a quadrature",
        statement=r"\text{if a fourth integral is obtainable, the solution is reducible to a quadrature}",
        domain="no external force; x and y, on regular levels of the integrals",
        method="the divergence of the right sides of (3), (4) vanishes for every T (exact expansion), so "
        "that Jacobi's last multiplier is 1; the gradients of T, F^2, FG and y3 at a point",
        verdict=Verdict.ONLY_IF,
        condition="the fourth integral is independent of T, F^2 and FG",
        correction=r"\text{with a fourth integral independent of } T, F^2, FG",
        counterexample="F^4 is an integral too, and adds nothing",
        check=_both(identity(unloaded, divergence), independent("y3")),
        transcribed=independent("F^4"),
        mutants={
            "B for its transpose in Omega": identity(unloaded, divergence, transposed=False),
            "F^4 as the fourth": independent("F^4"),
        },
        remark="Attitude and centre take further quadratures.",
    ),
    Claim(
        id="hydromechanics 48 limited series of cases",
        statement=r"\text{a fourth integral is not possible except in a limited series of cases}",
        domain="no external force; which integrals are meant is not said",
        method="polynomial integrals of degree up to 4 of a body with 21 coefficients without relation, "
        f"and of the known families (Clebsch, both cases, and Steklov); {_COUNTED}",
        verdict=Verdict.UNDECIDED,
        gap="for one body there is no further polynomial integral of degree 4 or less, so that some "
        "condition on T is needed; integrals of higher degree, and integrals that are no "
        "polynomials, are not excluded here, nor is the series of cases shown to be complete",
        check=_both(no_further(GENERIC), known_families),
        mutants={
            "Clebsch's first case as the general body": no_further(SYMMETRIC),
            "Clebsch's second case as the general body": no_further(SECOND_CASE),
            "Steklov's case as the general body": no_further(STEKLOV),
        },
    ),
    Claim(
        id="hydromechanics 48 double-theta function",
        statement=r"\text{the general solution requires the double-theta hyperelliptic function}",
        domain="no external force",
        method="a quotient of theta functions of linear functions of t is single-valued; at a pole of a "
        "general solution the Kowalevski exponents must then be integers: they are in Clebsch's "
        "second case, and are not for a body with 21 coefficients without relation",
        verdict=Verdict.UNDECIDED,
        gap="for a body without a fourth integral no theta function of t serves, so that only the "
        "integrable cases can be meant; that these need genus two and no less is not shown here",
        check=branching(SECOND_CASE),
        mutants={"a body without a fourth integral": branching(GENERIC)},
    ),
    Claim(
        id="hydromechanics 49 most general energy",
        statement=r"\text{in the motion which can be solved by the elliptic function, the most "
        r"general expression of the kinetic energy is (1)}",
        domain="free motions of a solid",
        method="of 21 coefficients y3' = 0 leaves seven, those of (1) and s (x1 y2 - x2 y1), which is that "
        f"of another origin; {_COUNTED}. A planar motion of another body, by exact expansion",
        verdict=Verdict.ONLY_IF,
        condition="it is meant of bodies for all of whose motions y3 is constant; single motions of "
        "other bodies are elliptic as well",
        correction=r"\text{the most general } T \text{ with } y_3 = \text{constant for every motion}",
        counterexample="2T = 2 x1^2 + 3 x2^2 + p3 x3^2 + r1 y1^2 + r2 y2^2 + y3^2 in the plane x3 = y1 = "
        "y2 = 0: y3 is not constant, but (dy3/dt)^2 = (2T - y3^2 - 2 F^2)(3 F^2 - 2T + y3^2)",
        check=_both(coefficients_left, identity(Planar, swing)),
        transcribed=identity(Planar, swing_rate),
        mutants={
            "six coefficients": partial(coefficients_left, kept=6),
            "the planar motion without r y3^2": identity(Planar, swing, factor=0),
        },
    ),
)
