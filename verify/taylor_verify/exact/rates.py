"""First and second time derivatives of an exact motion, from its own equations.

The equations are those of exact.quadratic_forms, z' = c + L z + z.Q z/2, so that z'' = L z' + z.Q z'. No
difference of two motions is taken.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, Final

import numpy as np
from mpmath import mp

from taylor_verify.exact.quadratic_forms import Floats, Scaled
from taylor_verify.exact.registry import kind_of
from taylor_verify.exact.row_arithmetic import cross_matrices
from taylor_verify.exact.units import Units
from taylor_verify.numbers.precision import power_of_two
from taylor_verify.scenes.motion import Motion
from taylor_verify.scenes.scene import Scene

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


def rates(scene: Scene, motion: Motion) -> Rates:
    """The derivatives of a motion of this scene, to the roundings of float64.

    Raises ValueError for loads that a scene writes down: their rates are not known here.
    """
    if scene.body.loads is not None:
        raise ValueError(f"expected a body without written loads, got some @ {scene.name}")
    scale, moving = _units(scene), kind_of(scene.body).moving
    names = (*moving, "attitude", "centre")
    exponents = dict(zip(names, (*scale.blocks, 0, scale.centre), strict=True))
    values = {
        name: _floats(motion[name], exponents[name]) for name in names if name in motion.quantities
    }
    state, flow = np.concatenate([values[name] for name in moving], axis=1), _flow(scene)
    with np.errstate(all="ignore"):  # what is not finite stays so, and is the caller's to see
        velocity, acceleration = _derivatives(flow, moving, state, values.get("attitude"))
    return Rates(
        velocity={name: velocity[name] for name in values},
        acceleration={name: acceleration[name] for name in values},
        units={name: exponents[name] for name in values},
        time=scale.time,
    )


def _units(scene: Scene) -> Units:
    kind = kind_of(scene.body)
    return kind.units(scene.body, kind.state(scene.initial))


def _derivatives(
    flow: Scaled, moving: Sequence[str], z: Floats, attitude: Floats | None
) -> tuple[dict[str, Floats], dict[str, Floats]]:
    """First and second derivatives of every quantity by name.

    ``z`` has the shape (times, n), ``attitude`` (times, 3, 3); without it there is the state alone.
    """
    rate = flow.constant + z @ flow.linear.T + np.einsum("iab,ta,tb->ti", flow.hessian, z, z) / 2
    second = rate @ flow.linear.T + np.einsum("iab,ta,tb->ti", flow.hessian, z, rate)
    firsts, seconds = (
        {name: rows[:, 3 * k : 3 * k + 3] for k, name in enumerate(moving)}
        for rows in (rate, second)
    )
    if attitude is None:
        return firsts, seconds
    spin, spun = cross_matrices(z @ flow.spin.T), cross_matrices(rate @ flow.spin.T)
    turning = attitude @ spin
    firsts["attitude"], seconds["attitude"] = turning, turning @ spin + attitude @ spun
    if len(flow.velocity):
        speed, pushed = z @ flow.velocity.T, rate @ flow.velocity.T
        firsts["centre"] = np.einsum("tij,tj->ti", attitude, speed)
        carried = np.einsum("tij,tj->ti", turning, speed)
        seconds["centre"] = carried + np.einsum("tij,tj->ti", attitude, pushed)
    return firsts, seconds


@lru_cache(maxsize=16)
def _flow(scene: Scene) -> Scaled:
    """The equations of a scene's state in its units."""
    scale, body = _units(scene), scene.body
    unit = tuple(power_of_two(e) for e in scale.blocks for _ in range(3))
    times = power_of_two(scale.time), power_of_two(scale.centre)
    return kind_of(body).equations(body).scaled(unit, *times)


def _floats(values: np.ndarray[Any, Any], exponent: int) -> Floats:
    """The values in units of 2^exponent; a double holds these, whatever the size of the units."""
    if abs(exponent) <= _MODERATE:
        counted: Floats = np.ldexp(values.astype(float), -exponent)
        return counted
    scaled = [mp.ldexp(value, -exponent) for value in values.flat]
    return np.array(scaled, dtype=object).reshape(values.shape).astype(float)
