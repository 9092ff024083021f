"""The rounding class of a published number: the values that another processor may give.

Fused multiplications, vector widths and elementary functions differ between processors. So a run has
other roundings there, and its error is another draw from the same random walk. These must agree: the
verdict, the cost and the size of the error:

    verdict, outcome, unit, roundoff   the same
    steps, evaluations a step          within a tenth (or two steps)
    bound, attainable                  within a tenth, where both maxima are at the same time
    max, mean, final, ratio            new <= FACTOR max(old, LEVEL attainable), and the reverse

(``ratio`` is in units of attainable already; for the others the larger attainable of both counts.)
``time_shift``, ``residual``, ``shift``, ``trend`` and ``remains`` have no class. For a gate that passed,
they are read from roundings alone, whose sign and course in time differ from run to run. Only those of
a failed gate are published.

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
by a factor of two to change the steps by a tenth. Attainable grows as the square root of the steps.

MPFR rounds its operations and its elementary functions correctly, so that mpN should give the same
numbers on every processor. Until measurements confirm this, mpN has the same class as the others.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Any, Final

from taylor_verify.records.status import Status
from taylor_verify.records.verdict import Verdict

FACTOR: Final = 10.0
LEVEL: Final = 0.5
# The relative slack of steps, evaluations, attainable and bound.
SLACK: Final = 0.1
FEW_STEPS: Final = 2

ERRORS: Final = ("max", "mean", "final", "ratio")
_SAME = ("verdict", "outcome", "unit", "roundoff")

Key = tuple[str, str, str, str]


@dataclass(frozen=True)
class Departure:
    """A row or number that differs from the published one; ``what`` is empty for a whole row.

    ``solver`` and ``setting`` are those of its run.
    """

    scene: str
    rung: str
    quantity: str
    what: str
    expected: str
    got: str
    solver: str = ""
    setting: str = ""

    @classmethod
    def of(cls, verdict: Verdict, expected: str, got: str, what: str = "") -> Departure:
        """Return the departure of a row, or of its number ``what``."""
        row = verdict.scene, verdict.rung, verdict.quantity
        return cls(*row, what, expected, got, verdict.solver, verdict.setting)

    def __str__(self) -> str:
        place = " ".join(part for part in (self.scene, self.rung, self.quantity, self.what) if part)
        # Rows of several files of one scene differ in the setting alone.
        run = f" ({self.setting})" if self.setting else ""
        return f"expected {self.expected}, got {self.got} @ {place}{run}"


@dataclass(frozen=True)
class Comparison:
    """The number of rows that were compared with published ones, and the departures from them."""

    compared: int
    departures: tuple[Departure, ...]


def compare(published: Iterable[Verdict], made: Iterable[Verdict]) -> Comparison:
    """Compare every new row with its published row.

    A row that exists on one side only is a departure. Runs on a rung that one of the machines does not have
    are left out, because there is nothing to compare.
    """
    rows = paired(published, made)
    departures_of_all = [Departure.of(verdict, "this row", "none") for verdict in rows.missing]
    departures_of_all += [Departure.of(verdict, "no such row", "one") for verdict in rows.extra]
    departures_of_all += [departure for pair in rows.shared for departure in departures(*pair)]
    return Comparison(len(rows.shared), tuple(departures_of_all))


@dataclass(frozen=True)
class Paired:
    """Former and present rows: those that exist on one side only, and the pairs (before, now).

    ``absent`` are rows of runs on a rung that one of the two machines does not have.
    """

    missing: tuple[Verdict, ...]
    extra: tuple[Verdict, ...]
    shared: tuple[tuple[Verdict, Verdict], ...]
    absent: tuple[Verdict, ...]


def paired(published: Iterable[Verdict], made: Iterable[Verdict]) -> Paired:
    """Pair every row with the row of the same scene, solver, setting, rung and quantity."""
    old, new = list(published), list(made)
    unavailable = {_run(v) for v in (*old, *new) if v.verdict is Status.UNAVAILABLE}
    before, after = (
        {(_run(v), v.quantity): v for v in rows if _run(v) not in unavailable}
        for rows in (old, new)
    )
    return Paired(
        missing=tuple(v for key, v in before.items() if key not in after),
        extra=tuple(v for key, v in after.items() if key not in before),
        shared=tuple((before[key], v) for key, v in after.items() if key in before),
        absent=tuple(v for v in (*old, *new) if _run(v) in unavailable),
    )


def _run(verdict: Verdict) -> Key:
    return verdict.scene, verdict.solver, verdict.setting, verdict.rung


def departures(old: Verdict, new: Verdict) -> Iterator[Departure]:
    """Yield every departure of a row from the class of its published row."""
    if old.provenance.get("scene") != new.provenance.get("scene"):
        expected = "the scene as it was published (`make reports` publishes anew)"
        yield Departure.of(new, expected, "another text")
    for name in _SAME:
        was, now = getattr(old, name), getattr(new, name)
        if was != now:
            yield Departure.of(new, str(was), str(now), name)
    sizes: list[tuple[str, Any, Any]] = [("steps", old.steps, new.steps)]
    if old.steps and new.steps:
        # Evaluations a step show the order of the method.
        evaluations_per_step = old.evaluations / old.steps, new.evaluations / new.steps
        sizes.append(("evaluations a step", *evaluations_per_step))
    if old.at == new.at:
        sizes += [(n, getattr(old, n), getattr(new, n)) for n in ("attainable", "bound")]
    for name, was, now in sizes:
        if not _is_like(was, now, FEW_STEPS if name == "steps" else 0.0):
            yield Departure.of(
                new, f"{format_number(was)} within {SLACK:.0%}", format_number(now), name
            )
    # The maxima may be at different times; the later one, after more steps, has the larger floor.
    attainable = max(old.attainable or 0.0, new.attainable or 0.0)
    for name in ERRORS:
        was, now = finite(old, name), finite(new, name)
        level = LEVEL * (1.0 if name == "ratio" else attainable)
        if has_grown(was, now, level) or has_grown(now, was, level):
            expected = f"{format_number(was)} within a factor {FACTOR:g} (below {level:.3g} as {level:.3g})"
            yield Departure.of(new, expected, format_number(now), name)


def _is_like(was: float | None, now: float | None, few: float) -> bool:
    """Return True if a number changed by at most a tenth of itself, or by at most ``few``."""
    if was is None or now is None:
        return was is now
    return abs(now - was) <= max(few, SLACK * min(abs(now), abs(was)))


def finite(verdict: Verdict, name: str) -> float | None:
    """Return a number of a verdict as it is stored in its row: None for NaN and the infinities."""
    value: float | None = getattr(verdict, name)
    return value if value is not None and math.isfinite(value) else None


def has_grown(was: float | None, now: float | None, level: float) -> bool:
    """Return True if an error grew by more than its class allows. NaN and infinity count as growth."""
    if was is None or now is None:
        return now is None and was is not None
    return not now <= FACTOR * max(was, level)


def format_number(value: float | None) -> str:
    """Return a number in three digits as text; "no finite number" for None."""
    return "no finite number" if value is None else f"{value:.3g}"
