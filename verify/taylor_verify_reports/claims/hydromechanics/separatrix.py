"""Hydromechanics 49 (26) and the sentence after it: the axis that leaves its direction, A > 0.

Symbols as in axial.py; S is the root of A + 2 B y + C y^2, s that of B^2 - A C, a that of A.
"""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from typing import Any, Final

from mpmath import mp

from taylor_verify.scenes.bodies import Clebsch
from taylor_verify.scenes.motion import Impulse
from taylor_verify_reports.claims.check import All
from taylor_verify_reports.claims.claim import Claim
from taylor_verify_reports.claims.hydromechanics import falling
from taylor_verify_reports.claims.hydromechanics.axial import squares
from taylor_verify_reports.claims.setting import Exact, Numeric
from taylor_verify_reports.claims.trajectory import DIGITS, trajectory

# A = a^2 and C = (B^2 - s^2)/A, so that only S is a root; d is the derivative with respect to y.
# The numbers are those of the trajectory below at its turning point, slightly moved: S^2 > 0.
_antiderivative: Final = Exact(
    {"a": Fraction(2, 3), "B": Fraction(7, 36), "s": Fraction(1, 4), "y": Fraction(-1, 2)},
    """
    A, C = a**2, (B**2 - s**2) / a**2
    turn(y=1, aS=a**2 * (2*B + 2*C*y) / (2*aS))
    S = aS / a
    u = a*S / (y*s)
    """,
    roots={"aS": "a**4 + 2*a**2*B*y + (B**2 - s**2)*y**2"},
)
# u is the argument of sh^-1; with that of ch^-1, v: v^2 - u^2 = 1 and du/dy = -v a/(y S).
# So d sh^-1 u = du/v = -a dy/(y S) where v > 0, and +a dy/(y S) where v < 0.
_both_lines: Final = _antiderivative(
    "((A + B*y) / (y*s))**2 - u**2 = 1", "d(u) = -(A + B*y) / (y*s) * a / (y*S)"
)

# kappa = -1/18, lambda = 1/4; with F = 5 and G = y3 = 3: A = 4/9, B = 7/36, B^2 - A C = 1/16. The start is
# the turning point y = -1, where A + 2 B y + C y^2 = 0 and y1 : y2 = x1 : x2 = G : F + x3.
_BODY: Final = Clebsch(*map(Fraction, ("1", "8/9", "1/4", "3/4", "2", "5/4")))
_START: Final = Impulse(
    linear=(Fraction(3), Fraction(0), Fraction(4)),
    angular=(Fraction(1), Fraction(0), Fraction(3)),
)
_TIMES: Final = tuple(Fraction(k, 2) for k in range(1, 13))
# Near F the separatrix is unstable: within these six time units an error grows by e^{6 r sqrt(A)/2}.
_LOST_DIGITS: Final = 8


def _along() -> Iterator[dict[str, Any]]:
    """Names of (26) with their numbers at each time; rate is r sqrt(A)."""
    functions = {name: getattr(mp, name) for name in ("cosh", "acosh", "asinh", "sqrt")}
    A, B, square = map(mp.convert, (Fraction(4, 9), Fraction(7, 36), Fraction(1, 16)))
    s = mp.sqrt(square)
    constants = {"A": A, "B": B, "s": s, "C": (B**2 - s**2) / A, "rate": 2 * mp.sqrt(A)}
    motion = trajectory(_BODY.body(), _START, _TIMES)
    for x, t in zip(motion["linear_impulse"], _TIMES, strict=True):
        yield functions | constants | {"y": x[2] - 5, "t": mp.convert(t)}


_separatrix: Final = Numeric(
    _along,
    DIGITS + _LOST_DIGITS,
    10.0 ** (_LOST_DIGITS - DIGITS),
    "trajectory settled to 60 digits on the separatrix, where an error grows by e^(r sqrt(A) t/2) and "
    "y itself shrinks: eight digits are granted",
)
# From the turning point, while A + B y > 0. y is negative, and so is the argument of ch^-1 as it stands.
_on_separatrix: Final = _separatrix(
    "y = -A / (B + s*cosh(rate*t))",
    "acosh(abs((A + B*y) / (y*s))) = rate*t",
    "asinh(sqrt(A) * sqrt(abs(A + 2*B*y + C*y**2)) / (y*s)) = -rate*t",
)

