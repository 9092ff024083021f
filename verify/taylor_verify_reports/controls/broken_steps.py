"""Defects of the stepping: a body in principal axes, followed at a fixed step in double precision.

H  angular momentum, body axes        h      the step
k  principal values of I^-1           omega  k H
q  attitude quaternion, body to space

The sound twin is the classical Runge-Kutta method of fourth order at the same step, which is so small
that the twin passes every gate: the defect fails, not the step. In the last defect heyoka
chooses the step; its twin is our driver of heyoka, `Taylor`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from itertools import pairwise
from math import cos, sin, sqrt
from time import perf_counter
from typing import Any, Final, final

import numpy as np

from taylor_verify.models.frame import attitude_rate
from taylor_verify.models.problem import Problem
from taylor_verify.numbers.precision import exact_value
from taylor_verify.solvers.solver import Solver
from taylor_verify.solvers.taylor.plain import Plain
from taylor_verify.solvers.trajectory import Outcome, Trajectory, from_scaled
from taylor_verify_reports.controls.defect import BRICK, Defect

# The brick turns by 0.2 rad between two samples: by 1e-3 rad a step. Fourth order then leaves some
# 1e-12/120 a radian, a hundredth of what rounding so many steps may.
_STEPS_PER_SAMPLE: Final = 200
# An implicit step is solved by iteration, which gains the factor 1e-3 each time.
_ITERATIONS: Final = 6

Vector = np.ndarray[Any, np.dtype[np.float64]]
Step = Callable[["Body", Vector, float], Vector]


@dataclass(frozen=True)
class Body:
    """The principal values of I^-1, in the problem's units; a state is H1 H2 H3 q0 q1 q2 q3."""

    k: Vector

    def omega(self, H: Vector) -> Vector:
        return self.k * H

    def momentum_rate(self, H: Vector) -> Vector:
        """Return H x omega."""
        (k1, k2, k3), (H1, H2, H3) = self.k.tolist(), H.tolist()
        return np.array([(k3 - k2) * H2 * H3, (k1 - k3) * H3 * H1, (k2 - k1) * H1 * H2])

    def rate(self, state: Vector) -> Vector:
        """Return H' = H x omega and q' = q (0, omega)/2, as one vector of seven."""
        H = state[:3]
        turning = attitude_rate(state[3:].tolist(), self.omega(H).tolist())
        return np.array([*self.momentum_rate(H), *turning])


@final
@dataclass(frozen=True)
class FixedStep(Solver):
    """A free body in principal axes with its attitude, ``steps_per_sample`` equal steps a sample."""

    step: Step
    name: str
    setting: str = ""
    steps_per_sample: int = _STEPS_PER_SAMPLE
    counts_steps = True

    def solve(self, problem: Problem) -> Trajectory:
        began = perf_counter()
        given = problem.parameter
        body = Body(np.array([float(given[name]) for name in ("K11", "K22", "K33")]))
        state = np.array([float(value) for value in problem.initial_momenta])
        rows = [state]
        for before, after in pairwise(float(t) for t in problem.times):
            h = (after - before) / self.steps_per_sample
            for _ in range(self.steps_per_sample):
                state = self.step(body, state, h)
            rows.append(state)
        exact = [[exact_value(value) for value in row] for row in rows]
        steps = self.steps_per_sample * (len(rows) - 1)
        seconds = perf_counter() - began
        quantities = from_scaled(problem, exact)
        return Trajectory(Outcome.FINISHED, quantities, steps=steps, seconds=seconds)


# The steps.


def runge_kutta(body: Body, state: Vector, h: float) -> Vector:
    """Step momentum and attitude together by the classical method of fourth order."""
    return state + h / 6 * _weighted(*_stages(body.rate, state, h))


def _stages(rate: Callable[[Vector], Vector], state: Vector, h: float) -> tuple[Vector, ...]:
    first = rate(state)
    second = rate(state + h / 2 * first)
    third = rate(state + h / 2 * second)
    return first, second, third, rate(state + h * third)


def _weighted(a: Vector, b: Vector, c: Vector, d: Vector) -> Vector:
    return a + 2 * (b + c) + d


