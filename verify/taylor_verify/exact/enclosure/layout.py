"""The order of the components in the state of a body under written loads."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import accumulate
from typing import TypeVar

from taylor_verify.scenes.loads.states import Held, State

T = TypeVar("T")


@dataclass(frozen=True)
class Layout:
    """The ``size`` components of the body's own equations; then the turn e, the centre, and own states.

    Own states that are held come last.
    """

    size: int
    turns: bool
    travels: bool
    declared: tuple[State, ...] = ()

    @cached_property
    def states(self) -> tuple[State, ...]:
        """The scene's own states in the order of the components."""
        return tuple(sorted(self.declared, key=lambda state: isinstance(state, Held)))

    @cached_property
    def _lengths(self) -> list[int]:
        frame = [4] * self.turns + [3] * self.travels
        return [3] * (self.size // 3) + frame + [len(s.components) for s in self.states]

    @cached_property
    def blocks(self) -> tuple[int, ...]:
        """The ends of the vectors that the state is made of."""
        return tuple(accumulate(self._lengths))

    @property
    def whole(self) -> int:
        """The number of all components."""
        return self.blocks[-1]

    @cached_property
    def own(self) -> Mapping[str, range]:
        """The places of each own state."""
        ends = (0, *self.blocks)[len(self.blocks) - len(self.states) :]
        return {s.name: range(ends[k], ends[k + 1]) for k, s in enumerate(self.states)}

    def body(self, state: Sequence[T]) -> Sequence[T]:
        """The components of the body's own equations."""
        return state[: self.size]

    def turn(self, state: Sequence[T]) -> Sequence[T]:
        """The components of e, as far as it is in the state."""
        return state[self.size : self.size + 4 * self.turns]

    def centre(self, state: Sequence[T]) -> Sequence[T]:
        """The components of the centre, as far as it is in the state."""
        first = self.size + 4 * self.turns
        return state[first : first + 3 * self.travels]

    def components(self, state: Sequence[T]) -> dict[str, T]:
        """The components of own states by their names in texts."""
        return {
            name: state[place]
            for each in self.states
            for name, place in zip(each.components, self.own[each.name], strict=True)
        }
