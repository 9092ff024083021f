"""How fast an exact motion moves: its first and second time derivatives, from its own equations.

The equations are those of exact.taylor, z' = c + sum of products of two variables, so that
z'' = sum of (first' second + first second'). No difference of two motions is taken.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from typing import Any, Final

import numpy as np
from mpmath import mp

from verify.exact import clocks
from verify.exact.recursion import Combination
from verify.exact.taylor import posed
from verify.scenes.motion import Motion
from verify.scenes.scene import Scene

Floats = np.ndarray[Any, np.dtype[np.float64]]

# The order of the states in exact.taylor.
_STATES: Final = {
    "euler": ("omega", "attitude"),
    "kirchhoff": ("linear_impulse", "angular_impulse", "attitude", "centre"),
}

# Units of 2^-500 to 2^500 leave as much again to what is counted in them.
_MODERATE: Final = 500


@dataclass(frozen=True)
class Rates:
    """Derivatives of the tracked quantities at every instant of a motion, as float64.

    ``velocity`` and ``acceleration`` are shaped as in Motion. A quantity is measured in
    2^units[quantity], time in 2^time: powers of two in which the motion is of size one.
    """

    velocity: Mapping[str, Floats]
    acceleration: Mapping[str, Floats]
    units: Mapping[str, int]
    time: int


def rates(scene: Scene, motion: Motion, elapsed: Sequence[Fraction] | None = None) -> Rates:
    """The derivatives of a motion of this scene, to the roundings of float64.

    ``elapsed`` are the times of its rows since the start, the scene's own unless they are given; loads
    that change with time, those of a manufactured motion, ask for them.
    """
    flow = _flow(scene)
    names = [name for name in _STATES[scene.model] if name in motion.quantities]
    states = [motion[name].reshape(len(motion.radius), -1) for name in names]
    units = flow.exponents[: sum(block.shape[1] for block in states)]
    z = _floats(np.concatenate(states, axis=1), units)
    manufactured = scene.body.manufactured
    if manufactured is not None:
        times = scene.clock.elapsed if elapsed is None else elapsed
        z = np.concatenate([z, clocks.floats(manufactured, times)], axis=1)
    with np.errstate(all="ignore"):  # what is not finite stays so, and is the caller's to see
        velocity, acceleration = flow.derivatives(z)
    places, first = {}, 0
    for name, block in zip(names, states, strict=True):
        places[name] = slice(first, first + block.shape[1])
        first += block.shape[1]
    return Rates(
        velocity={n: velocity[:, p].reshape(motion[n].shape) for n, p in places.items()},
        acceleration={n: acceleration[:, p].reshape(motion[n].shape) for n, p in places.items()},
        units={name: units[place.start] for name, place in places.items()},
        time=flow.time,
    )


@dataclass(frozen=True)
class _Flow:
    """z' = constant + weights (v[first] v[second]), v being the states and then the forms."""

    constant: Floats
    forms: Floats
    first: tuple[int, ...]
    second: tuple[int, ...]
    weights: Floats
    exponents: tuple[int, ...]
    time: int

    def derivatives(self, z: Floats) -> tuple[Floats, Floats]:
        """z' and z'' at every row of z."""
        v = self._with_forms(z)
        a, b = v[:, self.first], v[:, self.second]
        velocity = self.constant + (a * b) @ self.weights.T
        dv = self._with_forms(velocity)
        acceleration = (dv[:, self.first] * b + a * dv[:, self.second]) @ self.weights.T
        return velocity, acceleration

    def _with_forms(self, z: Floats) -> Floats:
        return np.concatenate([z, z[:, : self.forms.shape[1]] @ self.forms.T], axis=1)


@lru_cache(maxsize=16)
def _flow(scene: Scene) -> _Flow:
    problem = posed(scene)
    size = len(problem.start)
    constant, weights = np.zeros(size), np.zeros((size, len(problem.products)))
    constant[: len(problem.constant)] = [float(c) for c in problem.constant]
    for row, (places, combination) in zip(weights, problem.rates, strict=True):
        row[list(places)] = _coefficients(combination)
    return _Flow(
        constant=constant,
        forms=np.array([_coefficients(form) for form in problem.forms]).reshape(
            len(problem.forms), -1 if problem.forms else 0
        ),
        first=tuple(a for a, _ in problem.products),
        second=tuple(b for _, b in problem.products),
        weights=weights,
        exponents=problem.units.variables,
        time=problem.units.time,
    )


def _coefficients(combination: Combination) -> list[float]:
    # The numerators may be gmpy2's, whose quotients are no floats.
    return [int(numerator) / combination.denominator for numerator in combination.numerators]


def _floats(states: np.ndarray[Any, Any], exponents: tuple[int, ...]) -> Floats:
    """The states in their units; a double holds these, whatever the size of the units."""
    if max(abs(e) for e in exponents) <= _MODERATE:
        counted: Floats = np.ldexp(states.astype(float), [-e for e in exponents])
        return counted
    columns = [[mp.ldexp(v, -e) for v in c] for c, e in zip(states.T, exponents, strict=True)]
    return np.array(columns, dtype=object).T.astype(float)
