"""The verdict on the start alone: the first row of a judgement, because a wrong start explains the others.

The state whose error at the start is nearest to its bound counts. The gate is the gate of that state at
this sample: a rounding of the data, without any growth along the orbit. If the caller asks for a
tolerance, it applies to the start too.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from math import inf, isnan

import numpy as np

from taylor_verify.judge.gated import Gate
from taylor_verify.judge.gates import Finding, judge
from taylor_verify.records.error_kind import ErrorKind
from taylor_verify.records.quantities import GATE_FACTOR, INITIAL
from taylor_verify.records.reason import Carried, Cause, Reason, RoundoffFloor, shown
from taylor_verify.records.status import Status
from taylor_verify.records.verdict import Verdict


def initial_verdict(gates: Sequence[Gate], carried: Carried) -> list[Verdict]:
    """Return the verdict on the row at the start, in a list; empty if there is no such row.

    ``carried`` distinguishes the start of a run from the start of a file, which is rounded once more.
    """
    starts = [
        (gate, int(k), _finding(gate, int(k), carried))
        for gate in gates
        if gate.errors.is_state
        for k in np.flatnonzero(gate.run.times == gate.run.start)[:1]
    ]
    if not starts:
        return []
    gate, k, finding = starts[int(np.argmax([_nearness(*row) for row in starts]))]
    error, start = float(gate.errors.values[k]), gate.run.start
    remark = _remark(gate.errors.quantity, error, finding, start)
    verdict = gate.run.verdict(
        INITIAL,
        finding.status,
        max=error,
        mean=error,
        final=error,
        at=start,
        unit=gate.errors.unit,
        bound=finding.bound,
        tolerance=finding.tolerance,
        reason=finding.reason.with_remark(Cause.START, remark),
        attainable=float(gate.attainable[k]),
        ratio=finding.ratio,
        ratio_at=start,
        until=start,
        error_kind=ErrorKind.ROUNDOFF if finding.is_rounding else None,
    )
    return [verdict]


def _finding(gate: Gate, k: int, carried: Carried) -> Finding:
    """Return the finding of a gate at one sample. The truth is as wide there as for the whole gate."""
    row = slice(k, k + 1)
    width = inf if gate.finding.status is Status.UNDECIDED else 0.0
    errors = replace(
        gate.errors, values=gate.errors.values[row], truth_radius=np.full(1, width), is_state=True
    )
    terms = Reason(floor=RoundoffFloor(carried, shown(float(gate.attainable[k]))))
    return judge(errors, gate.attainable[row], terms, gate.tolerance)


def _nearness(gate: Gate, k: int, finding: Finding) -> float:
    """Return the error of the start of a state, in tenths of its bound."""
    tolerance = finding.tolerance
    error = float(gate.errors.values[k])
    return finding.ratio if tolerance is None else GATE_FACTOR * error / tolerance


def _remark(quantity: str, error: float, finding: Finding, start: float) -> str:
    row, off = f"the row at the start, t = {start:g}", f"its {quantity} is off by {error:.3g}"
    if isnan(error):
        off = f"its {quantity} is no number"
    if not error <= finding.bound:
        return f"{row}, is not the scene's initial state: {off}"
    if finding.is_rounding or finding.tolerance is None:
        return f"{row}, is the scene's initial state"
    return f"{row}, is the scene's initial state to within the tolerance: {off}"
