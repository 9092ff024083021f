"""Expressions that the load texts of a changed scene are linear in, with their names in such a text.

In order: 1, the velocities nu, their products, their squares with a sign, nu times the whole speed (|U| u,
|W| w), the entries of R, the loads of the scene, and these taken for components in space axes (R^T f). nu
is omega, or U and omega.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from itertools import combinations_with_replacement
from typing import Any, Final

import numpy as np

from taylor_verify.judge.causes.many_flows import Floats

EPSILON: Final = np.array(
    [
        [[0, 0, 0], [0, 0, 1], [0, -1, 0]],
        [[0, 0, -1], [0, 0, 0], [1, 0, 0]],
        [[0, 1, 0], [-1, 0, 0], [0, 0, 0]],
    ],
    dtype=float,
)


@dataclass(frozen=True)
class Basis:
    """The expressions for ``n`` velocities: the columns of each group, and the texts of those with one."""

    n: int
    groups: dict[str, slice]
    texts: tuple[str, ...]
    pairs: tuple[tuple[int, int], ...]

    @property
    def count(self) -> int:
        return int(self.groups["turned loads"].stop)

    def factors(self, **blocks: Any) -> Floats:
        """Return the matrix (n, expressions) with these blocks and zeros elsewhere."""
        matrix = np.zeros((self.n, self.count))
        for name, block in blocks.items():
            matrix[:, self.groups[name.replace("_", " ")]] = block
        return matrix

    def products(self, forms: Floats) -> Floats:
        """Return the factors of the products in quadratic forms (..., n, n, n)."""
        j, k = np.transpose(self.pairs)
        both = forms + np.swapaxes(forms, -1, -2)
        return np.asarray(both[..., j, k] / np.where(j == k, 2.0, 1.0))


@cache
def basis(n: int) -> Basis:
    """Return the expressions for a rigid body (n = 3) or a body in a fluid (6)."""
    names = [f"{letter}{i}" for letter in ("w" if n == 3 else "uw") for i in (1, 2, 3)]
    pairs = tuple(combinations_with_replacement(range(n), 2))
    of_group = {
        "constants": [""],
        "velocities": names,
        "products": [f"{names[j]}*{names[k]}" for j, k in pairs],
        "squares": [f"abs({name})*{name}" for name in names],
        "speeds": [f"{_speed(name[0])}*{name}" for name in names],
        "frame": [f"r{i}{k}" for i in (1, 2, 3) for k in (1, 2, 3)],
    }
    groups, begin = dict[str, slice](), 0
    for name, columns in {**of_group, "loads": names, "turned loads": names}.items():
        groups[name] = slice(begin, begin + len(columns))
        begin += len(columns)
    return Basis(n, groups, tuple(text for texts in of_group.values() for text in texts), pairs)


def _speed(letter: str) -> str:
    return f"sqrt({' + '.join(f'{letter}{i}*{letter}{i}' for i in (1, 2, 3))})"


def coriolis(gyro: Floats, turn: Any = 0.0, munk: Any = 0.0) -> Floats:
    """Return the factors of the products in (x_t x W, y x W + x_m x U), y = gyro nu and so on.

    Each matrix has the shape (..., 3, n); of a rigid body only (gyro nu) x W is left.
    """
    n = gyro.shape[-1]
    forms = np.zeros((*gyro.shape[:-2], n, n, n))
    forms[..., -3:, :, -3:] = _crossed(gyro)
    if n == 6:
        zero = np.zeros_like(gyro)
        forms[..., :3, :, 3:] = _crossed(turn + zero)
        forms[..., 3:, :, :3] = _crossed(munk + zero)
    return basis(n).products(forms)


def crossed(vector: Floats) -> Floats:
    """Return the matrix of u -> vector x u, (..., 3, 3)."""
    return np.asarray(np.einsum("ijk,...j->...ik", EPSILON, vector))


def _crossed(matrix: Floats) -> Floats:
    return np.asarray(np.einsum("ijk,...jl->...ilk", EPSILON, matrix))


def coriolis_of(mass: Floats) -> Floats:
    """Return the factors of the products in the Coriolis terms of a mass matrix."""
    return coriolis(mass[..., -3:, :], mass[..., :3, :], mass[..., :3, :])
