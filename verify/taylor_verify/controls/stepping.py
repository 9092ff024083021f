"""Defects of the stepping: a body in principal axes, followed at a fixed step in double precision.

H  angular momentum, body axes        h      the step
k  principal values of I^-1           omega  k H
q  attitude quaternion, body to space

The sound twin is the classical Runge-Kutta method of fourth order at the very same step, so small
that it passes every gate: what fails here is the defect and not the step. Last comes a step of
heyoka's own choice, whose twin is the driver.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import cos, sin, sqrt
from time import perf_counter
from typing import Final, final

import numpy as np

from taylor_verify.controls.defect import Defect
from taylor_verify.models.frame import attitude_rate
from taylor_verify.models.problem import Problem
from taylor_verify.scenes.precision import exact_value
from taylor_verify.solvers.solver import Solver
from taylor_verify.solvers.taylor.plain import Plain
from taylor_verify.solvers.trajectory import Outcome, Trajectory, from_scaled

_BRICK: Final = "euler/nesc-brick"

# The brick turns by 0.2 rad between two samples: by 1e-3 rad a step. Fourth order then leaves some
# 1e-12/120 a radian, a hundredth of what rounding so many steps may.
_STEPS_PER_SAMPLE: Final = 200
# An implicit step is solved by iteration, which gains the factor 1e-3 each time.
_ITERATIONS: Final = 6

Triple = tuple[float, float, float]
State = tuple[float, ...]
Rate = Callable[[Sequence[float]], Triple]
Step = Callable[["Body", State, float], State]


@dataclass(frozen=True)
class Body:
    """The principal values of I^-1, in the problem's units; a state is H1 H2 H3 q0 q1 q2 q3."""

    k: Triple

    def omega(self, H: Sequence[float]) -> Triple:
        k1, k2, k3 = self.k
        return k1 * H[0], k2 * H[1], k3 * H[2]

    def momentum_rate(self, H: Sequence[float]) -> Triple:
        """H x omega."""
        k1, k2, k3 = self.k
        return (k3 - k2) * H[1] * H[2], (k1 - k3) * H[2] * H[0], (k2 - k1) * H[0] * H[1]

    def rate(self, state: Sequence[float]) -> State:
        """H' = H x omega and q' = q (0, omega)/2."""
        H = state[:3]
        return (*self.momentum_rate(H), *attitude_rate(state[3:], self.omega(H)))


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
        body = Body((float(given["K11"]), float(given["K22"]), float(given["K33"])))
        state: State = tuple(float(value) for value in problem.initial_momenta)
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


def runge_kutta(body: Body, state: State, h: float) -> State:
    """The classical method of fourth order, momentum and attitude together."""
    return _summed(state, _stages(body.rate, state, h), h)


def _stages(rate: Callable[[State], State], state: State, h: float) -> tuple[State, ...]:
    first = rate(state)
    second = rate(_ahead(state, first, h / 2))
    third = rate(_ahead(state, second, h / 2))
    return first, second, third, rate(_ahead(state, third, h))


def _ahead(state: State, rate: State, h: float) -> State:
    return tuple(s + h * r for s, r in zip(state, rate, strict=True))


def _summed(state: State, stages: Sequence[State], h: float) -> State:
    parts = zip(state, *stages, strict=True)
    return tuple(s + h / 6 * (a + 2 * (b + c) + d) for s, a, b, c, d in parts)


def _averaged_exponential(body: Body, state: State, h: float) -> State:
    """H as above; the attitude by one rotation, about the mean of the four stages' velocities."""
    H = state[:3]
    rates = _stages(body.momentum_rate, H, h)
    after_half, after_half_again, after = (
        _ahead(H, rate, part) for rate, part in zip(rates, (h / 2, h / 2, h), strict=False)
    )
    velocities = [body.omega(point) for point in (H, after_half, after_half_again, after)]
    mean = _summed((0.0, 0.0, 0.0), velocities, 1.0)
    return (*_summed(H, rates, h), *_turned(state[3:], mean, h))


