"""The one comparison of two sets of verdicts: what got worse, what got better, and what else differs.

Fused multiplications, vector widths and elementary functions differ between processors. So a sound run has
other roundings there, and its error is another draw from the same random walk. Two errors that may be such
draws are in one rounding class, and do not differ:

    max, mean, final, ratio     worse if now > FACTOR max(before, LEVEL attainable); better in reverse
    verdict                     worse or better in the grades of the exit status: pass, open, fail
    row                         worse if it is gone: what is no longer compared is no longer right
    scene, last time,           another question: nothing can be said
    unit, roundoff
    steps, evaluations a step   changed beyond a tenth (or two steps)
    bound, attainable           likewise, where both maxima are at the same time
    outcome, a new row          changed

A caller chooses which of these fail. From a baseline only what is worse does, and another question is
undecided. A published number must neither grow nor shrink: every difference fails. Of a row with another
question, or of one that is worse, nothing else is said: it would be a consequence.

(``ratio`` is in units of attainable already.) `attainable` is the roundoff floor for the *former* number of
steps. The floor grows as the square root of the steps, and more steps must not excuse a larger error. The
larger of two values is taken, the former floor and sqrt(former steps / steps now) times the present floor,
because the two maxima may be at different times. NaN and infinity are beyond every number. A verdict by
another tolerance is neither worse nor better; the errors are still compared. ``time_shift``, ``residual``,
``shift``, ``trend`` and ``remains`` are not compared: for a gate that passed, they are read from roundings
alone, whose sign and course in time differ from run to run.

FACTOR and LEVEL come from the distribution of the maximum of a random walk, in units of its standard
deviation, which is `attainable`. A maximum can be small by chance: the error of an orbit with one
unstable direction is its magnified first roundings, and a Gaussian is below x with probability
0.8 x. So two errors may have any ratio, and all errors below LEVEL count as LEVEL. A maximum is not
large by chance: an error leaves its class only where one of the two errors is beyond FACTOR LEVEL = 5
attainable at its own time. The probability of this is 4 Q(5) = 1.1e-6 for a walk and 2 Q(5) = 5.7e-7 for
a single Gaussian, where Q is the Gaussian tail; if every sample of N steps is asked, it is at most
25 Q(5) ln N = 5e-5 for N = 1000. The other error is then below a tenth of the first. For the
maximum over all samples this alone is rarer than one in twenty. So a change of processor raises a false
alarm with probability at most 5e-6 per row, and once in two hundred tables of a thousand rows. On the
same processor all numbers are equal to the last bit, and there is no false alarm. All this assumes
that a solver's walk has no larger steps than attainable counts, which ``ratio`` near 1 confirms.

A step is the p-th root of the size of a Taylor coefficient, p >= 9: coefficients would have to change
by a factor of two to change the steps by a tenth. MPFR rounds its operations and its elementary functions
correctly, so that mpN should give the same numbers on every processor. Until measurements confirm this,
mpN has the same class as the others.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from enum import StrEnum
from typing import Any, Final

from taylor_verify.records.json_text import finite
from taylor_verify.records.quantities import COMPLETE, SOUND_ATTITUDE
from taylor_verify.records.status import Status
from taylor_verify.records.verdict import Verdict, exit_status
from taylor_verify.solvers.trajectory import Outcome

FACTOR: Final = 10.0
LEVEL: Final = 0.5
# The relative slack of steps, evaluations, attainable and bound.
SLACK: Final = 0.1
FEW_STEPS: Final = 2

ERRORS: Final = ("max", "mean", "final", "ratio")
# From the best: 0 all passed, 3 nothing shown, 1 failed.
_GRADES: Final = (0, 3, 1)


class Direction(StrEnum):
    """The direction of a difference, as seen from the earlier verdicts."""

    WORSE = "worse"
    BETTER = "better"
    CHANGED = "changed"
    OTHER_QUESTION = "another question"
    UNAVAILABLE = "unavailable on one machine"


@dataclass(frozen=True)
class Difference:
    """A row or number that differs from the earlier one; ``what`` is empty for a whole row.

    ``solver`` and ``setting`` are those of its run.
    """

    scene: str
    rung: str
    quantity: str
    what: str
    expected: str
    got: str
    solver: str
    setting: str
    direction: Direction

    @classmethod
    def of(
        cls, verdict: Verdict, direction: Direction, expected: str, got: str, what: str = ""
    ) -> Difference:
        """Return the difference of a row, or of its number ``what``."""
        return cls(
            *row_of(verdict), what, expected, got, verdict.solver, verdict.setting, direction
        )

    def __str__(self) -> str:
        place = " ".join(part for part in (self.scene, self.rung, self.quantity, self.what) if part)
        # Rows of several files of one scene differ in the setting alone.
        run = f" ({self.setting})" if self.setting else ""
        return f"expected {self.expected}, got {self.got} @ {place}{run}"


@dataclass(frozen=True)
class Differences:
    """The number of rows that were compared, and all differences between them."""

    compared: int
    all: tuple[Difference, ...]

    def towards(self, *directions: Direction) -> tuple[Difference, ...]:
        """Return the differences in some directions."""
        return tuple(each for each in self.all if each.direction in directions)

    @property
    def departures(self) -> tuple[Difference, ...]:
        """Whatever left the rounding class of its published row, upwards or downwards."""
        return tuple(each for each in self.all if each.direction is not Direction.UNAVAILABLE)


def compare(before: Iterable[Verdict], now: Iterable[Verdict]) -> Differences:
    """Compare every row of ``now`` with that of ``before`` for its scene, solver, setting, rung, quantity.

    A row that exists on one side only is a difference. A run on a rung that one of the two machines does
    not have is named and not compared; one that a solver is not suited for, or whose package is gone, is.
    """
    # Whether the row COMPLETE exists depends on the options of each call, so it is not compared.
    old, new = ([v for v in rows if v.quantity != COMPLETE] for rows in (before, now))
    lacking = {v.run for v in (*old, *new) if _lacks_rung(v)}
    earlier, later = (
        {(v.run, v.quantity): v for v in rows if v.run not in lacking} for rows in (old, new)
    )
    differing = [_missing(v) for key, v in earlier.items() if key not in later]
    runs = {run for run, _ in earlier}
    differing += [_new(v, v.run in runs) for key, v in later.items() if key not in earlier]
    differing += [
        Difference.of(v, Direction.UNAVAILABLE, "the rung on both machines", "it on one")
        for v in (*old, *new)
        if _lacks_rung(v)
    ]
    shared = [(earlier[key], v) for key, v in later.items() if key in earlier]
    differing += [each for pair in shared for each in _decisive(*pair)]
    return Differences(len(shared), tuple(differing))


def _lacks_rung(verdict: Verdict) -> bool:
    return verdict.verdict is Status.UNAVAILABLE and verdict.outcome == Outcome.NO_FORMAT.value


def _missing(verdict: Verdict) -> Difference:
    # The soundness of an attitude has a row only where it fails: a sound run has none.
    if verdict.quantity in SOUND_ATTITUDE:
        return Difference.of(verdict, Direction.BETTER, "a row that fails", "none: it is mended")
    return Difference.of(verdict, Direction.WORSE, "this row", "none")


def _new(verdict: Verdict, was_run: bool) -> Difference:
    is_lost = was_run and verdict.quantity in SOUND_ATTITUDE
    direction = Direction.WORSE if is_lost else Direction.CHANGED
    return Difference.of(
        verdict, direction, "no such row", "one that fails" if is_lost else "a new one"
    )


def _decisive(old: Verdict, new: Verdict) -> list[Difference]:
    """Return the differences of a row that are no consequences of another one."""
    differing = list(_of_row(old, new))
    for direction in (Direction.OTHER_QUESTION, Direction.WORSE):
        if chosen := [each for each in differing if each.direction is direction]:
            return chosen
    return differing


def _of_row(old: Verdict, new: Verdict) -> Iterator[Difference]:
    yield from _of_question(old, new)
    if old.verdict is not new.verdict:
        words = old.verdict.value, new.verdict.value
        yield Difference.of(new, _direction_of_verdict(old, new), *words, "verdict")
        if Status.UNAVAILABLE in (old.verdict, new.verdict):
            return
    if old.outcome != new.outcome:
        yield Difference.of(new, Direction.CHANGED, old.outcome, new.outcome, "outcome")
    yield from _of_cost(old, new)
    yield from _of_errors(old, new)


def _of_question(old: Verdict, new: Verdict) -> Iterator[Difference]:
    other = Direction.OTHER_QUESTION
    if old.provenance.get("scene") != new.provenance.get("scene"):
        yield Difference.of(new, other, "the same text of the scene", "another", "scene")
    # A longer run has larger errors.
    if None not in (old.until, new.until) and old.until != new.until:
        times = format_number(old.until), format_number(new.until)
        yield Difference.of(new, other, *times, "last time")
    for name in ("unit", "roundoff"):
        was, now = getattr(old, name), getattr(new, name)
        if was != now:
            # A run that was not compared has neither.
            direction = other if was and now else Direction.CHANGED
            yield Difference.of(new, direction, str(was), str(now), name)


def _direction_of_verdict(old: Verdict, new: Verdict) -> Direction:
    # Verdicts by different tolerances cannot be compared with each other.
    if old.tolerance != new.tolerance and old.is_compared and new.is_compared:
        return Direction.CHANGED
    if Status.UNAVAILABLE in (old.verdict, new.verdict):
        return Direction.WORSE if new.verdict is Status.UNAVAILABLE else Direction.BETTER
    was, now = (_GRADES.index(exit_status([verdict])) for verdict in (old, new))
    return Direction.CHANGED if was == now else Direction.WORSE if now > was else Direction.BETTER


def _of_cost(old: Verdict, new: Verdict) -> Iterator[Difference]:
    """Yield what changed in the cost, and in what is allowed at the same time."""
    sizes: list[tuple[str, Any, Any]] = [("steps", old.steps, new.steps)]
    if old.steps and new.steps:
        # Evaluations a step show the order of the method.
        a_step = old.evaluations / old.steps, new.evaluations / new.steps
        sizes.append(("evaluations a step", *a_step))
    if old.at == new.at:
        sizes += [(n, getattr(old, n), getattr(new, n)) for n in ("attainable", "bound")]
    for name, was, now in sizes:
        if not _is_like(was, now, FEW_STEPS if name == "steps" else 0.0):
            expected = f"{format_number(was)} within {SLACK:.0%}"
            yield Difference.of(new, Direction.CHANGED, expected, format_number(now), name)


def _is_like(was: float | None, now: float | None, few: float) -> bool:
    """Return True if a number changed by at most a tenth of itself, or by at most ``few``."""
    if was is None or now is None:
        return was is now
    return abs(now - was) <= max(few, SLACK * min(abs(now), abs(was)))


def _of_errors(old: Verdict, new: Verdict) -> Iterator[Difference]:
    """Yield the growth of a row's errors and their decrease, one difference for each.

    The errors of a row grow together: the figures of the first suffice, the others are named.
    """
    attainable = _attainable(old, new)
    grown: list[tuple[str, str, str]] = []
    shrunk: list[tuple[str, str, str]] = []
    for name in ERRORS:
        was, now = finite(getattr(old, name)), finite(getattr(new, name))
        level = LEVEL * (1.0 if name == "ratio" else attainable)
        # An earlier error that is no number has nothing beyond it.
        if was is not None and has_grown(was, now, level):
            floors = f"{LEVEL:g} roundoff floors, {level:.3g}"
            larger = f"the larger of the earlier error {was:.3g} and {floors}"
            most = f"at most {FACTOR * max(was, level):.3g} ({FACTOR:g} x {larger})"
            grown.append((name, most, format_number(now)))
        elif has_grown(now, was, level):
            shrunk.append((name, _least(was), format_number(now)))
    for direction, errors in ((Direction.WORSE, grown), (Direction.BETTER, shrunk)):
        if errors:
            name, expected, got = errors[0]
            others = ", ".join(each for each, *_ in errors[1:])
            what = f"{name} (and {others})" if others else name
            yield Difference.of(new, direction, expected, got, what)


def has_grown(was: float | None, now: float | None, level: float) -> bool:
    """Return True if an error grew by more than its class allows. NaN and infinity count as growth."""
    if was is None or now is None:
        return now is None and was is not None
    return not now <= FACTOR * max(was, level)


def _least(was: float | None) -> str:
    if was is None:
        return format_number(was)
    return f"at least {was / FACTOR:.3g} (the earlier error {was:.3g} over {FACTOR:g})"


def _attainable(old: Verdict, new: Verdict) -> float:
    """Return the error that is attainable in the former number of steps."""
    before, now = (finite(row.attainable) or 0.0 for row in (old, new))
    steps = old.steps / new.steps if 0 < old.steps < new.steps else 1.0
    return max(before, math.sqrt(steps) * now)


def row_of(each: Verdict | Difference) -> tuple[str, str, str]:
    """Return scene, rung and quantity."""
    return each.scene, each.rung, each.quantity


def format_number(value: float | None) -> str:
    """Return a number in three digits as text; "no finite number" for None."""
    return "no finite number" if value is None else f"{value:.3g}"
