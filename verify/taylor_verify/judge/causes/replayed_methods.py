"""Methods of one step, replayed from each row of an answer to the next: no number but that of the steps.

A rate is a function of time and state; states are arrays (sets, components, arcs), and h has one entry for
each arc. An attitude's update takes q, the angular velocities at both ends of the step, and h.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any, Final

import numpy as np

from taylor_verify.judge.causes.changed_equations import Equations
from taylor_verify.judge.causes.many_flows import Floats
from taylor_verify.models.acting import Frame
from taylor_verify.models.frame import attitude_rate
from taylor_verify.models.frame import rotation as matrix
from taylor_verify.numbers import rotation

_Step = Callable[[Equations, Floats, Floats, Floats], Floats]
_Update = Callable[[Floats, Floats, Floats, Floats], Floats]

_ITERATIONS: Final = 30
_NEWTON: Final = 4
_SHIFT: Final = 1e-7
_SETTLED: Final = 1e-15
# Evaluations of a step of Newton's method, with its slopes, and of an iterated step, about.
_EVALUATIONS_OF_NEWTON: Final = 5
_EVALUATIONS: Final = 12


@dataclass(frozen=True)
class Method:
    """A step (equations, time, v, h) of some order, by so many ``evaluations`` where that is not the order.

    One that ``has_frame`` leads the attitude and the centre as well. One with a ``run`` (answer, equations,
    h, components) needs more than the state: its step is nearly right, and the run is the motion.
    ``held`` are loads that are taken once in a step, where that is all of the method; ``frame`` is how its
    stages read q.
    """

    order: int
    step: _Step
    evaluations: int = 0
    has_frame: bool = False
    run: Any = None
    held: Any = None
    frame: Frame | None = None

    @property
    def is_dear(self) -> bool:
        """True for a step that is solved, or goes in stages."""
        return self.evaluations > self.order


def _explicit(weights: Sequence[float], *rows: Sequence[float]) -> _Step:
    """Return the step of a Runge-Kutta method; the first stage has no row."""

    def step(equations: Equations, time: Floats, v: Floats, h: Floats) -> Floats:
        slopes = [equations.rates(time, v)]
        for row in rows:
            inner = v + h * sum(a * k for a, k in zip(row, slopes, strict=True))
            slopes.append(equations.rates(time + sum(row) * h, inner))
        return v + h * sum(b * k for b, k in zip(weights, slopes, strict=True))

    return step


def _backward(rounds: int) -> _Step:
    """Return backward Euler by so many steps of Newton's method from the begin of the step."""

    def step(equations: Equations, time: Floats, v: Floats, h: Floats) -> Floats:
        z, n = v, v.shape[1]
        size = _SHIFT * (np.max(np.abs(v)) or 1.0)
        shifts = size * np.eye(n)[:, None, :, None]
        for _ in range(rounds):
            rest = z - v - h * equations.rates(time + h, z)
            slopes = [
                (z + s - v - h * equations.rates(time + h, z + s) - rest) / size for s in shifts
            ]
            matrix = np.stack(slopes, axis=2).transpose(0, 3, 1, 2)
            change = np.linalg.solve(matrix, rest.transpose(0, 2, 1)[..., None])[..., 0]
            z = z - change.transpose(0, 2, 1)
        return z

    return step


def _iterated(slope: Callable[[Equations, Floats, Floats, Floats, Floats], Floats]) -> _Step:
    """Return an implicit step z = v + h slope(v, z), solved by iteration."""

    def step(equations: Equations, time: Floats, v: Floats, h: Floats) -> Floats:
        z = v + h * equations.rates(time, v)
        for _ in range(_ITERATIONS):
            before, z = z, v + h * slope(equations, time, v, z, h)
            if np.max(np.abs(z - before)) < _SETTLED * np.max(np.abs(v)):
                break
        return z

    return step


def _midpoint(equations: Equations, time: Floats, v: Floats, z: Floats, h: Floats) -> Floats:
    return equations.rates(time + h / 2, (v + z) / 2)


def _trapezoid(equations: Equations, time: Floats, v: Floats, z: Floats, h: Floats) -> Floats:
    return (equations.rates(time, v) + equations.rates(time + h, z)) / 2


