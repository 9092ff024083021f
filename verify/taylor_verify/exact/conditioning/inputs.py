"""What a motion depends on, one component at a time: the initial state and the body, in exact rationals.

A component is moved by some part of its unit, a power of two near its size, so that what is moved stays
a short rational.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Final

from taylor_verify.records.quantities import IMPULSES
from taylor_verify.scenes import tensors
from taylor_verify.scenes.bodies import Clebsch, ImmersedBody, RigidBody
from taylor_verify.scenes.motion import Impulse, Spin
from taylor_verify.scenes.precision import floor_log2, power_of_two
from taylor_verify.scenes.scene import Scene
from taylor_verify.scenes.tensors import Matrix, Vector

Place = tuple[int, int]

_SYMMETRIC: Final = ((0, 0), (1, 1), (2, 2), (1, 2), (0, 2), (0, 1))
_ALL: Final = tuple((i, j) for i in range(3) for j in range(3))


@dataclass(frozen=True)
class Input:
    """Something the motion depends on: its components by name and one power of two near the size of each.

    ``moved(j, amount)`` is the scene with component j greater by that amount, exactly.
    """

    name: str
    components: tuple[str, ...]
    units: Vector
    moved: Callable[[int, Fraction], Scene]


# The start.


def momentum(scene: Scene) -> Input:
    """The initial momentum in body axes: H, or the impulses x and y as one vector of six."""
    body, initial = scene.body, scene.initial
    if isinstance(body, RigidBody) and isinstance(initial, Spin):
        return _spin_momentum(scene, body, initial)
    if isinstance(body, ImmersedBody) and isinstance(initial, Impulse):
        return _impulses(scene, body, initial)
    raise TypeError(
        f"expected a rigid body with a spin, or a solid in a fluid with impulses, got "
        f"{type(body).__name__} with {type(initial).__name__} @ {scene.name}"
    )


def start_inputs(scene: Scene) -> list[Input]:
    """The initial omega, or the two impulses."""
    if isinstance(scene.initial, Spin):
        return [_omega(scene, scene.initial)]
    z = momentum(scene)
    return [
        Input("linear_impulse", z.components[:3], z.units[:3], z.moved),
        Input(
            "angular_impulse",
            z.components[3:],
            z.units[3:],
            lambda j, amount: z.moved(j + 3, amount),
        ),
    ]


def _spin_momentum(scene: Scene, body: RigidBody, spin: Spin) -> Input:
    K = body.inverse_inertia
    H = tensors.apply(body.inertia, spin.omega)

    def moved(j: int, amount: Fraction) -> Scene:
        omega = tensors.apply(K, _raised(H, j, amount))
        return replace(scene, initial=replace(spin, omega=omega))

    return Input("momentum", ("H1", "H2", "H3"), _block_units(H, [K], K), moved)


def _impulses(scene: Scene, body: ImmersedBody, start: Impulse) -> Input:
    z = start.linear + start.angular

    def moved(j: int, amount: Fraction) -> Scene:
        there = _raised(z, j, amount)
        return replace(scene, initial=replace(start, linear=there[:3], angular=there[3:]))

    units = _block_units(z, [body.linear, body.angular], body.energy_matrix)
    return Input("momentum", IMPULSES, units, moved)


def _omega(scene: Scene, spin: Spin) -> Input:
    def moved(j: int, amount: Fraction) -> Scene:
        return replace(scene, initial=replace(spin, omega=_raised(spin.omega, j, amount)))

    unit = _near(tensors.dot(spin.omega, spin.omega) or Fraction(1))
    return Input("omega", ("omega1", "omega2", "omega3"), (unit,) * 3, moved)


# The body.


def body_input(scene: Scene) -> Input:
    """The inertia, Clebsch's six coefficients, or all 21 of T."""
    body = scene.body
    if isinstance(body, RigidBody):
        return _inertia(scene, body)
    return _energy(scene, body) if body.clebsch is None else _clebsch(scene, body, body.clebsch)


