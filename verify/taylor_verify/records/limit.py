"""A limit on what is read of somebody's file, with its reason."""

from __future__ import annotations

from typing import NamedTuple

from taylor_verify.records.faults import Refused


class Limit(NamedTuple):
    """Greatest number of something that is read, with its reason."""

    most: int
    what: str
    because: str

    def refusal(self, got: int | str, place: object) -> Refused:
        """Return the refusal of what exceeds the limit."""
        limit = f"expected at most {self.most} {self.what}"
        return Refused([f"{limit}, got {got} @ {place} ({self.because})"])

    def check(self, got: int, place: object) -> None:
        """Raise Refused for what exceeds the limit."""
        if got > self.most:
            raise self.refusal(got, place)
