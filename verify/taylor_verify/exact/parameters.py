"""The numbers of a body that its motion depends on, one at a time, in exact rationals."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any, Final

from taylor_verify.scenes.tensors import Matrix, Vector

_SYMMETRIC: Final = ((0, 0), (1, 1), (2, 2), (1, 2), (0, 2), (0, 1))
_ALL: Final = tuple((i, j) for i in range(3) for j in range(3))


@dataclass(frozen=True)
class Parameters:
    """The components by name, and the square of a size of each.

    ``changed(j, amount)`` is the body with component j greater by that amount, exactly.
    """

    name: str
    components: tuple[str, ...]
    squares: Vector
    changed: Callable[[int, Fraction], Any]


@dataclass(frozen=True)
class Block:
    """A 3x3 matrix of a body: the letter of its entries and the attribute that holds it.

    An entry's square is of the size of the product of two diagonal entries, of its row in ``sides[0]`` and
    of its column in ``sides[1]``.
    """

    letter: str
    attribute: str
    sides: tuple[Matrix, Matrix]
    is_symmetric: bool = True


def entries(name: str, body: Any, blocks: Sequence[Block]) -> Parameters:
    """The entries of these matrices; an entry of a symmetric one changes with the one opposite."""
    places = [
        (block, place) for block in blocks for place in (_SYMMETRIC if block.is_symmetric else _ALL)
    ]

    def changed(j: int, amount: Fraction) -> Any:
        block, (i, k) = places[j]
        matrix = _with_entry(getattr(body, block.attribute), i, k, amount)
        if block.is_symmetric and i != k:
            matrix = _with_entry(matrix, k, i, amount)
        return replace(body, **{block.attribute: matrix})

    return Parameters(
        name,
        tuple(f"{block.letter}{i + 1}{k + 1}" for block, (i, k) in places),
        tuple(block.sides[0][i][i] * block.sides[1][k][k] for block, (i, k) in places),
        changed,
    )


def raised(vector: Vector, j: int, amount: Fraction) -> Vector:
    """The vector with component j greater by this amount."""
    return tuple(entry + amount * (i == j) for i, entry in enumerate(vector))


def _with_entry(matrix: Matrix, i: int, k: int, amount: Fraction) -> Matrix:
    return (*matrix[:i], raised(matrix[i], k, amount), *matrix[i + 1 :])