def _in_place(equations: Equations, time: Floats, v: Floats, h: Floats) -> Floats:
    z = v.copy()
    for i in range(v.shape[1]):
        z[:, i] += h * equations.rates(time, z)[:, i]
    return z


def _momentum(equations: Equations, v: Floats) -> Floats:
    return equations.mass @ v + equations.rotor[:, None]


def _velocity(equations: Equations, momentum: Floats) -> Floats:
    return equations.inverse @ (momentum - equations.rotor[:, None])


def _turned_by_the_rate(equations: Equations, time: Floats, v: Floats, h: Floats) -> Floats:
    momentum = _momentum(equations, v)
    push = h * _torque(equations, time, v, momentum)
    return _velocity(equations, _rotated(momentum, v, -h) + push)


def _pushed_and_turned(
    is_euler: bool, equations: Equations, time: Floats, v: Floats, h: Floats
) -> Floats:
    momentum = _momentum(equations, v)
    push = h * _torque(equations, time, v, momentum)
    if is_euler:
        # q + h q omega / 2 of unit length turns by the angle 2 atan(h |omega| / 2).
        half = h * np.linalg.norm(v, axis=1, keepdims=True) / 2
        v = v * np.arctan(half) / np.where(half > 0, half, 1.0)
    return _velocity(equations, _rotated(momentum + push, v, -h))


def _torque(equations: Equations, time: Floats, v: Floats, momentum: Floats) -> Floats:
    return equations.mass @ equations.rates(time, v) - np.cross(momentum, v, axis=1)


def _rotated(vectors: Floats, omega: Floats, h: Floats) -> Floats:
    """Return the vectors turned about omega by the angle h |omega|."""
    size = np.linalg.norm(omega, axis=1, keepdims=True)
    axis, angle = omega / np.where(size > 0, size, 1.0), h * size
    along = np.sum(axis * vectors, axis=1, keepdims=True) * axis
    across = np.cross(axis, vectors, axis=1)
    return np.asarray(along + (vectors - along) * np.cos(angle) + across * np.sin(angle))


def _of_fixed_size(equations: Equations, time: Floats, v: Floats, h: Floats) -> Floats:
    before = _momentum(equations, v)
    after = before + h * (equations.mass @ equations.rates(time, v))
    sizes = [np.linalg.norm(each, axis=1, keepdims=True) for each in (before, after)]
    return _velocity(equations, after * sizes[0] / sizes[1])


def _runge_kutta(order: int, weights: Sequence[float], *rows: Sequence[float]) -> Method:
    """Return an explicit method that leads the attitude as it leads the motion."""
    return Method(order, _explicit(weights, *rows), has_frame=True)


METHODS: Final[Mapping[str, Method]] = {
    "explicit Euler": Method(1, _explicit([1])),
    "backward Euler": Method(1, _backward(_NEWTON), _NEWTON * _EVALUATIONS_OF_NEWTON),
    "one Newton step of backward Euler": Method(1, _backward(1), _EVALUATIONS_OF_NEWTON),
    "components updated in place": Method(1, _in_place),
    "midpoint": _runge_kutta(2, [0, 1], [1 / 2]),
    "Heun": _runge_kutta(2, [1 / 2, 1 / 2], [1]),
    "Ralston": _runge_kutta(2, [1 / 4, 3 / 4], [2 / 3]),
    "implicit midpoint": Method(2, _iterated(_midpoint), _EVALUATIONS, has_frame=True),
    "trapezoid": Method(2, _iterated(_trapezoid), _EVALUATIONS, has_frame=True),
    "RK3 (Kutta)": _runge_kutta(3, [1 / 6, 2 / 3, 1 / 6], [1 / 2], [-1, 2]),
    "RK3 (SSP)": _runge_kutta(3, [1 / 6, 1 / 6, 2 / 3], [1], [1 / 4, 1 / 4]),
    "RK4": _runge_kutta(4, [1 / 6, 1 / 3, 1 / 3, 1 / 6], [1 / 2], [0, 1 / 2], [0, 0, 1]),
    "RK4 with its fourth stage at h/2": _runge_kutta(
        1, [1 / 6, 1 / 3, 1 / 3, 1 / 6], [1 / 2], [0, 1 / 2], [0, 0, 1 / 2]
    ),
    "RK4 (3/8)": _runge_kutta(4, [1 / 8, 3 / 8, 3 / 8, 1 / 8], [1 / 3], [-1 / 3, 1], [1, -1, 1]),
}
# Methods of the momentum of a rigid body.
OF_MOMENTUM: Final[Mapping[str, Method]] = {
    "momentum turned by the rate at the begin of the step": Method(1, _turned_by_the_rate),
    "explicit step of the momentum, its size restored": Method(1, _of_fixed_size),
}
# Under a moment, which is added before the turn.
OF_PUSHED_MOMENTUM: Final[Mapping[str, Method]] = {
    f"momentum with the moment of the step turned by {turn} at its begin": Method(
        1, partial(_pushed_and_turned, is_euler)
    )
    for turn, is_euler in (("the rate", False), ("q + h q omega / 2", True))
}


