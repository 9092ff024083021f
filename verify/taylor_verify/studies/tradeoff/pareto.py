"""Pareto front: the items that no other beats in both of two numbers."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TypeVar

Item = TypeVar("Item")


def pareto(items: Iterable[Item], costs: Callable[[Item], tuple[float, float]]) -> list[Item]:
    """Return the unbeaten items by rising first and falling second cost.

    An item is beaten by another that is no larger in both costs and smaller in one. Items of equal costs do
    not beat each other.
    """
    front: list[Item] = []
    for item in sorted(items, key=costs):
        if not front or costs(item)[1] < costs(front[-1])[1] or costs(item) == costs(front[-1]):
            front.append(item)
    return front
