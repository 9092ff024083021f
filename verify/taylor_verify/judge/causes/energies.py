"""The coefficients of the energy of a solid in a fluid, where a scene writes these: one that is another.

(U, Omega) = E (x, y), with E = [[A, B], [B^T, C]]; Clebsch's body has p, p, p' in A, and so on.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from typing import Final

import numpy as np

from taylor_verify.judge.causes.changed_equations import Changes, Equations
from taylor_verify.judge.causes.fit import Family
from taylor_verify.judge.causes.many_flows import Floats

_Places = tuple[tuple[int, int], ...]
_CLEBSCH: Final[dict[str, _Places]] = {
    "p": ((0, 0), (1, 1)),
    "p_prime": ((2, 2),),
    "q": ((0, 3), (1, 4)),
    "q_prime": ((2, 5),),
    "r": ((3, 3), (4, 4)),
    "r_prime": ((5, 5),),
}
_DIGITS: Final = 12
_BLOCKS: Final = {"linear": (0, 0), "coupling": (0, 3), "angular": (3, 3)}


def as_written(energy: Floats, mass: Floats) -> Floats | None:
    """Return E where a scene writes it: its numbers are shorter than those of the mass matrix."""
    digits = [sum(len(f"{x:.{_DIGITS}g}") for x in matrix.ravel()) for matrix in (energy, mass)]
    return energy if len(energy) == 6 and digits[0] < digits[1] else None


def families_of_energies(right: Equations) -> Iterator[Family]:
    """Yield each coefficient as another number, as a scene calls it."""
    energy = right.energy
    if energy is None:
        return
    for name, places in _coefficients(energy).items():
        i, k = places[0]
        value, scale = np.array([energy[i, k]]), np.array([np.sqrt(energy[i, i] * energy[k, k])])
        yield Family(name, "body", value, scale, partial(_changes, energy, places), (name,))


def keys_of(energy: Floats, number: Callable[[float], str]) -> dict[str, str]:
    """Return the key of [body] that writes an energy, and its value as TOML."""
    if _is_clebsch(energy):
        parts = [f"{name} = {number(energy[places[0]])}" for name, places in _CLEBSCH.items()]
        return {"clebsch": f"{{ {', '.join(parts)} }}"}
    blocks = {name: energy[i : i + 3, k : k + 3] for name, (i, k) in _BLOCKS.items()}
    rows = {name: [f"[{', '.join(map(number, row))}]" for row in e] for name, e in blocks.items()}
    parts = [f"{name} = [{', '.join(each)}]" for name, each in rows.items()]
    return {"energy": f"{{ {', '.join(parts)} }}"}


def _coefficients(energy: Floats) -> dict[str, _Places]:
    if _is_clebsch(energy):
        return {f"clebsch.{name}": places for name, places in _CLEBSCH.items()}
    return {
        f"energy.{name} {i + 1}{k + 1}": ((first + i, second + k),)
        for name, (first, second) in _BLOCKS.items()
        for i in range(3)
        for k in range(0 if name == "coupling" else i, 3)
        if energy[first + i, second + k] or (i == k and name != "coupling")
    }


def _is_clebsch(energy: Floats) -> bool:
    places = [place for own in _CLEBSCH.values() for place in own]
    are_alike = all(np.ptp([energy[i, k] for i, k in own]) == 0 for own in _CLEBSCH.values())
    return are_alike and not np.any(_with(energy, tuple(places), 0.0))


def _with(energy: Floats, places: _Places, value: float) -> Floats:
    other = energy.copy()
    for i, k in places:
        other[i, k] = other[k, i] = value
    return other


def _changes(energy: Floats, places: _Places, values: Floats) -> Changes:
    return {"mass": np.linalg.inv(_with(energy, places, float(values[0])))}
