"""A verdict: one row for one quantity of one run. Tables and pages are made from these alone."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, field
from enum import StrEnum
from typing import Any, Final

# The quantities that say where the body is; all others compared are conserved.
STATES: Final = ("omega", "impulse", "attitude", "centre")
# Two rows that compare no quantity of their own: the start alone, and the extent of an answer.
INITIAL: Final = "initial state"
COMPLETE: Final = "complete"


def is_conserved(quantity: str) -> bool:
    """Whether a row of this name is that of a conserved quantity."""
    return quantity not in (*STATES, INITIAL, COMPLETE)


class Status(StrEnum):
    """What a gate said. Only PASS is green."""

    PASS = "pass"
    FAIL = "fail"
    UNDECIDED = "undecided"
    VACUOUS = "vacuous"
    REFUSED = "refused"
    UNAVAILABLE = "unavailable"


@dataclass(frozen=True)
class Verdict:
    """One compared quantity.

    ``max``, ``mean`` and ``final`` are errors in ``unit``, ``at`` the time of the largest; ``bound``
    and ``attainable`` hold at that time. ``ratio`` is the largest error over attainable of all
    samples (those before a vacuous gate's bound reached the size of the motion) and ``ratio_at`` its
    time: the gate asks each of them, so ``ratio`` decides. For a state
    quantity ``time_shift`` is the constant c with answer(t) ~ exact(t - c), in the unit of t and
    positive if the answer is late, and ``residual`` the largest error that it leaves, in ``unit``.
    ``shift`` says what a shift of time makes of the error: constant, drifting, wandering, or none (it
    leaves more than a tenth). ``remains`` is the largest error that this course leaves, and ``trend`` the
    shift per unit of time of one that drifts; both are None where no shift explains the error. A
    number that does not exist, or is not finite, is None.
    """

    scene: str
    solver: str
    rung: str
    setting: str
    quantity: str
    verdict: Status
    outcome: str
    max: float | None = None
    mean: float | None = None
    final: float | None = None
    at: float | None = None
    unit: str = ""
    bound: float | None = None
    because: str = ""
    attainable: float | None = None
    ratio: float | None = None
    ratio_at: float | None = None
    time_shift: float | None = None
    residual: float | None = None
    shift: str | None = None
    trend: float | None = None
    remains: float | None = None
    roundoff: float | None = None
    exponent: float | None = None
    steps: int = 0
    evaluations: int = 0
    seconds: float | None = None
    provenance: dict[str, Any] = field(default_factory=dict)

    @property
    def is_conserved(self) -> bool:
        """Whether the row is that of a conserved quantity."""
        return is_conserved(self.quantity)

    @property
    def is_waived(self) -> bool:
        """Whether the row says what an answer lacks to a caller who asked for a part of it."""
        return self.quantity == COMPLETE and self.verdict is Status.VACUOUS

    def row(self) -> dict[str, Any]:
        """The row as JSON holds it: no NaN, no infinity. Its ``provenance`` is the verdict's own."""
        return {name: _json_number(value) for name, value in vars(self).items()}


def summary(verdicts: Iterable[Verdict]) -> dict[str, int]:
    """How many verdicts of each status, every status named."""
    counts = {status.value: 0 for status in Status}
    for verdict in verdicts:
        counts[verdict.verdict.value] += 1
    return counts


def exit_status(verdicts: Iterable[Verdict]) -> int:
    """0 if nothing failed, 1 if a gate failed, 3 if nothing failed but something is undecided.

    A scene that the arithmetic had to refuse, or whose gate is vacuous, is no pass either: here both
    count as undecided. Where such verdicts are expected, `batch.expectations` knows of it. A part that
    the caller has waived counts for nothing.
    """
    found = {verdict.verdict for verdict in verdicts if not verdict.is_waived}
    if Status.FAIL in found:
        return 1
    return 3 if found & {Status.UNDECIDED, Status.REFUSED, Status.VACUOUS} else 0


def _json_number(value: Any) -> Any:
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value