# Attitudes.


def _quaternion_of(omega: Floats, h: Floats) -> Floats:
    size = np.linalg.norm(omega, axis=1, keepdims=True)
    sine = np.where(size > 0, np.sin(h * size / 2) / np.where(size > 0, size, 1.0), h / 2)
    return np.concatenate([np.cos(h * size / 2), omega * sine], axis=1)


def _turned(q: Floats, omega: Floats, h: Floats) -> Floats:
    return np.stack(rotation.product(_parts(q), _parts(_quaternion_of(omega, h))), axis=1)


def _slope(q: Floats, omega: Floats) -> Floats:
    return np.stack(attitude_rate(_parts(q), _parts(omega)), axis=1)


def _parts(rows: Floats) -> list[Any]:
    return list(rows.swapaxes(0, 1))


def _in_turn(
    q: Floats, omega: Floats, cosine: Any, sine: Any, order: Sequence[int] = range(4)
) -> Floats:
    """Return cosine q + sine q omega, where each component is put into the others that follow it."""
    q = q.copy()
    for i in order:
        q[:, i] = cosine * q[:, i] + 2 * sine * _slope(q, omega)[:, i]
    return q


def _turned_in_place(q: Floats, before: Floats, after: Floats, h: Floats) -> Floats:
    size = np.linalg.norm(before, axis=1)
    return _in_turn(q, before, np.cos(h * size / 2), h / 2 * np.sinc(h * size / 2 / np.pi))


UPDATES: Final[Mapping[str, _Update]] = {
    "turned by the rate at the begin of the step": lambda q, w, after, h: _turned(q, w, h),
    "turned by the rate at the end of the step": lambda q, w, after, h: _turned(q, after, h),
    "turned by the mean of the rates of a step": lambda q, w, after, h: _turned(
        q, (w + after) / 2, h
    ),
    "q + h q omega / 2 with the rate at the begin": lambda q, w, after, h: q + h * _slope(q, w),
    "q + h q omega / 2 with the rate at the end": lambda q, w, after, h: q + h * _slope(q, after),
    "q + h q omega / 2 with the mean of the rates": lambda q, w, after, h: (
        q + h * _slope(q, (w + after) / 2)
    ),
    "quaternion updated in place": lambda q, w, after, h: _in_turn(q, w, 1.0, h / 2),
    "quaternion updated in place, its last component first": lambda q, w, after, h: _in_turn(
        q, w, 1.0, h / 2, range(3, -1, -1)
    ),
    "quaternion updated in place, its vector first": lambda q, w, after, h: _in_turn(
        q, w, 1.0, h / 2, (1, 2, 3, 0)
    ),
    "quaternion turned by the rate at the begin of the step, updated in place": _turned_in_place,
}
OF_SECOND_ORDER: Final = frozenset(name for name in UPDATES if "mean of the rates" in name)

_IN_THE_MIDDLE: Final = "turned by the rate in the middle of the step"

# The first-order updates of the attitude by which loads that read it differ.
_WITH_EULER: Final = (
    "turned by the rate at the begin of the step",
    "turned by the rate at the end of the step",
    "q + h q omega / 2 with the rate at the end",
)


