"""The axial movement of Clebsch's body disturbed: the tilt of its axis, and its period of nutation.

Trajectories of the Taylor route; kappa, lambda, A as in axial.py. The tilt is |xi|/F, the sine of
the angle between the axis and F; the start has y = x, so that eta = xi.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from functools import cache
from typing import Any, Final

from mpmath import mp, mpf

from taylor_verify.scenes.bodies import Clebsch
from taylor_verify.scenes.motion import Impulse
from taylor_verify_reports.claims.check import Residual
from taylor_verify_reports.claims.setting import Numeric
from taylor_verify_reports.claims.trajectory import trajectory

DIGITS: Final = 40

# With q' = q and F = G = 1, A of 49 (25) is 4 kappa - 1: -3 for the first body and 1 for the second.
STABLE: Final = Clebsch(*map(Fraction, ("2", "3/2", "0", "0", "1", "5/4")))
UNSTABLE: Final = Clebsch(*map(Fraction, ("1", "3/2", "0", "0", "1", "5/4")))
_SMALL: Final = Fraction(1, 10**8)


def rate_of(body: Clebsch) -> mpf:
    """r sqrt(|A|)."""
    A = 4 * (body.p_prime - body.p) / body.r - 1
    return mp.sqrt(mp.convert(abs(A))) * mp.convert(body.r)


def tilted(tilt: Fraction) -> Impulse:
    """x = e3 turned by a small angle of sine nearly ``tilt``, y = G x: F = G = 1, at a turning point.

    The half-angle formulas keep x.x = 1 exactly; y along x has x1 y2 - x2 y1 = 0.
    """
    half = tilt / 2
    x = (2 * half / (1 + half**2), Fraction(0), (1 - half**2) / (1 + half**2))
    return Impulse(linear=x, angular=x)


def speeds(body: Clebsch, tilt: Fraction, times: Sequence[Fraction]) -> list[Any]:
    """(dx3/dt)/r at some times."""
    motion = trajectory(body.body(), tilted(tilt), tuple(times), DIGITS)
    rows = zip(motion["linear_impulse"], motion["angular_impulse"], strict=True)
    return [x[0] * y[1] - x[1] * y[0] for x, y in rows]


def as_fraction(t: mpf, decimals: int) -> Fraction:
    return Fraction(int(mp.nint(t * mpf(10) ** decimals)), 10**decimals)


def bounded_tilt(body: Clebsch = STABLE) -> Residual:
    """The largest tilt of 400 samples over a dozen nutations, over what linear equations allow.

    xi = e^{mu t} (a cos nu t + b sin nu t/nu) with nu = r sqrt(-A)/2, a the start and b its rate in the
    frame that turns at the mean rate; so |xi| <= |a| + |b|/nu. The next order is of the tilt squared.
    A body with A > 0 exceeds this measure.
    """
    start = tilted(_SMALL)
    times = tuple(Fraction(k, 10) for k in range(1, 401))
    motion = trajectory(body.body(), start, times, DIGITS)
    with mp.workdps(DIGITS):
        a = abs(mp.convert(start.linear[0]))
        # By (11) xi' = i (r - r') xi at the start, where eta = xi and q' = q; the mean rate, half the
        # trace of the linearised equations, is i (r/2 - r').
        b = a * mp.convert(body.r) / 2
        largest = max(mp.hypot(x[0], x[1]) for x in motion["linear_impulse"])
        return Residual(
            float(largest / (a + b / (rate_of(body) / 2))),
            float(1 + _SMALL),
            "largest tilt over |a| + |b|/nu, what the linearised equations allow; the next order is "
            "relatively tilt^2, and more than that, the tilt itself, is granted",
        )


@cache
def _period() -> dict[str, Any]:
    """The period of x3, from x1 y2 - x2 y1 = 0 on the trajectory, by the secant rule; and r sqrt(-A).

    A nutation begins and ends at the same turning point; half-way lies the other one, where the
    product vanishes too, but x3 is another.
    """
    rate = rate_of(STABLE)
    before, after = (as_fraction(2 * mp.pi / rate * mpf(factor), 30) for factor in ("0.99", "1.01"))
    while abs(after - before) >= Fraction(1, 10**20):
        ((first,), (last,)) = (speeds(STABLE, _SMALL, [t]) for t in (before, after))
        t = mp.convert(after) - last * mp.convert(after - before) / (last - first)
        before, after = after, as_fraction(t, 30)
    return {"period": mp.convert(after), "rate": rate, "pi": mp.pi}


whole_swings: Final = Numeric(
    lambda: [_period()],
    DIGITS,
    float(100 * _SMALL**2),
    "nutations counted in one period of x3, less 1; the period depends on the tilt in the "
    "second order, with a factor of the size of the coefficients: a hundred tilts squared",
)("period * rate * (1 / (2*pi)) = 1")
