"""Symmetric splitting into turns about the three principal axes, of second order and explicit.

    T = T1 + T2 + T3,  Ti = ki Hi^2 / 2;   a step is  1(h/2) 2(h/2) 3(h) 2(h/2) 1(h/2)

The flow of Ti alone turns the frame about axis i at the constant rate ki Hi, and H + r with it, r the
momentum of wheels. Each is exact, so that the step is a Poisson map and |H + r|^2 and R (H + r) are
conserved; T is conserved only up to a swing of order h^2. Loads that a scene writes down are kicks between
such steps (kicks.py).

R. I. McLachlan, Explicit Lie-Poisson integration and the Euler equations, Phys. Rev. Lett. 71 (1993)
3043-3046; S. Reich, Momentum conserving symplectic integrators, Physica D 76 (1994) 375-383;
E. Hairer, C. Lubich and G. Wanner, Geometric Numerical Integration, 2nd ed. (2006), VII.5.3.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, sin
from typing import ClassVar, final

from taylor_verify.models.problem import Problem
from taylor_verify.solvers.geometric.fixed_step import Body, FixedStep, Step, Stepped
from taylor_verify.solvers.geometric.vectors import Quaternion, Vector, product

# The angles of the five turns of a step, about the axes 1, 2, 3, 2, 1.
Angles = tuple[float, float, float, float, float]
# Five components of omega are formed: two derivatives, rounded up.
_EVALUATIONS = 2


@final
@dataclass(frozen=True)
class Splitting(FixedStep):
    """The splitting method; a full tensor is converted to its principal axes, to roundoff."""

    name: str = "geometric:splitting"
    in_principal_axes: ClassVar[bool] = True
    takes = ("rotor", "loads")
    takes_loads = True

    def unsuited(self, problem: Problem) -> str:
        loads = problem.given.body.loads
        if loads is not None and (loads.states or loads.rotor):
            without = "states of the scene's own, and wheels that a text writes"
            return f"{self.name} is made for bodies without {without}"
        return super().unsuited(problem)

    def stepping(self, body: Body, H: Vector, h: float) -> Step:
        del H
        half1, half2, whole3 = h / 2 * body.K[0][0], h / 2 * body.K[1][1], h * body.K[2][2]

        r1, r2, r3 = body.r

        def step(H: Vector) -> Stepped:
            H1, H2, H3 = H
            a = half1 * H1
            H2, H3 = _seen_from_a_turned_frame(a, H2, H3, r2, r3)
            b = half2 * H2
            H3, H1 = _seen_from_a_turned_frame(b, H3, H1, r3, r1)
            c = whole3 * H3
            H1, H2 = _seen_from_a_turned_frame(c, H1, H2, r1, r2)
            d = half2 * H2
            H3, H1 = _seen_from_a_turned_frame(d, H3, H1, r3, r1)
            e = half1 * H1
            H2, H3 = _seen_from_a_turned_frame(e, H2, H3, r2, r3)
            return Stepped((H1, H2, H3), (a, b, c, d, e), _EVALUATIONS)

        return step

    def turn(self, trace: Angles) -> Quaternion:
        a, b, c, d, e = trace
        first = product(_about(1, a), _about(2, b))
        last = product(_about(2, d), _about(1, e))
        return product(product(first, _about(3, c)), last)


def _seen_from_a_turned_frame(
    angle: float, x: float, y: float, x_wheels: float, y_wheels: float
) -> tuple[float, float]:
    """Return the two components across the axis, when the frame has turned by the angle about it.

    By increments: cos(angle) is rounded by up to 2^-54 however small the angle is, and where step after
    step turns by nearly the same one, that alone makes |H| drift in proportion to time.
    """
    s, half = sin(angle), sin(angle / 2)
    versine = 2 * half * half
    x_whole, y_whole = x + x_wheels, y + y_wheels
    return x + (s * y_whole - versine * x_whole), y - (s * x_whole + versine * y_whole)


def _about(axis: int, angle: float) -> Quaternion:
    c, s = cos(angle / 2), sin(angle / 2)
    return (c, s * (axis == 1), s * (axis == 2), s * (axis == 3))
