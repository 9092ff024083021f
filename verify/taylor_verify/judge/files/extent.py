"""The extent of somebody's answer: the row `complete`, where a file lacks a part of what the scene asks.

The times of the samples are the file's own affair. It has to reach the scene's end, to begin no later
than one of its own sampling intervals after the start, and to have more than one row.
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from itertools import pairwise
from typing import Any, Final

from taylor_verify.judge.rows import verdict_on
from taylor_verify.records.quantities import COMPLETE, GROUPS
from taylor_verify.records.reason import Cause, stated
from taylor_verify.records.status import Status
from taylor_verify.records.verdict import Verdict
from taylor_verify.scenes.precision import Rung
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.files.file import Recorded
from taylor_verify.solvers.trajectory import Outcome

# A clock that adds up its step errs by a roundoff of the span in each of them: steps of 1e-4 up to 100.
_CLOCK_STEPS: Final = 10**6
# So many rows show an interval of their own.
_FEWEST_ROWS: Final = 3


class _Since(Sequence[Fraction]):
    """Strictly monotonic times, counted from a start in one direction and put in ascending order."""

    def __init__(self, times: Sequence[Fraction], start: Fraction, sign: int) -> None:
        self._times, self._start, self._sign = times, start, sign
        rises = sign * (times[-1] - times[0]) >= 0
        self._places = range(len(times)) if rises else range(len(times) - 1, -1, -1)

    def __len__(self) -> int:
        return len(self._times)

    def __getitem__(self, place: Any) -> Any:
        return self._sign * (self._times[self._places[place]] - self._start)


@dataclass(frozen=True)
class Extent:
    """The rows of a file, as times since the scene's start in the direction of its motion, sorted.

    ``begin`` and ``end`` are the first and the last instant of the scene, counted likewise.
    """

    rows: Sequence[Fraction]
    begin: Fraction
    end: Fraction
    slack: Fraction

    @classmethod
    def of(cls, scene: Scene, times: Sequence[Fraction], rung: Rung) -> Extent:
        start, elapsed = scene.clock.start, scene.clock.elapsed
        sign = 1 if elapsed[-1] >= 0 else -1
        rows = _Since(times, start, sign)
        end = sign * elapsed[-1]
        rounded = _CLOCK_STEPS * rung.unit_roundoff * (end + abs(start))
        # In less than half an interval no row of the file is missing.
        last = rows[-1] - rows[-2] if len(rows) > 1 else Fraction(0)
        return cls(rows, sign * elapsed[0], end, min(rounded, last / 2))

    @property
    def reaches_end(self) -> bool:
        return self.rows[-1] >= self.end - self.slack

    @cached_property
    def inside(self) -> range:
        """The places of the rows within the scene's span."""
        first = bisect_left(self.rows, -self.slack)
        return range(first, bisect_right(self.rows, self.end + self.slack))

    @property
    def first(self) -> Fraction:
        """The first row within the span."""
        return self.rows[self.inside[0]]

    @property
    def reaches_start(self) -> bool:
        """True if the first row within the span is at the first instant, or one interval after it.

        Of two rows nobody can tell the interval.
        """
        if not self.inside or self.first <= self.begin + self.slack:
            return bool(self.inside)
        inside = pairwise(self.rows[k] for k in self.inside)
        is_known = len(self.inside) >= _FEWEST_ROWS
        return is_known and any(self.first <= b - a + self.slack for a, b in inside)

    @property
    def is_one_state(self) -> bool:
        """True if one row is all there is within the span, of a scene that asks for several."""
        return len(self.inside) <= 1 and self.begin != self.end


def not_judged(extent: Extent, missing: Sequence[str]) -> Iterator[str]:
    """Yield the parts of the scene's question that a file does not answer; ``missing`` are groups."""
    yield from (f"the {GROUPS[name].noun}" for name in missing)
    span = f"the scene's span of {float(extent.end):g}"
    if extent.is_one_state:
        yield f"the motion along {span} (one row within it is no trajectory)"
        return
    if not extent.reaches_start:
        yield f"the first {float(extent.first):.6g} of {span}"
    if not extent.reaches_end:
        yield f"the last {float(extent.end - max(extent.rows[-1], Fraction(0))):.6g} of {span}"


def complete_verdict(
    scene: Scene, file: str, rung: Rung, lack: Sequence[str], partial: bool
) -> Verdict:
    """Return the row that says what was not judged: undecided, or vacuous where a part was asked for."""
    status = Status.VACUOUS if partial else Status.UNDECIDED
    whole = f"`taylor-verify question {scene.name} --csv` prints the header and the times of a whole file"
    asked = "a part is all that --partial asks for" if partial else "--partial accepts a part"
    said = f"not judged: {', '.join(lack)}; {whole}; {asked}"
    row = (scene, Recorded({}, setting=file), rung, COMPLETE, status, Outcome.FINISHED)
    reason, roundoff = stated(Cause.INCOMPLETE, said), float(rung.unit_roundoff)
    return verdict_on(*row, reason=reason, roundoff=roundoff)
