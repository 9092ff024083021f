"""Hydromechanics 49 (18)-(22): the position of the body's origin, with the axis of space along F.

X, Y, Z   coordinates of the origin in space (c below), c' = R U; cos xY is the element of R in row Y
and column x, and so on. Other symbols as in clebsch.py and angles.py.
M         R y + c x R x, the moment of the impulse about the origin of space: constant, and along Z
          where that origin lies on the central axis of the impulse
"""

from __future__ import annotations

from typing import Final

from taylor_verify_reports.claims.check import All
from taylor_verify_reports.claims.claim import Claim
from taylor_verify_reports.claims.field import values
from taylor_verify_reports.claims.hydromechanics.angles import angles
from taylor_verify_reports.claims.hydromechanics.clebsch import COEFFICIENTS, FORMS
from taylor_verify_reports.claims.hydromechanics.paths import place
from taylor_verify_reports.claims.setting import QUATERNION, UNIT, Exact

_NAMES: Final = ("F", "x1", "x2", "x3", "y1", "y2", "y3", "c1", "c2", "c3", *COEFFICIENTS)

# Clebsch's body in a frame of space whose third axis is along F: x is F times R's third row.
led: Final = Exact(
    {**QUATERNION, **values(_NAMES)},
    f"""{FORMS}
R = rotation(e0, e1, e2, e3)
T = energy(p, x, y)
U, Omega = (at(grad(T, letter), x=F*R[2]) for letter in "xy")
x1, x2, x3 = x = F * R[2]
turn(
    **quaternion_rates(e0, e1, e2, e3, Omega), y=cross(y, Omega) + cross(x, U), c=R @ U
)
Ry = R @ y
G = x @ y / F
M = Ry + cross(c, R @ x)
""",
    UNIT,
)

_ROOM: Final = "T of the form (1); Z along F, which is not zero"
_AXIS: Final = "the origin of space lies on the central axis of the impulse"
_ORBIT: Final = "X and Y of a trajectory of 60 digits"
_EXACT: Final = "exact expansion in the quaternion, y, c, F and the six coefficients"

_complex_place: Final = angles(
    "Ry[1] - i*Ry[0] = (Ry[2]*x3 - F*y3 + i*(x1*y2 - x2*y1)) / (F*st) * (cp + i*sp)"
)

