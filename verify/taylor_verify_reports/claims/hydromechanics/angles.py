"""Hydromechanics 49 (14)-(17): Euler's angles of Clebsch's body, the axis of space along F.

theta, phi, psi   R = Rz(psi) Rx(theta) Rz(phi), so that R x is along the third axis of space
st ct sf cf sp cp their sines and cosines: the cosines are roots, ct^2 = 1 - st^2
dtheta ...        their rates, free symbols: the angular velocity follows from R' = R [Omega]x
"""

from __future__ import annotations

from fractions import Fraction
from typing import Final

from taylor_verify_reports.claims.check import All
from taylor_verify_reports.claims.claim import Claim
from taylor_verify_reports.claims.hydromechanics.clebsch import STATE_TEXT, clebsch
from taylor_verify_reports.claims.hydromechanics.paths import angle_advance
from taylor_verify_reports.claims.setting import Exact

# A body whose impulse x has the direction of the third axis of space.
angles: Final = Exact(
    {
        # Sines of Pythagorean angles, so that the cosines are rational too.
        **{"st": Fraction(4, 5), "sf": Fraction(5, 13), "sp": Fraction(8, 17)},
        **{"ct": Fraction(3, 5), "cf": Fraction(12, 13), "cp": Fraction(15, 17)},
        **{"dtheta": Fraction(1, 2), "dphi": Fraction(2, 3), "dpsi": Fraction(7, 4)},
        **{"F": 7, "y1": 1, "y2": -2, "y3": 4, "q": Fraction(1, 2), "r": 2},
    },
    """
    turn(st=ct*dtheta, ct=-st*dtheta, sf=cf*dphi, cf=-sf*dphi, sp=cp*dpsi, cp=-sp*dpsi)
    Rx = lambda s, c: array([[1, 0, 0], [0, c, -s], [0, s, c]])
    Rz = lambda s, c: array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
    R = Rz(sp, cp) @ Rx(st, ct) @ Rz(sf, cf)
    x1, x2, x3 = x = F * R[2]
    spin = R.T @ d(R)
    P, Q = spin[2, 1], spin[0, 2]
    Ry = R @ y
    """,
    roots={"ct": "1 - st**2", "cf": "1 - sf**2", "cp": "1 - sp**2"},
)
_ANGLE_TEXT: Final = "sin theta = 4/5, sin phi = 5/13, sin psi = 8/17, all in the first quadrant"

# (17), differentiated: psi' by (16), and dx3 = r sqrt(X3) dt by (3) and (9).
_advance: Final = clebsch(
    "F * (Omega[0]*x1 + Omega[1]*x2) / (F**2 - x3**2) - q*F"
    " = (FG - x3*y3) / (F**2 - x3**2) * F / root * d(x3)"
)

CLAIMS: Final = (
    Claim(
        id="hydromechanics 49 (14)",
        statement=r"x_1 = F\sin\theta\sin\phi,\quad x_2 = F\sin\theta\cos\phi,\quad "
        r"x_1 + x_2i = iF\sin\theta\,e^{-\psi i},\quad x_3 = F\cos\theta",
        domain="Z along F; R = Rz(psi) Rx(theta) Rz(phi)",
        method="the third row of R in the sines and cosines of the angles; exact expansion",
        correction=r"x_1 + x_2i = iF\sin\theta\,e^{-\phi i}",
        counterexample=f"F = 7, {_ANGLE_TEXT}: x1 + i x2 = 28/65 (5 + 12 i), and 28/85 (8 + 15 i) as "
        "transcribed; psi does not enter x1 and x2 of the same line",
        check=angles("x = [F*st*sf, F*st*cf, F*ct]", "x1 + i*x2 = i*F*st * (cf - i*sf)"),
        transcribed=("(cf - i*sf)", "(cp - i*sp)"),
        mutants={"theta in the exponent": ("(cf - i*sf)", "(ct - i*st)")},
    ),
    Claim(
        id="hydromechanics 49 (15)",
        statement=r"\sin\theta\frac{d\psi}{dt} = P\sin\phi + Q\cos\phi",
        domain="any motion; R = Rz(psi) Rx(theta) Rz(phi)",
        method="P, Q, R from R^T R' with free rates of the angles; exact expansion",
        lost="the fraction is torn apart",
        check=angles("st*dpsi = P*sf + Q*cf"),
        mutants={"- Q cos phi": ("+ Q", "- Q")},
    ),
    Claim(
        id="hydromechanics 49 (16)",
        statement=r"F\sin^2\theta\frac{d\psi}{dt} = \frac{dT}{dy_1}x_1 + \frac{dT}{dy_2}x_2 "
        r"= (qx_1 + ry_1)x_1 + (qx_2 + ry_2)x_2 = q(x_1^2 + x_2^2) + r(x_1y_1 + x_2y_2) "
        r"= qF^2\sin^2\theta + r(FG - x_3y_3)",
        domain="T of the form (1); Z along F",
        method="the kinematics as in (15), the rest exact expansion in the angles and y",
        lost="the fractions are torn apart, and q reads g in the last member",
        check=angles(
            "F*st**2*dpsi = P*x1 + Q*x2",
            "(q*x1 + r*y1)*x1 + (q*x2 + r*y2)*x2 = q*(x1**2 + x2**2) + r*(x1*y1 + x2*y2)"
            " = q*F**2*st**2 + r*(x @ y - x3*y3)",
        ),
        mutants={
            "- x2 dT/dy2": ("+ Q", "- Q"),
            "2 q": ("q*F**2", "2*q*F**2"),
        },
    ),
    Claim(
        id="hydromechanics 49 (17)",
        statement=r"\psi - qFt = \int\frac{FG - x_3y_3}{F^2 - x_3^2}\,\frac{Fr\,dx_3}{\sqrt{X_3}}",
        domain="T of the form (1); Z along F; off the axis. X3 as in (8), (dx3/dt)^2 = r^2 X3",
        method="differentiated: psi' from (16), dx3/dt = r sqrt(X3), exact expansion; and the integral "
        "itself against the angle of a trajectory of 40 digits",
        correction=r"\psi - qFt = \int\frac{FG - x_3y_3}{F^2 - x_3^2}\,\frac{F\,dx_3}{\sqrt{X_3}}",
        counterexample=f"{STATE_TEXT}: the rate of the left side is -56/13, of the right side -112/13; "
        "the two agree for r = 1 alone",
        check=All(_advance, angle_advance),
        transcribed=("* F / root", "* F * r / root"),
        mutants={
            "FG + x3 y3": ("FG - x3*y3", "FG + x3*y3"),
            "r^2": ("* F / root", "* F * r**2 / root"),
            "r in the integral along the trajectory": (
                "(F**2 - z**2) * F",
                "(F**2 - z**2) * F * r",
            ),
        },
        remark="With r it is right if sqrt(X3) is read as dx3/dt, against (8) and (9).",
    ),
)