def _explicit(body: Body, state: State, h: float) -> State:
    """H + h (H x omega), all of it at the old state; then the frame by the new velocity."""
    H = _ahead(state[:3], body.momentum_rate(state[:3]), h)
    return (*H, *_turned(state[3:], body.omega(H), h))


def _implicit(body: Body, state: State, h: float) -> State:
    """The same with H x omega at the new state."""
    before = H = state[:3]
    for _ in range(_ITERATIONS):
        H = _ahead(before, body.momentum_rate(H), h)
    return (*H, *_turned(state[3:], body.omega(H), h))


def _energy_restored(body: Body, state: State, h: float) -> State:
    """The explicit step, and H scaled back to the energy that it had."""
    after = _explicit(body, state, h)
    share = sqrt(_doubled_energy(body, state) / _doubled_energy(body, after))
    return (*(share * component for component in after[:3]), *after[3:])


def _doubled_energy(body: Body, state: State) -> float:
    return sum(h * w for h, w in zip(state[:3], body.omega(state[:3]), strict=True))


def _in_single_precision(body: Body, state: State, h: float) -> State:
    """A sound step whose result is kept in float32 until the next."""
    return tuple(float(np.float32(value)) for value in runge_kutta(body, state, h))


def _turned(q: State, omega: Sequence[float], h: float) -> State:
    """q times the rotation by h omega, exact for a constant velocity; no velocity here is zero."""
    speed = sqrt(sum(w * w for w in omega))
    c, s = cos(h * speed / 2), sin(h * speed / 2) / speed
    # attitude_rate(q, omega) is q (0, omega)/2.
    turning = attitude_rate(q, omega)
    return tuple(c * a + 2 * s * b for a, b in zip(q, turning, strict=True))


_TWIN: Final = FixedStep(runge_kutta, "runge-kutta-4", "1.5 ms")


def _stepping(
    name: str,
    gate: str,
    step: Step,
    passes: frozenset[str],
    what: str,
    why: str,
    told: bool = False,
) -> Defect:
    return Defect(
        name,
        _BRICK,
        gate,
        passes=passes,
        what=what,
        why=why,
        told=told,
        solver=FixedStep(step, name),
        twin=_TWIN,
    )


STEPPING: Final = (
    _stepping(
        "explicit-gyroscopic-update",
        "T",
        _explicit,
        frozenset(),
        "the gyroscopic term taken at the old state (explicit)",
        "H x omega stands at right angles to H, and a step along a tangent ends outside the sphere: "
        "|H| and T rise in every step",
        told=True,
    ),
    _stepping(
        "implicit-gyroscopic-update",
        "T",
        _implicit,
        frozenset(),
        "the gyroscopic term taken at the new state (implicit)",
        "the mirror image: every step ends inside the sphere, |H| and T fall",
        told=True,
    ),
    _stepping(
        "energy-restored",
        "H2",
        _energy_restored,
        frozenset({"T"}),
        "an explicit step, the energy then restored by scaling",
        "the energy is what is put there; the error is where it was",
        told=True,
    ),
    _stepping(
        "averaged-exponential",
        "attitude",
        _averaged_exponential,
        frozenset({"omega", "T", "H2"}),
        "the attitude by one rotation about the mean velocity of a step",
        "turns about different axes do not commute: omega is of fourth order, the attitude only of "
        "second, and no quantity in body axes knows the attitude",
        told=True,
    ),
    _stepping(
        "float32-state",
        "T",
        _in_single_precision,
        frozenset(),
        "the state kept in float32 between steps",
        "each step rounds to 24 bits, half a billion times as coarsely as to 53",
        told=True,
    ),
    Defect(
        "unbounded-step",
        "extremes/euler-unstable-axis-1e-12",
        "omega",
        passes=frozenset({"T", "H2"}),
        what="no bound on the step beside an unstable axis",
        why="the error of a step is held against the whole state: the distance from the axis, 1e-12 of "
        "it, is rounded to 1e-16 of the whole and not of itself, and tells when the body tumbles. On "
        "the orbit that it takes everything is conserved",
        solver=Plain(),
    ),
)
