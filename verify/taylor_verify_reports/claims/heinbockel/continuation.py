"""Euler's equations with constant moments in complex time: poles, and the change after a loop round one.

J   principal moments      w   angular velocity, J_i w_i' = (J_j - J_k) w_j w_k + M_i
t*  a singularity, s = t - t*;  w = c/s + d s log s + (powers of s), with -J_i c_i = (J_j - J_k) c_j c_k
d   d_i = c_i x_i, sum x = 0, sum J c^2 x = c.M, sum J^2 c^2 x = J c.M: the second from T' = M.w, the
    third from (H^2)'/2 = M.J w. After one loop the logarithm has grown by 2 pi i, and w by 2 pi i d s
"""

from __future__ import annotations

from functools import cache
from itertools import accumulate, repeat
from operator import mul
from typing import Any, Final, NamedTuple

from mpmath import mp, mpc, mpf

_DIGITS: Final = 30
# A quarter of the distance to the singularity is the step: 4^-48 = 10^-29.
_ORDER: Final = 48
_PARTS: Final = 24
_NEAR: Final = mpf(2) ** -6
_CYCLES: Final = ((0, 1, 2), (1, 2, 0), (2, 0, 1))

Vector = list[Any]


class Loop(NamedTuple):
    """The change of w after a loop round a singularity.

    ``relative`` is the size of the change over |w|; ``predicted`` its distance from 2 pi i d s, relative to
    that and NaN without moment; ``distance`` is |s|.
    """

    relative: float
    predicted: float
    distance: float


@cache
def loop(J: tuple[int, ...], w: tuple[int, ...], M: tuple[str, ...]) -> Loop:
    """Continue from t = 0 to the next singularity upwards in complex time, and once round it."""
    with mp.workdps(_DIGITS + 10):
        body = [mpf(entry) for entry in J]
        moment = [mpf(entry) for entry in M]
        state: Vector = [mpc(entry) for entry in w]
        # The first step goes up: there lies the pole of a body that starts in a plane w_2 = 0.
        state = _moved(body, moment, state, mpc(0, mpf(1) / 8))
        s = _offset(body, moment, state)
        while abs(s) > _NEAR:
            # Far from the singularity s is no distance; 1/|w| is a measure of one everywhere.
            step = min(abs(s) / 4, 1 / (5 * mp.norm(state)))
            state = _moved(body, moment, state, -step * s / abs(s))
            s = _offset(body, moment, state)
        around = state
        for k in range(_PARTS):
            here, there = (s * mp.expjpi(mpf(2 * n) / _PARTS) for n in (k, k + 1))
            around = _moved(body, moment, around, there - here)
        change = mp.matrix(around) - mp.matrix(state)
        predicted = mp.nan
        if any(moment):
            logarithm = 2j * mp.pi * s * _logarithm(body, moment, [s * v for v in state])
            predicted = mp.norm(change - logarithm) / mp.norm(logarithm)
        return Loop(float(mp.norm(change) / mp.norm(state)), float(predicted), float(abs(s)))


def _rates(J: Vector, M: Vector, w: Vector) -> Vector:
    return [((J[j] - J[k]) * w[j] * w[k] + M[i]) / J[i] for i, j, k in _CYCLES]


def _offset(J: Vector, M: Vector, w: Vector) -> Any:
    """t - t* from w = c/s: w_1 / w_1' = -s, with an error of third order."""
    return -w[0] / _rates(J, M, w)[0]


def _moved(J: Vector, M: Vector, w: Vector, step: Any) -> Vector:
    """w one step on, by its Taylor series: coefficients by the convolutions of the products."""
    series = [[v] for v in w]
    for n in range(_ORDER):
        fresh = []
        for i, j, k in _CYCLES:
            product = mp.fdot(series[j], series[k][::-1])
            fresh.append(((J[j] - J[k]) * product + (M[i] if n == 0 else 0)) / (J[i] * (n + 1)))
        for coefficients, value in zip(series, fresh, strict=True):
            coefficients.append(value)
    powers = list(accumulate(repeat(step, _ORDER), mul, initial=mpc(1)))
    return [mp.fdot(coefficients, powers) for coefficients in series]


def _logarithm(J: Vector, M: Vector, c: Vector) -> Any:
    """d from the sums for x; c is taken from the motion, with an error of second order in s."""
    Jc = [moment * entry for moment, entry in zip(J, c, strict=True)]
    squares = [J[i] * c[i] ** 2 for i in range(3)]
    rows = mp.matrix([[1, 1, 1], squares, [v**2 for v in Jc]])
    x = mp.lu_solve(rows, mp.matrix([0, mp.fdot(c, M), mp.fdot(Jc, M)]))
    return mp.diag(c) * x
