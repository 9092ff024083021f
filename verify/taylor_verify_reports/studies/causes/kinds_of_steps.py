"""Kinds of methods of one step and of updates of the attitude."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Final

import numpy as np

from taylor_verify_reports.studies.causes.bodies import Floats, Sample
from taylor_verify_reports.studies.causes.kind import RIGID, WITH_RATES, Kind
from taylor_verify_reports.studies.causes.simulated import (
    Rows,
    law,
    stepped,
    stepped_together,
    turned,
)
from taylor_verify_reports.studies.causes.stepping import (
    Draw,
    Make,
    begin,
    by,
    by_rates,
    euler,
    heun,
    mean,
    rk4,
    turn,
)

_Rate = Callable[[Floats], Floats]
_Step = Callable[[_Rate, Floats, float], Floats]


def _tableau(weights: Sequence[float], *rows: Sequence[float]) -> _Step:
    def step(f: _Rate, v: Floats, h: float) -> Floats:
        k = [f(v)]
        for row in rows:
            k.append(f(v + h * sum(a * each for a, each in zip(row, k, strict=True))))
        return np.asarray(v + h * sum(b * each for b, each in zip(weights, k, strict=True)))

    return step


def _implicit(slope: Callable[[_Rate, Floats, Floats], Floats]) -> _Step:
    def step(f: _Rate, v: Floats, h: float) -> Floats:
        z = v
        for _ in range(60):
            z = v + h * slope(f, v, z)
        return z

    return step


def _newton(f: _Rate, v: Floats, h: float) -> Floats:
    size = 1e-7 * float(np.max(np.abs(v)))
    slopes = np.array([(f(v + size * e) - f(v - size * e)) / (2 * size) for e in np.eye(len(v))]).T
    return np.asarray(v + np.linalg.solve(np.eye(len(v)) - h * slopes, h * f(v)))


def _in_turn(f: _Rate, v: Floats, h: float) -> Floats:
    z = v.copy()
    for i in range(len(v)):
        z[i] += h * f(z)[i]
    return z


def _of_momentum(*, is_turned: bool) -> Make:
    def make(s: Sample, d: Draw, size: float) -> Rows:
        def step(f: _Rate, v: Floats, h: float) -> Floats:
            before = s.mass @ v + s.rotor
            if is_turned:
                torque = s.mass @ f(v) - np.cross(before, v)
                q = turn(np.array([1.0, 0, 0, 0]), -v, h)
                around = np.cross(q[1:], before)
                after = before + 2 * (q[0] * around + np.cross(q[1:], around)) + h * torque
            else:
                after = before + h * (s.mass @ f(v))
                after = after * np.linalg.norm(before) / np.linalg.norm(after)
            return np.asarray(np.linalg.solve(s.mass, after - s.rotor))

        return stepped(s, step, begin, int(d.integers(4, 20)))

    return make


def _damped(f: _Rate, v: Floats, h: float) -> Floats:
    """Return an RK4 step with damping once, as engines have it by default."""
    return (1 - 0.05 * h) * rk4(f, v, h)


def _end(q: Floats, before: Floats, after: Floats, h: float) -> Floats:
    return turn(q, after, h)


def _loaded(s: Sample, d: Draw, size: float) -> Rows:
    """Return RK4 steps beside another load."""
    own = law(s)
    own.load = own.load + size * d.uniform(0.3, 1, s.n)
    return stepped(s, rk4, mean, int(d.integers(1, 4)), own)


def _uneven(s: Sample, d: Draw, size: float) -> Rows:
    """Return Heun steps that do not divide the rows."""
    h = float(s.times[1]) / d.uniform(1.2, 3.8)

    def step(f: _Rate, v: Floats, span: float) -> Floats:
        left = span
        while left > 1e-12:
            v, left = heun(f, v, min(h, left)), left - h
        return v

    return stepped(s, step, mean, 1)


_STEPS: Final[dict[str, _Step]] = {
    "midpoint": _tableau([0, 1], [0.5]),
    "Ralston": _tableau([1 / 4, 3 / 4], [2 / 3]),
    "implicit midpoint": _implicit(lambda f, v, z: f((v + z) / 2)),
    "trapezoid": _implicit(lambda f, v, z: (f(v) + f(z)) / 2),
    "RK3 (Kutta)": _tableau([1 / 6, 2 / 3, 1 / 6], [0.5], [-1, 2]),
    "RK3 (SSP)": _tableau([1 / 6, 1 / 6, 2 / 3], [1], [1 / 4, 1 / 4]),
    "RK4 (3/8)": _tableau([1 / 8, 3 / 8, 3 / 8, 1 / 8], [1 / 3], [-1 / 3, 1], [1, -1, 1]),
    "RK4 with its fourth stage at h/2": _tableau(
        [1 / 6, 1 / 3, 1 / 3, 1 / 6], [0.5], [0, 0.5], [0, 0, 0.5]
    ),
    "one Newton step of backward Euler": _newton,
}
_IN_PLACE: Final = "components updated in place"
_HELD: Final = ("q + h q omega / 2 with the rate at the begin",)
OF_STEPS: Final = (
    *(Kind(name, (name, "attitude turned by"), by(step, mean)) for name, step in _STEPS.items()),
    Kind(_IN_PLACE, (_IN_PLACE, "attitude turned by"), by(_in_turn, mean), WITH_RATES),
    Kind(
        "momentum turned",
        ("momentum turned", "attitude turned by"),
        _of_momentum(is_turned=True),
        RIGID,
    ),
    Kind(
        "momentum of fixed size",
        ("its size restored", "attitude turned by"),
        _of_momentum(is_turned=False),
        RIGID,
    ),
    Kind("semi-implicit Euler", ("explicit Euler", "attitude turned by"), by(euler, _end)),
    Kind(
        "attitude by Euler steps",
        _HELD,
        lambda s, d, size: by_rates(s, d, lambda q, w, h: q + h * turned(q, w)),
    ),
    Kind(
        "RK4 and another load",
        ("RK4", "attitude turned by", "force", "couple", "moment"),
        _loaded,
    ),
    Kind("steps that do not divide the rows", (), _uneven),
)
# A kind that came later stands last among all: a kind is drawn by its place.
DAMPING_STEP: Final = Kind(
    "damping step", ("damping step", "attitude turned by"), by(_damped, mean)
)


def _together(step: _Step) -> Make:
    return lambda s, d, size: stepped_together(s, step, int(d.integers(1, 5)))


_OF_ALL: Final = ("gradient", "vehicle", "pulse", "sampled", "lag", "surge")
_TURN: Final = "attitude q + h q omega / 2"
# Steps that are exact but for one switch do no more than a load for a short time.
_OVER_ONE: Final = "exact motion between jumps"
LATER_OF_STEPS: Final = (
    Kind("RK4 of all states", ("RK4", _OVER_ONE), _together(rk4), _OF_ALL),
    Kind("Heun of all states", ("Heun",), _together(heun), _OF_ALL),
    Kind("midpoint of all states", ("midpoint",), _together(_STEPS["midpoint"]), _OF_ALL),
    Kind("explicit Euler of all states", ("explicit Euler", _TURN), _together(euler), _OF_ALL),
)