_ROOM: Final = "T of the form (1); a motion for which x3 - F is a repeated factor of X3; A > 0"
_X3: Final = (
    r"x_3 = F - \frac{A}{B + \sqrt{B^2 - AC}\,\operatorname{ch} r\sqrt A\,(t - t_0)},\quad "
    r"B^2 - AC = G^2\Big(\frac{p' - p}{r} + \frac{(q' - q)^2}{r^2}\Big)"
)

CLAIMS: Final = (
    Claim(
        id="hydromechanics 49 (26)",
        statement=r"rt = \int\frac{dy}{y\sqrt{A + 2By + Cy^2}} = \frac1{\sqrt A}"
        r"\begin{matrix}\operatorname{sh}^{-1}\\ \operatorname{ch}^{-1}\end{matrix}"
        r"\frac{\sqrt A\sqrt{A + 2By + Cy^2}}{y\sqrt{B^2 \sim AC}} = \frac1{\sqrt A}"
        r"\begin{matrix}\operatorname{ch}^{-1}\\ \operatorname{sh}^{-1}\end{matrix}"
        r"\frac{A + By}{y\sqrt{B^2 \sim AC}}",
        domain=f"{_ROOM}; upper line B^2 > AC, lower line B^2 < AC; ~ is the absolute difference",
        method="exactly: v^2 - u^2 = 1 for the arguments, and the derivative of u, with the roots as "
        "symbols; then x3 and both arguments along a trajectory of 60 digits on the separatrix",
        condition="the argument of ch^-1 is made positive, and the sign of rt chosen with the branch: in "
        "every real motion y < 0, where the argument as it stands is below -1",
        correction=_X3,
        counterexample="p = 1, p' = 8/9, q = 1/4, q' = 3/4, r = 2, r' = 5/4, x = (3, 0, 4), y = (1, 0, 3): "
        "F = 5, y = -1 at the start, and (A + By)/(y sqrt(B^2 - AC)) = -1",
        check=All(_both_lines, _on_separatrix),
        transcribed=("acosh(abs((A + B*y) / (y*s)))", "acosh((A + B*y) / (y*s))"),
        mutants={
            "A - B y": ("A + B*y", "A - B*y"),
            "half the derivative": ("d(u)", "2*d(u)"),
            "- B in x3": ("-A / (B +", "-A / (-B +"),
            "sh^-1 with the other sign": ("= -rate*t", "= rate*t"),
        },
    ),
    Claim(
        id="hydromechanics 49 case B^2 < AC",
        statement=r"\text{the lower line of (26)}",
        domain=_ROOM,
        method="B^2 - A C = G^2 (kappa + lambda^2) and A = 4 F^2 (kappa + lambda^2) - (G - 2 lambda F)^2; "
        "exact expansion in F, G and the six coefficients",
        void="A > 0 asks kappa + lambda^2 > 0, and then B^2 - AC >= 0: the case does not occur",
        check=squares,
        mutants={"2 F^2 (kappa + lambda^2)": ("4*F**2", "2*F**2")},
    ),
    Claim(
        id="hydromechanics 49 falls away ultimately",
        statement=r"\text{if } A \text{ is positive the axis falls away ultimately from its original "
        r"direction}",
        domain="T of the form (1); the motion along and about the axis, slightly disturbed; A > 0",
        method="trajectories of 40 digits with tilts of 10^-6 and 10^-7: the excursion does not depend on "
        "the tilt, at twice the time of the turning point the tilt is that of the start, and this time "
        "grows by (4/(r sqrt(A))) ln 10 from one tilt to the other",
        condition="it is meant of the next while: the axis leaves by an angle that does not depend on "
        "the disturbance, but it comes back, and does so for ever",
        correction=r"\text{the axis leaves its direction and returns, after } \sim\frac{4}{r\sqrt A}"
        r"\ln\frac1\varepsilon \text{ for a tilt } \varepsilon",
        counterexample="p = 1, p' = 3/2, q = q' = 0, r = 1, r' = 5/4, F = G = 1: A = 1, and a tilt of "
        "10^-7 is a tilt of 10^-7 again after twice the time of the turning point",
        check=All(falling.falls_away, falling.comes_back, falling.return_time),
        transcribed=falling.stays_away,
        mutants={
            "the excursion is proportional to the tilt": ("first / far", "first / (10 * far)"),
            "it comes back after half the time": ("4 * ln10", "2 * ln10"),
            "it comes back with twice the tilt": ("back / tilt", "back / (2 * tilt)"),
        },
    ),
)
