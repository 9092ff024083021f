"""The rounding class of a published number: what a run on another processor may make of it.

Fused multiplications, vector widths and elementary functions differ between processors, so that the
roundings of a run are drawn anew, and its error is another draw from the same random walk. What must
come again is therefore the verdict, the cost and the size of the error:

    verdict, outcome, unit, roundoff   the same
    steps, evaluations a step          within a tenth (or two steps)
    bound, attainable                  within a tenth, where both maxima are of the same time
    max, mean, final, ratio            new <= FACTOR max(old, LEVEL attainable), and the reverse

(``ratio`` is in units of attainable already; for the others the larger attainable of both counts.)
``time_shift``, ``residual``, ``shift``, ``trend`` and ``remains`` have no class. Of a gate that
passed they are read from roundings alone, whose sign and course in time are drawn anew: only those of a
failed gate are published.

FACTOR and LEVEL come from the distribution of the maximum of a random walk, in units of its standard
deviation, which attainable is. A maximum can be small by chance: the error of an orbit with one
unstable direction is its first roundings magnified, and a Gaussian is below x with probability
0.8 x. So no ratio of two errors is absurd, and below LEVEL all errors count as LEVEL. A large maximum
is no chance: an error leaves its class only where one of the two is beyond FACTOR LEVEL = 5
attainable at its own time. For a walk that is 4 Q(5) = 1.1e-6, for a single Gaussian
2 Q(5) = 5.7e-7, Q being the Gaussian tail; asked of every sample of N steps, at most
25 Q(5) ln N = 5e-5 for N = 1000. The other of the two is then below a tenth of it, which for the
maximum over all samples is itself rarer than one in twenty. So a row raises a false alarm at most
5e-6 times in a change of processor, and a table of a thousand rows once in two hundred; on
one and the same processor all is equal to the last bit, and there is none. This takes for granted
that a solver's walk has no larger steps than attainable counts, which ``ratio`` near 1 says.

A step is the p-th root of the size of a Taylor coefficient, p >= 9: for the steps to change by a
tenth, coefficients would have to change by a factor of two. Attainable grows as the root of the steps.

The operations of MPFR are rounded correctly, its elementary functions too, so that mpN ought to be
the same anywhere. Until that has been seen on unlike processors it has the same class as the rest.
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
# Of steps, evaluations, attainable and bound.
SLACK: Final = 0.1
FEW_STEPS: Final = 2

ERRORS: Final = ("max", "mean", "final", "ratio")
_SAME = ("verdict", "outcome", "unit", "roundoff")

Key = tuple[str, str, str, str]


@dataclass(frozen=True)
class Departure:
    """A row or number that is not what was published; ``what`` is empty for a whole row.

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
        # Several files of one scene have rows that differ in this alone.
        run = f" ({self.setting})" if self.setting else ""
        return f"expected {self.expected}, got {self.got} @ {place}{run}"


@dataclass(frozen=True)
class Comparison:
    """The number of rows that were compared with published ones, and the departures from them."""

    compared: int
    departures: tuple[Departure, ...]


def compare(published: Iterable[Verdict], made: Iterable[Verdict]) -> Comparison:
    """Compare every row made with its published one.

    A row of one side alone is a departure. Only runs on a rung that either machine does not have are
    left out: there is nothing to compare.
    """
    rows = paired(published, made)
    found = [Departure.of(verdict, "this row", "none") for verdict in rows.missing]
    found += [Departure.of(verdict, "no such row", "one") for verdict in rows.extra]
    found += [departure for pair in rows.shared for departure in departures(*pair)]
    return Comparison(len(rows.shared), tuple(found))


@dataclass(frozen=True)
class Paired:
    """Rows of before and of now: those of one side alone, and the pairs as (before, now).

    ``absent`` are rows of runs on a rung that one of the two machines does not have.
    """

    missing: tuple[Verdict, ...]
    extra: tuple[Verdict, ...]
    shared: tuple[tuple[Verdict, Verdict], ...]
    absent: tuple[Verdict, ...]


def paired(published: Iterable[Verdict], made: Iterable[Verdict]) -> Paired:
    """Return every row beside the one of the same scene, solver, setting, rung and quantity."""
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
    """Yield everything by which one row is out of the class of its published one."""
    if old.provenance.get("scene") != new.provenance.get("scene"):
        expected = "the scene as it was published (`make reports` publishes anew)"
        yield Departure.of(new, expected, "another text")
    for name in _SAME:
        was, now = getattr(old, name), getattr(new, name)
        if was != now:
            yield Departure.of(new, str(was), str(now), name)
    sizes: list[tuple[str, Any, Any]] = [("steps", old.steps, new.steps)]
    if old.steps and new.steps:
        # Their order.
        each = old.evaluations / old.steps, new.evaluations / new.steps
        sizes.append(("evaluations a step", *each))
    if old.at == new.at:
        sizes += [(n, getattr(old, n), getattr(new, n)) for n in ("attainable", "bound")]
    for name, was, now in sizes:
        if not _is_like(was, now, FEW_STEPS if name == "steps" else 0.0):
            yield Departure.of(new, f"{told(was)} within {SLACK:.0%}", told(now), name)
    # The maxima may be of unlike times; the later one, of more steps, has the larger floor.
    attainable = max(old.attainable or 0.0, new.attainable or 0.0)
    for name in ERRORS:
        was, now = finite(old, name), finite(new, name)
        level = LEVEL * (1.0 if name == "ratio" else attainable)
        if has_grown(was, now, level) or has_grown(now, was, level):
            expected = f"{told(was)} within a factor {FACTOR:g} (below {level:.3g} as {level:.3g})"
            yield Departure.of(new, expected, told(now), name)


def _is_like(was: float | None, now: float | None, few: float) -> bool:
    """Return True for a number within a tenth, or ``few``, of what it was."""
    if was is None or now is None:
        return was is now
    return abs(now - was) <= max(few, SLACK * min(abs(now), abs(was)))


def finite(verdict: Verdict, name: str) -> float | None:
    """Return a number of a verdict as its row has it: None for NaN and the infinities."""
    value: float | None = getattr(verdict, name)
    return value if value is not None and math.isfinite(value) else None


def has_grown(was: float | None, now: float | None, level: float) -> bool:
    """Return True if an error left its class upwards; to be no finite number is beyond every error."""
    if was is None or now is None:
        return now is None and was is not None
    return not now <= FACTOR * max(was, level)


def told(value: float | None) -> str:
    """Return a number in three digits, or that it is none."""
    return "no finite number" if value is None else f"{value:.3g}"
