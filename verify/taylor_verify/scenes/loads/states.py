"""States of a scene's own: numbers or vectors with a rate, or with a value held between instants."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any, Final, NamedTuple, Self, cast

from taylor_verify.numbers.precision import Rung
from taylor_verify.numbers.tensors import Vector
from taylor_verify.scenes.loads.vocabulary import Entries

MOST_INSTANTS: Final = 10_000


class State:
    """The base class: a vector h of three has the components h1, h2, h3, and a number h has h alone."""

    name: str
    start: Vector | None
    is_vector: bool

    @property
    def entries(self) -> Entries:
        """The rate or the value of each component."""
        raise NotImplementedError

    @property
    def components(self) -> tuple[str, ...]:
        """The names of the components, as texts and files have them."""
        numbers = range(1, len(self.entries) + 1)
        return tuple(f"{self.name}{i}" for i in numbers) if self.is_vector else (self.name,)

    def on_rung(self, rung: Rung) -> Self:
        """The state with its start rounded once; instants are rounded where they are formed."""
        return self if self.start is None else self.starting(tuple(map(rung.round, self.start)))

    def starting(self, start: Vector) -> Self:
        """State with another start."""
        changed: Self = replace(cast("Any", self), start=start)
        return changed


@dataclass(frozen=True)
class Continuous(State):
    """A state whose components have the rates ``rate``, and ``start`` at the start of the scene."""

    name: str
    start: Vector
    rate: Entries
    is_vector: bool

    @property
    def entries(self) -> Entries:
        return self.rate


@dataclass(frozen=True)
class Held(State):
    """A state whose ``value`` is taken at the elapsed times offset + k every, and held in between.

    Values that are taken at one instant all read what was before it. ``start`` is what the state is
    before its first instant; None where nothing reads that.
    """

    name: str
    start: Vector | None
    value: Entries
    every: Fraction
    offset: Fraction
    is_vector: bool

    @property
    def entries(self) -> Entries:
        return self.value

    @property
    def first(self) -> Vector:
        """The components before the first instant; 0 where nothing reads that."""
        return self.start or (Fraction(0),) * len(self.components)

    def count(self, until: Fraction) -> int:
        """The number of instants up to an elapsed time, both ends included."""
        return max(int((until - self.offset) // self.every) + 1, 0)

    def instants(self, until: Fraction, rung: Rung | None) -> Iterator[tuple[Fraction, Fraction]]:
        """Yield the elapsed times at which the value is taken, exactly and on a rung, with both ends."""
        # The next one may round to the end, which is rounded too.
        for k in range(self.count(until) + 1):
            exactly = self.offset + k * self.every
            rounded = exactly if rung is None else rung.round(exactly)
            if rounded <= until:
                yield exactly, rounded


class Instant(NamedTuple):
    """An elapsed time at which values are taken: ``names`` are those of states, in the scene's order.

    ``places`` are those of their components among the components of all held states.
    """

    time: Fraction
    names: tuple[str, ...]
    places: tuple[int, ...]


def instants(
    states: Sequence[Held], until: Fraction, rung: Rung | None = None
) -> tuple[Instant, ...]:
    """The instants up to an elapsed time, sorted, both ends included.

    On a rung each is formed exactly and rounded once, as sample times are. Raises ValueError for too many
    of them, and where two that differ round to one number.
    """
    exactly: set[Fraction] = set()
    rounded: dict[Fraction, list[int]] = {}
    for k, state in enumerate(states):
        _check_count(state.count(until))
        for time, on_rung in state.instants(until, rung):
            exactly.add(time)
            rounded.setdefault(on_rung, []).append(k)
    _check_count(len(exactly))
    if rung is not None and len(rounded) < len(exactly):
        raise ValueError(f"expected instants that differ, got two that {rung.name} makes one")
    return tuple(_instant(states, time, rounded[time]) for time in sorted(rounded))


def _check_count(count: int) -> None:
    if count > MOST_INSTANTS:
        raise ValueError(f"expected at most {MOST_INSTANTS} instants of held states, got {count}")


def _instant(states: Sequence[Held], time: Fraction, which: Sequence[int]) -> Instant:
    ends = [0]
    for state in states:
        ends.append(ends[-1] + len(state.value))
    places = tuple(place for k in which for place in range(ends[k], ends[k + 1]))
    return Instant(time, tuple(states[k].name for k in which), places)
