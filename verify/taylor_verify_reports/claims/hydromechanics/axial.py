"""Hydromechanics 49 (23)-(25): Clebsch's body moving along its axis, and the stability of that motion.

kappa = (p' - p)/r, lambda = (q' - q)/r      y = x3 - F, the depth below the axis: y <= 0 in motion
A = 4 kappa F^2 + 4 lambda F G - G^2, B = 2 kappa F + lambda G, C = kappa
xi = x1 + i x2, eta = y1 + i y2, in which the equations linearised about x = F e3, y = G e3 are
xi' = a xi + b eta, eta' = c xi + d eta
"""

from __future__ import annotations

from fractions import Fraction
from functools import partial
from typing import Final

from taylor_verify_reports.claims.check import All
from taylor_verify_reports.claims.claim import Claim
from taylor_verify_reports.claims.hydromechanics.clebsch import FORMS, STATE
from taylor_verify_reports.claims.hydromechanics.spins import UNSTABLE, bounded_tilt, whole_swings
from taylor_verify_reports.claims.setting import Exact

# F, G and y as free symbols; free is one more.
axial: Final = Exact(
    {**STATE, "G": 3, "y": Fraction(-5, 2), "free": 1},
    f"""{FORMS}
kappa, lam = (pp - p)/r, (qq - q)/r
A, B, C = 4*kappa*F**2 + 4*lam*F*G - G**2, 2*kappa*F + lam*G, kappa
m1 = -(p - pp)*F**2 - 2*(q - qq)*F*G
T = energy(p, x, [y1, y2, y3])
U, Omega = grad(T, "x"), grad(T, "y")
dx, dy = cross(x, Omega), cross([y1, y2, y3], Omega) + cross(x, U)
on_axis = lambda v, name: at(partial(v[0] + i*v[1], name), x1=0, x2=0, x3=F, y1=0, y2=0, y3=G)
a, b, c, d = on_axis(dx, "x1"), on_axis(dx, "y1"), on_axis(dy, "x1"), on_axis(dy, "y1")
""",
)

# (24), (dy/dt)^2 = r^2 X3; the coefficients are A, 2 B and C.
_depth_rate: Final = axial(
    "r**2 * quartic(F + y, F, G, G, m1) = r**2 * y**2"
    " * (4*kappa*F**2 + 4*lam*F*G - G**2 + 2*(2*kappa*F + lam*G)*y + kappa*y**2)"
)
# (25) as a stability criterion: the mean eigenvalue is imaginary.
_discriminant: Final = axial(
    "(a - d)**2 + 4*b*c = r**2 * (4*kappa*F**2 + 4*lam*F*G - G**2)",
    "a + d = 2*i * (q*F - qq*F + r*G/2 - rr*G)",
)
squares: Final = axial(
    "A = 4*F**2*(kappa + lam**2) - (G - 2*lam*F)**2", "B**2 - A*C = G**2*(kappa + lam**2)"
)

_ROOM: Final = "T of the form (1); the motion x = F e3, y = G e3 along and about the axis, F > 0"
_EXACT: Final = "exact expansion in F, G, y and the six coefficients"
_A: Final = r"A = 4\frac{p' - p}{r}F^2 + 4\frac{q' - q}{r}FG - G^2"

