"""Weber's motion in mpmath, by this package's own theta series, without their derivatives.

Legend: that of curve.py and characteristics.py; j(i) says which e_j is a_i. Beside x_i as in enclosure.py,

    y_k = d_k theta[j(i) + j(j)](Z)/theta[0](Z),   (k, i, j) cyclic:

at the half period where the points are a_i and a_k, n_i = 0 and n_i'^2 = B(a_i)/(a_i - a_k) while
n_j^2 = 1, so that there (rho y_k)^2 = (n_i' n_j)^2 = B(a_i)/(a_i - a_k). The sign of d_k follows
from y = n' x n/rho at one place where that is not small.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from fractions import Fraction
from functools import cached_property
from typing import Final, final

import numpy as np
from mpmath import mp, mpf

from taylor_verify.exact.kirchhoff.integrable import CYCLIC
from taylor_verify.exact.kirchhoff.weber.characteristics import HALF_PERIODS, at_branches, of_pair
from taylor_verify.exact.kirchhoff.weber.curve import REGIME, Curve
from taylor_verify.exact.kirchhoff.weber.quadrature import branch_points, narrowness, real_jacobian
from taylor_verify.exact.kirchhoff.weber.riemann import Thetas
from taylor_verify.exact.solution import Quantities, Settled, Time, longest
from taylor_verify.scenes.precision import exact_value

_GUARD_DIGITS: Final = 12
# Enough digits for the sign of a number that is not small, and for the size of a rate.
_FEW_DIGITS: Final = 20
_ORIGIN: Final = 0
# Where the sign of d_k is looked up: a coarse grid of parts of the two periods.
_PLACES: Final = tuple(
    (Fraction(m, 16), Fraction(n, 16)) for m in range(1, 16, 5) for n in range(1, 16, 5)
)


@final
class WeberSums(Settled):
    """The impulses of a motion of Weber's case in mpmath."""

    route = "mpmath"
    regime = REGIME

    def __init__(self, curve: Curve) -> None:
        self._curve = curve
        self._sums: dict[int, Sums] = {}

    def evaluate(self, elapsed: Sequence[Time], digits: int) -> Quantities:
        narrow, faster = self._difficulty
        turns = len(str(math.ceil(faster * longest(elapsed))))
        start = self._curve.start
        with mp.workdps(digits + _GUARD_DIGITS + narrow + turns):
            if mp.dps not in self._sums:
                self._sums[mp.dps] = Sums(self._curve)
            sums = self._sums[mp.dps]
            given = tuple([mp.convert(entry) for entry in v] for v in (start.linear, start.angular))
            rows = np.array([given if t == 0 else sums.at(t) for t in elapsed], dtype=object)
            rows = rows.reshape(-1, 2, 3)
            return {"linear_impulse": rows[:, 0], "angular_impulse": rows[:, 1]}

    @cached_property
    def _difficulty(self) -> tuple[int, Fraction]:
        """The digits that differences of the e lose, and the rate of the faster angle, roughly."""
        narrow = narrowness(self._curve)
        with mp.workdps(_FEW_DIGITS + narrow):
            faster = max(abs(rate) for rate in real_jacobian(self._curve).rate)
            return narrow, exact_value(faster)


