"""The axial movement of Clebsch's body when A > 0: the separatrix, and what is near it.

Trajectories of the Taylor route; kappa, lambda, A, B, C as in axial.py, y = x3 - F.
"""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from functools import cache
from typing import Any, Final

from mpmath import mp, mpf

from taylor_verify.claims.claim import Residual
from taylor_verify.claims.hydromechanics.spins import UNSTABLE, A_of, tilted
from taylor_verify.claims.trajectory import DIGITS, trajectory
from taylor_verify.scenes.bodies import Clebsch
from taylor_verify.scenes.motion import Impulse

# kappa = -1/18, lambda = 1/4; with F = 5 and G = y3 = 3: A = 4/9, B = 7/36, B^2 - A C = 1/16. The start is
# the turning point y = -1, where A + 2 B y + C y^2 = 0 and y1 : y2 = x1 : x2 = G : F + x3.
_BODY: Final = Clebsch(
    p=Fraction(1),
    p_prime=Fraction(8, 9),
    q=Fraction(1, 4),
    q_prime=Fraction(3, 4),
    r=Fraction(2),
    r_prime=Fraction(5, 4),
)
_F, _G = Fraction(5), Fraction(3)
_START: Final = Impulse(
    linear=(Fraction(3), Fraction(0), Fraction(4)),
    angular=(Fraction(1), Fraction(0), Fraction(3)),
)
_TIMES: Final = tuple(Fraction(k, 2) for k in range(1, 13))
_A, _B, _S2 = Fraction(4, 9), Fraction(7, 36), Fraction(1, 16)
# Near F the separatrix is unstable: within these six time units an error grows by e^{6 r sqrt(A)/2}.
_LOST_DIGITS: Final = 8

# From the truth and r, A, B, B^2 - A C, and the time: by how much a form of (26) misses.
_Form = Callable[[mpf, mpf, mpf], Any]


def _on_separatrix(form: _Form, because: str) -> Residual:
    motion = trajectory(_BODY.body(), _START, _TIMES)
    with mp.workdps(DIGITS + _LOST_DIGITS):
        F, angle = mp.convert(_F), mp.convert(_BODY.r) * mp.sqrt(mp.convert(_A))
        misses = [
            abs(form(x[2] - F, angle * mp.convert(t), mp.sqrt(mp.convert(_S2))))
            for x, t in zip(motion["linear_impulse"], _TIMES, strict=True)
        ]
        return Residual(float(max(misses)), 10.0 ** (_LOST_DIGITS - DIGITS), because)


_WHY: Final = (
    "trajectory settled to 60 digits on the separatrix, where an error grows by e^(r sqrt(A) t/2) and "
    "y itself shrinks: eight digits are granted"
)


def _depth(angle: mpf, s: mpf, B: mpf) -> mpf:
    return -mp.convert(_A) / (B + s * mp.cosh(angle))


def closed_depth() -> Residual:
    """y = -A/(B + sqrt(B^2 - A C) cosh r sqrt(A) t), t from the turning point."""
    return _on_separatrix(lambda y, angle, s: y - _depth(angle, s, mp.convert(_B)), _WHY)


def closed_depth_with_minus_B() -> Residual:
    return _on_separatrix(lambda y, angle, s: y - _depth(angle, s, -mp.convert(_B)), _WHY)


def hyperbolic_cosine() -> Residual:
    """ch^-1 of the absolute value is r sqrt(A) |t|: y is negative, and so is the argument as it stands."""
    return _on_separatrix(
        lambda y, angle, s: mp.acosh(abs((_a() + mp.convert(_B) * y) / (y * s))) - angle, _WHY
    )


def hyperbolic_cosine_as_it_stands() -> Residual:
    return _on_separatrix(
        lambda y, angle, s: mp.acosh((_a() + mp.convert(_B) * y) / (y * s)) - angle, _WHY
    )


def hyperbolic_sine(sign: int = -1) -> Residual:
    """sh^-1 with the sign of y taken along: -r sqrt(A) |t|, while A + B y > 0."""

    def form(y: mpf, angle: mpf, s: mpf) -> Any:
        C = (mp.convert(_B) ** 2 - s**2) / _a()
        root = mp.sqrt(abs(_a() + 2 * mp.convert(_B) * y + C * y**2))
        return mp.asinh(mp.sqrt(_a()) * root / (y * s)) - sign * angle

    return _on_separatrix(form, _WHY)


def _a() -> mpf:
    return mp.convert(_A)


# A body beside the separatrix.

_TILTS: Final = (Fraction(1, 10**6), Fraction(1, 10**7))
_NEAR_DIGITS: Final = 40
# One march along the orbit has as many samples as are asked for: three narrow 8 to 8/40^3 = 10^-4, and
# the chord to the third power of that, 10^-12.
_NARROWINGS, _INTERVALS = 3, 40


