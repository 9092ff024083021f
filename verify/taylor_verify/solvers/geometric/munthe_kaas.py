"""The Runge-Kutta-Munthe-Kaas method of fourth order, on the rotation group and on so(3)*.

    H(t) = exp(-[theta]x) H0,   R(t) = R0 exp([theta]x),   theta' = dexp^-1 (K H),  theta(0) = 0
    dexp^-1 w = w + theta x w/2 + theta x (theta x w)/12 + O(theta^4 w)

The classical Runge-Kutta method for theta, from step to step: H moves by rotations, so that |H|^2 and
R H are conserved whatever the step. T drifts. With damping d, H(t) has the factor e^{-dt} besides,
exactly, and |H| e^{dt} is conserved.

H. Munthe-Kaas, Runge-Kutta methods on Lie groups, BIT 38 (1998) 92-111.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import exp
from typing import final

from taylor_verify.numbers.tensors import cross
from taylor_verify.solvers.geometric.fixed_step import Body, FixedStep, Step, Stepped
from taylor_verify.solvers.geometric.vectors import (
    Quaternion,
    Vector,
    ahead,
    apply,
    exponential,
    scaled,
    turned_back,
)


@final
@dataclass(frozen=True)
class MuntheKaas(FixedStep):
    """The Munthe-Kaas method for any tensor; the truncated series of dexp^-1 has an error of order five."""

    name: str = "geometric:lie-rk4"
    takes = ("damping",)

    def stepping(self, body: Body, H: Vector, h: float) -> Step:
        del H
        K, half, whole = body.K, exp(-body.d * h / 2), exp(-body.d * h)

        def step(H: Vector) -> Stepped:
            def rate(theta: Vector, decay: float) -> Vector:
                return _inverse_dexp(theta, scaled(decay, apply(K, turned_back(theta, H))))

            first = apply(K, H)
            second = rate(scaled(h / 2, first), half)
            third = rate(scaled(h / 2, second), half)
            fourth = rate(scaled(h, third), whole)
            ends, middle = ahead(first, 1.0, fourth), ahead(second, 1.0, third)
            theta = scaled(h / 6, ahead(ends, 2.0, middle))
            return Stepped(scaled(whole, turned_back(theta, H)), theta, evaluations=4)

        return step

    def turn(self, trace: Vector) -> Quaternion:
        return exponential(trace)


def _inverse_dexp(theta: Vector, omega: Vector) -> Vector:
    """Return the rate of theta at which R0 exp([theta]x) turns with omega, seen from the body."""
    once = cross(theta, omega)
    return ahead(ahead(omega, 0.5, once), 1 / 12, cross(theta, once))