CLAIMS: Final = (
    Claim(
        id="hydromechanics 49 (23)",
        statement=r"y_3 = G,\quad X_3 = (x_3 - F)^2\Big[\frac{p' - p}{r}(x_3 + F)^2 "
        r"+ 2\frac{q' - q}{r}G(x_3 + F) - G^2\Big]",
        domain="T of the form (1); x3 - F a repeated factor of X3; F not zero",
        method=f"X3(F) = -F^2 (G - y3)^2, and its slope there gives m1; {_EXACT}",
        lost="the fraction bars",
        check=axial(
            "quartic(F, F, G, y3, free) = -(F**2) * (G - y3)**2",
            "at(partial(r * quartic(F + y, F, G, G, free), 'y'), y=0) = -2*F*(free - m1)",
            "quartic(F + y, F, G, G, m1) = y**2 * (kappa*(2*F + y)**2 + 2*lam*G*(2*F + y) - G**2)",
        ),
        mutants={"q - q'": ("+ 2*lam*G", "- 2*lam*G")},
    ),
    Claim(
        id="hydromechanics 49 (24)",
        statement=r"\Big(\frac{dy}{dt}\Big)^2 = r^2y^2\Big[4\frac{p' - p}{r}F^2 "
        r"+ 4\frac{q' - q}{r}FG - G^2 + 2\Big(2\frac{p' - p}{r}F + \frac{q' - q}{r}G\Big)y "
        r"+ \frac{p' - p}{r}y^2\Big]",
        domain="as in (23); y = x3 - F",
        method=f"(8) with the X3 of (23); {_EXACT}",
        lost="the fraction bars",
        check=_depth_rate,
        mutants={
            "r for r^2": ("= r**2", "= r"),
            "1 for 2 before the middle term": ("+ 2*(2*kappa", "+ (2*kappa"),
        },
    ),
    Claim(
        id="hydromechanics 49 (25)",
        statement=_A,
        domain=f"a definition; {_ROOM}",
        method="consistent: the bracket of (24) at y = 0, and r^2 A is the discriminant of the equations "
        f"linearised about this motion; A = 4 F^2 (kappa + lambda^2) - (G - 2 lambda F)^2; {_EXACT}",
        lost="the fraction bars",
        check=All(_depth_rate, _discriminant, squares),
        mutants={
            "q - q'": ("+ 4*lam*F*G - G**2 + 2", "- 4*lam*F*G - G**2 + 2"),
            "q - q' in the discriminant": ("+ 4*lam*F*G - G**2)", "- 4*lam*F*G - G**2)"),
            "2 F^2 (kappa + lambda^2)": ("4*F**2", "2*F**2"),
        },
    ),
    Claim(
        id="hydromechanics 49 stable if A is negative",
        statement=r"\text{the stability of this axial movement is secured if } A \text{ is negative}",
        domain=f"{_ROOM}; stable: x and y stay near x = F e3, y = G e3",
        method="the linearised equations have the eigenvalues i(qF - q'F + rG/2 - r'G) +- (r/2) sqrt(A), "
        "by exact expansion, imaginary for A < 0; X3 < 0 on both sides of x3 = F shuts the motion in, "
        "and a trajectory of 60 digits stays within the tilt that the linear equations allow",
        check=All(_discriminant, _depth_rate, bounded_tilt),
        mutants={
            "q - q'": ("+ 4*lam*F*G - G**2)", "- 4*lam*F*G - G**2)"),
            "a body with A > 0": partial(bounded_tilt, UNSTABLE),
        },
        remark="For A > 0 the movement is unstable. For A = 0, of which the text says nothing, (24) has "
        "r^2 y^3 (2B + Cy) on the right, and y <= 0: B < 0 lets the motion go, B > 0 does not.",
    ),
    Claim(
        id="hydromechanics 49 nutations per second",
        statement=r"\text{the axis makes } r\sqrt{-A}/\pi \text{ nutations per second}",
        domain=f"{_ROOM}; A < 0; small tilts; a nutation is a whole one, there and back",
        method="the eigenvalues differ by r sqrt(A), so that x3 has the period 2 pi/(r sqrt(-A)); that "
        "period on a trajectory of 40 digits with a tilt of 10^-8",
        correction=r"\frac{r\sqrt{-A}}{2\pi} \text{ nutations per second}",
        counterexample="p = 2, p' = 3/2, q = q' = 0, r = 1, r' = 5/4, F = 1, G = 1: A = -3, and x3 "
        "returns after 2 pi/sqrt(3) = 3.63, in which the text counts two. It counts half-swings",
        check=All(_discriminant, whole_swings),
        transcribed=("2*pi", "pi"),
        mutants={"r sqrt(-A)/pi": ("2*pi", "pi")},
    ),
)