@cache
def _excursion(tilt: Fraction) -> tuple[mpf, mpf, mpf]:
    """The largest tilt, reached at a turning point at some time t; the tilt at 2 t; and r sqrt(A) t."""
    with mp.workdps(_NEAR_DIGITS):
        start = tilted(tilt)
        rate = mp.sqrt(mp.convert(A_of(UNSTABLE, Fraction(1), Fraction(1))) * UNSTABLE.r**2)
        # ch(rate t) is of the size of 1/tilt^2 half a period from the turning point beside the axis.
        guess = 2 * mp.log(1 / mp.convert(tilt)) / rate
        low, high = _as_fraction(guess), _as_fraction(guess + 8 / rate)
        turn = _turning_point(start, low, high)
        far, back = trajectory(UNSTABLE.body(), start, (turn, 2 * turn), _NEAR_DIGITS)[
            "linear_impulse"
        ]
        return mp.hypot(far[0], far[1]), mp.hypot(back[0], back[1]), rate * mp.convert(turn)


def _turning_point(start: Impulse, low: Fraction, high: Fraction) -> Fraction:
    """Where dx3/dt changes from falling to rising, to the third order of the last interval.

    The motion is symmetric about that time, so that the speed is an odd function of the distance and a
    chord through two of its values misses its zero by their third power.
    """
    for _ in range(_NARROWINGS):
        times = tuple(low + (high - low) * k / _INTERVALS for k in range(_INTERVALS + 1))
        motion = trajectory(UNSTABLE.body(), start, times, _NEAR_DIGITS)
        speeds = [
            x[0] * y[1] - x[1] * y[0]
            for x, y in zip(motion["linear_impulse"], motion["angular_impulse"], strict=True)
        ]
        rising = [speed > 0 for speed in speeds]
        first = max(rising.index(True) if True in rising else _INTERVALS, 1)
        low, high = times[first - 1], times[first]
    share = speeds[first - 1] / (speeds[first - 1] - speeds[first])
    return low + _as_fraction(share) * (high - low)


def _as_fraction(t: mpf) -> Fraction:
    return Fraction(int(mp.nint(t * mpf(10) ** 12)), 10**12)


def falls_away(proportion: int = 1) -> Residual:
    """Two tilts, one a tenth of the other, lead to the same excursion; ``proportion`` 10 to one like it."""
    first, second = (_excursion(tilt)[0] for tilt in _TILTS)
    with mp.workdps(_NEAR_DIGITS):
        return Residual(
            float(abs(first / (proportion * second) - 1)),
            float(100 * _TILTS[0] ** 2),
            "largest tilts of two motions, of which one starts ten times nearer to the axis: the constants "
            "of the motion, and so the turning points, differ in the second order of the tilt; a hundred "
            "of its squares are granted",
        )


def stays_away() -> Residual:
    """That it does not come back: the start's tilt over that at twice the time of the turning point."""
    far, back, _ = _excursion(_TILTS[1])
    with mp.workdps(_NEAR_DIGITS):
        tilt = mp.convert(_TILTS[1])
        return Residual(
            float(tilt / back),
            float(tilt / far),
            "tilt of the start over the tilt after twice the time of the turning point; what has fallen "
            "away for good would keep a tilt of the size of the excursion",
        )


def comes_back(factor: int = 1) -> Residual:
    """The motion is symmetric about a turning point: at twice its time the tilt is that of the start."""
    _, back, _ = _excursion(_TILTS[1])
    with mp.workdps(_NEAR_DIGITS):
        return Residual(
            float(abs(back / (factor * mp.convert(_TILTS[1])) - 1)),
            1e-12,
            "tilt at the return over that of the start, less 1; it is stationary at its own turning point, "
            "and the sine of the start is the tilt less a quarter of its cube: relatively 10^-15, of which "
            "a thousand are granted",
        )


def return_time(factor: int = 4) -> Residual:
    """Ten times nearer to the axis the return takes (4/(r sqrt(A))) ln 10 longer."""
    sooner, later = (2 * _excursion(tilt)[2] for tilt in _TILTS)
    with mp.workdps(_NEAR_DIGITS):
        longer = (later - sooner) / (factor * mp.log(10))
        return Residual(
            float(abs(longer - 1)),
            1e-8,
            "growth of the time of return for a tilt ten times smaller, over 4 ln 10, less 1; the next "
            "term is of the size of the tilt squared times its logarithm, 10^-11, and the turning points "
            "are known to 10^-12: a thousand of these are granted",
        )
