"""Vectors whose components are texts of loads: their sums, products, and turns by the rotation matrix."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Final

from taylor_verify.judge.causes.texts import decimal, rational
from taylor_verify.scenes.loads.vocabulary import Entry

# The entries of R, which turns from body to space axes, and of R^T, by row and column.
BY_R: Final = "r{0}{1}"
BY_TRANSPOSED: Final = "r{1}{0}"


def plus(one: Entry, other: str) -> str:
    """Return the sum of two texts."""
    if other == "0":
        return str(one)
    return f"({one}) + {other}" if str(one) != "0" else other


def sum_of(products: Iterable[tuple[str, str]]) -> str:
    """Return the sum of products, of which those with a zero are left out."""
    return " + ".join(f"{a}*({b})" for a, b in products if b != "0" and a != "(0)") or "0"


def turned(vector: Iterable[str], entry: str) -> list[str]:
    """Return a vector turned by the matrix of these entries."""
    parts = [*vector]
    return [
        sum_of((entry.format(i, k), part) for k, part in enumerate(parts, 1)) for i in (1, 2, 3)
    ]


def cross(a: Sequence[str], b: Sequence[str]) -> list[str]:
    """Return the product a x b."""
    return [
        sum_of([(f"({a[j]})", b[k]), (f"({_negative(a[k])})", b[j])])
        for j, k in ((1, 2), (2, 0), (0, 1))
    ]


def _negative(text: str) -> str:
    number = rational(text)
    return sum_of([("-1", text)]) if number is None else decimal(-number)
