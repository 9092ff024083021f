"""Renamings of axes: a file may number the axes of the body, of space, or of both in another order.

A renaming is a proper rotation P that maps axes to axes: a signed permutation of determinant +1.
It takes the file's axes to the scene's, v_scene = P v_file. A reflection is not a renaming, because no
right-handed frame has such axes: a file with one wrong sign has an error.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import permutations, product, starmap
from typing import Any, Final

import numpy as np
from mpmath import mp

from taylor_verify.numbers import rotation

Array = np.ndarray[Any, Any]

# There are many ways to name axes, so a renaming costs more than another convention.
_COST: Final = 2


@dataclass(frozen=True)
class Axes:
    """A signed permutation: component i of the scene is ``signs[i]`` times the file's ``order[i]``."""

    order: tuple[int, ...]
    signs: tuple[int, ...]

    def names(self, columns: Sequence[str]) -> str:
        """Return the file's column, with its sign, for every renamed axis."""
        return ", ".join(
            f"axis {i + 1} is {'-' if self.signs[i] < 0 else ''}{columns[self.order[i]]}"
            for i in self.moved
        )

    @property
    def moved(self) -> list[int]:
        return [i for i in range(3) if self.order[i] != i or self.signs[i] < 0]

    def effect(self, active: Collection[int]) -> tuple[tuple[int, int] | None, ...]:
        """Return the part of the permutation that is visible if only ``active`` columns are nonzero."""
        pairs = zip(self.order, self.signs, strict=True)
        return tuple((k, sign) if k in active else None for k, sign in pairs)

    def vectors(self, rows: Array) -> Array:
        """Return P v for every row v."""
        return np.asarray(rows[:, self.order] * np.array(self.signs))

    def left(self, matrices: Array) -> Array:
        """Return P R for every matrix R."""
        return np.asarray(matrices[:, self.order, :] * np.array(self.signs)[:, None])

    def right(self, matrices: Array) -> Array:
        """Return R P^T for every matrix R."""
        return np.asarray(matrices[:, :, self.order] * np.array(self.signs))

    @cached_property
    def quaternion(self) -> tuple[int, ...]:
        """Quaternion of P in integers, scalar first, not normalised."""
        (column,) = quaternion_columns(self.vectors(np.eye(3, dtype=int)).T[None])
        return tuple(column.tolist())


_SIGNED: Final = starmap(Axes, product(permutations(range(3)), product((1, -1), repeat=3)))
# The 24 rotations of a cube, simplest first: a reflection has the determinant -1.
AXES: Final = tuple(
    sorted(
        (axes for axes in _SIGNED if np.linalg.det(axes.vectors(np.eye(3))) > 0),
        key=lambda axes: (len(axes.moved), axes.signs.count(-1)),
    )
)
UNMOVED: Final = AXES[0]


@dataclass(frozen=True)
class Frames:
    """A renaming of the body's axes and of the space axes, valid for every quantity of a file."""

    body: Axes = UNMOVED
    space: Axes = UNMOVED

    @property
    def cost(self) -> int:
        return _COST * bool(self.body.moved or self.space.moved)

    def words(self, columns: Sequence[str]) -> str:
        """Return the renaming in words; ``columns`` are the names of the file's three vector columns."""
        if not self.cost:
            return ""
        axes = self.body if self.body.moved else self.space
        if columns:
            return f"{' '.join(columns)} have other axes: {axes.names(columns)}"
        names = axes.names(("the file's 1", "the file's 2", "the file's 3"))
        if self.body == self.space:
            return f"both frames have other axes: {names}"
        return f"{'the body' if self.body.moved else 'space'} has other axes: {names}"

    def attitudes(self, matrices: Array) -> Array:
        """Return the scene's attitude Q R P^T for every R of the file; Q renames the space axes."""
        return self.space.left(self.body.right(matrices))

    def quaternions(self, rows: Array) -> Array:
        """Return the quaternions of ``attitudes``, with the length that they have in the file."""
        if not self.cost:
            return rows
        backward = rotation.conjugate(self.body.quaternion)
        forward = rotation.product(self.space.quaternion, list(rows.T))
        turned = rotation.product(forward, backward)
        square = sum(e * e for e in self.space.quaternion) * sum(e * e for e in backward)
        length = mp.sqrt(square) if rows.dtype == object else np.sqrt(square)
        return np.asarray(np.array(turned).T / length)


def renamings(body: Collection[int], space: Collection[int], joined: bool) -> Iterator[Frames]:
    """Yield every renaming of one frame, or of both alike, that can be seen in a file; the identity first.

    ``body`` and ``space`` are the axes along which the file has components that are not always zero.
    Both frames are renamed together only if quantities of the file connect them (``joined``).
    """
    shown = set()
    both = [Frames(axes, axes) for axes in AXES[1:]] if joined else []
    single = [f for axes in AXES[1:] for f in (Frames(body=axes), Frames(space=axes))]
    for frames in (Frames(), *both, *single):
        effect = (frames.body.effect(body), frames.space.effect(space))
        if effect not in shown:
            shown.add(effect)
            yield frames


def quaternion_columns(matrices: Array) -> Array:
    """Return quaternions of rotation matrices (n, 3, 3), not normalised: the largest column of 4 q q^T."""
    transposed, trace = matrices.transpose(0, 2, 1), np.trace(matrices, axis1=1, axis2=2)
    odd = matrices - transposed
    squares = np.empty((len(matrices), 4, 4), matrices.dtype)
    squares[:, 0, 0] = 1 + trace
    squares[:, 0, 1:] = squares[:, 1:, 0] = odd[:, (2, 0, 1), (1, 2, 0)]
    squares[:, 1:, 1:] = matrices + transposed
    squares[:, range(1, 4), range(1, 4)] += (1 - trace)[:, None]
    largest = np.argmax(np.einsum("nii->ni", np.nan_to_num(squares)), axis=1)
    return np.asarray(squares[np.arange(len(squares)), largest])
