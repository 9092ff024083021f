"""The verdict on the start alone: the first row of a judgement, because a wrong start explains the others.

The state whose error at the start is nearest to its bound counts. The gate is the gate of that state at
this sample: a rounding of the data, without any growth along the orbit. If the caller asks for a
tolerance, it applies to the start too.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any, Final

import numpy as np

from taylor_verify.judge.gates import Finding
from taylor_verify.judge.judgement import Judgement
from taylor_verify.judge.regraded import Graded
from taylor_verify.records.error_kind import ErrorKind
from taylor_verify.records.quantities import GATE_FACTOR, INITIAL, STATES
from taylor_verify.records.reason import Carried, Cause, Reason, RoundoffFloor, shown
from taylor_verify.records.verdict import Verdict

# A single sample has no course in time.
_NO_COURSE: Final[dict[str, Any]] = dict.fromkeys(
    ("time_shift", "residual", "shift", "trend", "remains", "change", "exponent", "since")
)


def with_initial(judgement: Judgement, start: float) -> Judgement:
    """Return the judgement with the verdict on the start as its first row, if a sample is at the start."""
    record = judgement.record
    if record is None:
        return judgement
    times, pairs = np.array(record.times), zip(judgement.verdicts, record.gates, strict=True)
    gates = [Graded.of(verdict, gate, times) for verdict, gate in pairs]
    initial = initial_verdict(gates, start, Carried.START)
    return replace(judgement, verdicts=(*initial, *judgement.verdicts))


def initial_verdict(
    gates: Sequence[Graded], start: float, carried: Carried = Carried.ROW
) -> list[Verdict]:
    """Return the verdict on the row at the start, in a list; empty if there is no such row.

    ``carried`` distinguishes the start of a run from the start of a file, which is rounded once more.
    """
    starts = [
        (gate, int(k), _finding(gate, int(k), carried))
        for gate in gates
        if gate.verdict.quantity in STATES
        for k in np.flatnonzero(gate.times == start)[:1]
    ]
    if not starts:
        return []
    gate, k, finding = starts[int(np.argmax([_nearness(*row) for row in starts]))]
    error = float(gate.errors[k])
    remark = _remark(gate.verdict.quantity, error, finding, start)
    verdict = replace(
        gate.verdict,
        quantity=INITIAL,
        verdict=finding.status,
        max=error,
        mean=error,
        final=error,
        at=start,
        bound=finding.bound,
        tolerance=finding.tolerance,
        reason=finding.reason.with_remark(Cause.START, remark),
        attainable=float(gate.attainable[k]),
        ratio=finding.ratio,
        ratio_at=start,
        until=start,
        error_kind=ErrorKind.ROUNDOFF if finding.is_rounding else None,
        **_NO_COURSE,
    )
    return [verdict]


def _finding(gate: Graded, k: int, carried: Carried) -> Finding:
    floor = RoundoffFloor(carried, shown(float(gate.attainable[k])))
    return gate.judged(Reason(floor=floor), slice(k, k + 1))


def _nearness(gate: Graded, k: int, finding: Finding) -> float:
    """Return the error of the start of a state, in tenths of its bound."""
    tolerance = finding.tolerance
    return finding.ratio if tolerance is None else GATE_FACTOR * float(gate.errors[k]) / tolerance


def _remark(quantity: str, error: float, finding: Finding, start: float) -> str:
    off = f"its {quantity} is off by {error:.3g}"
    if not error <= finding.bound:
        return f"{_row(start)}, is not the scene's initial state: {off}"
    if finding.is_rounding or finding.tolerance is None:
        return _right_start(start)
    return f"{_right_start(start)} to within the tolerance: {off}"


def _right_start(start: float) -> str:
    """Return the sentence on a correct start."""
    return f"{_row(start)}, is the scene's initial state"


def _row(start: float) -> str:
    return f"the row at the start, t = {start:g}"
