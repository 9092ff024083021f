"""49 (18), (19), (22) and (27) along trajectories that carry attitude and origin.

Both start with Z along F. The trajectories come from R' = R [Omega]x and c' = R U alone, apart from what
keeps R x constant; Euler's angles are read off the elements of R.
"""

from __future__ import annotations

from fractions import Fraction
from typing import Any, Final

from mpmath import mp, mpf

from taylor_verify.claims.claim import Residual
from taylor_verify.claims.trajectory import DIGITS, trajectory
from taylor_verify.exact.rotation import rotation_matrix
from taylor_verify.scenes import tensors
from taylor_verify.scenes.bodies import Clebsch
from taylor_verify.scenes.motion import Impulse, Quaternion
from taylor_verify.scenes.tensors import Vector

_BOUND: Final = 1e-50
_WHY: Final = (
    "along a trajectory settled to 60 digits, relative; ten are granted for what the quotients lose"
)
_TIMES: Final = tuple(Fraction(k, 4) for k in range(1, 9))


def _vector(*entries: Fraction | int | str) -> Vector:
    return tuple(Fraction(entry) for entry in entries)


# The third row of R that this quaternion makes is x/F = (12, 20, 9)/25.
_TURN: Final[Quaternion] = (Fraction(1), Fraction(2), Fraction(2), Fraction(4))
_BODY: Final = Clebsch(*_vector("3/100", "1/50", "1/30", "1/20", "2/5", "1/4"))
_LINEAR, _ANGULAR = _vector(12, 20, 9), _vector(3, 9, -4)
_F: Final = Fraction(25)


def _central_start() -> Impulse:
    """The origin of space on the central axis: X and Y by (18) and the corrected (19) at the start."""
    first, second, _ = rotation_matrix(_TURN)
    centre = (tensors.dot(second, _ANGULAR) / _F, -tensors.dot(first, _ANGULAR) / _F, Fraction(0))
    return Impulse(_LINEAR, _ANGULAR, _TURN, centre)


def place(sign: int = -1, whole: bool = True) -> Residual:
    """(18), (19) and (22): ``sign`` is that of F y3 - G x3, ``whole`` the minus before all of (19)."""
    start = _central_start()
    tracked = frozenset({"attitude", "centre"})
    motion = trajectory(_BODY.body(), start, _TIMES, track=tracked)
    with mp.workdps(DIGITS + 10):
        F, y3 = mp.convert(_F), mp.convert(_ANGULAR[2])
        G = mp.fdot(_LINEAR, _ANGULAR) / F
        misses: list[Any] = []
        rows = zip(*(motion[name] for name in _NAMES), strict=True)
        for x, y, R, c in rows:
            across = mp.sqrt(F**2 - x[2] ** 2)
            # R13 + i R23 = -i sin(theta) e^(i psi)
            exponential = 1j * (R[0, 2] + 1j * R[1, 2]) * F / across
            root = x[0] * y[1] - x[1] * y[0]
            found = (sign * (F * y3 - G * x[2]) + 1j * root) / across * exponential
            tail = R[0, 1] * y[1] + R[0, 2] * y[2]
            second = -R[0, 0] * y[0] - (tail if whole else -tail)
            size = F * mp.hypot(c[0], c[1])
            misses += [abs(F * (c[0] + 1j * c[1]) - found) / size, abs(F * c[1] - second) / size]
        return Residual(float(max(misses)), _BOUND, _WHY)


_NAMES: Final = ("linear_impulse", "angular_impulse", "attitude", "centre")

# a = 17, b = -44, for which x = tan(theta/2) = 2 is a root of the corrected X2; F = 1, G = (a + b)/2
# and y3 = (a - b)/2.
_a, _b = 17, -44
_R: Final = Fraction(1, 100)
_SWINGING: Final = Clebsch(
    p=1 + _R * (Fraction(27, 2) ** 2 + Fraction(61, 2) ** 2),
    p_prime=Fraction(1),
    q=Fraction(0),
    q_prime=Fraction(0),
    r=_R,
    r_prime=Fraction(1, 50),
)
_SWING_START: Final = Impulse(
    linear=_vector("4/5", 0, "-3/5"),
    angular=_vector(6, 0, "61/2"),
    attitude=(Fraction(1), Fraction(0), Fraction(-2), Fraction(0)),
)


def algebraic_path(sign: int = 1) -> Residual:
    """The square of (27), in which the product of the roots is 4 F x x'/r, at each time over the start.

    sqrt(X1) sqrt(X2) has the sign of dx/dt. ``sign`` -1 takes X1 for X2, as transcribed.
    """
    motion = trajectory(_SWINGING.body(), _SWING_START, _TIMES, track=frozenset({"attitude"}))
    with mp.workdps(DIGITS + 10):
        start = _squared(mpf(2), mpf(0), sign)
        misses: list[Any] = []
        rows = zip(*(motion[name] for name in _NAMES[:3]), strict=True)
        for v, y, R in rows:
            sine = mp.hypot(v[0], v[1])
            x = sine / (1 + v[2])
            # x3 = (1 - x^2)/(1 + x^2), so that 4 x x'/r = -(1 + x^2)^2 (dx3/dt)/r.
            product = -((1 + x**2) ** 2) * (v[0] * y[1] - v[1] * y[0])
            turn = 1j * (R[0, 2] + 1j * R[1, 2]) / sine
            right = _squared(x, product, sign)
            # At the start x = 2, and psi is that of the quaternion.
            left = start * (x / 2) ** 3 * (turn / _first_turn()) ** 3
            misses.append(abs(left - right) / abs(right))
        return Residual(float(max(misses)), _BOUND, _WHY)


def _first_turn() -> Any:
    """e^(i psi) at the start: R13 + i R23 of the quaternion (1, 0, -2, 0) over -i sin(theta)."""
    return 1j * mp.convert(Fraction(-4, 5)) / mp.convert(Fraction(4, 5))


def _squared(x: mpf, product: Any, sign: int) -> Any:
    """((x + 1) sqrt(X1) + i (x - 1) sqrt(X2))^2."""
    even = sign * (_a * x**4 + 3 * (_a + _b) * x**2 + _b)
    odd = 2 * _a * x**3 + 2 * _b * x
    X1, X2 = odd - even, odd + even
    return (x + 1) ** 2 * X1 - (x - 1) ** 2 * X2 + 2j * (x**2 - 1) * product
