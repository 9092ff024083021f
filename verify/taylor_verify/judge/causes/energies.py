"""The coefficients of the energy of a solid in a fluid, where a scene writes these: some that are others.

(U, Omega) = E (x, y), with E = [[A, B], [B^T, C]]; Clebsch's body has p, p, p' in A, and so on.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from functools import partial
from typing import Final

import numpy as np

from taylor_verify.judge.causes.changed_equations import Changes, Equations
from taylor_verify.judge.causes.fit import Family
from taylor_verify.judge.causes.many_flows import Floats

_Places = tuple[tuple[int, int], ...]
_CLEBSCH: Final[dict[str, _Places]] = {
    "clebsch.p": ((0, 0), (1, 1)),
    "clebsch.p_prime": ((2, 2),),
    "clebsch.q": ((0, 3), (1, 4)),
    "clebsch.q_prime": ((2, 5),),
    "clebsch.r": ((3, 3), (4, 4)),
    "clebsch.r_prime": ((5, 5),),
}
_BLOCKS: Final = {"linear": (0, 0), "coupling": (0, 3), "angular": (3, 3)}
_GENERAL: Final[dict[str, _Places]] = {
    f"energy.{block} {i + 1}{k + 1}": ((first + i, second + k),)
    for block, (first, second) in _BLOCKS.items()
    for i in range(3)
    for k in range(0 if block == "coupling" else i, 3)
}
_EVERY: Final = "coefficients of the energy"
_DIGITS: Final = 12
# Two energies that differ by less than this part are one.
_SAME: Final = 1e-9


def as_written(energy: Floats, mass: Floats) -> Floats | None:
    """Return E where a scene writes it: its numbers are shorter than those of the mass matrix."""
    digits = [sum(len(f"{x:.{_DIGITS}g}") for x in matrix.ravel()) for matrix in (energy, mass)]
    return energy if len(energy) == 6 and digits[0] < digits[1] else None


def families_of_energies(right: Equations) -> Iterator[Family]:
    """Yield other coefficients, as a scene calls them: one, a factor of a block, its own, and all."""
    energy = right.energy
    if energy is None:
        return
    own = _CLEBSCH if _is_clebsch(energy) else _GENERAL
    for name, places in own.items():
        i, k = places[0]
        if energy[i, k] or i == k:
            yield _others(energy, name, {name: places})
    for block, (i, k) in _BLOCKS.items():
        rows, columns = np.s_[i : i + 3], np.s_[k : k + 3]
        of_block = {
            n: p for n, p in own.items() if p[0][0] // 3 == i // 3 and p[0][1] // 3 == k // 3
        }
        name = f"factor of {' and '.join(of_block) if own is _CLEBSCH else f'energy.{block}'}"
        scaled = partial(_scaled, energy, rows, columns)
        yield Family(name, "body", np.ones(1), np.ones(1), scaled)
        yield _others(energy, _EVERY, of_block)
    yield _others(energy, _EVERY, own)
    if own is not _GENERAL:
        yield _others(energy, _EVERY, _GENERAL)


def coefficients(right: Floats, mass: Floats) -> tuple[tuple[str, ...], Floats, Floats]:
    """Return the names of the coefficients of an energy, their values, and those of a mass matrix."""
    energy = np.asarray(np.linalg.inv(mass))
    own = _CLEBSCH if _is_clebsch(right) and _is_clebsch(energy) else _GENERAL
    return tuple(own), _values(right, own), _values(energy, own)


def keys_of(energy: Floats, number: Callable[[float], str]) -> dict[str, str]:
    """Return the key of [body] that writes an energy, and its value as TOML."""
    if _is_clebsch(energy):
        each = zip(_CLEBSCH, _values(energy, _CLEBSCH), strict=True)
        parts = [f"{name.partition('.')[2]} = {number(value)}" for name, value in each]
        return {"clebsch": f"{{ {', '.join(parts)} }}"}
    blocks = {name: energy[i : i + 3, k : k + 3] for name, (i, k) in _BLOCKS.items()}
    rows = {name: [f"[{', '.join(map(number, row))}]" for row in e] for name, e in blocks.items()}
    parts = [f"{name} = [{', '.join(each)}]" for name, each in rows.items()]
    return {"energy": f"{{ {', '.join(parts)} }}"}


def _is_clebsch(energy: Floats) -> bool:
    of_body = _with(np.zeros((6, 6)), _CLEBSCH, _values(energy, _CLEBSCH))
    return bool(np.all(np.abs(energy - of_body) <= _SAME * np.max(np.abs(energy))))


def _values(energy: Floats, own: Mapping[str, _Places]) -> Floats:
    return np.array([energy[places[0]] for places in own.values()])


def _with(energy: Floats, own: Mapping[str, _Places], values: Floats) -> Floats:
    other = energy.copy()
    for places, value in zip(own.values(), values, strict=True):
        for i, k in places:
            other[i, k] = other[k, i] = value
    return other


def _others(energy: Floats, name: str, own: Mapping[str, _Places]) -> Family:
    """Return the family of other values of some coefficients."""
    size = np.sqrt(np.diag(energy))
    scale = np.array([size[i] * size[k] for (i, k), *_ in own.values()])
    return Family(
        name, "body", _values(energy, own), scale, partial(_changed, energy, own), tuple(own)
    )


def _changed(energy: Floats, own: Mapping[str, _Places], values: Floats) -> Changes:
    return {"mass": np.linalg.inv(_with(energy, own, values))}


def _scaled(energy: Floats, rows: slice, columns: slice, factor: Floats) -> Changes:
    other = energy.copy()
    other[rows, columns] *= factor[0]
    other[columns, rows] = other[rows, columns].T
    return {"mass": np.linalg.inv(other)}
