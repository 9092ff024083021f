"""The equations of a scene in float64, and the time derivatives of its exact motion by them.

The equations are those of exact.quadratic_forms, z' = c + L z + z.Q z/2, so that z'' = L z' + z.Q z'. No
difference of two motions is taken.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from typing import Any, Final

import numpy as np
from mpmath import mp

from taylor_verify.exact.quadratic_forms import Floats, Scaled
from taylor_verify.exact.registry import kind_of
from taylor_verify.exact.row_arithmetic import cross_matrices
from taylor_verify.numbers.precision import power_of_two
from taylor_verify.scenes.motion import Motion
from taylor_verify.scenes.scene import Scene

# Units of 2^-500 to 2^500 leave as much again to what is counted in them.
_MODERATE: Final = 500
# The numbers of a quantity that is no vector.
_SIZES: Final = {"attitude": 9}


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


def rates(scene: Scene, motion: Motion) -> Rates:
    """The derivatives of a motion of this scene, to the roundings of float64.

    Raises ValueError for loads that a scene writes down: their rates are not known here.
    """
    flow = float_flow(scene)
    states = flow.states(motion.quantities)
    with np.errstate(all="ignore"):  # what is not finite stays so, and is the caller's to see
        first, second = flow.two_rates(states)
    return Rates(flow.by_quantity(first), flow.by_quantity(second), flow.units, flow.time)


@dataclass(frozen=True)
class FloatFlow:
    """The equations of a scene in float64.

    A state is a row (n,) of the momenta, then the nine entries of the frame and the centre where they are
    there, each in 2^units of its own; time is in 2^time. An array of states is (times, n).
    """

    moving: tuple[str, ...]
    units: Mapping[str, int]
    time: int
    scaled: Scaled

    def times(self, elapsed: Sequence[Fraction]) -> Floats:
        """Times since the start in the unit of the equations."""
        unit = power_of_two(self.time)
        return np.array([float(t / unit) for t in elapsed])

    def states(self, quantities: Mapping[str, np.ndarray[Any, Any]]) -> Floats:
        """The states of the rows of a motion, in the scene's own units before."""
        rows = [
            _floats(quantities[name], exponent).reshape(-1, _SIZES.get(name, 3))
            for name, exponent in self.units.items()
            if name in quantities
        ]
        return np.hstack(rows)

    def by_quantity(self, states: Floats) -> dict[str, Floats]:
        """The parts of states by name, still in their units."""
        parts, end = dict[str, Floats](), 0
        for name in self.units:
            begin, end = end, end + _SIZES.get(name, 3)
            if end > states.shape[1]:
                break
            rows = states[:, begin:end]
            parts[name] = rows.reshape(-1, 3, 3) if name == "attitude" else rows
        return parts

    def quantities(self, states: Floats) -> dict[str, Floats]:
        """The rows of a motion, in the scene's units."""
        parts = self.by_quantity(states)
        return {name: np.ldexp(rows, self.units[name]) for name, rows in parts.items()}

    def rates(self, states: Floats) -> Floats:
        """The first derivatives of states."""
        z, parts = self._momenta(states), self.by_quantity(states)
        rate = self.scaled.constant + z @ self.scaled.linear.T + self._product(z, z) / 2
        if "attitude" not in parts:
            return rate
        columns, frames = [rate], parts["attitude"]
        columns.append((frames @ cross_matrices(z @ self.scaled.spin.T)).reshape(-1, 9))
        if "centre" in parts:
            columns.append(_turned(frames, z @ self.scaled.velocity.T))
        return np.hstack(columns)

    def two_rates(self, states: Floats) -> tuple[Floats, Floats]:
        """The first and the second derivatives of states."""
        first = self.rates(states)
        z, rate = self._momenta(states), self._momenta(first)
        second = rate @ self.scaled.linear.T + self._product(z, rate)
        parts, firsts = self.by_quantity(states), self.by_quantity(first)
        if "attitude" not in parts:
            return first, second
        columns, frames, turning = [second], parts["attitude"], firsts["attitude"]
        spin, spun = (cross_matrices(rows @ self.scaled.spin.T) for rows in (z, rate))
        columns.append((turning @ spin + frames @ spun).reshape(-1, 9))
        if "centre" in parts:
            speed, pushed = (rows @ self.scaled.velocity.T for rows in (z, rate))
            columns.append(_turned(turning, speed) + _turned(frames, pushed))
        return first, np.hstack(columns)

    def paces(self, states: Floats) -> Floats:
        """The pace at which a state and its neighbours change: the largest of three rates (times,).

        They are that of the momenta in their units, that of their neighbours, and the angular velocity.
        That of the neighbours is the fourth root of the norm of the fourth power of the Jacobian: no unit
        matters in its spectral radius, and little in this.
        """
        z, first = self._momenta(states), self._momenta(self.rates(states))
        jacobian = self.scaled.linear + np.einsum("iab,ta->tib", self.scaled.hessian, z)
        square = jacobian @ jacobian
        norms = np.linalg.norm((square @ square).reshape(len(z), -1), axis=1) ** 0.25
        changes, spins = (np.linalg.norm(rows, axis=1) for rows in (first, z @ self.scaled.spin.T))
        return np.asarray(np.max([norms, changes, spins], axis=0))

    def _momenta(self, states: Floats) -> Floats:
        return states[:, : 3 * len(self.moving)]

    def _product(self, left: Floats, right: Floats) -> Floats:
        """left.hessian right, row by row."""
        hessian = self.scaled.hessian.reshape(len(self.scaled.hessian), -1)
        both = left[:, :, None] * right[:, None, :]
        product: Floats = both.reshape(len(left), -1) @ hessian.T
        return product


@lru_cache(maxsize=16)
def float_flow(scene: Scene) -> FloatFlow:
    """The equations of a scene in float64, in powers of two in which its motion is of size one.

    Raises ValueError for loads that a scene writes down.
    """
    body = scene.body
    if body.loads is not None:
        raise ValueError(f"expected a body without written loads, got some @ {scene.name}")
    kind = kind_of(body)
    scale = kind.units(body, kind.state(scene.initial))
    unit = tuple(power_of_two(e) for e in scale.blocks for _ in range(3))
    times = power_of_two(scale.time), power_of_two(scale.centre)
    names = (*kind.moving, "attitude", "centre")
    units = dict(zip(names, (*scale.blocks, 0, scale.centre), strict=True))
    return FloatFlow(kind.moving, units, scale.time, kind.equations(body).scaled(unit, *times))


def _turned(frames: Floats, vectors: Floats) -> Floats:
    turned: Floats = np.einsum("tij,tj->ti", frames, vectors)
    return turned


def _floats(values: np.ndarray[Any, Any], exponent: int) -> Floats:
    """The values in units of 2^exponent; a double holds these, whatever the size of the units."""
    if abs(exponent) <= _MODERATE:
        counted: Floats = np.ldexp(values.astype(float), -exponent)
        return counted
    scaled = [mp.ldexp(value, -exponent) for value in values.flat]
    return np.array(scaled, dtype=object).reshape(values.shape).astype(float)
