"""Coverage of the scene's question by a file: its columns, its span, and notes on missing parts.

A file may have samples at any times. But it must reach the scene's end, begin at most one of its own
sampling intervals after the start, and have more than one row. If a part is missing, the judgement has the
row `complete`.
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from itertools import pairwise
from typing import Final

from taylor_verify.judge.judged_rows import verdict_on
from taylor_verify.numbers.precision import Rung
from taylor_verify.records.faults import Refused
from taylor_verify.records.quantities import (
    COMPLETE,
    MOMENTA,
    VELOCITIES,
    Group,
    answerable_groups,
)
from taylor_verify.records.reason import Cause, stated
from taylor_verify.records.status import Status
from taylor_verify.records.verdict import Verdict
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.files.file import Recorded, TrajectoryFile
from taylor_verify.solvers.trajectory import Outcome

# A clock that sums its steps errs by up to a roundoff of the span per step: 10^6 steps of 1e-4 reach 100.
_CLOCK_STEPS: Final = 10**6
# At least this many rows show a sampling interval.
_FEWEST_ROWS: Final = 3


@dataclass(frozen=True)
class Extent:
    """The rows of a file and the scene's span, as times since the start in the direction of motion.

    ``times`` are the file's times in that direction. ``begin`` and ``end`` are the first and the last
    instant of the scene.
    """

    times: Sequence[Fraction]
    start: Fraction
    sign: int
    begin: Fraction
    end: Fraction
    slack: Fraction

    @classmethod
    def of(cls, scene: Scene, times: Sequence[Fraction], rung: Rung) -> Extent:
        start, elapsed = scene.clock.start, scene.clock.elapsed
        sign = 1 if elapsed[-1] >= 0 else -1
        if sign * (times[-1] - times[0]) < 0:
            times = times[::-1]
        end = sign * elapsed[-1]
        rounded = _CLOCK_STEPS * rung.unit_roundoff * (end + abs(start))
        # If less than half an interval is left, no row of the file is missing.
        last = abs(times[-1] - times[-2]) if len(times) > 1 else Fraction(0)
        return cls(times, start, sign, sign * elapsed[0], end, min(rounded, last / 2))

    def since(self, time: Fraction) -> Fraction:
        """Return the time since the start."""
        return self.sign * (time - self.start)

    @property
    def last(self) -> Fraction:
        """Time of the last row."""
        return self.since(self.times[-1])

    @property
    def reaches_end(self) -> bool:
        return self.last >= self.end - self.slack

    @cached_property
    def inside(self) -> range:
        """Indices of the rows within the scene's span."""
        first = bisect_left(self.times, -self.slack, key=self.since)
        return range(first, bisect_right(self.times, self.end + self.slack, key=self.since))

    @property
    def first(self) -> Fraction:
        """Time of the first row within the span."""
        return self.since(self.times[self.inside[0]])

    @property
    def reaches_start(self) -> bool:
        """True if the first row within the span is at the first instant, or at most one interval later.

        Two rows alone show no interval.
        """
        if not self.inside or self.first <= self.begin + self.slack:
            return bool(self.inside)
        first, inside = self.first, pairwise(self.times[k] for k in self.inside)
        is_known = len(self.inside) >= _FEWEST_ROWS
        return is_known and any(first <= abs(b - a) + self.slack for a, b in inside)

    @property
    def is_one_state(self) -> bool:
        """True if only one row is within the span, although the scene asks for several."""
        return len(self.inside) <= 1 and self.begin != self.end


def not_judged(extent: Extent, missing: Sequence[Group]) -> Iterator[str]:
    """Yield the parts of the scene's question that a file does not answer, with its ``missing`` groups."""
    yield from (f"the {group.noun}" for group in missing)
    span = f"the scene's span of {float(extent.end):g}"
    if extent.is_one_state:
        yield f"the motion along {span} (one row within it is no trajectory)"
        return
    if not extent.reaches_start:
        yield f"the first {float(extent.first):.6g} of {span}"
    if not extent.reaches_end:
        yield f"the last {float(extent.end - max(extent.last, Fraction(0))):.6g} of {span}"


