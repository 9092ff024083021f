"""The Pareto front: the items that no other beats in both of two numbers."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TypeVar

Item = TypeVar("Item")


def pareto(items: Iterable[Item], costs: Callable[[Item], tuple[float, float]]) -> list[Item]:
    """Return the items that none beats, by their first cost; the second falls from each to the next.

    An item is beaten by one that is no larger in both costs and smaller in one. So items of equal costs
    stand or fall together.
    """
    front: list[Item] = []
    for item in sorted(items, key=costs):
        if not front or costs(item)[1] < costs(front[-1])[1] or costs(item) == costs(front[-1]):
            front.append(item)
    return front
