"""The work that a search may do. It is counted, not timed, so that an answer has one verdict everywhere."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field


class Spent(Exception):
    """The search has used up its budget; nothing is said then."""


@dataclass
class Budget:
    """``left`` is the work that may still be done: about one for each microsecond of a processor."""

    left: float = field(default=300_000.0)

    @contextmanager
    def of_its_own(self, work: float) -> Iterator[None]:
        """Do something with at most so much work, which is not taken from what is left for others."""
        left, self.left = self.left, min(self.left, work)
        try:
            yield
        finally:
            self.left = left

    def spend(self, work: float) -> None:
        """Take some work from the budget. Raises Spent at its end."""
        self.left -= work
        if self.left < 0:
            raise Spent
