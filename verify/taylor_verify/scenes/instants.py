"""Exact numbers in a row that are formed when somebody first looks at one of them.

A solver of ten thousand samples takes milliseconds, and as many rationals take longer: who needs no
rational makes none. A million of them take more memory than all that is made of them.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from fractions import Fraction
from functools import cached_property
from math import lcm
from typing import Any, Final

# So many rationals are kept once they are formed; of more each is formed anew whenever it is looked at.
MOST_KEPT: Final = 8192


class Instants(Sequence[Fraction]):
    """``count`` rationals, the k-th of them ``at(k)``; equal to any sequence of the same numbers."""

    def __init__(self, count: int, at: Callable[[int], Fraction]) -> None:
        self._count, self._at = count, at

    @cached_property
    def _numbers(self) -> tuple[Fraction, ...]:
        return tuple(map(self._at, range(self._count)))

    @property
    def _is_kept(self) -> bool:
        return self._count <= MOST_KEPT

    def __len__(self) -> int:
        return self._count

    def __getitem__(self, place: Any) -> Any:
        if self._is_kept:
            return self._numbers[place]
        places = range(self._count)[place]
        return tuple(map(self._at, places)) if isinstance(places, range) else self._at(places)

    def __iter__(self) -> Iterator[Fraction]:
        return iter(self._numbers) if self._is_kept else map(self._at, range(self._count))

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Sequence):
            return NotImplemented
        if self is other:
            return True
        return len(self) == len(other) and all(a == b for a, b in zip(self, other, strict=True))

    @cached_property
    def _hash(self) -> int:
        # Nobody holds so many in a tuple beside these.
        return hash(self._numbers if self._is_kept else (self._count, self[0], self[-1]))

    def __hash__(self) -> int:
        return self._hash

    def __repr__(self) -> str:
        return repr(tuple(self))

    def __reduce__(self) -> tuple[Any, ...]:
        # A process that is sent a scene is sent its numbers, not how they are formed.
        return tuple, (tuple(self),)


class EquallySpaced(Instants):
    """The instants first + k step for k = 0 .. count - 1."""

    def __init__(self, first: Fraction, step: Fraction, count: int) -> None:
        super().__init__(count, lambda k: first + k * step)
        self.first, self.step = first, step

    def __getitem__(self, place: Any) -> Any:
        # One is wanted sooner than all.
        if isinstance(place, int) and -len(self) <= place < len(self):
            return self._at(place % len(self))
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
