"""Comparison of a run with a baseline, the verdicts of an earlier run, to find regressions.

Another processor or another order of a sum changes the roundings of a sound run, but its errors stay in
their rounding class (see `rounding_class`, which defines FACTOR and LEVEL). That class has two sides,
because a published number must neither grow nor shrink. A regression has only one side:

    verdict                   worse in the grades of the exit status: pass, nothing shown, fail
    max, mean, final, ratio   now > FACTOR max(before, LEVEL attainable), or no finite number
    row                       missing: a quantity that is no longer compared is no longer right

By the figures of that class, rounding alone raises a false alarm with probability at most 5e-6 per row.
An error below 5 attainable never counts as grown, whatever it was: it may have been small by chance.

`attainable` here is the roundoff floor for the *former* number of steps. The floor grows as the square
root of the steps, and more steps must not excuse a larger error. The larger of two values is taken, the
former floor and sqrt(former steps / steps now) times the present floor, because the two maxima may be at
different times.

A row that answers another question (another text of the scene, another unit or roundoff) cannot be
compared with the former row: it is undecided, never green. Every other change is reported and fails
nothing: a smaller error, a better verdict, a new row, another cost.

A verdict by another tolerance is not a worse verdict; the errors are still compared.

A baseline excuses nothing: a gate that failed before and fails again is a failure. A caller may let the
baseline alone decide (`decided_alone`): then failed gates do not count, and a row that shows nothing by
itself is never green.
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
    format_number,
    has_grown,
    paired,
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
    """The result of comparing a run with a baseline: the number of rows, and the rows that departed."""

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
    """Compare every row that was ``made`` with its row of the baseline.

    Rungs that a machine lacks are left out. Four things are regressions: a missing row, a worse verdict, a
    quaternion that is no longer a unit quaternion, and an error above ten times the larger of the former
    error and half of the attainable one. Below that limit, other roundings may explain the growth.
    """
    # Whether the row COMPLETE exists depends on the options of each call, so it is not compared.
    before, now = ([v for v in verdicts if v.quantity != COMPLETE] for verdicts in (baseline, made))
    rows = paired(before, now)
    # A quaternion has a row only where it fails: a sound run has none.
    missing, mended = _parted(rows.missing)
    added, spoiled = _parted(rows.extra)
    regressions = [Departure.of(verdict, "this row", "none") for verdict in missing]
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
        # Where a row is a regression, its other numbers are consequences.
        changes += [] if other or grown else departures(old, new)
    regressions += [Departure.of(verdict, "no such row", "one that fails") for verdict in spoiled]
    return Held(len(rows.shared), tuple(regressions), tuple(undecided), tuple(changes))


def _parted(rows: Iterable[Verdict]) -> tuple[list[Verdict], list[Verdict]]:
    """Split rows into those that every run has and those about the length of quaternions."""
    every = list(rows)
    lengths = [verdict for verdict in every if verdict.quantity == UNIT_QUATERNION]
    return [verdict for verdict in every if verdict not in lengths], lengths


def decided_alone(comparison: Held, baseline: Iterable[Verdict], made: Iterable[Verdict]) -> Held:
    """Return the ``comparison`` with a status that ignores the gates of the rows ``made``.

    A failed row without a finite error is a regression, even if the baseline has no finite error either.
    A row that shows nothing counts as not compared: it is undecided, vacuous or refused, or it fails and
    is new.
    """
    known = {_name(verdict) for verdict in baseline}
    named = {
        (d.scene, d.rung, d.quantity) for d in (*comparison.regressions, *comparison.undecided)
    }
    lost, unshown = [], []
    for verdict in made:
        status = exit_status([verdict])
        if status == 0 or _name(verdict) in named:
            continue
        if status != 1:
            verdict_words = f"{verdict.verdict} ({verdict.because})"
            unshown.append(Departure.of(verdict, "a row that shows something", verdict_words))
        elif finite(verdict, "max") is None:
            lost.append(Departure.of(verdict, "a finite error", format_number(None), "max"))
        elif _name(verdict) not in known:
            unshown.append(Departure.of(verdict, "a row of the baseline", "a new one that fails"))
    regressions, undecided = (*comparison.regressions, *lost), (*comparison.undecided, *unshown)
    return Held(comparison.compared, regressions, undecided, comparison.changes)


def _name(verdict: Verdict) -> tuple[str, str, str]:
    return verdict.scene, verdict.rung, verdict.quantity


def _other_question(old: Verdict, new: Verdict) -> Iterator[Departure]:
    if old.provenance.get("scene") != new.provenance.get("scene"):
        yield Departure.of(new, "the text that the baseline was made of", "another", "scene")
    # A longer run has larger errors.
    if None not in (old.until, new.until) and old.until != new.until:
        yield Departure.of(new, format_number(old.until), format_number(new.until), "last time")
    for name in ("unit", "roundoff"):
        was, now = getattr(old, name), getattr(new, name)
        # A run that was not compared has neither.
        if was and now and was != now:
            yield Departure.of(new, str(was), str(now), name)


def _regressions(old: Verdict, new: Verdict) -> Iterator[Departure]:
    # Verdicts by different tolerances cannot be compared with each other.
    is_alike = old.tolerance == new.tolerance or not (old.is_compared and new.is_compared)
    grades = [_GRADES.index(exit_status([verdict])) for verdict in (old, new)]
    if is_alike and grades[1] > grades[0]:
        yield Departure.of(new, old.verdict.value, new.verdict.value, "verdict")
    grown = {name: excess for name in ERRORS if (excess := _grown(old, new, name)) is not None}
    if grown:
        # The errors of a row grow together: the figures of the first suffice, the others are named.
        name, *further = grown
        limit, error = grown[name]
        others = ", ".join(further)
        yield Departure.of(new, limit, error, f"{name} (and {others})" if others else name)


def _grown(old: Verdict, new: Verdict, name: str) -> tuple[str, str] | None:
    """Return the limit that an error exceeds, and the error; None if it stays below."""
    was, now = finite(old, name), finite(new, name)
    level = LEVEL * (1.0 if name == "ratio" else _attainable(old, new))
    if not has_grown(was, now, level):
        return None
    if was is None:
        return format_number(was), format_number(now)
    limit = FACTOR * max(was, level)
    larger = f"the larger of the baseline's {was:.3g} and {LEVEL:g} attainable, {level:.3g}"
    return f"at most {limit:.3g} ({FACTOR:g} x {larger}: rounding explains no more)", format_number(
        now
    )


def _attainable(old: Verdict, new: Verdict) -> float:
    """Return the error that is attainable in the former number of steps."""
    before, now = (finite(row, "attainable") or 0.0 for row in (old, new))
    steps = old.steps / new.steps if 0 < old.steps < new.steps else 1.0
    return max(before, math.sqrt(steps) * now)


# Reading.


def load(file: Path | str) -> tuple[Verdict, ...]:
    """Return the verdicts of a file: verdicts.json of `run --out`, or the document of `--json`.

    Raises scenes.reading.faults.Refused for a file that cannot be read. Raises ValueError, which names what
    was expected and where, for a file with other content: a half-understood baseline would pass everything.
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
    """The part of a document that a baseline needs; a document of several files has one for each file."""

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
    """Refuse a row whose numbers cannot belong to a verdict, or with which nothing can be compared."""
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
