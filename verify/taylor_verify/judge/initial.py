"""The verdict on the start alone: an answer that is wrong there says so before anything else.

Of the rows of all states at the start the one counts that is nearest to its bound. The gate is that of
the state at this sample: a rounding of the data, and nothing that an orbit has made of it. Where a
tolerance was asked for, the start may be off by the tolerance of its state.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from mpmath import mp, mpf

from taylor_verify.judge.errors.state import Errors
from taylor_verify.judge.gates import Finding, index_of_largest, judge
from taylor_verify.judge.judgement import Judgement
from taylor_verify.judge.regraded import Graded
from taylor_verify.records.error_kind import ErrorKind
from taylor_verify.records.quantities import GATE_FACTOR, INITIAL, STATES
from taylor_verify.records.reason import Carried, Cause, Reason, RoundoffFloor, shown
from taylor_verify.records.verdict import Verdict


def with_initial(judgement: Judgement, start: float) -> Judgement:
    """The judgement of a run with the verdict on its start in front, if a sample is at the start."""
    record = judgement.record
    if record is None:
        return judgement
    times = np.array(record.times)
    gates = [
        Graded.of(verdict, gate, times, np.array(gate.attainable), verdict.reason)
        for verdict, gate in zip(judgement.verdicts, record.gates, strict=True)
    ]
    initial = initial_verdict(gates, start, Carried.START)
    if initial is None:
        return judgement
    return replace(judgement, verdicts=(initial, *judgement.verdicts))


def initial_verdict(
    gates: Sequence[Graded], start: float, carried: Carried = Carried.ROW
) -> Verdict | None:
    """Return the verdict on the row at the start; None where there is no such row.

    ``carried`` tells the start of a run from that of a file, which has been rounded once more.
    """
    starts = [
        (gate, int(k))
        for gate in gates
        if gate.verdict.quantity in STATES
        for k in np.flatnonzero(gate.times == start)[:1]
    ]
    if not starts:
        return None
    findings = [_finding(gate, k, carried) for gate, k in starts]
    worst = index_of_largest(
        np.array([_nearness(*row) for row in zip(starts, findings, strict=True)])
    )
    (gate, k), finding = starts[worst], findings[worst]
    error, attainable = float(gate.errors[k]), float(gate.attainable[k])
    return replace(
        gate.verdict,
        quantity=INITIAL,
        verdict=finding.status,
        max=error,
        mean=error,
        final=error,
        at=start,
        bound=finding.bound,
        tolerance=finding.tolerance,
        reason=finding.reason.with_remark(Cause.START, _said(gate, error, finding, start)),
        attainable=attainable,
        ratio=finding.ratio,
        ratio_at=start,
        time_shift=None,
        residual=None,
        shift=None,
        trend=None,
        remains=None,
        change=None,
        exponent=None,
        since=None,
        until=start,
        error_kind=ErrorKind.ROUNDOFF if finding.is_rounding else None,
    )


def _nearness(row: tuple[Graded, int], finding: Finding) -> float:
    """How near the start of a state is to its bound, in tenths of the bound."""
    gate, k = row
    tolerance = finding.tolerance
    return finding.ratio if tolerance is None else GATE_FACTOR * float(gate.errors[k]) / tolerance


def _said(gate: Graded, error: float, finding: Finding, start: float) -> str:
    row, off = (
        f"the row at the start, t = {start:g}",
        f"its {gate.verdict.quantity} is off by {error:.3g}",
    )
    if not error <= finding.bound:
        return f"{row}, is not the scene's initial state: {off}"
    if finding.is_rounding or finding.tolerance is None:
        return f"{row}, is the scene's initial state"
    return f"{row}, is the scene's initial state to within the tolerance: {off}"


def _finding(gate: Graded, k: int, carried: Carried) -> Finding:
    error = np.array([mpf(float(gate.errors[k]))], dtype=object)
    width = np.array([mp.inf if gate.is_doubtful else mp.zero], dtype=object)
    row = Errors(gate.verdict.quantity, gate.verdict.unit, error, width, {}, is_state=True)
    floor = RoundoffFloor(carried, shown(float(gate.attainable[k])))
    terms = Reason(floor=floor)
    return judge(row, gate.attainable[k : k + 1], terms, gate.verdict.tolerance)
