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
    departure,
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
    """A run held against a baseline: how many rows, and what is to be said of which."""

    compared: int
    regressions: tuple[Departure, ...]
    undecided: tuple[Departure, ...]
    changes: tuple[Departure, ...]

    @property
    def status(self) -> int:
        """As an exit status: 1 for a regression, 3 where something could not be compared."""
        if self.regressions:
            return 1
        return 3 if self.undecided or not self.compared else 0


def hold(baseline: Iterable[Verdict], made: Iterable[Verdict]) -> Held:
    """Hold every row made against the row of the baseline; rungs that a machine lacks are left out.

    A row that is gone, a verdict that is worse, a quaternion that is no unit quaternion any more, and an
    error beyond ten times the larger of what it was and half of what is attainable are regressions: below
    that, roundings drawn anew may explain it.
    """
    rows = paired(_compared(baseline), _compared(made))
    # This row is there only where it fails: of a sound run neither baseline nor result has one.
    mended = [verdict for verdict in rows.missing if verdict.quantity == UNIT_QUATERNION]
    gone = [verdict for verdict in rows.missing if verdict not in mended]
    regressions = [_row(verdict, "this row", "none") for verdict in gone]
    undecided: list[Departure] = []
    spoiled = [verdict for verdict in rows.extra if verdict.quantity == UNIT_QUATERNION]
    other_rows = [verdict for verdict in rows.extra if verdict not in spoiled]
    changes = [_row(verdict, "a row of the baseline", "a new one") for verdict in other_rows]
    changes += [_row(verdict, "a row that fails", "none: it is mended") for verdict in mended]
    changes += _machines(rows.absent)
    for old, new in rows.shared:
        other = list(_other_question(old, new))
        grown = [] if other else list(_regressions(old, new))
        undecided += other
        regressions += grown
        # Of a verdict that is worse the other numbers are the consequence.
        changes += [] if other or grown else departures(old, new)
    regressions += [_row(verdict, "no such row", "one that fails") for verdict in spoiled]
    return Held(len(rows.shared), tuple(regressions), tuple(undecided), tuple(changes))


def decided_alone(held: Held, baseline: Iterable[Verdict], made: Iterable[Verdict]) -> Held:
    """Return the comparison ``held``, made to decide alone, whatever the gates of the rows made say.

    A row that failed and has no finite error is a regression, though the baseline has none either. A row
    that shows nothing cannot be compared: it is undecided, vacuous or refused, or it fails and is new.
    """
    known = {_name(verdict) for verdict in baseline}
    told_of = {(d.scene, d.rung, d.quantity) for d in (*held.regressions, *held.undecided)}
    lost, unshown = [], []
    for verdict in made:
        status = exit_status([verdict])
        if status == 0 or _name(verdict) in told_of:
            continue
        if status != 1:
            got = f"{verdict.verdict} ({verdict.because})"
            unshown.append(departure(verdict, "", "a row that shows something", got))
        elif finite(verdict, "max") is None:
            lost.append(departure(verdict, "max", "a finite error", told(None)))
        elif _name(verdict) not in known:
            unshown.append(_row(verdict, "a row of the baseline", "a new one that fails"))
    regressions, undecided = (*held.regressions, *lost), (*held.undecided, *unshown)
    return Held(held.compared, regressions, undecided, held.changes)


def _name(verdict: Verdict) -> tuple[str, str, str]:
    return verdict.scene, verdict.rung, verdict.quantity


def _compared(verdicts: Iterable[Verdict]) -> Iterator[Verdict]:
    """All rows but that of the extent of an answer, which its own call has asked for or not."""
    return (verdict for verdict in verdicts if verdict.quantity != COMPLETE)


def _other_question(old: Verdict, new: Verdict) -> Iterator[Departure]:
    if old.provenance.get("scene") != new.provenance.get("scene"):
        yield departure(new, "scene", "the text that the baseline was made of", "another")
    if _is_other_span(old, new):
        yield departure(new, "last time", told(old.until), told(new.until))
    for name in ("unit", "roundoff"):
        was, now = getattr(old, name), getattr(new, name)
        # A run that came to no comparison has neither.
        if was and now and was != now:
            yield departure(new, name, str(was), str(now))


def _is_other_span(old: Verdict, new: Verdict) -> bool:
    """Return True where the last time that was judged is another one: a longer run has larger errors."""
    return old.until is not None and new.until is not None and old.until != new.until


def _regressions(old: Verdict, new: Verdict) -> Iterator[Departure]:
    if _grade(new) > _grade(old) and not _have_unlike_tolerances(old, new):
        yield departure(new, "verdict", old.verdict.value, new.verdict.value)
    grown = [(name, *found) for name in ERRORS if (found := _grown(old, new, name)) is not None]
    if grown:
        # They grow together: the first has the figures, the others are named.
        name, limit, got = grown[0]
        others = ", ".join(other for other, *_ in grown[1:])
        yield departure(new, f"{name} (and {others})" if others else name, limit, got)


def _have_unlike_tolerances(old: Verdict, new: Verdict) -> bool:
    """Return True for two comparisons by unlike gates, of which neither verdict tells of the other."""
    return old.is_compared and new.is_compared and old.tolerance != new.tolerance


def _grown(old: Verdict, new: Verdict, name: str) -> tuple[str, str] | None:
    """What was expected of an error that is beyond it, and what came."""
    was, now = finite(old, name), finite(new, name)
    level = LEVEL * (1.0 if name == "ratio" else _attainable(old, new))
    return (_limit(was, level), told(now)) if has_grown(was, now, level) else None


def _grade(verdict: Verdict) -> int:
    return _GRADES.index(exit_status([verdict]))


def _attainable(old: Verdict, new: Verdict) -> float:
    """What is attainable in the former number of steps."""
    before, now = (finite(row, "attainable") or 0.0 for row in (old, new))
    steps = old.steps / new.steps if 0 < old.steps < new.steps else 1.0
    return max(before, math.sqrt(steps) * now)


def _limit(was: float | None, level: float) -> str:
    if was is None:
        return told(was)
    limit = FACTOR * max(was, level)
    larger = f"the larger of the baseline's {was:.3g} and {LEVEL:g} attainable, {level:.3g}"
    return f"at most {limit:.3g} ({FACTOR:g} x {larger}: rounding explains no more)"


def _machines(absent: Iterable[Verdict]) -> Iterator[Departure]:
    for verdict in absent:
        if verdict.verdict is Status.UNAVAILABLE:
            yield _row(verdict, "the rung on both machines", "it on one: not compared")


def _row(verdict: Verdict, expected: str, got: str) -> Departure:
    return departure(verdict, "", expected, got)


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
        rows = tuple(placed.values())
        _check_once(rows)
    except ValueError as fault:
        raise ValueError(f"{fault} @ {file}") from fault
    return rows


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


def _check_once(found: Iterable[Verdict]) -> None:
    rows = Counter((v.scene, v.solver, v.setting, v.rung, v.quantity) for v in found)
    twice = [" ".join(filter(None, key)) for key, count in rows.items() if count > 1]
    if twice:
        raise ValueError(f"expected every row once, got more of {', '.join(twice)}")
