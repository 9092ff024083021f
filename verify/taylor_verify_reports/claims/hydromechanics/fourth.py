"""Hydromechanics 48 and 49: the bodies with a fourth integral, and its use.

A polynomial integral splits into homogeneous ones, because the right sides of 48 (3), (4) are
homogeneous quadratic: those of one degree are the null space of a matrix of rationals.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from fractions import Fraction
from functools import partial
from itertools import combinations_with_replacement
from math import prod
from typing import Any, Final

import numpy as np
from flint import fmpq, fmpq_mat

from taylor_verify.numbers import tensors
from taylor_verify.scenes.bodies import Clebsch, ImmersedBody
from taylor_verify_reports.claims.check import All, Residual
from taylor_verify_reports.claims.claim import Claim
from taylor_verify_reports.claims.field import Field
from taylor_verify_reports.claims.hydromechanics.clebsch import clebsch
from taylor_verify_reports.claims.hydromechanics.poles import branching
from taylor_verify_reports.claims.hydromechanics.solid import unloaded
from taylor_verify_reports.claims.setting import Exact

_NAMES: Final = ("x1", "x2", "x3", "y1", "y2", "y3")
_COUNTED: Final = "dimensions of null spaces, by exact elimination over the rationals"


def _diagonal(*entries: Fraction | int) -> tensors.Matrix:
    return tensors.diagonal(tuple(Fraction(entry) for entry in entries))


def _matrix(*rows: tuple[int, int, int]) -> tensors.Matrix:
    return tuple(tuple(Fraction(entry, 7) for entry in row) for row in rows)


# A body without symmetry: no relation between any two of the 21 coefficients.
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
    """Return the number of homogeneous polynomials of this degree that every free motion conserves."""
    field = Field(dict.fromkeys(_NAMES, 1))
    x, y = field["x"], field["y"]
    linear, coupling, angular = map(np.array, (body.linear, body.coupling, body.angular))
    U, Omega = linear @ x + coupling @ y, coupling.T @ x + angular @ y
    field.turn(x=np.cross(x, Omega), y=np.cross(y, Omega) + np.cross(x, U))
    products = combinations_with_replacement([field[name] for name in _NAMES], degree)
    return _relations([field.rate(prod(factors)) for factors in products])


def _relations(polynomials: Sequence[Any]) -> int:
    """The number of linear relations between polynomials."""
    terms = [polynomial.num.to_dict() for polynomial in polynomials]
    rows = sorted(set().union(*terms))
    return len(terms) - _rank([term.get(row, 0) for term in terms] for row in rows)


def _rank(rows: Iterable[Sequence[Any]]) -> int:
    entries = list(rows)
    return int(fmpq_mat(entries).rank()) if entries else 0


# The numbers of integrals, by degree, that T, F^2, FG (of degree 2) and their products give.
_OF_THREE: Final = {1: 0, 2: 3, 3: 0, 4: 6}


def no_further(body: ImmersedBody) -> Residual:
    """The number of polynomial integrals of degree up to 4 besides T, F^2, FG and their products."""
    extra = sum(abs(integrals(body, d) - known) for d, known in _OF_THREE.items())
    return Residual(
        float(extra), bound=0.0, because=f"integrals beyond those of T, F^2 and FG; {_COUNTED}"
    )


def known_families() -> Residual:
    """The bodies named have exactly one more: of degree 1, 2 and 2."""
    numbers = (integrals(SYMMETRIC, 1), integrals(SECOND_CASE, 2), integrals(STEKLOV, 2))
    missed = sum(abs(a - b) for a, b in zip(numbers, (1, 4, 4), strict=True))
    return Residual(
        float(missed), bound=0.0, because=f"integrals of the known families; {_COUNTED}"
    )


# div v = 0 for every T: Jacobi's last multiplier is constant.
_divergence: Final = unloaded(
    "trace(grad(cross(x, Omega), 'x')) = -trace(grad(cross(y, Omega) + cross(x, vel), 'y'))"
)


def independent(fourth: str) -> Residual:
    """4 less the number of independent gradients, at a point: of T, F^2, FG and a fourth integral."""
    rows = []
    for integral in (clebsch["T"], clebsch["F"] ** 2, clebsch["FG"], clebsch[fourth]):
        slopes = [clebsch.field.partial(integral, name) for name in _NAMES]
        values = [clebsch.field.value(slope) for slope in slopes]
        rows.append([fmpq(v.numerator, v.denominator) for v in values])
    missing = 4 - _rank(rows)
    return Residual(
        float(missing), bound=0.0, because="4 less the rank of four gradients at a rational point"
    )


def coefficients_left(expected: int = 7) -> Residual:
    """Compare the number of coefficients of T that y3' = 0 leaves free with the ``expected`` number."""
    names = [name for name in unloaded.field.names if name[0] in "ABC"]
    left = _relations([unloaded.field.partial(unloaded["dy"][2], name) for name in names])
    return Residual(
        float(abs(left - expected)),
        bound=0.0,
        because=f"free coefficients of T beyond seven; {_COUNTED}",
    )