CLAIMS: Final = (
    Claim(
        id="hydromechanics 49 (18)",
        statement=r"FX = y_1\cos xY + y_2\cos yY + y_3\cos zY",
        domain=_ROOM,
        method=f"F X' against F (R U)_X, and F X - (R y)_Y against the constant -M_Y; {_EXACT}. {_ORBIT}",
        condition=_AXIS,
        correction=r"FX = y_1\cos xY + y_2\cos yY + y_3\cos zY - M_Y",
        counterexample="R = 1, y = 0, c = (1, 0, 0): FX = F, and the right side is 0",
        check=All(led("F*c1 = Ry[1] - M[1]", "d(Ry[1]) = F*d(c1)", "d(M[1]) = 0"), place),
        transcribed=("Ry[1] - M[1]", "Ry[1]"),
        mutants={"minus the sum": ("= Ry[1]", "= -Ry[1]")},
    ),
    Claim(
        id="hydromechanics 49 (19)",
        statement=r"FY = -y_1\cos xX + y_2\cos yX + y_3\cos zX",
        domain=f"{_ROOM}; {_AXIS}",
        method=f"F Y' against F (R U)_Y, and F Y - right side against the constant M_X; {_EXACT}. "
        f"{_ORBIT}",
        correction=r"FY = -(y_1\cos xX + y_2\cos yX + y_3\cos zX)",
        counterexample="body axis y along space axis X, y = (0, 1, 0): FY = -1, the right side as "
        "transcribed is +1; the minus belongs before the whole sum",
        check=All(
            led(
                "d(-(y1*R[0,0] + y2*R[0,1] + y3*R[0,2])) = F*d(c2)",
                "F*c2 = -(y1*R[0,0] + y2*R[0,1] + y3*R[0,2]) + M[0]",
            ),
            place,
        ),
        transcribed=("(y1*R[0,0] + y2*R[0,1] + y3*R[0,2])", "(y1*R[0,0] - y2*R[0,1] - y3*R[0,2])"),
        mutants={
            "plus the whole sum": led("F*c2 = Ry[0]"),
            "the minus before y1 alone, along the trajectory": (
                "- (R[0, 1]",
                "+ (R[0, 1]",
            ),
        },
    ),
    Claim(
        id="hydromechanics 49 (20)",
        statement=r"G = y_1\cos xZ + y_2\cos yZ + y_3\cos zZ",
        domain=_ROOM,
        method=f"G = x.y/F; {_EXACT}",
        check=led("G = y @ R[2]"),
        mutants={"Y for Z": ("R[2]", "R[1]")},
    ),
    Claim(
        id="hydromechanics 49 coordinate Z",
        statement=r"\text{expressions for } X, Y, Z, \text{ the coordinates of the centre}",
        domain=_ROOM,
        method=f"the right side of (20) does not hold Z; the rate of Z from c' = R U; {_EXACT}",
        void="(20), in the third place, is an equation for G and says nothing of Z",
        correction=r"F\frac{dZ}{dt} = pF^2 + (p' - p)x_3^2 + qFG + (q' - q)x_3y_3",
        check=led(
            "F*d(c3) = p*F**2 + (pp - p)*x3**2 + q*F*G + (qq - q)*x3*y3",
            "partial(y @ R[2], 'c3') = 0",
        ),
        mutants={"q - q'": ("+ (qq - q)", "- (qq - q)")},
    ),
    Claim(
        id="hydromechanics 49 (21)",
        statement=r"F^2(X^2 + Y^2) = y_1^2 + y_2^2 + y_3^2 - G^2",
        domain=_ROOM,
        method=f"with X, Y of (18) and the corrected (19); {_EXACT}",
        condition=_AXIS,
        correction=r"(FX + M_Y)^2 + (FY - M_X)^2 = y_1^2 + y_2^2 + y_3^2 - G^2",
        counterexample="R = 1, y = 0, c = (1, 0, 0): F^2 = 0",
        check=led("F**2 * ((Ry[1]/F)**2 + (-Ry[0]/F)**2) = y1**2 + y2**2 + y3**2 - G**2"),
        transcribed=("(Ry[1]/F)**2 + (-Ry[0]/F)**2", "c1**2 + c2**2"),
        mutants={"+ G^2": ("- G**2", "+ G**2")},
    ),
    Claim(
        id="hydromechanics 49 (22)",
        statement=r"F(X + Yi) = \frac{Fy_3 - Gx_3 + i\sqrt{X_3}}{\sqrt{F^2 - x_3^2}}\,e^{\psi i}",
        domain=f"{_ROOM}; {_AXIS}; off the axis; sqrt(X3) = x1 y2 - x2 y1 as in (9), psi as in (14), "
        "(15)",
        method=f"F (X + Y i) = (R y)_Y - i (R y)_X in Euler's angles; exact expansion. {_ORBIT}",
        correction=r"F(X + Yi) = \frac{Gx_3 - Fy_3 + i\sqrt{X_3}}{\sqrt{F^2 - x_3^2}}\,e^{\psi i}",
        counterexample="theta = pi/2, phi = psi = 0, y = (0, 0, 1), F = 1: R y = -Y, so that X = -1, Y = "
        "0; the right side as transcribed is +1",
        check=All(_complex_place, place),
        transcribed=("Ry[2]*x3 - F*y3", "F*y3 - Ry[2]*x3"),
        mutants={
            "as transcribed, along the trajectory": ("(G*x3 - F*y3)", "(F*y3 - G*x3)"),
            "e^(-psi i)": ("cp + i*sp", "cp - i*sp"),
            "- i sqrt(X3)": ("+ i*(x1", "- i*(x1"),
        },
        remark="As transcribed it would be right with psi counted from the opposite direction and the "
        "other sign of sqrt(X3), against (9).",
    ),
    Claim(
        id="hydromechanics 49 centre from (22)",
        statement=r"\text{the motion of the centre may then be inferred from (22)}",
        domain=f"the motion of (27)-(29); {_AXIS}",
        method="|X + Y i| from (22) is that of (21) with either sign, its direction is not; exact "
        "expansion",
        condition="(22) is corrected; as transcribed it gives the right distance in a wrong direction",
        correction=r"F(X + Yi) = \frac{Gx_3 - Fy_3 + i\sqrt{X_3}}{\sqrt{F^2 - x_3^2}}\,e^{\psi i}",
        counterexample="as for (22)",
        check=_complex_place,
        transcribed=("Ry[2]*x3 - F*y3", "F*y3 - Ry[2]*x3"),
        mutants={"e^(-psi i)": ("cp + i*sp", "cp - i*sp")},
    ),
)
