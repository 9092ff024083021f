"""The closed form in plain doubles, as most users would write it: `closed-form:ellipj`.

k_i  principal values of K, the inverse inertia tensor      h    momentum in principal axes
a    the axis that the orbit encircles                      b    the middle axis, c the third
w_a = s a_a dn u,   w_b = -+ s a_b sn u,   w_c = a_c cn u,   u = lam t + u0,  parameter m

The formulas are correct, and SciPy's `ellipj` and `ellipkinc` get sums without cancellation where there are
any. It is a solver like any other. Its failures come from double precision:

long times      u is rounded to 2^-53 of itself before it is reduced by the period: a phase error of
                about 2^-53 lam |t|, in proportion to time, although no step is taken
near m = 1      1 - m is known only to 2^-53, and the period to 2^-53/(1 - m) of itself;
                where 1 - m is below 10^-10, `ellipj` uses series about m = 1 that hold for
                less than a quarter of a period
the separatrix  the last bit of h decides: m = 1, or a period of about 80/lam
middle axis     for a rotation about it u0 is infinite, and the answer is NaN
"""

from __future__ import annotations

from dataclasses import dataclass
from importlib import import_module
from math import atan2, copysign, sqrt
from time import perf_counter
from typing import Any, Final, final

import numpy as np
from flint import fmpq, fmpq_mat

from taylor_verify.models.problem import Problem
from taylor_verify.numbers import tensors
from taylor_verify.numbers.precision import Rung
from taylor_verify.solvers.geometric.fixed_step import Body
from taylor_verify.solvers.options import options
from taylor_verify.solvers.scipy import unavailable
from taylor_verify.solvers.solver import Solver, made_without, raised
from taylor_verify.solvers.trajectory import Outcome, Trajectory, of_rows

METHODS: Final = ("ellipj",)

Floats = np.ndarray[Any, Any]


@final
@dataclass(frozen=True)
class ClosedForm(Solver):
    """Omega of a free body with three distinct principal moments, by Jacobi's functions in float64."""

    name: str

    def unavailable(self, rung: Rung) -> str:
        return unavailable(self.name, rung)

    def unsuited(self, problem: Problem) -> str:
        if reason := super().unsuited(problem):
            return reason
        body = problem.given.body
        if problem.given.model != "euler":
            return f"{self.name} is made for Euler's equations, got {problem.given.model}"
        if reason := made_without(self.name, body):
            return reason
        if "attitude" in problem.scene.track:
            return f"{self.name} gives omega and no attitude"
        if not any(problem.initial_momenta):
            return f"{self.name} is made for a body that turns"
        if not _has_distinct_moments(body.energy_matrix):
            return f"{self.name} is made for three distinct principal moments"
        return ""

    def solve(self, problem: Problem) -> Trajectory:
        if reason := self.unsuited(problem) or self.unavailable(problem.rung):
            return Trajectory(Outcome.NOT_STARTED, detail=reason)
        asked = perf_counter()
        import_module("scipy.special")
        began = perf_counter()
        try:
            with np.errstate(all="ignore"):
                rows = _momenta(problem).tolist()
        except (ArithmeticError, ValueError, np.linalg.LinAlgError) as error:
            return raised(error)
        # Each sample is computed separately: there are no steps, and no errors add up.
        seconds = perf_counter() - began
        return of_rows(
            problem, rows, steps=len(rows), seconds=seconds, compile_seconds=began - asked
        )


def _momenta(problem: Problem) -> Floats:
    """Return the momentum in body axes at each of the problem's times, in its units."""
    from scipy.special import ellipj, ellipkinc

    k, axes = _principal(np.array(Body.of(problem).K))
    h = axes.T @ [float(value) for value in problem.initial_momenta]
    if _encircles_last(k, h):
        k, h, axes = k[::-1], h[::-1], axes[:, ::-1]
    if np.linalg.det(axes) < 0:
        h, axes = h * [1, -1, 1], axes * [1, -1, 1]
    rate, m, amplitudes, angle = _orbit(*(float(value) for value in (*k, *h)))
    times = np.array([float(t) for t in problem.times])
    sn, cn, dn, _ = ellipj(rate * times + ellipkinc(angle, m), m)
    along = amplitudes[:, None] * np.array([dn, sn, cn])
    momenta: Floats = (axes @ along).T
    return momenta


def _principal(K: Floats) -> tuple[Floats, Floats]:
    """Return the principal values in rising order and the axes as columns; exact where K is diagonal."""
    if np.count_nonzero(K - np.diag(np.diag(K))):
        values, vectors = np.linalg.eigh(K)
        return values, vectors
    order = np.argsort(np.diag(K))
    return np.diag(K)[order], np.eye(3)[:, order]


def _encircles_last(k: Floats, h: Floats) -> bool:
    """Return True for an orbit about the axis of the largest k, the least moment: 2T > k_b |H|^2."""
    return bool((k[2] - k[1]) * h[2] ** 2 > (k[1] - k[0]) * h[0] ** 2)


def _orbit(
    k_a: float, k_b: float, k_c: float, h_a: float, h_b: float, h_c: float
) -> tuple[float, float, Floats, float]:
    """Return lam, m, the amplitudes of h_a, h_b, h_c, and the amplitude of u0.

    The orbit is about axis a, which is the axis of the least or of the largest k.
    """
    ab, bc, ac = abs(k_b - k_a), abs(k_c - k_b), abs(k_c - k_a)
    # | |H|^2 k_c - 2T | and | 2T - |H|^2 k_a |, sums of positive terms.
    A, C = ac * h_a**2 + bc * h_b**2, ab * h_b**2 + ac * h_c**2
    # On the separatrix rounding may make it slightly larger than 1, which ellipj does not accept.
    m = min(bc * C / (ab * A), 1.0)
    side, turn = copysign(1.0, h_a), copysign(1.0, k_a - k_c)
    a, b, c = side * sqrt(A / ac), side * turn * sqrt(C / ab), sqrt(C / ac)
    # The sine and cosine of the amplitude of u0 are sn and cn at the start.
    angle = atan2(h_b * c * copysign(1.0, b), h_c * abs(b))
    return sqrt(ab * A), m, np.array([a, b, c]), angle


def _has_distinct_moments(tensor: tensors.Matrix) -> bool:
    """Return True if the characteristic polynomial, in rationals, shares no root with its derivative."""
    entries = [fmpq(entry.numerator, entry.denominator) for row in tensor for entry in row]
    polynomial = fmpq_mat(3, 3, entries).charpoly()
    return bool(polynomial.gcd(polynomial.derivative()).degree() == 0)


def named(name: str) -> ClosedForm:
    """Return the closed form of that name. Raises ValueError for an unknown name and for any setting."""
    options(name, METHODS, [])
    return ClosedForm(name)