# Three planes of symmetry, p1 != p2, moving with x3 = y1 = y2 = 0: y3 is not constant.
_planar: Final = Exact(
    {"x1": 2, "x2": 3, "y3": 4, "p1": 2, "p2": 3, "r": 1},
    """
    x, y = array([x1, x2, 0 * x1]), array([0 * y3, 0 * y3, y3])
    U, Omega = array([p1, p2, 0]) * x, r * y
    dx, dy = cross(x, Omega), cross(y, Omega) + cross(x, U)
    turn(x1=dx[0], x2=dx[1], y3=dy[2])
    F2, twice_T = x @ x, x @ U + y @ Omega
    """,
)
# The plane is kept, and y3'^2 is a quartic in y3 with constant coefficients.
_swing: Final = _planar(
    "[dx[2], dy[0], dy[1], d(twice_T), d(F2)] = 0",
    "d(y3)**2 = (twice_T - r*y3**2 - p1*F2) * (p2*F2 - (twice_T - r*y3**2))",
)


CLAIMS: Final = (
    Claim(
        id="hydromechanics 48 reducible to a quadrature",
        statement=r"\text{if a fourth integral is obtainable, the solution is reducible to a quadrature}",
        domain="no external force; x and y, on regular levels of the integrals",
        method="the divergence of the right sides of (3), (4) vanishes for every T (exact expansion), so "
        "that Jacobi's last multiplier is 1; the gradients of T, F^2, FG and y3 at a point",
        condition="the fourth integral is independent of T, F^2 and FG",
        correction=r"\text{with a fourth integral independent of } T, F^2, FG",
        counterexample="F^4 is an integral too, and adds nothing",
        check=All(_divergence, partial(independent, "y3")),
        transcribed=partial(independent, "F4"),
        mutants={
            "B for its transpose in Omega": ("Omega", "(B @ x + C @ y)"),
            "F^4 as the fourth": partial(independent, "F4"),
        },
        remark="Attitude and centre take further quadratures.",
    ),
    Claim(
        id="hydromechanics 48 limited series of cases",
        statement=r"\text{a fourth integral is not possible except in a limited series of cases}",
        domain="no external force; which integrals are meant is not said",
        method="polynomial integrals of degree up to 4 of a body with 21 coefficients without relation, "
        f"and of the known families (Clebsch, both cases, and Steklov); {_COUNTED}",
        gap="for one body there is no further polynomial integral of degree 4 or less, so that some "
        "condition on T is needed; integrals of higher degree, and integrals that are no "
        "polynomials, are not excluded here, nor is the series of cases shown to be complete",
        check=All(partial(no_further, GENERIC), known_families),
        mutants={
            "Clebsch's first case as the general body": partial(no_further, SYMMETRIC),
            "Clebsch's second case as the general body": partial(no_further, SECOND_CASE),
            "Steklov's case as the general body": partial(no_further, STEKLOV),
        },
    ),
    Claim(
        id="hydromechanics 48 double-theta function",
        statement=r"\text{the general solution requires the double-theta hyperelliptic function}",
        domain="no external force",
        method="a quotient of theta functions of linear functions of t is single-valued; at a pole of a "
        "general solution the Kowalevski exponents must then be integers: they are in Clebsch's "
        "second case, and are not for a body with 21 coefficients without relation",
        gap="for a body without a fourth integral no theta function of t serves, so that only the "
        "integrable cases can be meant; that these need genus two and no less is not shown here",
        check=partial(branching, SECOND_CASE),
        mutants={"a body without a fourth integral": partial(branching, GENERIC)},
    ),
    Claim(
        id="hydromechanics 49 most general energy",
        statement=r"\text{in the motion which can be solved by the elliptic function, the most "
        r"general expression of the kinetic energy is (1)}",
        domain="free motions of a solid",
        method="of 21 coefficients y3' = 0 leaves seven, those of (1) and s (x1 y2 - x2 y1), which is that "
        f"of another origin; {_COUNTED}. A planar motion of another body, by exact expansion",
        condition="it is meant of bodies for all of whose motions y3 is constant; single motions of "
        "other bodies are elliptic as well",
        correction=r"\text{the most general } T \text{ with } y_3 = \text{constant for every motion}",
        counterexample="2T = 2 x1^2 + 3 x2^2 + p3 x3^2 + r1 y1^2 + r2 y2^2 + y3^2 in the plane x3 = y1 = "
        "y2 = 0: y3 is not constant, but (dy3/dt)^2 = (2T - y3^2 - 2 F^2)(3 F^2 - 2T + y3^2)",
        check=All(coefficients_left, _swing),
        transcribed=_planar("d(y3) = 0"),
        mutants={
            "six coefficients": partial(coefficients_left, expected=6),
            "the planar motion without r y3^2": (" - r*y3**2", ""),
        },
    ),
)
