"""The integrals of 49 (8) and (17), from x3 to x3, against the time and the angle of a trajectory.

The trajectory starts with Z along F: the quaternion (1, 2, 2, 4) has the third row x/F, x = (12, 20, 9).
Between the two times x3 only rises, and the integrands stay finite.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import astuple
from fractions import Fraction
from typing import Any, Final

from mpmath import mp, mpf

from taylor_verify.claims.check import Residual
from taylor_verify.claims.hydromechanics.clebsch import COEFFICIENTS, QUARTIC
from taylor_verify.claims.trajectory import trajectory
from taylor_verify.scenes.bodies import Clebsch
from taylor_verify.scenes.motion import Impulse

_DIGITS: Final = 40
_BOUND: Final = 1e-35
_BODY: Final = Clebsch(
    *(Fraction(n) for n in ("3/100", "1/50", "1/30", "1/20", "2/5", "1/4"))  # T > 0: q^2 < p r
)
_START: Final = Impulse(
    linear=(Fraction(12), Fraction(20), Fraction(9)),
    angular=(Fraction(3), Fraction(9), Fraction(-4)),
    attitude=(Fraction(1), Fraction(2), Fraction(2), Fraction(4)),
)
_TIMES: Final = (Fraction(1), Fraction(7, 5))
_WHY: Final = (
    "quadrature of forty digits of a smooth integrand against a trajectory settled to forty; five digits "
    "are granted for what the sums lose"
)


class _Stretch:
    """The constants of the motion, x3 at the two times and the angle psi between them."""

    def __init__(self) -> None:
        motion = trajectory(_BODY.body(), _START, _TIMES, _DIGITS, frozenset({"attitude"}))
        x, y = ([mp.convert(v) for v in vector] for vector in (_START.linear, _START.angular))
        six = {name: mp.convert(c) for name, c in zip(COEFFICIENTS, astuple(_BODY), strict=True)}
        self.q, self.r = six["q"], six["r"]
        self.F, self.y3 = mp.sqrt(mp.fdot(x, x)), y[2]
        self.G = mp.fdot(x, y) / self.F
        # (6) at the start, in which nothing cancels.
        p, pp, q, qq, r, _ = six.values()
        self.m1 = r * (y[0] ** 2 + y[1] ** 2) - (p - pp) * x[2] ** 2 - 2 * (q - qq) * x[2] * y[2]
        self.quartic = eval(QUARTIC, six)
        self.z = [row[2] for row in motion["linear_impulse"]]
        nodes = [R[0, 2] + 1j * R[1, 2] for R in motion["attitude"]]
        self.turned = mp.arg(nodes[1] / nodes[0])
        self.elapsed = mp.convert(_TIMES[1] - _TIMES[0])

    def X3(self, z: mpf) -> Any:
        return self.quartic(z, self.F, self.G, self.y3, self.m1)

    def integral(self, integrand: Callable[[mpf], Any]) -> Any:
        """The integral over x3 of the integrand over sqrt(X3), which is positive while x3 rises."""
        return mp.quad(lambda z: integrand(z) / mp.sqrt(self.X3(z)), self.z)


def elapsed_time(power: int = 1) -> Residual:
    """t from (8): the integral of dx3/(r sqrt(X3))."""
    with mp.workdps(_DIGITS + 5):
        s = _Stretch()
        found = s.integral(lambda z: 1 / s.r**power)
        return Residual(float(abs(found / s.elapsed - 1)), _BOUND, f"relative; {_WHY}")


def angle_advance(power: int = 0) -> Residual:
    """psi - q F t from (17), with r^power before dx3."""
    with mp.workdps(_DIGITS + 5):
        s = _Stretch()
        found = s.integral(lambda z: (s.F * s.G - z * s.y3) / (s.F**2 - z**2) * s.F * s.r**power)
        miss = s.turned - s.q * s.F * s.elapsed - found
        return Residual(float(abs(miss)), _BOUND, f"radians; {_WHY}")
