"""Sums and products in any arithmetic, where the integer 0 stands for a term that is not there.

heyoka has no algebraic simplification: a term that is multiplied by a zero parameter is computed
at every order of every step. So an absent coefficient enters the equations as the int 0, and these
functions leave out whatever it touches. Everything else is + and x of the caller's own numbers:
heyoka expressions, mpf, Arb balls, Fractions and NumPy arrays all pass through.
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
    """Return the sum of a_i b_i over the terms that are there."""
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
