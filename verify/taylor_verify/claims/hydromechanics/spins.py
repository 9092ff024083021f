"""The axial movement of Clebsch's body disturbed: how far its axis tilts, and how often it nutates.

Trajectories of the Taylor route; kappa, lambda, A as in axial.py. The tilt is |xi|/F, the sine of
the angle between the axis and F; the start has y = x, so that eta = xi.
"""

from __future__ import annotations

from fractions import Fraction
from functools import cache
from typing import Any, Final

from mpmath import mp, mpf

from taylor_verify.claims.claim import Residual
from taylor_verify.claims.trajectory import trajectory
from taylor_verify.scenes.bodies import Clebsch
from taylor_verify.scenes.motion import Impulse, Motion

_DIGITS: Final = 40


def _rational(*numbers: Fraction | int | str) -> Clebsch:
    return Clebsch(*(Fraction(number) for number in numbers))


# A = 4 kappa F^2 - G^2 at F = G = 1: -3 for the first body, and 1 for the second.
STABLE: Final = _rational(2, "3/2", 0, 0, 1, "5/4")
UNSTABLE: Final = _rational(1, "3/2", 0, 0, 1, "5/4")


def A_of(body: Clebsch, F: Fraction, G: Fraction) -> Fraction:
    """49 (25)."""
    kappa, lam = (body.p_prime - body.p) / body.r, (body.q_prime - body.q) / body.r
    return 4 * kappa * F**2 + 4 * lam * F * G - G**2


def tilted(tilt: Fraction) -> Impulse:
    """x = e3 turned by a small angle of sine nearly ``tilt``, y = G x: F = G = 1, at a turning point.

    The half-angle formulas keep x.x = 1 exactly; y along x has x1 y2 - x2 y1 = 0.
    """
    half = tilt / 2
    x = (2 * half / (1 + half**2), Fraction(0), (1 - half**2) / (1 + half**2))
    return Impulse(linear=x, angular=x)


def _tilts(motion: Motion) -> list[mpf]:
    return [mp.hypot(x[0], x[1]) for x in motion["linear_impulse"]]


def _largest_over(body: Clebsch, tilt: Fraction) -> Residual:
    """The largest tilt of 400 samples over a dozen nutations, over what linear equations allow.

    xi = e^{mu t} (a cos nu t + b sin nu t/nu) with nu = r sqrt(-A)/2, a the start and b its rate in the
    frame that turns at the mean rate; so |xi| <= |a| + |b|/nu. The next order is of the tilt squared.
    """
    start, one = tilted(tilt), Fraction(1)
    times = [Fraction(k, 10) for k in range(1, 401)]
    motion = trajectory(body.body(), start, times, _DIGITS)
    with mp.workdps(_DIGITS):
        nu = mp.sqrt(abs(mp.convert(A_of(body, one, one)))) * mp.convert(body.r) / 2
        a = abs(mp.convert(start.linear[0]))
        # By (11) xi' = i (r - r') xi at the start, where eta = xi and q' = q; the mean rate, half the
        # trace of the linearised equations, is i (r/2 - r').
        b = a * mp.convert(body.r) / 2
        allowed = a + b / nu
        size = max(_tilts(motion)) / allowed
        return Residual(
            float(size),
            float(1 + tilt),
            "largest tilt over |a| + |b|/nu, what the linearised equations allow; the next order is "
            "relatively tilt^2, and more than that, the tilt itself, is granted",
        )


_SMALL: Final = Fraction(1, 10**8)


def bounded_tilt() -> Residual:
    """A < 0: the tilt stays within what the linear equations allow."""
    return _largest_over(STABLE, _SMALL)


def unbounded_tilt() -> Residual:
    """A > 0: the same measure, which must fail."""
    return _largest_over(UNSTABLE, _SMALL)


@cache
def _period() -> tuple[mpf, mpf]:
    """The period of x3 for a tilt of 10^-8, from x1 y2 - x2 y1 = 0 on the trajectory; and r sqrt(-A).

    A nutation begins and ends at the same turning point; half-way lies the other one, where the
    product vanishes too, but x3 is another.
    """
    body, one = STABLE, Fraction(1)
    start = tilted(_SMALL)
    with mp.workdps(_DIGITS):
        rate = mp.sqrt(-mp.convert(A_of(body, one, one))) * mp.convert(body.r)
        guess = 2 * mp.pi / rate
        found = [_as_fraction(guess * factor) for factor in (mpf("0.99"), mpf("1.01"))]
        speeds = [_speed(body, start, t) for t in found]
        for _ in range(5):  # the secant rule
            t = mp.convert(found[1]) - speeds[1] * mp.convert(found[1] - found[0]) / (
                speeds[1] - speeds[0]
            )
            found, speeds = [found[1], _as_fraction(t)], [speeds[1], mpf(0)]
            speeds[1] = _speed(body, start, found[1])
            if abs(found[1] - found[0]) < Fraction(1, 10**20):
                break
        return mp.convert(found[1]), rate


def _speed(body: Clebsch, start: Impulse, t: Fraction) -> Any:
    """(dx3/dt)/r at a time."""
    motion = trajectory(body.body(), start, (t,), _DIGITS)
    (x,), (y,) = motion["linear_impulse"], motion["angular_impulse"]
    return x[0] * y[1] - x[1] * y[0]


def _as_fraction(t: mpf) -> Fraction:
    return Fraction(int(mp.nint(t * mpf(10) ** 30)), 10**30)


def _counted(nutations_per_radian: mpf) -> Residual:
    period, rate = _period()
    with mp.workdps(_DIGITS):
        counted = period * rate * nutations_per_radian
        return Residual(
            float(abs(counted - 1)),
            float(100 * _SMALL**2),
            "nutations counted in one period of x3, less 1; the period depends on the tilt in the "
            "second order, with a factor of the size of the coefficients: a hundred tilts squared",
        )


def whole_swings() -> Residual:
    with mp.workdps(_DIGITS):
        return _counted(1 / (2 * mp.pi))


def half_swings() -> Residual:
    with mp.workdps(_DIGITS):
        return _counted(1 / mp.pi)
