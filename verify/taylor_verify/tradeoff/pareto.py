"""Pareto front: the items that no other beats in both of two numbers."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TypeVar

Item = TypeVar("Item")


def pareto(items: Iterable[Item], costs: Callable[[Item], tuple[float, float]]) -> list[Item]:
    """Return the unbeaten items, by rising first and falling second cost.

    An item beats another if neither of its costs is larger and one is smaller. Items of equal costs do not
    beat each other.
    """
    front: list[Item] = []
    for item in sorted(items, key=costs):
        if not front or costs(item)[1] < costs(front[-1])[1] or costs(item) == costs(front[-1]):
            front.append(item)
    return front