def complete_verdict(
    scene: Scene, file: str, rung: Rung, lack: Sequence[str], partial: bool
) -> Verdict:
    """Return the row on what was not judged: undecided, or vacuous if a ``partial`` answer is accepted."""
    status = Status.VACUOUS if partial else Status.UNDECIDED
    whole = f"`taylor-verify question {scene.name} --csv` prints the header and the times of a whole file"
    asked = "accepted, as --partial says" if partial else "--partial accepts a part"
    sentence = f"not judged: {', '.join(lack)}; {whole}; {asked}"
    row = (scene, Recorded({}, setting=file), rung, COMPLETE, status, Outcome.FINISHED)
    reason, roundoff = stated(Cause.INCOMPLETE, sentence), float(rung.unit_roundoff)
    return verdict_on(*row, reason=reason, roundoff=roundoff)


# The columns, and the sentences.


def comparable(file: TrajectoryFile, scene: Scene) -> list[str]:
    """Return the file's groups that can be compared with the scene. Raises Refused if there are none."""
    known = _known(scene)
    every, tracked = scene.known_groups, {quantity.name for quantity in scene.tracked}
    compared = {n for n in known if n in VELOCITIES or every[n].quantity in tracked}
    if groups := [name for name in file.groups if name in compared]:
        return groups
    foreign = [name for name in file.groups if name not in known]
    if foreign:
        expected = f"expected columns of a scene of model {scene.model} ({_columns(scene, known)})"
        raise Refused(
            [f"{expected}, got {_columns(scene, [name])} @ {file.name}" for name in foreign]
        )
    wanted = [group.name for group in scene.groups]
    # A file with velocities needs no impulses.
    instead = [VELOCITIES] if scene.model == "kirchhoff" else []
    choices = (*instead, *([name] for name in wanted))
    expected = " or ".join(_columns(scene, names) for names in choices)
    notes = "; ".join(
        (*file.notes, f"name other columns: --columns {every[wanted[0]].columns[0]}=NAME,...")
    )
    columns = _columns(scene, file.groups) or "t alone"
    raise Refused(
        [f"expected {expected}, which {scene.name} tracks, got {columns} @ {file.name} ({notes})"]
    )


def _columns(scene: Scene, groups: Iterable[str]) -> str:
    return " ".join(column for name in groups for column in scene.known_groups[name].columns)


def _known(scene: Scene) -> list[str]:
    """Return the groups that a file for this scene may have."""
    known = answerable_groups(scene.model) | {state.name for state in scene.own_states}
    return [name for name in scene.known_groups if name in known]


def coverage_notes(file: TrajectoryFile, groups: Sequence[str], scene: Scene) -> Iterator[str]:
    """Yield a sentence for each group that is not compared; groups of other models come first."""
    known, every = _known(scene), scene.known_groups
    for name in sorted(file.groups, key=lambda name: name in known):
        if name not in known:
            why = f"{scene.name} is of model {scene.model}, whose motion has no {every[name].noun}"
        elif name not in groups:
            why = f"{scene.name} does not track the {every[name].noun}"
        else:
            continue
        yield f"{_columns(scene, [name])} not compared: {why}"
    for group in missing_groups(groups, scene):
        other = " or r11 ... r33" if group.is_frame else ""
        yield f"the {group.noun} is not judged: the file has no {' '.join(group.columns)}{other}"


def missing_groups(groups: Sequence[str], scene: Scene) -> list[Group]:
    """Return the groups that the scene asks for and the file lacks."""
    every = scene.known_groups
    has = {"quaternion" if every[name].is_frame else name for name in groups}
    if scene.model == "kirchhoff" and has.issuperset(VELOCITIES):
        # Both velocities together replace the impulses.
        has |= set(MOMENTA["kirchhoff"])
    return [group for group in scene.groups if group.name not in has]


def span_notes(scene: Scene, times: Sequence[Fraction], extent: Extent) -> Iterator[str]:
    """Yield a sentence if no row is at the start, if rows are reversed, if the file stops too early."""
    start, end = float(scene.clock.start), float(scene.clock.instants[-1])
    if (times[-1] - times[0]) * (scene.clock.instants[-1] - scene.clock.start) < 0:
        yield (
            f"the rows are reversed: their times go from t = {float(times[0]):.12g} to "
            f"{float(times[-1]):.12g}, against the direction of the scene"
        )
    if all(float(time) != start for time in times):
        yield f"no row is at the start, t = {start:g}: the initial state was not compared"
    if extent.last >= 0 and not extent.reaches_end:
        last = float(max(times, key=lambda t: abs(t - scene.clock.start)))
        yield (
            f"the last row is at t = {last:.12g}, and the scene ends at t = {end:.12g}: "
            "the rest was not judged"
        )
