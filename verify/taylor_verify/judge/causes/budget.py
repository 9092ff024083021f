"""The work that a search may do. It is counted, not timed, so that an answer has one verdict everywhere."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass


class Spent(Exception):
    """The search has used up its budget; nothing is said then."""


@dataclass
class Budget:
    """``left`` is the work that may still be done: about one for each microsecond of a processor."""

    left: float = 300_000.0

    def at_least(self, work: float) -> None:
        """Let so much work be done from here on, whatever is left."""
        self.left = max(self.left, work)

    @contextmanager
    def at_most(self, work: float) -> Iterator[None]:
        """Do something with at most so much of what is left. It raises Spent beyond that."""
        rest, self.left = max(self.left - work, 0.0), min(self.left, work)
        try:
            yield
        finally:
            self.left = max(self.left, 0.0) + rest

    @contextmanager
    def share(self, part: float) -> Iterator[None]:
        """Do something with at most a part of what is left; at the end of that it is left as it stands."""
        with suppress(Spent), self.at_most(part * self.left):
            yield

    def spend(self, work: float) -> None:
        """Take some work from the budget. Raises Spent at its end."""
        self.left -= work
        if self.left < 0:
            raise Spent
