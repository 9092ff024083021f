"""Inputs of a motion, one component at a time: the initial state and the body, in exact rationals.

A component is moved by some part of its unit, a power of two near its size, so that what is moved stays
a short rational.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import partial

from taylor_verify.exact.parameters import raised
from taylor_verify.exact.registry import kind_of
from taylor_verify.scenes import tensors
from taylor_verify.scenes.precision import floor_log2, power_of_two
from taylor_verify.scenes.scene import Scene
from taylor_verify.scenes.tensors import Matrix, Vector


@dataclass(frozen=True)
class Input:
    """Something the motion depends on: its components by name and one power of two near the size of each.

    ``moved(j, amount)`` is the scene with component j greater by that amount, exactly.
    """

    name: str
    components: tuple[str, ...]
    units: Vector
    moved: Callable[[int, Fraction], Scene]


def momentum(scene: Scene) -> Input:
    """The initial momentum in body axes: H, or the impulses x and y as one vector of six."""
    kind, body = kind_of(scene.body), scene.body
    z = kind.momentum(body, kind.state(scene.initial))

    def moved(j: int, amount: Fraction) -> Scene:
        state = kind.of_momentum(body, raised(z, j, amount))
        return replace(scene, initial=kind.with_state(scene.initial, state))

    names = tuple(f"{block}{i}" for block in kind.momenta for i in (1, 2, 3))
    return Input("momentum", names, _block_units(z, kind.momentum_energy(body)), moved)


def start_inputs(scene: Scene) -> list[Input]:
    """The initial omega, or the two impulses."""
    kind = kind_of(scene.body)
    z = kind.state(scene.initial)
    units = _block_units(z, kind.energy(scene.body))

    def moved(first: int, j: int, amount: Fraction) -> Scene:
        initial = kind.with_state(scene.initial, raised(z, first + j, amount))
        return replace(scene, initial=initial)

    return [
        Input(name, components, units[3 * k : 3 * k + 3], partial(moved, 3 * k))
        for k, (name, components) in enumerate(kind.components.items())
    ]


def body_input(scene: Scene) -> Input:
    """The inertia, Clebsch's six coefficients, or all 21 of T."""
    parameters = kind_of(scene.body).parameters(scene.body)
    return Input(
        parameters.name,
        parameters.components,
        tuple(map(_near, parameters.squares)),
        lambda j, amount: replace(scene, body=parameters.changed(j, amount)),
    )


def damping_input(scene: Scene) -> Input:
    """The rate of damping c, zero in a body that has none; in units of the fastest rate of the motion."""
    kind, body = kind_of(scene.body), scene.body
    unit = power_of_two(-kind.units(body, kind.state(scene.initial)).time)

    def moved(j: int, amount: Fraction) -> Scene:
        del j
        return replace(scene, body=body.with_damping(body.damping + amount))

    return Input("damping", ("c",), (unit,), moved)


def _block_units(z: Vector, energy: Matrix) -> Vector:
    """Units of a state, or a momentum: for each component a power of two near the size of its block.

    A block that is zero takes the size that would hold the kinetic energy, 2T = z . energy z; 1 in a body
    at rest.
    """
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