def _averaged_exponential(body: Body, state: Vector, h: float) -> Vector:
    """Step H as `runge_kutta` does, the attitude by one rotation about the mean velocity of the stages."""
    H = state[:3]
    first, second, third, fourth = _stages(body.momentum_rate, H, h)
    points = (H, H + h / 2 * first, H + h / 2 * second, H + h * third)
    mean = 1 / 6 * _weighted(*map(body.omega, points))
    after = H + h / 6 * _weighted(first, second, third, fourth)
    return np.concatenate([after, _turned(state[3:], mean, h)])


def _explicit(body: Body, state: Vector, h: float, iterations: int = 1) -> Vector:
    """Return H + h (H x omega), with H x omega at the old state, and the frame turned by the new omega.

    More iterations approach H x omega at the new state.
    """
    H = state[:3]
    for _ in range(iterations):
        H = state[:3] + h * body.momentum_rate(H)
    return np.concatenate([H, _turned(state[3:], body.omega(H), h)])


def _energy_restored(body: Body, state: Vector, h: float) -> Vector:
    """Return the explicit step with H scaled back to its old energy."""
    after = _explicit(body, state, h)
    before, scaled = state[:3], after[:3]
    scaled *= sqrt(sum(before * body.omega(before)) / sum(scaled * body.omega(scaled)))
    return after


def _in_single_precision(body: Body, state: Vector, h: float) -> Vector:
    """Return a sound step, its result rounded to float32."""
    return runge_kutta(body, state, h).astype(np.float32).astype(np.float64)


def _turned(q: Vector, omega: Vector, h: float) -> Vector:
    """Return q times the rotation by h omega, exact for a constant omega, which is not zero here."""
    speed = sqrt(sum(omega * omega))
    c, s = cos(h * speed / 2), sin(h * speed / 2) / speed
    # attitude_rate(q, omega) is q (0, omega)/2.
    return c * q + 2 * s * np.array(attitude_rate(q.tolist(), omega.tolist()))


_TWIN: Final = FixedStep(runge_kutta, "runge-kutta-4", "1.5 ms")
# A defect of fixed steps of the brick, as published simulators have them.
_common: Final = partial(Defect, scene=BRICK, twin=_TWIN, is_common=True)


STEPPING: Final = (
    _common(
        name="explicit-gyroscopic-update",
        gate="T",
        what="the gyroscopic term taken at the old state (explicit)",
        why="H x omega stands at right angles to H, and a step along a tangent ends outside the sphere: "
        "|H| and T rise in every step",
        solver=FixedStep(_explicit, "explicit-gyroscopic-update"),
    ),
    _common(
        name="implicit-gyroscopic-update",
        gate="T",
        what="the gyroscopic term taken at the new state (implicit)",
        why="the mirror image: every step ends inside the sphere, |H| and T fall",
        solver=FixedStep(partial(_explicit, iterations=_ITERATIONS), "implicit-gyroscopic-update"),
    ),
    _common(
        name="energy-restored",
        gate="H2",
        passes=frozenset({"T"}),
        what="an explicit step, the energy then restored by scaling",
        why="the energy is what is put there; the error is where it was",
        solver=FixedStep(_energy_restored, "energy-restored"),
    ),
    _common(
        name="averaged-exponential",
        gate="attitude",
        passes=frozenset({"omega", "T", "H2"}),
        what="the attitude by one rotation about the mean velocity of a step",
        why="turns about different axes do not commute: omega is of fourth order, the attitude only of "
        "second, and no quantity in body axes knows the attitude",
        solver=FixedStep(_averaged_exponential, "averaged-exponential"),
    ),
    _common(
        name="float32-state",
        gate="T",
        what="the state kept in float32 between steps",
        why="each step rounds to 24 bits, half a billion times as coarsely as to 53",
        solver=FixedStep(_in_single_precision, "float32-state"),
    ),
    Defect(
        name="unbounded-step",
        scene="extremes/euler-unstable-axis-1e-12",
        gate="omega",
        passes=frozenset({"T", "H2"}),
        what="no bound on the step beside an unstable axis",
        why="the error of a step is held against the whole state: the distance from the axis, 1e-12 of "
        "it, is rounded to 1e-16 of the whole and not of itself, and tells when the body tumbles. On "
        "the orbit that it takes everything is conserved",
        solver=Plain(),
    ),
)