class Sums:
    """The motion set up at the ambient precision of mpmath, and good only there."""

    def __init__(self, curve: Curve) -> None:
        self._jacobian = real_jacobian(curve)
        places = curve.places
        self._x = [HALF_PERIODS[place] for place in places]
        self._y = [of_pair(places[i], places[j]) for _, i, j in CYCLIC]
        self._thetas = Thetas(self._jacobian.Y, (_ORIGIN, *self._x, *self._y))
        self._F, self._rho = mp.sqrt(mp.convert(curve.F2)), mp.convert(curve.rho)
        constants = Thetas(self._jacobian.Y, range(16)).values((mpf(0), mpf(0)))
        self._c = [mpf(1)] * 3
        place = self._jacobian
        n, rate = _direction(self._thetas, place.phase, place.neumann, self._c, self._x)
        signs = [
            mp.sign(mp.convert(x) * entry + mp.convert(x_rate) * slope)
            for (x, x_rate), entry, slope in zip(curve.sign_data, n, rate, strict=True)
        ]
        sizes = _sizes_of_x(curve, constants)
        self._c = [sign * size for sign, size in zip(signs, sizes, strict=True)]
        heights = _sizes_of_y(curve, constants)
        self._d = [sign * size for sign, size in zip(self._signs_of_y(), heights, strict=True)]

    def at(self, t: Time) -> tuple[list[mpf], list[mpf]]:
        """x and y, this long after the start."""
        place = self._jacobian
        time = mp.convert(t)
        Z = [start + rate * time for start, rate in zip(place.phase, place.rate, strict=True)]
        values = self._thetas.values(Z)
        x = [self._F * c * values[which] for c, which in zip(self._c, self._x, strict=True)]
        y = [d * values[which] for d, which in zip(self._d, self._y, strict=True)]
        below = values[_ORIGIN]
        return [entry / below for entry in x], [entry / below for entry in y]

    def _signs_of_y(self) -> list[mpf]:
        """The signs of d_k, each where its theta is the largest of a few places."""
        with mp.workdps(_FEW_DIGITS):
            thetas = Thetas(self._jacobian.Y, (_ORIGIN, *self._x, *self._y))
            places = [tuple(mp.convert(z) for z in place) for place in _PLACES]
            values = [thetas.values(Z) for Z in places]
            signs = []
            for (_, i, j), which in zip(CYCLIC, self._y, strict=True):
                best = max(range(len(places)), key=lambda n: abs(values[n][which]))
                n, rate = _direction(thetas, places[best], self._jacobian.neumann, self._c, self._x)
                across = rate[i] * n[j] - rate[j] * n[i]
                signs.append(mp.sign(across * values[best][which]))
            return signs


def _direction(
    thetas: Thetas, Z: Sequence[mpf], along: Sequence[mpf], c: Sequence[mpf], which: Sequence[int]
) -> tuple[list[mpf], list[mpf]]:
    """n, and its rate along a direction."""
    values, slopes = thetas.values(Z), thetas.slopes(Z, along)
    below, fall = values[_ORIGIN], slopes[_ORIGIN]
    n = [factor * values[w] / below for factor, w in zip(c, which, strict=True)]
    rate = [
        factor * (slopes[w] * below - values[w] * fall) / below**2
        for factor, w in zip(c, which, strict=True)
    ]
    return n, rate


def _sizes_of_x(curve: Curve, constants: Mapping[int, mpf]) -> list[mpf]:
    """|c_i|, from the half period of the two highest e that are not a_i."""
    e = branch_points(curve)
    sizes = []
    for i, j, k in CYCLIC:
        own = curve.places[i]
        p, q = [branch for branch in range(5) if branch != own][-2:]
        below, above = at_branches(p, q), at_branches(p, q) ^ HALF_PERIODS[own]
        slope = mp.convert((curve.a[i] - curve.a[j]) * (curve.a[i] - curve.a[k]))
        square = abs((e[own] - e[p]) * (e[own] - e[q]) / slope)
        sizes.append(mp.sqrt(square) * abs(constants[below] / constants[above]))
    return sizes


def _sizes_of_y(curve: Curve, constants: Mapping[int, mpf]) -> list[mpf]:
    """|d_k|, from the half period of a_i and a_k; B(a_i) = F_i A'(a_i)."""
    sizes = []
    for k in range(3):
        i, j = (k + 1) % 3, (k + 2) % 3
        square = curve.uhlenbeck[i] * (curve.a[i] - curve.a[j])
        below = at_branches(curve.places[i], curve.places[k])
        above = at_branches(curve.places[j], curve.places[k])
        ratio = abs(constants[below] / constants[above])
        size = mp.sqrt(abs(mp.convert(square))) * mp.convert(curve.sigma) * ratio
        sizes.append(size / mp.convert(curve.rho))
    return sizes
