"""The kinds of the integrals of 49: first kind for t, third kind for the angles.

On the curve w^2 = X3(z) a differential g(z) dz/w has a simple pole at z = h if g has one; it is of the
third kind if the residue is not zero. Symbols as in clebsch.py and axial.py; z stands for x3.
"""

from __future__ import annotations

from typing import Final

from taylor_verify_reports.claims.check import All
from taylor_verify_reports.claims.claim import Claim
from taylor_verify_reports.claims.hydromechanics.axial import axial
from taylor_verify_reports.claims.hydromechanics.clebsch import clebsch
from taylor_verify_reports.claims.hydromechanics.paths import elapsed_time

# x3'' = r^2 X3'(x3)/2, so that x3 solves the equation of elliptic functions at its turning points too.
# X3 is of degree 4: its fifth derivative is zero.
_X3: Final = "quartic(z, F, G, y3, m1)"
_second_order: Final = clebsch(
    f"d(d(x3)) = r**2 / 2 * at(partial({_X3}, 'z'), z=x3)", f"reduce(partial, 5 * ['z'], {_X3}) = 0"
)

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
        check=All(_second_order, elapsed_time),
        mutants={
            "twice the acceleration": ("r**2 / 2", "r**2"),
            "without r in the integral": ("1 / r", "1"),
        },
    ),
    Claim(
        id="hydromechanics 49 third kind in (13)",
        statement=r"\text{requiring the elliptic integral of the third kind}",
        domain=f"{_ROOM}; y3 not G or -G, where one of the poles is missing",
        method="the residues of F (F y3 - G z)/(F^2 - z^2) dz/sqrt(X3) at z = F and -F: their squares are "
        "-1/4; exact expansion",
        check=axial(
            "4 * (F*(F*y3 - G*F) / (2*F))**2 = -quartic(F, F, G, y3, free)",
            "4 * (F*(F*y3 + G*F) / (2*F))**2 = -quartic(-F, F, G, y3, free)",
        ),
        mutants={"F G + z y3": ("F*y3 - G*F", "F*G + F*y3")},
        remark="For q' != q the integral of x3 adds poles where x3 is infinite.",
    ),
    Claim(
        id="hydromechanics 49 third kind in (17)",
        statement=r"\text{elliptic integrals of the third kind}",
        domain=f"{_ROOM}; y3 not G or -G, where one of the poles is missing",
        method="the residues of F (F G - z y3)/(F^2 - z^2) dz/sqrt(X3) at z = F and -F: their squares are "
        "-1/4; exact expansion",
        check=axial(
            "4 * (F*(F*G - F*y3) / (2*F))**2 = -quartic(F, F, G, y3, free)",
            "4 * (F*(F*G + F*y3) / (2*F))**2 = -quartic(-F, F, G, y3, free)",
        ),
        mutants={"F G + z y3": ("F*G - F*y3", "F*G + F*y3")},
        remark="With r left in, as (17) is transcribed, the residues would be r i/2.",
    ),
)
