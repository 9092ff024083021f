"""What 49 says of the kinds of its integrals: first kind for t, third kind for the angles.

On the curve w^2 = X3(z) a differential g(z) dz/w has a simple pole at z = h if g has one; it is of the
third kind if the residue is not zero. Symbols as in clebsch.py; z stands for x3.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import Final

from taylor_verify.claims.claim import Claim, Verdict, worse
from taylor_verify.claims.field import Element, identity
from taylor_verify.claims.hydromechanics.axial import Axial
from taylor_verify.claims.hydromechanics.clebsch import ClebschBody, quartic
from taylor_verify.claims.hydromechanics.quadratures import elapsed_time


def second_order(b: ClebschBody, factor: int = 1) -> Iterator[Element]:
    """x3'' = r^2 X3'(x3)/2, so that x3 solves the equation of elliptic functions at its turning points too.

    X3 is put together with y1 for a free z, which x3 replaces after the derivative.
    """
    field, z = b.field, b.field["y1"]
    constants = [field[name] for name in ("x1", "x2", "y2")]  # for F, G and m1
    X3 = quartic(b, z, constants[0], constants[1], b.y[2], constants[2])
    slope = field.partial(X3, "y1")
    degree = 4
    yield _fifth(b, X3, degree)
    left = b.rate(b.rate(b.x[2]))
    p, pp, q, qq, r, _ = b.six
    x3, y3 = b.x[2], b.y[2]
    across = (p - pp) * x3**2 + 2 * (q - qq) * x3 * y3 + b.m1
    rise = 2 * (p - pp) * x3 + 2 * (q - qq) * y3
    right = (-2 * x3 * across + (b.F**2 - x3**2) * rise) / r + 2 * y3 * (b.FG - x3 * y3)
    yield left - factor * r**2 * right / 2
    # The derivative just written is that of quartic().
    again = (p - pp) * z**2 + 2 * (q - qq) * z * y3 + constants[2]
    again_rise = 2 * (p - pp) * z + 2 * (q - qq) * y3
    yield slope - (
        (-2 * z * again + (constants[0] ** 2 - z**2) * again_rise) / r
        + 2 * y3 * (constants[0] * constants[1] - z * y3)
    )


def _fifth(b: ClebschBody, polynomial: Element, degree: int) -> Element:
    """The derivative of one order more than a polynomial of this degree has."""
    for _ in range(degree + 1):
        polynomial = b.field.partial(polynomial, "y1")
    return polynomial


def residues(s: Axial, sign: int = 1, along: bool = True) -> Iterator[Element]:
    """At z = F and z = -F the residues squared are -1/4: w^2 = -(F G -+ F y3)^2 there.

    For (17) the numerator of g is F (F G - z y3), for (13) F (F y3 - G z); the denominator F^2 - z^2 has
    the slope -+2 F.
    """
    y3, m1 = s.field["y3"], s.field["x1"]
    for side in (1, -1):
        z = side * s.F
        w2 = quartic(s, z, s.F, s.G, y3, m1)
        numerator = s.F * (s.F * s.G - sign * z * y3) if along else s.F * (s.F * y3 - s.G * z)
        yield 4 * (numerator / (2 * s.F)) ** 2 + w2


_ROOM: Final = "T of the form (1); any free motion"

CLAIMS: Final = (
    Claim(
        id="hydromechanics 49 elliptic time",
        statement=r"t \text{ is given by an elliptic integral of the first kind, and } x_3 \text{ is an "
        r"elliptic function of } t",
        domain=f"{_ROOM}; X3 without repeated root, else the function degenerates: trigonometric, "
        "hyperbolic or rational",
        method="(8), and x3'' = r^2 X3'(x3)/2 with X3 of degree 4 and constant coefficients (exact "
        "expansion); the integral between two points of a trajectory against the time",
        verdict=Verdict.HOLDS,
        check=lambda: worse(identity(ClebschBody, second_order)(), elapsed_time()),
        mutants={
            "twice the acceleration": identity(ClebschBody, second_order, factor=2),
            "without r in the integral": partial(elapsed_time, power=0),
        },
    ),
    Claim(
        id="hydromechanics 49 third kind in (13)",
        statement=r"\text{requiring the elliptic integral of the third kind}",
        domain=f"{_ROOM}; y3 not G or -G, where one of the poles is missing",
        method="the residues of F (F y3 - G z)/(F^2 - z^2) dz/sqrt(X3) at z = F and -F: their squares are "
        "-1/4; exact expansion",
        verdict=Verdict.HOLDS,
        check=identity(Axial, residues, along=False),
        mutants={"F G + z y3": identity(Axial, residues, sign=-1)},
        remark="For q' != q the integral of x3 adds poles where x3 is infinite.",
    ),
    Claim(
        id="hydromechanics 49 third kind in (17)",
        statement=r"\text{elliptic integrals of the third kind}",
        domain=f"{_ROOM}; y3 not G or -G, where one of the poles is missing",
        method="the residues of F (F G - z y3)/(F^2 - z^2) dz/sqrt(X3) at z = F and -F: their squares are "
        "-1/4; exact expansion",
        verdict=Verdict.HOLDS,
        check=identity(Axial, residues),
        mutants={"F G + z y3": identity(Axial, residues, sign=-1)},
        remark="With r left in, as (17) is transcribed, the residues would be r i/2.",
    ),
)
