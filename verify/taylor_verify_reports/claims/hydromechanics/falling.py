"""A body beside the separatrix: the axial movement of Clebsch's body, slightly disturbed, when A > 0.

Trajectories of the Taylor route; A as in axial.py.
"""

from __future__ import annotations

from fractions import Fraction
from functools import cache, partial
from typing import Any, Final

from mpmath import mp

from taylor_verify_reports.claims.hydromechanics.spins import (
    DIGITS,
    UNSTABLE,
    as_fraction,
    rate_of,
    speeds,
    tilted,
)
from taylor_verify_reports.claims.setting import Numeric
from taylor_verify_reports.claims.trajectory import trajectory

_TILT: Final = Fraction(1, 10**6)
# One march along the orbit has as many samples as are asked for: three narrow 8 to 8/40^3 = 10^-4, and
# the chord to the third power of that, 10^-12.
_NARROWINGS, _INTERVALS, _DECIMALS = 3, 40, 12


@cache
def _excursions() -> dict[str, Any]:
    """Two excursions, from the tilt and from a tenth of it; ``longer`` is what the second takes longer."""
    (first, _, sooner), (far, back, later) = map(_excursion, (_TILT, _TILT / 10))
    numbers = {"tilt": mp.convert(_TILT / 10), "ln10": mp.log(10)}
    return numbers | {"first": first, "far": far, "back": back, "longer": later - sooner}


def _excursion(tilt: Fraction) -> tuple[Any, Any, float]:
    """The largest tilt, at the turning point; the tilt at twice its time; that time times r sqrt(A)."""
    turn = _turning_point(tilt)
    motion = trajectory(UNSTABLE.body(), tilted(tilt), (turn, 2 * turn), DIGITS)
    far, back = (mp.hypot(x[0], x[1]) for x in motion["linear_impulse"])
    return far, back, float(2 * rate_of(UNSTABLE) * mp.convert(turn))


def _turning_point(tilt: Fraction) -> Fraction:
    """The time when dx3/dt changes from falling to rising, to the third order of the last interval.

    The motion is symmetric about that time, so that the speed is an odd function of the distance and a
    chord through two of its values misses its zero by their third power.
    """
    rate = rate_of(UNSTABLE)
    # ch(rate t) is of the size of 1/tilt^2 half a period from the turning point beside the axis.
    guess = 2 * mp.log(1 / mp.convert(tilt)) / rate
    low, high = (as_fraction(t, _DECIMALS) for t in (guess, guess + 8 / rate))
    for _ in range(_NARROWINGS):
        times = [low + (high - low) * k / _INTERVALS for k in range(_INTERVALS + 1)]
        values = speeds(UNSTABLE, tilt, times)
        first = next((k for k in range(1, _INTERVALS) if values[k] > 0), _INTERVALS)
        low, high = times[first - 1], times[first]
    share = values[first - 1] / (values[first - 1] - values[first])
    return low + as_fraction(share, _DECIMALS) * (high - low)


_beside: Final = partial(Numeric, lambda: [_excursions()], DIGITS)

falls_away: Final = _beside(
    float(100 * _TILT**2),
    "largest tilts of two motions, of which one starts ten times nearer to the axis: the constants "
    "of the motion, and so the turning points, differ in the second order of the tilt; a hundred "
    "of its squares are granted",
)("first / far = 1")

comes_back: Final = _beside(
    1e-12,
    "tilt at the return over that of the start, less 1; it is stationary at its own turning point, "
    "and the sine of the start is the tilt less a quarter of its cube: relatively 10^-15, of which "
    "a thousand are granted",
)("back / tilt = 1")

return_time: Final = _beside(
    1e-8,
    "growth of the time of return for a tilt ten times smaller, over 4 ln 10, less 1; the next "
    "term is of the size of the tilt squared times its logarithm, 10^-11, and the turning points "
    "are known to 10^-12: a thousand of these are granted",
)("longer / (4 * ln10) = 1")

# The opposite of the return: a tilt that stays of the size of the excursion, which is that of 1.
stays_away: Final = _beside(
    float(_TILT / 10),
    "tilt of the start over the tilt after twice the time of the turning point; what has fallen "
    "away for good would keep a tilt of the size of the excursion",
)("tilt / back = 0")
