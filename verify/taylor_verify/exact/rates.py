"""How fast an exact motion moves: its first and second time derivatives, from its own equations.

The equations are those of exact.enclosure.system, z' = c + z.Q z/2, so that z'' = z.Q z'. No difference
of two motions is taken.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from typing import Any, Final

import numpy as np
from mpmath import mp

from taylor_verify.exact import clocks
from taylor_verify.exact.enclosure.system import posed_exactly
from taylor_verify.exact.registry import kind_of
from taylor_verify.exact.rows import cross_matrices
from taylor_verify.exact.units import Units
from taylor_verify.scenes.motion import Motion
from taylor_verify.scenes.precision import power_of_two
from taylor_verify.scenes.scene import Scene
from taylor_verify.scenes.tensors import Matrix

Floats = np.ndarray[Any, np.dtype[np.float64]]

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
    scale, moving = _units(scene), kind_of(scene.body).moving
    names = (*moving, "attitude", "centre")
    exponents = dict(zip(names, (*scale.blocks, 0, scale.centre), strict=True))
    values = {
        name: _floats(motion[name], exponents[name]) for name in names if name in motion.quantities
    }
    blocks = [values[name] for name in moving]
    manufactured = scene.body.manufactured
    if manufactured is not None:
        times = scene.clock.elapsed if elapsed is None else elapsed
        blocks.append(clocks.floats(manufactured, times))
    elif kind_of(scene.body).equations(scene.body).linear:
        blocks.append(np.ones((len(blocks[0]), 1)))
    with np.errstate(all="ignore"):  # what is not finite stays so, and is the caller's to see
        found = _flow(scene).derivatives(np.concatenate(blocks, axis=1), values.get("attitude"))
    velocity, acceleration = (_by_name(derivatives, moving) for derivatives in found)
    return Rates(
        velocity={name: velocity[name] for name in values},
        acceleration={name: acceleration[name] for name in values},
        units={name: exponents[name] for name in values},
        time=scale.time,
    )


def _by_name(derivatives: Sequence[Floats], moving: Sequence[str]) -> dict[str, Floats]:
    """The derivatives of the state apart, by block; then those of the frame, as far as it is tracked."""
    state, *frame = derivatives
    blocks = {name: state[:, 3 * k : 3 * k + 3] for k, name in enumerate(moving)}
    return blocks | dict(zip(("attitude", "centre"), frame, strict=False))


def _units(scene: Scene) -> Units:
    kind = kind_of(scene.body)
    return kind.units(scene.body, kind.state(scene.initial))


@dataclass(frozen=True)
class _Flow:
    """z' = constant + z.hessian z/2, Omega = spin z, U = velocity z: all of it in units, as float64."""

    constant: Floats
    hessian: Floats
    spin: Floats
    velocity: Floats

    def derivatives(self, z: Floats, attitude: Floats | None) -> tuple[list[Floats], list[Floats]]:
        """First and second derivatives of the state, then of the attitude and of the centre.

        ``z`` has the shape (times, n), ``attitude`` (times, 3, 3); without it there is the state alone.
        """
        rate = self.constant + np.einsum("iab,ta,tb->ti", self.hessian, z, z) / 2
        second = np.einsum("iab,ta,tb->ti", self.hessian, z, rate)
        firsts, seconds = [rate], [second]
        if attitude is None:
            return firsts, seconds
        spin, spun = cross_matrices(z @ self.spin.T), cross_matrices(rate @ self.spin.T)
        turning = attitude @ spin
        firsts.append(turning)
        seconds.append(turning @ spin + attitude @ spun)
        if len(self.velocity):
            speed, pushed = z @ self.velocity.T, rate @ self.velocity.T
            firsts.append(np.einsum("tij,tj->ti", attitude, speed))
            seconds.append(
                np.einsum("tij,tj->ti", turning, speed) + np.einsum("tij,tj->ti", attitude, pushed)
            )
        return firsts, seconds


@lru_cache(maxsize=16)
def _flow(scene: Scene) -> _Flow:
    system, scale = posed_exactly(scene), _units(scene)
    n, time = system.size, power_of_two(scale.time)
    # The clock of a manufactured motion is of size one.
    blocks = [*scale.blocks, *[0] * (len(system.blocks) - len(scale.blocks))]
    unit = [power_of_two(e) for e, span in zip(blocks, system.spans, strict=True) for _ in span]
    return _Flow(
        constant=np.array(
            [float(c * time / one) for c, one in zip(system.constant, unit, strict=True)]
        ),
        hessian=np.array(
            [
                float(c * unit[place // n] * unit[place % n] * time / one) if c else 0.0
                for row, one in zip(system.forms.hessian, unit, strict=True)
                for place, c in enumerate(row)
            ]
        ).reshape(n, n, n),
        spin=_form(system.forms.spin, unit, time),
        velocity=_form(system.forms.velocity, unit, time / power_of_two(scale.centre)),
    )


def _form(rows: Matrix, unit: Sequence[Fraction], factor: Fraction) -> Floats:
    """A linear form of the state in units."""
    entries = [[float(c * one * factor) for c, one in zip(row, unit, strict=True)] for row in rows]
    return np.array(entries).reshape(len(rows), len(unit))


def _floats(values: np.ndarray[Any, Any], exponent: int) -> Floats:
    """The values in units of 2^exponent; a double holds these, whatever the size of the units."""
    if abs(exponent) <= _MODERATE:
        counted: Floats = np.ldexp(values.astype(float), -exponent)
        return counted
    scaled = [mp.ldexp(value, -exponent) for value in values.flat]
    return np.array(scaled, dtype=object).reshape(values.shape).astype(float)
