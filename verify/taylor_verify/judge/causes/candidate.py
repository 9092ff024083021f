"""Candidates for the cause of an error, and the choice among those that explain nearly all of it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Final

from taylor_verify.judge.errors.shift import LEAVES
from taylor_verify.records.answers import LikelyCause

# Two candidates explain equally well if the better one leaves at least a third of what the other leaves,
_ALIKE: Final = 3.0
# or if both leave less than this part of the error.
_NOTHING: Final = 1e-3


@dataclass(frozen=True)
class Candidate:
    """A hypothesis that was tried: the part of the error that it ``leaves``, and its ``fitted`` numbers.

    Beside one that ``is_sure`` no hypothesis about the dynamics is needed.
    """

    name: str
    quantity: str
    leaves: float
    why: str
    fitted: int = 0
    is_sure: bool = False

    def cause(self) -> LikelyCause:
        """Return the candidate as a likely cause."""
        share = f"this explains {100 * (1 - self.leaves):.3g} % of the error of {self.quantity}"
        sentence = f"{self.name}: {self.why}; {share}"
        return LikelyCause(self.name, self.quantity, self.leaves, sentence)


def causes_of(candidates: Iterable[Candidate]) -> tuple[LikelyCause, ...]:
    """Return the best candidates for each quantity; none where no candidate explains nearly all."""
    good = [one for one in candidates if one.leaves <= LEAVES]
    quantities = dict.fromkeys(one.quantity for one in good)
    return tuple(
        one.cause()
        for quantity in quantities
        for one in _best([one for one in good if one.quantity == quantity])
    )


def _best(good: list[Candidate]) -> Iterator[Candidate]:
    """Yield the candidates that explain as well as any with the fewest fitted numbers, by name."""
    least = max(min(one.leaves for one in good), _NOTHING)
    alike = [one for one in good if one.leaves <= _ALIKE * least]
    fewest = min(one.fitted for one in alike)
    simple = sorted((one for one in alike if one.fitted == fewest), key=lambda one: one.leaves)
    names = set()
    for one in simple:
        if one.name not in names:
            names.add(one.name)
            yield one