def _inertia(scene: Scene, body: RigidBody) -> Input:
    tensor = body.inertia

    def moved(j: int, amount: Fraction) -> Scene:
        heavier = _with_both_entries(tensor, _SYMMETRIC[j], amount)
        return replace(scene, body=replace(body, inertia=heavier))

    units = tuple(_near(tensor[i][i] * tensor[k][k]) for i, k in _SYMMETRIC)
    return Input("inertia", _entry_names("I", _SYMMETRIC), units, moved)


def _clebsch(scene: Scene, body: ImmersedBody, six: Clebsch) -> Input:
    components = ("p", "p_prime", "q", "q_prime", "r", "r_prime")

    def moved(j: int, amount: Fraction) -> Scene:
        changed = replace(six, **{components[j]: getattr(six, components[j]) + amount})
        return replace(scene, body=changed.body(body.force, body.couple))

    p, p_prime, r, r_prime = six.p, six.p_prime, six.r, six.r_prime
    # q may be zero; T > 0 keeps q^2 below p r.
    squares = (p * p, p_prime * p_prime, p * r, p_prime * r_prime, r * r, r_prime * r_prime)
    return Input("clebsch", components, tuple(map(_near, squares)), moved)


def _energy(scene: Scene, body: ImmersedBody) -> Input:
    A, C = body.linear, body.angular
    places = [("linear", place) for place in _SYMMETRIC]
    places += [("coupling", place) for place in _ALL]
    places += [("angular", place) for place in _SYMMETRIC]

    def moved(j: int, amount: Fraction) -> Scene:
        block, place = places[j]
        change = _with_entry if block == "coupling" else _with_both_entries
        blocks = {"linear": A, "coupling": body.coupling, "angular": C}
        blocks[block] = change(blocks[block], place, amount)
        a, b, c = blocks.values()
        return replace(scene, body=ImmersedBody(a, b, c, force=body.force, couple=body.couple))

    names = _entry_names("A", _SYMMETRIC) + _entry_names("B", _ALL) + _entry_names("C", _SYMMETRIC)
    # As with q, T > 0 keeps the square of an entry below the product of the two on the diagonal.
    sides = {"linear": (A, A), "coupling": (A, C), "angular": (C, C)}
    units = tuple(_near(sides[b][0][i][i] * sides[b][1][k][k]) for b, (i, k) in places)
    return Input("energy", names, units, moved)


# Names, entries and sizes.


def _entry_names(symbol: str, places: Sequence[Place]) -> tuple[str, ...]:
    return tuple(f"{symbol}{i + 1}{k + 1}" for i, k in places)


def _with_entry(matrix: Matrix, place: Place, amount: Fraction) -> Matrix:
    """The matrix with this entry greater by this amount."""
    i, k = place
    return (*matrix[:i], _raised(matrix[i], k, amount), *matrix[i + 1 :])


def _with_both_entries(matrix: Matrix, place: Place, amount: Fraction) -> Matrix:
    """A symmetric matrix with this entry, and the one opposite, greater by this amount."""
    once = _with_entry(matrix, place, amount)
    return once if place[0] == place[1] else _with_entry(once, place[::-1], amount)


def _raised(vector: Vector, j: int, amount: Fraction) -> Vector:
    return tuple(entry + amount * (i == j) for i, entry in enumerate(vector))


def _block_units(momentum: Vector, blocks: Sequence[Matrix], stiffness: Matrix) -> Vector:
    """For each component of the momentum a power of two near the size of its block.

    A block that is zero takes the size that would hold the kinetic energy; 1 in a body at rest.
    """
    twice_energy = tensors.dot(momentum, tensors.apply(stiffness, momentum))
    units: Vector = ()
    for index, matrix in enumerate(blocks):
        block = momentum[3 * index : 3 * index + 3]
        trace = sum((matrix[i][i] for i in range(3)), Fraction(0))
        units += (_near(tensors.dot(block, block) or twice_energy / trace or Fraction(1)),) * 3
    return units


def _near(square: Fraction) -> Fraction:
    """A power of two near the root of a positive number."""
    return power_of_two(floor_log2(square) // 2)
