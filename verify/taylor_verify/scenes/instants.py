"""Exact numbers in a row that are formed when somebody first looks at one of them.

A solver of ten thousand samples takes milliseconds, and as many rationals take longer: who needs no
rational makes none.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from fractions import Fraction
from functools import cached_property
from math import lcm
from typing import Any


class Instants(Sequence[Fraction]):
    """``count`` rationals; equal to any sequence of the same numbers, and as immutable as a tuple."""

    def __init__(self, count: int, formed: Callable[[], Iterable[Fraction]]) -> None:
        self._count, self._formed = count, formed

    @cached_property
    def numbers(self) -> tuple[Fraction, ...]:
        found = tuple(self._formed())
        assert len(found) == self._count
        return found

    def __len__(self) -> int:
        return self._count

    def __getitem__(self, place: Any) -> Any:
        return self.numbers[place]

    def __iter__(self) -> Iterator[Fraction]:
        return iter(self.numbers)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Sequence):
            return NotImplemented
        return self is other or (len(self) == len(other) and self.numbers == tuple(other))

    def __hash__(self) -> int:
        return hash(self.numbers)

    def __repr__(self) -> str:
        return repr(self.numbers)

    def __reduce__(self) -> tuple[Any, ...]:
        # A process that is sent a scene is sent its numbers, not how they are formed.
        return tuple, (self.numbers,)


class EquallySpaced(Instants):
    """The instants first + k step for k = 0 .. count - 1."""

    def __init__(self, first: Fraction, step: Fraction, count: int) -> None:
        super().__init__(count, lambda: (first + k * step for k in range(count)))
        self.first, self.step = first, step

    def __getitem__(self, place: Any) -> Any:
        if isinstance(place, int) and -len(self) <= place < len(self):
            return self.first + place % len(self) * self.step
        return super().__getitem__(place)

    def over_common_denominator(self, origin: Fraction) -> tuple[int, int, int]:
        """Return integers a, b, d, with which instant k less the origin is (a + k b)/d exactly."""
        offset = self.first - origin
        d = lcm(offset.denominator, self.step.denominator)
        return int(offset * d), int(self.step * d), d

    def __reduce__(self) -> tuple[Any, ...]:
        return EquallySpaced, (self.first, self.step, len(self))


def chosen(instants: Sequence[Fraction], most: int) -> list[Fraction]:
    """Return at most so many of the instants, evenly, first and last among them."""
    return [instants[k] for k in evenly(len(instants), most)]


def evenly(samples: int, most: int) -> list[int]:
    """Return at most so many indices, evenly, first and last among them."""
    count = min(samples, most)
    return sorted({round(k * (samples - 1) / max(count - 1, 1)) for k in range(count)})
