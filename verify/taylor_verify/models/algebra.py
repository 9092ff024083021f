"""Sums and products in any arithmetic; the integer 0 means an absent term.

heyoka has no algebraic simplification: it computes a term with a zero parameter at every order of every
step. So an absent coefficient is the int 0, and these functions leave out every product with it. All other
operations are + and x of the caller's numbers: heyoka expressions, mpf, Arb balls, Fractions and NumPy
arrays all work.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

ABSENT = 0
Terms = Sequence[Any]


def is_absent(term: Any) -> bool:
    return type(term) is int and term == ABSENT


def plus(a: Any, b: Any) -> Any:
    if is_absent(a):
        return b
    return a if is_absent(b) else a + b


def minus(a: Any, b: Any) -> Any:
    if is_absent(b):
        return a
    return -b if is_absent(a) else a - b


def times(a: Any, b: Any) -> Any:
    return ABSENT if is_absent(a) or is_absent(b) else a * b


def dot(a: Terms, b: Terms) -> Any:
    """Return the sum of a_i b_i over the terms that are not absent."""
    result: Any = ABSENT
    for p, q in zip(a, b, strict=True):
        result = plus(result, times(p, q))
    return result


def add(a: Terms, b: Terms) -> list[Any]:
    return [plus(p, q) for p, q in zip(a, b, strict=True)]


def apply(matrix: Sequence[Terms], vector: Terms) -> list[Any]:
    return [dot(row, vector) for row in matrix]


def transpose(matrix: Sequence[Terms]) -> list[tuple[Any, ...]]:
    return list(zip(*matrix, strict=True))


def cross(a: Terms, b: Terms) -> list[Any]:
    return [
        minus(times(a[1], b[2]), times(a[2], b[1])),
        minus(times(a[2], b[0]), times(a[0], b[2])),
        minus(times(a[0], b[1]), times(a[1], b[0])),
    ]
