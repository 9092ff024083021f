"""Sequences of exact times, whose rationals are formed when they are first read.

A solver answers ten thousand samples in milliseconds, and forming as many rationals takes longer: code
that reads no rational forms none. A million rationals would take more memory than all that is computed
from them.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from fractions import Fraction
from functools import cached_property
from typing import Any, Final

# A sequence of at most so many stores its rationals; a longer one forms each whenever it is read.
MOST_KEPT: Final = 8192


class Instants(Sequence[Fraction]):
    """Sequence of ``count`` rationals, the k-th is ``at(k)``; equal to any sequence of the same numbers."""

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
        # A long sequence has another hash than the equal tuple: no dictionary has both as keys.
        return hash(self._numbers if self._is_kept else (self._count, self[0], self[-1]))

    def __hash__(self) -> int:
        return self._hash

    def __repr__(self) -> str:
        return repr(tuple(self))

    def __reduce__(self) -> tuple[Any, ...]:
        # The function that forms the numbers may be a lambda, which pickle refuses: the numbers are sent.
        return tuple, (tuple(self),)


class EquallySpaced(Instants):
    """The instants first + k step for k = 0 .. count - 1."""

    def __init__(self, first: Fraction, step: Fraction, count: int) -> None:
        super().__init__(count, lambda k: first + k * step)
        self.first, self.step = first, step

    def __getitem__(self, place: Any) -> Any:
        # A single number is formed alone, unless the others are there.
        is_alone = "_numbers" not in vars(self)
        if is_alone and isinstance(place, int) and -len(self) <= place < len(self):
            return self._at(place % len(self))
        return super().__getitem__(place)

    def __reduce__(self) -> tuple[Any, ...]:
        return EquallySpaced, (self.first, self.step, len(self))


def chosen(instants: Sequence[Fraction], most: int) -> list[Fraction]:
    """Return at most ``most`` of the instants, evenly spread, the first and the last among them."""
    return [instants[k] for k in evenly(len(instants), most)]


def evenly(samples: int, most: int) -> list[int]:
    """Return at most ``most`` indices of samples, evenly spread, the first and the last among them."""
    count = min(samples, most)
    return sorted({round(k * (samples - 1) / max(count - 1, 1)) for k in range(count)})
