"""The initial momentum of a motion, moved one component at a time in exact rationals."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from typing import Final

from taylor_verify.exact.registry import kind_of
from taylor_verify.numbers import tensors
from taylor_verify.numbers.precision import floor_log2, power_of_two
from taylor_verify.numbers.tensors import Vector
from taylor_verify.scenes.bodies import Body
from taylor_verify.scenes.motion import State
from taylor_verify.scenes.scene import Scene

# The square of a momentum that is nothing beside another one, over the square of that.
_NOTHING: Final = Fraction(1, 2**80)


def momentum(body: Body, initial: State) -> Vector:
    """Return the initial momentum in body axes: H, or the impulses x and y as one vector of six."""
    kind = kind_of(body)
    return kind.momentum(body, kind.state(initial))


def moved(scene: Scene, j: int, share: Fraction) -> Scene:
    """Return the scene with component j of the momentum greater by this share of its unit, exactly.

    Units are powers of two near the size of each component, so that it stays a short rational.
    """
    kind, body, initial = kind_of(scene.body), scene.body, scene.initial
    amount = share * block_units(scene)[j]
    greater = tuple(entry + amount * (i == j) for i, entry in enumerate(momentum(body, initial)))
    state = kind.of_momentum(body, greater)
    return replace(scene, initial=kind.with_state(initial, state))


def block_units(scene: Scene) -> Vector:
    """Return powers of two near the size of the block of each component of a momentum.

    A block that is nothing beside what constant loads give it has that size. One that is zero takes the
    size that would hold the kinetic energy, 2T = z . energy z; 1 in a body at rest.
    """
    body, kind, span = scene.body, kind_of(scene.body), scene.clock.elapsed[-1]
    given = tuple(span * load for load in kind.momentum_equations(body).constant)
    z: Vector = ()
    for first in range(0, len(given), 3):
        start, pushed = (v[first : first + 3] for v in (momentum(body, scene.initial), given))
        is_nothing = tensors.dot(start, start) <= _NOTHING * tensors.dot(pushed, pushed)
        z += pushed if is_nothing else start
    energy = kind.momentum_energy(body)
    twice_energy = tensors.dot(z, tensors.apply(energy, z))
    units: Vector = ()
    for first in range(0, len(z), 3):
        block = z[first : first + 3]
        trace = sum((energy[i][i] for i in range(first, first + 3)), Fraction(0))
        units += (_near(tensors.dot(block, block) or twice_energy / trace or Fraction(1)),) * 3
    return units


def _near(square: Fraction) -> Fraction:
    """A power of two near the root of a positive number."""
    return power_of_two(floor_log2(square) // 2)
