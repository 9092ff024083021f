"""Units for a motion that the loads of its scene speed up."""

from __future__ import annotations

from collections.abc import Iterable
from contextlib import suppress
from dataclasses import replace
from fractions import Fraction
from typing import Any, Final

import numpy as np

from taylor_verify.models import own
from taylor_verify.models.acting import Acting
from taylor_verify.models.evaluated import wheels
from taylor_verify.models.units import Units, binary, largest, least_rate, root, size
from taylor_verify.numbers import tensors
from taylor_verify.numbers.tensors import ZERO_VECTOR
from taylor_verify.scenes.loads.loads import Loads
from taylor_verify.scenes.scene import Scene

# The loads are looked at in these parts of the time, at the state of the start.
_LOOKS: Final = (Fraction(0), Fraction(1, 3), Fraction(2, 3))


def driven(units: Units, scene: Scene, span: Fraction) -> Units:
    """Return the units of a scene for the momenta that its loads give; ``units`` are without loads.

    Within the span a moment M drives a body whose inverse inertia is K to M times the span, or as
    far as it turns by a radian: (M/K)^(1/2). Both are estimates, as units need them.
    """
    loads = scene.body.loads
    assert loads is not None
    acting, initial, clock = Acting(scene, loads), scene.initial, scene.clock
    place = (*initial.attitude, *initial.parts().get("centre", ZERO_VECTOR))
    state = [float(value) for value in (*initial.moving, *place, *own.starts(loads))]
    held = [float(value) for value in own.held_starts(loads)]
    end = -span if clock.elapsed[-1] < 0 else span
    times = [float(clock.start + p * end) for p in _LOOKS]
    with np.errstate(all="ignore"):
        sizes = _largest(acting.loads(t, state, held) for t in times)
        rates = _largest(acting.rates(t, state, held) for t in times)
    if sizes is not None and sizes.any():
        units = _pushed(units, scene, span, sizes)
    if loads.rotor:
        units = _wheeled(units, scene, loads)
    given = [0.0] * len(loads.continuous) if rates is None else rates.tolist()
    return replace(units, own=own.units_of(loads, given, units.time))


def _largest(values: Iterable[Any]) -> Any:
    """Return the largest size of each component; None where one has no value."""
    with suppress(ArithmeticError, ValueError):
        sizes = np.abs([*values]).max(axis=0)
        return sizes if np.isfinite(sizes).all() else None
    return None


def _wheeled(units: Units, scene: Scene, loads: Loads) -> Units:
    """Return the units with the momentum of wheels in that of the body."""
    h = wheels(loads, Fraction(0), own.starts(loads), 53)
    if not any(h):
        return units
    rate = size(tensors.apply(tensors.inverse(scene.body.energy_matrix), h))
    momentum = max(units.momentum, size(h))
    return replace(units, momentum=momentum, time=min(units.time, 1 / binary(rate)))


def _pushed(units: Units, scene: Scene, span: Fraction, sizes: Any) -> Units:
    matrix = scene.body.energy_matrix
    is_rigid, moves = len(matrix) == 3, any(scene.initial.moving)
    block = [row[-3:] for row in matrix[-3:]]
    angular = 1 / min(block[i][i] for i in range(3)) if is_rigid else largest(block)
    force, moment = (Fraction(float(part.max())) for part in (sizes[:3], sizes[-3:]))
    square = min(span**2, 1 / (angular * moment)) if moment else span**2
    momentum, impulse = root(moment**2 * square), root(force**2 * square)
    if moves:
        momentum, impulse = max(momentum, units.momentum), max(impulse, units.impulse)
    momentum, impulse = momentum or impulse, impulse or momentum
    fastest = max(angular * momentum, least_rate(moment, momentum))
    if is_rigid:
        unit = 1 / binary(fastest)
        return replace(units, time=min(units.time, unit) if moves else unit, momentum=momentum)
    linear = largest([row[:3] for row in matrix[:3]])
    coupling = largest([row[3:] for row in matrix[:3]])
    fastest = max(fastest, linear * impulse**2 / momentum, coupling * impulse)
    fastest = max(fastest, least_rate(force, impulse))
    speed = linear * impulse + coupling * momentum
    path = max(binary(speed * span * impulse / momentum), Fraction(1))
    return Units(time=1 / binary(fastest), momentum=momentum, impulse=impulse, path=path)
