"""A baseline: the verdicts of an earlier run, and what of a new run is a regression from them.

The errors of a sound run are drawn anew by another processor or another order of a sum, and stay in
their rounding class (see `rounding_class`, whose FACTOR and LEVEL these are). That class has two
sides, for what is published must neither grow nor shrink. A regression has one:

    verdict                   worse in the grades of the exit status: pass, nothing shown, fail
    max, mean, final, ratio   now > FACTOR max(before, LEVEL attainable), or no finite number
    row                       gone: a quantity that is no longer compared is no longer right

By the figures of that class, rounding alone raises a false alarm at most 5e-6 times a row. Below 5
attainable no error of a single row is seen as grown, whatever it was: chance may make it small.

Attainable is here what the *former* number of steps would leave, for it grows as their root and
errors may not be excused by more steps: the larger of the former one and of sqrt(former steps / steps
now) times the present one, since the two maxima may be of unlike times.

A row that was asked another question (another text of the scene, another unit or roundoff) cannot
be held against its former self: it is undecided, never green. All else that left its class is told
and fails nothing: an error that shrank, a better verdict, a new row, another cost.

A verdict by another tolerance is no worse verdict; the errors are compared all the same.

A baseline excuses nothing: a gate that fails does so though it failed before. A caller may let the
baseline alone decide (`decided_alone`): then a failed gate is none of its business, and what shows nothing
of its own is never green.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from taylor_verify.judge.rounding_class import (
    ERRORS,
    FACTOR,
    LEVEL,
    Departure,
    departures,
    finite,
    has_grown,
    paired,
    told,
)
from taylor_verify.records.json_text import parsed
from taylor_verify.records.quantities import COMPLETE, UNIT_QUATERNION
from taylor_verify.records.status import Status
from taylor_verify.records.verdict import Verdict, exit_status
from taylor_verify.scenes.reading.limit import Limit
from taylor_verify.scenes.reading.regular_file import read_bytes

_SIZES: Final = (*ERRORS, "bound", "attainable", "roundoff")
# From the best: 0 all passed, 3 nothing shown, 1 failed.
_GRADES: Final = (0, 3, 1)
_MOST_BYTES: Final = Limit(2**28, "bytes", "a hundred thousand verdicts")


@dataclass(frozen=True)
class Held:
    """A run compared with a baseline: how many rows, and what is to be said of which."""

    compared: int
    regressions: tuple[Departure, ...]
    undecided: tuple[Departure, ...]
    changes: tuple[Departure, ...]

    @property
    def status(self) -> int:
        """Exit status: 1 for a regression, 3 where something could not be compared, else 0."""
        if self.regressions:
            return 1
        return 3 if self.undecided or not self.compared else 0


def hold(baseline: Iterable[Verdict], made: Iterable[Verdict]) -> Held:
    """Compare every row made with the row of the baseline; rungs that a machine lacks are left out.

    A row that is gone, a verdict that is worse, a quaternion that is no unit quaternion any more, and an
    error beyond ten times the larger of what it was and half of what is attainable are regressions: below
    that, roundings drawn anew may explain it.
    """
    # That of the extent of an answer is there or not as its own call has asked.
    before, now = ([v for v in verdicts if v.quantity != COMPLETE] for verdicts in (baseline, made))
    rows = paired(before, now)
    # The row of a quaternion is there only where it fails: a sound run has none.
    gone, mended = _parted(rows.missing)
    added, spoiled = _parted(rows.extra)
    regressions = [Departure.of(verdict, "this row", "none") for verdict in gone]
    undecided: list[Departure] = []
    changes = [Departure.of(verdict, "a row of the baseline", "a new one") for verdict in added]
    changes += [Departure.of(v, "a row that fails", "none: it is mended") for v in mended]
    changes += [
        Departure.of(verdict, "the rung on both machines", "it on one: not compared")
        for verdict in rows.absent
        if verdict.verdict is Status.UNAVAILABLE
    ]
    for old, new in rows.shared:
        other = list(_other_question(old, new))
        grown = [] if other else list(_regressions(old, new))
        undecided += other
        regressions += grown
        # Of a verdict that is worse the other numbers are the consequence.
        changes += [] if other or grown else departures(old, new)
    regressions += [Departure.of(verdict, "no such row", "one that fails") for verdict in spoiled]
    return Held(len(rows.shared), tuple(regressions), tuple(undecided), tuple(changes))


def _parted(rows: Iterable[Verdict]) -> tuple[list[Verdict], list[Verdict]]:
    """Rows that every run has, and those of the length of quaternions."""
    every = list(rows)
    lengths = [verdict for verdict in every if verdict.quantity == UNIT_QUATERNION]
    return [verdict for verdict in every if verdict not in lengths], lengths


def decided_alone(held: Held, baseline: Iterable[Verdict], made: Iterable[Verdict]) -> Held:
    """Return the comparison ``held``, made to decide alone, whatever the gates of the rows made say.

    A row that failed and has no finite error is a regression, though the baseline has none either. A row
    that shows nothing cannot be compared: it is undecided, vacuous or refused, or it fails and is new.
    """
    known = {_name(verdict) for verdict in baseline}
    named = {(d.scene, d.rung, d.quantity) for d in (*held.regressions, *held.undecided)}
    lost, unshown = [], []
    for verdict in made:
        status = exit_status([verdict])
        if status == 0 or _name(verdict) in named:
            continue
        if status != 1:
            got = f"{verdict.verdict} ({verdict.because})"
            unshown.append(Departure.of(verdict, "a row that shows something", got))
        elif finite(verdict, "max") is None:
            lost.append(Departure.of(verdict, "a finite error", told(None), "max"))
        elif _name(verdict) not in known:
            unshown.append(Departure.of(verdict, "a row of the baseline", "a new one that fails"))
    regressions, undecided = (*held.regressions, *lost), (*held.undecided, *unshown)
    return Held(held.compared, regressions, undecided, held.changes)


def _name(verdict: Verdict) -> tuple[str, str, str]:
    return verdict.scene, verdict.rung, verdict.quantity


def _other_question(old: Verdict, new: Verdict) -> Iterator[Departure]:
    if old.provenance.get("scene") != new.provenance.get("scene"):
        yield Departure.of(new, "the text that the baseline was made of", "another", "scene")
    # A longer run has larger errors.
    if None not in (old.until, new.until) and old.until != new.until:
        yield Departure.of(new, told(old.until), told(new.until), "last time")
    for name in ("unit", "roundoff"):
        was, now = getattr(old, name), getattr(new, name)
        # A run that came to no comparison has neither.
        if was and now and was != now:
            yield Departure.of(new, str(was), str(now), name)


def _regressions(old: Verdict, new: Verdict) -> Iterator[Departure]:
    # Of two comparisons by unlike tolerances neither verdict tells of the other.
    is_alike = old.tolerance == new.tolerance or not (old.is_compared and new.is_compared)
    grades = [_GRADES.index(exit_status([verdict])) for verdict in (old, new)]
    if is_alike and grades[1] > grades[0]:
        yield Departure.of(new, old.verdict.value, new.verdict.value, "verdict")
    grown = [(name, *found) for name in ERRORS if (found := _grown(old, new, name)) is not None]
    if grown:
        # They grow together: the first has the figures, the others are named.
        name, limit, got = grown[0]
        others = ", ".join(other for other, *_ in grown[1:])
        yield Departure.of(new, limit, got, f"{name} (and {others})" if others else name)


def _grown(old: Verdict, new: Verdict, name: str) -> tuple[str, str] | None:
    """The limit that an error exceeds, and the error; None where it does not."""
    was, now = finite(old, name), finite(new, name)
    level = LEVEL * (1.0 if name == "ratio" else _attainable(old, new))
    if not has_grown(was, now, level):
        return None
    if was is None:
        return told(was), told(now)
    limit = FACTOR * max(was, level)
    larger = f"the larger of the baseline's {was:.3g} and {LEVEL:g} attainable, {level:.3g}"
    return f"at most {limit:.3g} ({FACTOR:g} x {larger}: rounding explains no more)", told(now)


def _attainable(old: Verdict, new: Verdict) -> float:
    """The error that is attainable in the former number of steps."""
    before, now = (finite(row, "attainable") or 0.0 for row in (old, new))
    steps = old.steps / new.steps if 0 < old.steps < new.steps else 1.0
    return max(before, math.sqrt(steps) * now)


# Reading.


def load(file: Path | str) -> tuple[Verdict, ...]:
    """Return the verdicts of a file: verdicts.json of `run --out`, or the document of `--json`.

    Raises scenes.reading.faults.Refused for a file that cannot be read, and ValueError, with what was
    expected and where, for one that holds something else: a baseline that is half understood would let
    all pass.
    """
    content = read_bytes(Path(file), "a file of verdicts", _MOST_BYTES)
    try:
        placed = dict(_placed(parsed(content, _Rows)))
        for place, verdict in placed.items():
            _check(verdict, place)
        rows = Counter(
            " ".join(filter(None, (v.scene, v.solver, v.setting, v.rung, v.quantity)))
            for v in placed.values()
        )
        if twice := [row for row, count in rows.items() if count > 1]:
            raise ValueError(f"expected every row once, got more of {', '.join(twice)}")
    except ValueError as fault:
        raise ValueError(f"{fault} @ {file}") from fault
    return tuple(placed.values())


@dataclass(frozen=True)
class _Rows:
    """The part of a document that a baseline is made of; that of several files has theirs."""

    verdicts: tuple[Verdict, ...] | None = None
    files: tuple[_Rows, ...] = ()


def _placed(document: _Rows, place: str = "") -> Iterator[tuple[str, Verdict]]:
    """Yield every row of a document with its place in it. Raises ValueError where there is no list."""
    if document.verdicts is None and not document.files:
        raise ValueError(f"expected a key verdicts, got none @ {place or 'the document'}")
    for i, verdict in enumerate(document.verdicts or ()):
        yield f"{place}verdicts[{i}]", verdict
    for k, file in enumerate(document.files):
        yield from _placed(file, f"{place}files[{k}].")


def _check(verdict: Verdict, place: str) -> None:
    """Refuse a row whose numbers cannot be those of a verdict, or that nothing can be compared with."""
    if not isinstance(verdict.provenance.get("scene"), str):
        raise ValueError(
            f"expected the digest of the scene's text, got none @ {place}.provenance.scene"
        )
    for name in _SIZES:
        value = getattr(verdict, name)
        if value is None and verdict.verdict is Status.PASS:
            raise ValueError(f"expected a number of a row that passed, got null @ {place}.{name}")
        if value is not None and not value >= 0:
            raise ValueError(
                f"expected a number that is not negative, got {value!r} @ {place}.{name}"
            )
