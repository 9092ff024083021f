"""Document of the hard scenes: verdicts, the worst of each family, and the reach of each precision."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from itertools import takewhile
from typing import Any, Final

from taylor_verify.records import store
from taylor_verify.records.answers import LeftOut
from taylor_verify.records.json_text import complete, plain
from taylor_verify.records.provenance import Machine, Provenance
from taylor_verify.records.quantities import GATE_FACTOR
from taylor_verify.records.status import Status
from taylor_verify.records.verdict import Verdict
from taylor_verify_reports.studies.stored import Stored


@dataclass(frozen=True)
class Expected:
    """The verdict that is expected of a row of a scene other than a pass, and the reason."""

    scene: str
    rung: str
    quantity: str
    verdict: Status
    why: str


@dataclass(frozen=True)
class Titled:
    """A scene and its title."""

    scene: str
    title: str


@dataclass(frozen=True)
class Search:
    """A search with ``runs`` runs in each family, drawn from ``seed``; a gate stands at ``factor``."""

    rung: str
    runs: int
    seed: int
    provenance: Provenance
    factor: int = GATE_FACTOR


@dataclass(frozen=True)
class WorstOfFamily:
    """The worst scene of one family, by the name ``scene``.

    ``what`` says what the scenes of the family are, ``judged`` is the number of judged scenes. ``ratio`` is
    the error over attainable of ``quantity``, and ``max`` its error, None if it is no number.
    """

    name: str
    what: str
    judged: int
    ratio: float
    quantity: str
    verdict: Status
    max: float | None
    scene: str


@dataclass(frozen=True)
class ReachFamily:
    """A family of motions: the texts of its values, the easiest first, and the most periods on each rung.

    In a family without a ``symbol`` only the number of periods varies.
    """

    name: str
    title: str
    symbol: str
    values: tuple[str, ...]
    rungs: dict[str, int]


@dataclass(frozen=True)
class ReachRow:
    """The errors of one member of a family on a rung, after each number of ``periods``.

    ``errors`` and ``floors`` are the largest relative errors up to that number of periods: achieved, and
    attainable. They are None for a lost motion (infinite during the measurement). ``floors`` is shorter
    than ``periods`` if no rung was followed so far. If nothing was run, both are empty, and ``why`` is the
    reason.
    """

    family: str
    value: str
    rung: str
    periods: tuple[int, ...]
    errors: tuple[float | None, ...] = ()
    floors: tuple[float | None, ...] = ()
    steps: int = 0
    why: str = ""


# The two rows of numbers of a ReachRow.
ACHIEVED: Final = "errors"
ATTAINABLE: Final = "floors"
# A motion with so large an error is lost: it leaves no digit, and a longer run would show nothing new.
LOST: Final = 1.0


@dataclass(frozen=True)
class HardStudy:
    """Verdicts with their mismatches in words, the worst scenes of a search, and the rows of the reach."""

    versions: dict[str, str]
    machine: Machine
    scenes: tuple[Titled, ...]
    left_out: tuple[LeftOut, ...]
    expected: tuple[Expected, ...]
    mismatches: tuple[str, ...]
    families: tuple[ReachFamily, ...]
    reach: tuple[ReachRow, ...]
    verdicts: tuple[Verdict, ...]
    search: Search | None = None
    worst: tuple[WorstOfFamily, ...] = field(default=())

    @cached_property
    def titles(self) -> dict[str, str]:
        """The title of each scene."""
        return {titled.scene: titled.title for titled in self.scenes}

    @cached_property
    def _expected(self) -> dict[tuple[str, str, str], Expected]:
        return {(row.scene, row.rung, row.quantity): row for row in self.expected}

    def expectation(self, verdict: Verdict) -> Expected | None:
        """Return what is expected of a row; None if that is a pass, or nothing."""
        return self._expected.get((verdict.scene, verdict.rung, verdict.quantity))

    def is_met(self, verdict: Verdict) -> bool:
        """Return True for a row that is as expected, and for one that this machine could not run."""
        wanted = self.expectation(verdict)
        if wanted is None:
            return verdict.verdict in (Status.PASS, Status.UNAVAILABLE)
        return wanted.verdict is verdict.verdict

    def reach_of(self, family: str, rung: str) -> list[ReachRow]:
        """Return the rows of a family on a rung, the easiest value first."""
        return [row for row in self.reach if (row.family, row.rung) == (family, rung)]


def _fields(study: HardStudy) -> dict[str, Any]:
    """Return the stored keys and values without the seconds of runs, which differ between machines."""
    rows = [store.row(verdict) for verdict in study.verdicts]
    return {**complete(study), "machine": plain(study.machine), "verdicts": rows}


HARD: Final = Stored(HardStudy, "hard", _fields)


def last_value(
    rows: Sequence[ReachRow], after: int, digits: int, key: str = ACHIEVED
) -> str | None:
    """Return the last value up to which ``digits`` are left after ``after`` periods; None if there is none.

    ``rows`` are those of one family on one rung, the easiest value first. ``key`` is ACHIEVED or
    ATTAINABLE.
    """
    precise = list(takewhile(lambda row: _leaves(row, after, digits, key), rows))
    return precise[-1].value if precise else None


def most_periods(row: ReachRow, digits: int, key: str = ACHIEVED) -> int | None:
    """Return the most periods after which ``digits`` are left; None if the fewest periods leave fewer."""
    precise = list(takewhile(lambda count: _leaves(row, count, digits, key), row.periods))
    return precise[-1] if precise else None


def _leaves(row: ReachRow, after: int, digits: int, key: str) -> bool:
    """Return True if the error after so many periods is a number and leaves so many digits."""
    error = dict(zip(row.periods, getattr(row, key), strict=False)).get(after)
    return error is not None and error <= 10.0**-digits