def with_updates(n: int) -> Iterator[tuple[str, Method]]:
    """Yield methods with updates of the attitude of their own, for states of n velocities and q."""
    yield from explicit_with_updates(n)
    # Explicit halves of the gyroscopic term are of first order.
    yield f"leapfrog, attitude {_IN_THE_MIDDLE}", Method(1, partial(_leapfrog, n))
    midpoint = partial(_midpoint_turned, n)
    yield f"implicit midpoint, attitude {_IN_THE_MIDDLE}", Method(2, midpoint, _EVALUATIONS)


def explicit_with_updates(n: int) -> Iterator[tuple[str, Method]]:
    """Yield explicit Euler's method with updates of the attitude of their own."""
    euler = METHODS["explicit Euler"]
    for name in _WITH_EULER:
        step = partial(_updated, euler.step, UPDATES[name], n)
        yield f"explicit Euler, attitude {name}", Method(1, step)


def _as_it_is(q: Sequence[Any]) -> tuple[Sequence[Any], Sequence[Sequence[Any]]]:
    return q, matrix(q)


def _with_ones(q: Sequence[Any]) -> tuple[Sequence[Any], Sequence[Sequence[Any]]]:
    """Return R with 1 - 2 (q2 q2 + q3 q3) and the like in its diagonal."""
    rest, R = 1 - sum(e * e for e in q), matrix(q)
    return q, [[e + rest * (i == k) for k, e in enumerate(row)] for i, row in enumerate(R)]


_FRAMES: Final[Mapping[str, Frame]] = {
    "whose stages read q as it is": _as_it_is,
    "whose stages read q as it is, R with 1 - 2 (...) in its diagonal": _with_ones,
}


def with_frames() -> Iterator[tuple[str, Method]]:
    """Yield methods of several stages, between which q is not of unit length, as loads may read it."""
    for name, method in METHODS.items():
        if method.has_frame:
            yield from as_it_is(name, method)


def as_it_is(name: str, method: Method) -> Iterator[tuple[str, Method]]:
    """Yield an explicit method with the ways in which its stages may read q that is not of unit length."""
    if method.frame is not None:
        yield name, method
    elif not (method.is_dear or method.run or method.held):
        for words, frame in _FRAMES.items():
            yield f"{name} {words}", replace(method, frame=frame)


def _leapfrog(n: int, equations: Equations, time: Floats, z: Floats, h: Floats) -> Floats:
    """Return z after half a step of v, a turn by its omega, and the other half."""
    z = z.copy()
    z[:, :n] += h / 2 * equations.rates(time, z)[:, :n]
    z[:, n : n + 4] = _turned(z[:, n : n + 4], equations.velocities(time, z)[:, -3:], h)
    z[:, :n] += h / 2 * equations.rates(time + h, z)[:, :n]
    return z


def _midpoint_turned(n: int, equations: Equations, time: Floats, z: Floats, h: Floats) -> Floats:
    """Return z after the step by the mean of v before and after, which turns the attitude as well."""
    q, after = z[:, n : n + 4], z
    for _ in range(_ITERATIONS):
        before, middle = after, (z + after) / 2
        omega = equations.velocities(time + h / 2, middle)[:, -3:]
        middle[:, n : n + 4] = _turned(q, omega, h / 2)
        after = z + h * equations.rates(time + h / 2, middle)
        after[:, n : n + 4] = _turned(q, omega, h)
        if np.max(np.abs(after - before)) < _SETTLED * np.max(np.abs(z)):
            break
    return after


def _updated(
    step: _Step, update: _Update, n: int, equations: Equations, time: Floats, z: Floats, h: Floats
) -> Floats:
    after = step(equations, time, z, h)
    before, then = equations.velocities(time, z), equations.velocities(time + h, after)
    after[:, n : n + 4] = update(z[:, n : n + 4], before[:, -3:], then[:, -3:], h)
    return after


def with_unit_attitude(z: Floats, n: int) -> Floats:
    """Return states of n velocities, q and more with q of unit length."""
    z = z.copy()
    z[:, n : n + 4] /= np.linalg.norm(z[:, n : n + 4], axis=1, keepdims=True)
    return z
