"""Rate of a motion at a state, on which the longest step rests.

s  state, in the problem's units       J(s)  the Jacobian of the rates
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from itertools import chain
from math import acos, cbrt, cos, inf, isfinite, pi, sqrt
from typing import Any, NamedTuple

import numpy as np

from taylor_verify.models.problem import Problem

_SLOWEST = 2.0**-10  # keeps a step finite for a body that is (almost) at rest

Floats = np.ndarray[Any, np.dtype[np.float64]]
Indices = np.ndarray[Any, np.dtype[np.intp]]


class Linearised:
    """The linearised equations of one problem, made once and evaluated at many of its states.

    The rates of (x, y, H) are quadratic in these, those of a quaternion linear in it and in these:
    J(s) = J(0) + sum_k s_k dJ/ds_k exactly. Doubles suffice: the rate is used to within a few per
    cent. The centre enters no rate, and its own row is the only one that is cubic: it is left out.
    """

    def __init__(self, problem: Problem) -> None:
        names = problem.form.states
        kept = [i for i, name in enumerate(names) if not name.startswith("c")]
        self._impulses = sum(not name.startswith("e") for name in names[: len(kept)])
        found = _values_at(problem, kept, _stencil(len(kept)).points)
        self._kept = kept
        self._constant, self._slopes = _derivatives(found)
        self._linear = self._constant.tolist(), self._slopes.tolist()

    def fastest(self, state: Sequence[float]) -> float:
        """Return the spectral radius of J, in radians per unit of time; infinite where J is not finite.

        A component too small for the error control to see grows or turns at one of these rates; they
        do not depend on the units of the components. H or x, y do not know the attitude: J falls
        into their block and that of the quaternion.
        """
        n, size = self._impulses, len(self._kept)
        if not all(map(isfinite, state)):
            return inf
        if n == size == 3:
            return max(_SLOWEST, self._largest_of_three(state))
        jacobian = self._constant + self._slopes @ [state[i] for i in self._kept]
        if not np.isfinite(jacobian).all():
            return inf
        rate = max(_SLOWEST, float(np.abs(np.linalg.eigvals(jacobian[:n, :n])).max()))
        if n < size:
            # q' = q (0, omega)/2 turns the quaternion at the rate |omega|/2: every column has it.
            rate = max(rate, sqrt(sum(entry * entry for entry in jacobian[n:, n].tolist())))
        return rate

    def _largest_of_three(self, state: Sequence[float]) -> float:
        """Return it by the cubic: LAPACK's way in and out takes longer than all of this."""
        x, y, z = state
        matrix = [
            [c + p * x + q * y + r * z for c, (p, q, r) in zip(constants, slopes, strict=True)]
            for constants, slopes in zip(*self._linear, strict=True)
        ]
        found = _largest_root(*_characteristic(matrix))
        if isfinite(found) or not all(map(isfinite, chain.from_iterable(matrix))):
            return found
        return float(np.abs(np.linalg.eigvals(matrix)).max())


class _Stencil(NamedTuple):
    """Columns 0, then e_i and -e_i, then e_i + e_j for the pairs i < j; and these pairs."""

    points: Floats
    first: Indices
    second: Indices


@lru_cache(maxsize=16)
def _stencil(n: int) -> _Stencil:
    e = np.eye(n)
    first, second = np.triu_indices(n, 1)
    return _Stencil(np.vstack([np.zeros(n), e, -e, e[first] + e[second]]).T, first, second)


def _values_at(problem: Problem, kept: list[int], points: Floats) -> Floats:
    """Return the rates of the kept states at each column of points, the other states zero."""
    state = np.zeros((len(problem.form.states), points.shape[1]))
    state[kept] = points
    parameters = [float(value) for value in problem.parameters]
    # All points at once: the equations work on rows as they do on numbers.
    found = problem.form.rates(list(state), parameters)
    rows = [np.broadcast_to(np.asarray(found[i], dtype=float), points.shape[1]) for i in kept]
    return np.array(rows)


def _derivatives(found: Floats) -> tuple[Floats, Floats]:
    """Return J(0) and the second derivatives of a quadratic function, from its values on the stencil."""
    n = len(found)
    zero, ahead, behind = found[:, :1], found[:, 1 : n + 1], found[:, n + 1 : 2 * n + 1]
    _, i, j = _stencil(n)
    slopes, all_of = np.zeros((n, n, n)), np.arange(n)
    slopes[:, all_of, all_of] = ahead + behind - 2 * zero
    mixed = found[:, 2 * n + 1 :] - ahead[:, i] - ahead[:, j] + zero
    slopes[:, i, j] = slopes[:, j, i] = mixed
    return (ahead - behind) / 2, slopes


def _characteristic(m: list[list[float]]) -> tuple[float, float, float]:
    """Return t, s, d of the characteristic polynomial z^3 - t z^2 + s z - d."""
    (a, b, c), (d, e, f), (g, h, i) = m
    minors = (e * i - f * h) + (a * i - c * g) + (a * e - b * d)
    return a + e + i, minors, a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g)


def _largest_root(t: float, s: float, d: float) -> float:
    """Return the largest |z| with z^3 - t z^2 + s z - d = 0, by Cardano's and Viète's formulas.

    With z = t/3 + w: w^3 + 3 p w - 2 q = 0. Double roots it has to half the digits, and infinity
    where a cube overflows.
    """
    shift = t / 3
    p, q = (s - t * shift) / 3, (d - shift * (s - 2 * shift * shift)) / 2
    discriminant = q * q + p * p * p
    if not isfinite(discriminant):
        return inf
    if discriminant <= 0:
        # Three real roots.
        size = sqrt(max(0.0, -p))
        cube = size * size * size
        angle = acos(max(-1.0, min(1.0, q / cube))) / 3 if cube else 0.0
        return max(abs(shift + 2 * size * cos(angle + 2 * pi * k / 3)) for k in range(3))
    # One real root, and two that are conjugate. The larger of the two cube roots is not cancelled.
    root = cbrt(abs(q) + sqrt(discriminant))
    u, v = (root, -p / root) if q >= 0 else (-root, p / root)
    real, pair = shift + u + v, complex(shift - (u + v) / 2, (u - v) * sqrt(3) / 2)
    return max(abs(real), abs(pair))
