"""Search for the quantities that written loads conserve.

Each family of quantities C_1, C_2, .. is searched for combinations whose rate is the polynomial zero, in
every piece of time that the scene meets. What is found is proven; what is not found may be conserved all
the same. T + V is searched with a potential V that is linear in R and in the centre, or quadratic.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from functools import lru_cache
from operator import add
from typing import Any, Final

from taylor_verify.exact.conserved.combinations import Combinations, orthogonal
from taylor_verify.exact.conserved.derivation import (
    Derivation,
    Row,
    cross,
    mapped,
    product,
)
from taylor_verify.exact.conserved.polynomial import Polynomial, TooLong
from taylor_verify.exact.conserved.potential import Factors, Potential, potentials
from taylor_verify.exact.registry import kind_of
from taylor_verify.numbers.irrational import rational
from taylor_verify.numbers.tensors import ZERO_VECTOR, Vector
from taylor_verify.scenes.loads.loads import CENTRE, Loads, Piece
from taylor_verify.scenes.scene import Scene

ENERGY: Final = "T+V"
# More pieces of time than this are not looked at, and nothing is found.
_MOST_PIECES: Final = 1000


@dataclass(frozen=True)
class Conservation:
    """The quantities that the loads of a scene are proven to conserve.

    ``steady`` names quantities of the body alone that are conserved as they are. ``potential`` is V where
    T + V is. ``directions`` are orthogonal vectors by the name of a momentum: those along which it is
    conserved where the whole is not, in space for ``H_space``, ``x_space`` and ``y_space``, and in body
    axes for ``H_axis`` and ``y_axis``.
    """

    steady: frozenset[str] = frozenset()
    potential: Potential | None = None
    directions: Mapping[str, tuple[Vector, ...]] = field(default_factory=dict)


@lru_cache(maxsize=16)
def conservation(scene: Scene) -> Conservation:
    """Return what the written loads of a scene conserve, as far as it is found; nothing without loads."""
    loads = scene.body.loads
    if loads is None:
        return Conservation()
    pieces = list(_pieces(scene, loads))
    if len(pieces) > _MOST_PIECES:
        return Conservation()
    derivations = Derivation.each(scene, pieces)
    try:
        return _proven(derivations)
    except TooLong:
        return Conservation()


def _proven(derivations: Sequence[Derivation]) -> Conservation:
    families = _MOMENTA[derivations[0].scene.model](derivations[0])
    products: dict[Factors, Polynomial] = {}
    if not derivations[0].has_rotor:
        # The motors of wheels do work of their own.
        energy = kinetic(derivations[0])
        products = potentials(derivations[0], derivations[0].rate(energy))
        families |= {"T": [energy], ENERGY: [energy, *products.values()]}
    searched = _searched(derivations, families)
    steady = {name for name, basis in searched.items() if len(basis) == len(families[name])}
    directions = {
        name: tuple(orthogonal(basis))
        for name, basis in searched.items()
        if basis and name not in (*steady, ENERGY)
    }
    is_potential = ENERGY in searched and "T" not in steady
    potential = Potential.among(searched[ENERGY], [*products]) if is_potential else None
    return Conservation(frozenset(steady), potential, directions)


def _pieces(scene: Scene, loads: Loads) -> Iterator[Piece]:
    """Yield the pieces of time that the motion goes through, those with equal steps once."""
    last = scene.clock.elapsed[-1]
    is_later, now, met = last >= 0, Fraction(0), set[Any]()
    for _ in range(_MOST_PIECES + 1):
        piece = loads.piece(now, is_later)
        if (key := (piece.steps, piece.outputs)) not in met:
            met.add(key)
            yield piece
        end = piece.end if is_later else piece.begin
        if end is None or abs(end) >= abs(last):
            return
        now = end


def _searched(
    derivations: Sequence[Derivation], families: Mapping[str, Row]
) -> dict[str, Sequence[Vector]]:
    """Return the combinations of each family that are conserved in every piece of time."""
    combinations = {name: Combinations(len(family)) for name, family in families.items()}
    for derivation in derivations:
        for name, family in families.items():
            if combinations[name].basis:
                combinations[name].add([derivation.rate(quantity) for quantity in family])
        if not any(each.basis for each in combinations.values()):
            break
    return {name: each.basis for name, each in combinations.items()}


# The families.


def kinetic(derivation: Derivation) -> Polynomial:
    """T."""
    body, z = derivation.scene.body, derivation.state
    return product(z, mapped(kind_of(body).energy(body), z)) / 2


def _of_spin(derivation: Derivation) -> dict[str, Row]:
    body, kind = derivation.scene.body, kind_of(derivation.scene.body)
    constant = map(rational, body.parts().get("rotor", ZERO_VECTOR))
    wheels = derivation.wheels if derivation.has_rotor else constant
    H = [*map(add, mapped(kind.energy(body), derivation.state), wheels)]
    return {"H2": [product(H, H)], "H_space": derivation.turned(H), "H_axis": H}


def _of_impulses(derivation: Derivation) -> dict[str, Row]:
    x, y = derivation.state[:3], derivation.state[3:]
    in_space = derivation.turned(x)
    arm = cross(derivation.symbols(CENTRE), in_space)
    return {
        "F2": [product(x, x)],
        "FG": [product(x, y)],
        "x_space": in_space,
        "y_space": [*map(add, derivation.turned(y), arm)],
        "y_axis": y,
    }


_MOMENTA: Final = {"euler": _of_spin, "kirchhoff": _of_impulses}
