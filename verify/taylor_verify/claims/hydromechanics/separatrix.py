"""Hydromechanics 49 (26) and the sentence after it: the axis that leaves its direction, A > 0.

Symbols as in axial.py; S is the root of A + 2 B y + C y^2, s that of B^2 - A C, a that of A.
"""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from functools import partial
from typing import Final

from taylor_verify.claims.claim import Claim, Verdict, worse
from taylor_verify.claims.field import Element, Field, Point, identity
from taylor_verify.claims.hydromechanics import falling
from taylor_verify.claims.hydromechanics.axial import Axial, squares

# Numbers of the trajectory in falling.py at its turning point, slightly moved: A + 2 B y + C y^2 > 0.
_POINT: Final[Point] = {
    "a": Fraction(2, 3),
    "B": Fraction(7, 36),
    "s": Fraction(1, 4),
    "y": Fraction(-1, 2),
}


class Antiderivative:
    """A = a^2 and C = (B^2 - s^2)/A, so that only S is a root."""

    def __init__(self) -> None:
        self.field = field = Field(_POINT, {"S": _times_a_squared})
        self.a, self.B, self.s, self.y = (field[name] for name in ("a", "B", "s", "y"))
        self.A = self.a**2
        self.C = (self.B**2 - self.s**2) / self.A
        self.S = field["S"] / self.a
        # S' = Q'/(2 S): the derivative with respect to y, which stands for time here.
        slope = self.A * (2 * self.B + 2 * self.C * self.y) / (2 * field["S"])
        field.turn({"y": field.element(1), "S": slope})


def _times_a_squared(field: Field) -> Element:
    """a^2 (A + 2 B y + C y^2), a polynomial."""
    a, B, s, y = (field[name] for name in ("a", "B", "s", "y"))
    return a**4 + 2 * a**2 * B * y + (B**2 - s**2) * y**2


def both_lines(t: Antiderivative, sign: int = 1, factor: int = 2) -> Iterator[Element]:
    """The arguments u of sh^-1 and v of ch^-1: v^2 - u^2 = 1 and du/dy = -v a/(y S).

    So d sh^-1 u = du/v = -a dy/(y S) where v > 0, and +a dy/(y S) where v < 0.
    """
    u, v = t.a * t.S / (t.y * t.s), (t.A + sign * t.B * t.y) / (t.y * t.s)
    yield v**2 - u**2 - 1
    yield 2 * t.field.rate(u) + factor * v * t.a / (t.y * t.S)


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
        verdict=Verdict.ONLY_IF,
        condition="the argument of ch^-1 is made positive, and the sign of rt chosen with the branch: in "
        "every real motion y < 0, where the argument as it stands is below -1",
        correction=_X3,
        counterexample="p = 1, p' = 8/9, q = 1/4, q' = 3/4, r = 2, r' = 5/4, x = (3, 0, 4), y = (1, 0, 3): "
        "F = 5, y = -1 at the start, and (A + By)/(y sqrt(B^2 - AC)) = -1",
        check=lambda: worse(
            identity(Antiderivative, both_lines)(),
            falling.closed_depth(),
            falling.hyperbolic_cosine(),
            falling.hyperbolic_sine(),
        ),
        transcribed=falling.hyperbolic_cosine_as_it_stands,
        mutants={
            "A - B y": identity(Antiderivative, both_lines, sign=-1),
            "half the derivative": identity(Antiderivative, both_lines, factor=1),
            "- B in x3": falling.closed_depth_with_minus_B,
            "sh^-1 with the other sign": partial(falling.hyperbolic_sine, sign=1),
        },
    ),
    Claim(
        id="hydromechanics 49 case B^2 < AC",
        statement=r"\text{the lower line of (26)}",
        domain=_ROOM,
        method="B^2 - A C = G^2 (kappa + lambda^2) and A = 4 F^2 (kappa + lambda^2) - (G - 2 lambda F)^2; "
        "exact expansion in F, G and the six coefficients",
        verdict=Verdict.VACUOUS,
        void="A > 0 asks kappa + lambda^2 > 0, and then B^2 - AC >= 0: the case does not occur",
        check=identity(Axial, squares),
        mutants={"2 F^2 (kappa + lambda^2)": identity(Axial, squares, factor=2)},
    ),
    Claim(
        id="hydromechanics 49 falls away ultimately",
        statement=r"\text{if } A \text{ is positive the axis falls away ultimately from its original "
        r"direction}",
        domain="T of the form (1); the motion along and about the axis, slightly disturbed; A > 0",
        method="trajectories of 40 digits with tilts of 10^-6 and 10^-7: the excursion does not depend on "
        "the tilt, at twice the time of the turning point the tilt is that of the start, and this time "
        "grows by (4/(r sqrt(A))) ln 10 from one tilt to the other",
        verdict=Verdict.ONLY_IF,
        condition="it is meant of the next while: the axis leaves by an angle that does not depend on "
        "the disturbance, but it comes back, and does so for ever",
        correction=r"\text{the axis leaves its direction and returns, after } \sim\frac{4}{r\sqrt A}"
        r"\ln\frac1\varepsilon \text{ for a tilt } \varepsilon",
        counterexample="p = 1, p' = 3/2, q = q' = 0, r = 1, r' = 5/4, F = G = 1: A = 1, and a tilt of "
        "10^-7 is a tilt of 10^-7 again after twice the time of the turning point",
        check=lambda: worse(falling.falls_away(), falling.comes_back(), falling.return_time()),
        transcribed=falling.stays_away,
        mutants={
            "the excursion is proportional to the tilt": partial(falling.falls_away, proportion=10),
            "it comes back after half the time": partial(falling.return_time, factor=2),
            "it comes back with twice the tilt": lambda: falling.comes_back(factor=2),
        },
    ),
)
