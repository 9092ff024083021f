"""The extent of somebody's answer: the row `complete`, where a file lacks a part of what the scene asks.

The times of the samples are the file's own affair. It has to reach the scene's end, to begin no later
than one of its own sampling intervals after the start, and to have more than one row.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import pairwise
from typing import Final

from taylor_verify.judge.judgement import unjudged
from taylor_verify.records.quantities import COMPLETE
from taylor_verify.records.reason import Cause
from taylor_verify.records.status import Status
from taylor_verify.records.verdict import Verdict
from taylor_verify.scenes.precision import Rung
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.file import Recorded
from taylor_verify.solvers.trajectory import Outcome

# A clock that adds up its step errs by a roundoff of the span in each of them: steps of 1e-4 up to 100.
_CLOCK_STEPS: Final = 10**6
# So many rows show an interval of their own.
_FEWEST_ROWS: Final = 3


@dataclass(frozen=True)
class Extent:
    """The rows of a file, as times since the scene's start in the direction of its motion, sorted.

    ``begin`` and ``end`` are the first and the last instant of the scene, counted likewise.
    """

    rows: tuple[Fraction, ...]
    begin: Fraction
    end: Fraction
    slack: Fraction

    @classmethod
    def of(cls, scene: Scene, times: Sequence[Fraction], rung: Rung) -> Extent:
        start, elapsed = scene.clock.start, scene.clock.elapsed
        sign = 1 if elapsed[-1] >= 0 else -1
        rows = tuple(sorted(sign * (t - start) for t in times))
        end = sign * elapsed[-1]
        rounded = _CLOCK_STEPS * rung.unit_roundoff * (end + abs(start))
        # In less than half an interval no row of the file is missing.
        last = rows[-1] - rows[-2] if len(rows) > 1 else Fraction(0)
        return cls(rows, sign * elapsed[0], end, min(rounded, last / 2))

    @property
    def reaches_end(self) -> bool:
        return self.rows[-1] >= self.end - self.slack

    @property
    def inside(self) -> tuple[Fraction, ...]:
        """The rows within the scene's span."""
        return tuple(t for t in self.rows if -self.slack <= t <= self.end + self.slack)

    @property
    def reaches_start(self) -> bool:
        """True if the first row within the span is at the first instant, or one interval after it.

        Of two rows nobody can tell the interval.
        """
        inside = self.inside
        gaps = [b - a for a, b in pairwise(inside)] if len(inside) >= _FEWEST_ROWS else []
        return bool(inside) and inside[0] <= max([self.begin, *gaps]) + self.slack

    @property
    def is_one_state(self) -> bool:
        """True if one row is all there is within the span, of a scene that asks for several."""
        return len(self.inside) <= 1 and self.begin != self.end


def not_judged(extent: Extent, missing: Sequence[str]) -> Iterator[str]:
    """The parts of the scene's question that a file does not answer; ``missing`` are quantities."""
    yield from (f"the {noun}" for noun in missing)
    span = f"the scene's span of {float(extent.end):g}"
    if extent.is_one_state:
        yield f"the motion along {span} (one row is no trajectory)"
        return
    if not extent.reaches_start:
        yield f"the first {float(extent.inside[0]):.6g} of {span}"
    if not extent.reaches_end:
        yield f"the last {float(extent.end - max(extent.rows[-1], Fraction(0))):.6g} of {span}"


def complete_verdict(
    scene: Scene, file: str, rung: Rung, lack: Sequence[str], partial: bool
) -> Verdict:
    """The row that says what was not judged: undecided, or vacuous where a part was asked for."""
    status = Status.VACUOUS if partial else Status.UNDECIDED
    whole = f"`taylor-verify question {scene.name} --csv` prints the header and the times of a whole file"
    asked = "a part is all that --partial asks for" if partial else "--partial accepts a part"
    said = f"not judged: {', '.join(lack)}; {whole}; {asked}"
    solver = Recorded({}, setting=file)
    (row,) = unjudged(
        scene, solver, rung, status, said, Cause.INCOMPLETE, Outcome.FINISHED
    ).verdicts
    return replace(row, quantity=COMPLETE, roundoff=float(rung.unit_roundoff))
