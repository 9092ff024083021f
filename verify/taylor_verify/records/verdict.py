"""The verdict: a row for a quantity of a run. Tables and pages are made from verdicts alone."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field, fields
from math import floor, inf, log10
from typing import Annotated, Any

from taylor_verify.records import status
from taylor_verify.records.error_kind import ErrorKind
from taylor_verify.records.json_text import Count, Size, about, finite, plain
from taylor_verify.records.quantities import COMPLETE, is_conserved
from taylor_verify.records.reason import NO_REASON, Reason
from taylor_verify.records.sentence import sentence
from taylor_verify.records.status import Status


@dataclass(frozen=True)
class Verdict:
    """The verdict on a compared quantity of a run.

    A number that does not exist, or is not finite, is None. ``bound`` and ``attainable`` hold at the time
    of the largest error; the gate asks every sample, so that ``ratio`` decides (of a vacuous gate: the
    samples before its bound reached the size of the motion).
    """

    scene: Annotated[str, about("The name of a shipped scene, or the path of a scene file.")]
    solver: str
    rung: Annotated[str, about("f32, f64, f80, f128 or mpN, N the bits.")]
    setting: Annotated[str, about("Tells two uses of one solver apart.")]
    quantity: Annotated[
        str,
        about(
            "initial state; omega, impulse, attitude, centre; T, H2, F2, FG, y3, H_space and so on; "
            "complete, where a file lacks a part of what the scene asks."
        ),
    ]
    verdict: Status
    outcome: Annotated[str, about("How the solver ended.")]
    max: Annotated[Size | None, about("The largest error of all samples, in unit.")] = None
    mean: Annotated[Size | None, about("The mean error of all samples.")] = None
    final: Annotated[Size | None, about("The error of the last sample.")] = None
    at: Annotated[float | None, about("The time of the largest error.")] = None
    unit: Annotated[str, about("What an error of 1 is.")] = ""
    bound: Annotated[Size | None, about("What is allowed at the time of the largest error.")] = None
    tolerance: Annotated[
        Size | None,
        about(
            "The tolerance that was asked for: it is the bound, and max decides. Null where the bound "
            "follows from the arithmetic."
        ),
    ] = None
    reason: Reason = NO_REASON
    attainable: Annotated[
        Size | None, about("What perfect rounding would leave, at the time of the largest error.")
    ] = None
    ratio: Annotated[
        Size | None,
        about(
            "The largest error over attainable, of all samples; it decides unless there is a tolerance."
        ),
    ] = None
    ratio_at: Annotated[float | None, about("The time of the largest ratio.")] = None
    time_shift: Annotated[
        float | None,
        about("State quantities: c with answer(t) ~ exact(t - c), positive if the answer is late."),
    ] = None
    residual: Annotated[
        Size | None, about("State quantities: the largest error that the time shift leaves.")
    ] = None
    shift: Annotated[
        str | None,
        about(
            "State quantities: the course of the shift of time behind the error, constant, drifting, "
            "wandering, or none where it leaves more than a tenth."
        ),
    ] = None
    trend: Annotated[float | None, about("The shift per unit of time, where it is drifting.")] = (
        None
    )
    remains: Annotated[
        Size | None, about("The largest error that the course of the shift leaves, in unit.")
    ] = None
    roundoff: Annotated[Size | None, about("u = 2^-bits of the rung.")] = None
    exponent: Annotated[
        float | None, about("Growth of the error as a power of t, where fitted.")
    ] = None
    change: Annotated[
        float | None,
        about(
            "Conserved numbers: the error of the last sample with its sign, below zero for a loss; null "
            "for vectors and states."
        ),
    ] = None
    since: Annotated[
        float | None,
        about("The time of the first sample whose error exceeds its bound; null if none does."),
    ] = None
    until: Annotated[float | None, about("The time of the last sample.")] = None
    error_kind: Annotated[ErrorKind | None, about("What the error that is left is made of.")] = None
    steps: Count = 0
    evaluations: Annotated[Count, about("Of the derivative.")] = 0
    seconds: Annotated[
        Size | None, about("Of the run, all its quantities together; in files it stands apart.")
    ] = None
    provenance: dict[str, Any] = field(default_factory=dict)

    @property
    def sentence(self) -> str:
        """The correct digits, the kind of the remaining error, and since when, in one line."""
        return sentence(self)

    @property
    def digits(self) -> int | None:
        """The correct decimal digits at every sample, at most as many as the rung has.

        None where nothing was compared, where the truth is too wide to tell, and where an error is no
        finite number. A radian counts as a whole.
        """
        if self.verdict is Status.UNDECIDED or self.max is None or not 0 <= self.max < inf:
            return None
        # The zeros after the decimal point, of the error and of the roundoff.
        counts = [max(floor(-log10(size)), 0) for size in (self.max, self.roundoff) if size]
        return min(counts, default=None)

    @property
    def run(self) -> tuple[str, str, str, str]:
        """Scene, solver, setting and rung, which tell the run of the row from other runs."""
        return self.scene, self.solver, self.setting, self.rung

    @property
    def is_conserved(self) -> bool:
        """True for the row of a conserved quantity."""
        return is_conserved(self.quantity)

    @property
    def is_compared(self) -> bool:
        """True if a comparison was made: a run that never came to one has no time of an error."""
        return self.at is not None

    @property
    def because(self) -> str:
        """The reason of the bound, or why there is no number, in one line."""
        return str(self.reason)

    @property
    def is_waived(self) -> bool:
        """True for the row of what an answer lacks, where the caller asked for a part alone."""
        return self.quantity == COMPLETE and self.verdict is Status.VACUOUS

    def row(self) -> dict[str, Any]:
        """Return the row as JSON holds it: no NaN, no infinity, its reason also in one line.

        ``digits`` and ``sentence`` are made of the others. Its ``provenance`` is the verdict's own.
        """
        values: dict[str, Any] = {}
        # A verdict that was read has its attributes in the order of the file.
        for name, value in ((member.name, getattr(self, member.name)) for member in fields(self)):
            if name == "reason":
                values |= {"because": self.because, "reason": plain(value)}
            else:
                values[name] = finite(value)
        return {**values, "digits": self.digits, "sentence": self.sentence}


def summary(verdicts: Iterable[Verdict]) -> dict[str, int]:
    """Return the number of verdicts of each status, every status named."""
    counts = {status.value: 0 for status in Status}
    for verdict in verdicts:
        counts[verdict.verdict.value] += 1
    return counts


def exit_status(verdicts: Iterable[Verdict]) -> int:
    """Return 0 if nothing failed, 1 if a gate failed, 3 if something is undecided and nothing failed.

    A scene that the arithmetic had to refuse, or whose gate is vacuous, is no pass either: here both
    count as undecided. Where such verdicts are expected, `batch.expectations` knows of it. A part that
    the caller has waived counts for nothing.
    """
    return status.exit_status({v.verdict for v in verdicts if not v.is_waived})
