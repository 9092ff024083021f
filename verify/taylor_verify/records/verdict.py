"""A verdict: one row for one quantity of one run. Tables and pages are made from these alone."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

from taylor_verify.records.json_text import Count, Size, converted, finite, plain
from taylor_verify.records.quantities import COMPLETE, is_conserved
from taylor_verify.records.reason import NO_REASON, Cause, Reason, stated
from taylor_verify.records.status import Status


@dataclass(frozen=True)
class Verdict:
    """One compared quantity.

    ``max``, ``mean`` and ``final`` are errors in ``unit``, ``at`` the time of the largest; ``bound``
    and ``attainable`` hold at that time. ``ratio`` is the largest error over attainable of all
    samples (those before a vacuous gate's bound reached the size of the motion) and ``ratio_at`` its
    time: the gate asks each of them, so ``ratio`` decides.

    For a state quantity ``time_shift`` is the constant c with answer(t) ~ exact(t - c), in the unit of t
    and positive if the answer is late, and ``residual`` the largest error that it leaves, in ``unit``.
    ``shift`` is the course of the shift of time behind the error: constant, drifting, wandering, or none
    (it leaves more than a tenth). ``remains`` is the largest error that this course leaves, and ``trend``
    the shift per unit of time of one that drifts; both are None where no shift explains the error.

    A number that does not exist, or is not finite, is None.
    """

    scene: str
    solver: str
    rung: str
    setting: str
    quantity: str
    verdict: Status
    outcome: str
    max: Size | None = None
    mean: Size | None = None
    final: Size | None = None
    at: float | None = None
    unit: str = ""
    bound: Size | None = None
    reason: Reason = NO_REASON
    attainable: Size | None = None
    ratio: Size | None = None
    ratio_at: float | None = None
    time_shift: float | None = None
    residual: Size | None = None
    shift: str | None = None
    trend: float | None = None
    remains: Size | None = None
    roundoff: Size | None = None
    exponent: float | None = None
    steps: Count = 0
    evaluations: Count = 0
    seconds: Size | None = None
    provenance: dict[str, Any] = field(default_factory=dict)

    @property
    def because(self) -> str:
        """The reason of the bound, or why there is no number, in one line."""
        return str(self.reason)

    @property
    def is_conserved(self) -> bool:
        """True for the row of a conserved quantity."""
        return is_conserved(self.quantity)

    @property
    def is_waived(self) -> bool:
        """True for the row of what an answer lacks, where the caller asked for a part alone."""
        return self.quantity == COMPLETE and self.verdict is Status.VACUOUS

    @property
    def is_compared(self) -> bool:
        """True if a comparison was made: a run that never came to one has no time of an error."""
        return self.at is not None

    def row(self) -> dict[str, Any]:
        """Return the row as JSON holds it: no NaN, no infinity, the reason also as a sentence.

        Its ``provenance`` is the verdict's own.
        """
        found: dict[str, Any] = {}
        for name, value in vars(self).items():
            if name == "reason":
                found |= {"because": self.because, "reason": plain(value)}
            else:
                found[name] = finite(value)
        return found


def read_row(row: Mapping[str, Any]) -> Verdict:
    """Return the verdict that a row holds; keys that a verdict has not are left out.

    A row that says its reason in a sentence alone has that sentence as its remark. Raises ValueError, with
    the place in the row, for a row that is none.
    """
    if "reason" not in row and row.get("because"):
        row = {**row, "reason": plain(stated(Cause.STATED, str(row["because"])))}
    return converted(row, Verdict)


def summary(verdicts: Iterable[Verdict]) -> dict[str, int]:
    """Return the number of verdicts of each status, every status named."""
    counts = {status.value: 0 for status in Status}
    for verdict in verdicts:
        counts[verdict.verdict.value] += 1
    return counts


def exit_status(verdicts: Iterable[Verdict]) -> int:
    """Return 0 if nothing failed, 1 if a gate failed, 3 if something is undecided and nothing failed.

    A scene that the arithmetic had to refuse, or whose gate is vacuous, is no pass either: here both
    count as undecided. Where such verdicts are expected, `taylor_verify.expected` knows of it. A part that
    the caller has waived counts for nothing.
    """
    found = {verdict.verdict for verdict in verdicts if not verdict.is_waived}
    if Status.FAIL in found:
        return 1
    return 3 if found & {Status.UNDECIDED, Status.REFUSED, Status.VACUOUS} else 0
