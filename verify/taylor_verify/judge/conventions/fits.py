"""The choice of the conventions that explain a file, among worlds with the best reading of each group."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import log10
from typing import Final

from taylor_verify.judge.conventions.axis_orders import Frames
from taylor_verify.judge.conventions.meanings import Reading, readings
from taylor_verify.judge.conventions.worlds import World

# A convention explains an error if at most this part remains: the remainder is the solver's error.
EXPLAINS: Final = 1e-2
# A convention that leaves up to this many times as much as the best one explains equally well.
AS_WELL: Final = 10.0
FLOAT64: Final = 2.0**-53


@dataclass(frozen=True)
class Finding:
    """A convention of the file that differs from the scene's.

    ``subject`` is ``time``, ``body``, ``axes`` or a group of columns; ``before`` and ``after`` are
    relative errors (radians for an attitude) without and with the convention. A finding with
    ``alternatives`` is ambiguous.
    """

    subject: str
    words: str
    before: float
    after: float
    alternatives: tuple[str, ...] = ()

    @property
    def is_certain(self) -> bool:
        return not self.alternatives

    @property
    def sentence(self) -> str:
        figures = f"error {self.before:.2g} without it, {self.after:.2g} with it"
        if self.is_certain:
            return f"{self.words} ({figures})"
        either = "; or ".join(f"[{words}]" for words in (self.words, *self.alternatives))
        return f"{self.subject} is ambiguous, this motion cannot tell {either} ({figures})"


@dataclass(frozen=True)
class Conventions:
    """The findings, and the world and readings that correct the file where the finding is certain."""

    findings: tuple[Finding, ...]
    world: World
    readings: Mapping[str, Reading]

    @property
    def rank(self) -> tuple[int, int]:
        return sum(finding.is_certain for finding in self.findings), len(self.findings)


@dataclass(frozen=True)
class BestReading:
    """The simplest reading of a group among the best, and other readings as simple and as good.

    ``plain`` is the error of the scene's own reading. ``motion`` is the distance that the exact motion goes
    over the rows, in the unit of the errors.
    """

    reading: Reading
    error: float
    plain: float
    motion: float
    others: tuple[Reading, ...]

    def is_explained(self, plain: BestReading, noise: float) -> bool:
        return self.error <= plain.explained(self.motion, noise)

    def explained(self, motion: float, noise: float) -> float:
        """Return the largest error that explains this one, of an exact motion that goes so far."""
        return max(noise, EXPLAINS * max(self.error, motion))


@dataclass(frozen=True)
class Fit:
    world: World
    groups: Mapping[str, BestReading]

    @property
    def worst(self) -> float:
        """Largest error of all groups in the scene's own conventions."""
        return max(read.plain for read in self.groups.values())

    @property
    def cost(self) -> int:
        return self.world.cost + sum(read.reading.cost for read in self.groups.values())

    def size(self, noise: float) -> float:
        """Return the sum of the orders of magnitude of all groups' errors."""
        return sum(log10(max(read.error, noise)) for read in self.groups.values())

    def gain(self, plain: Fit) -> str:
        """Return the group that the world explains best."""
        return max(
            self.groups, key=lambda g: plain.groups[g].error / (self.groups[g].error or FLOAT64)
        )

    def explains(self, plain: Fit, noise: float) -> bool:
        """Return True if the world explains at least one group and leaves no group unexplained.

        A file without motion agrees with any unit of time in which the truth does not move either. So a map
        of time explains a file only if the file moves.
        """
        best = self.gain(plain)
        gained, worst = self.groups[best], plain.groups[best].error
        if self.world.moves_time:
            worst = min(worst, gained.motion)
        groups = self.groups.items()
        return gained.error <= EXPLAINS * worst and all(
            read.is_explained(plain.groups[group], noise) for group, read in groups
        )


def simplest(fits: Sequence[Fit], noise: float) -> tuple[Fit, list[Fit]]:
    """Return the simplest of the best worlds, and the other worlds that are as good and as simple."""
    best = min(fit.size(noise) for fit in fits)
    good = [fit for fit in fits if fit.size(noise) <= best + log10(AS_WELL)]
    cost = min(fit.cost for fit in good)
    simple = sorted((f for f in good if f.cost == cost), key=lambda fit: fit.size(noise))
    return simple[0], simple[1:]


def findings_of(
    plain: Fit, best: Fit, others: Sequence[Fit], spacing: Fraction | None = None
) -> Conventions:
    """Return the departures of the best fit from the plain fit; ``others`` are as good and as simple."""
    gained = best.gain(plain)
    before, after = plain.groups[gained].error, best.groups[gained].error
    alternatives = tuple(o.world.words or "the scene's own" for o in others)
    findings = [
        Finding(subject, words, before, after, alternatives)
        for subject, words in best.world.subjects.items()
    ]
    # If the axes are ambiguous, no axis is renamed.
    frames = Frames() if others else best.world.frames
    certain = {group: readings(group, frames, spacing)[0] for group in best.groups if frames.cost}
    for group, read in best.groups.items():
        if read.reading.cost and read.error <= EXPLAINS * read.plain:
            words, unlike = read.reading.words, tuple(other.sentence for other in read.others)
            findings.append(Finding(group, "; ".join(words), read.plain, read.error, unlike))
            if not unlike:
                known = readings(group, frames, spacing)
                certain[group] = next(reading for reading in known if reading.words == words)
    return Conventions(tuple(findings), plain.world if others else best.world, certain)
