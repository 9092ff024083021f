"""Regrading of a judgement with a floor that includes the rounding of the input.

It uses the record, which has the errors and floors of every gate at every sample. If there are two
judgements, one in each direction of time from the start, the worse one counts.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import inf, isfinite
from typing import Any

import numpy as np

from taylor_verify.judge.diagnosis import diagnosed
from taylor_verify.judge.errors.state import Errors
from taylor_verify.judge.floor.inputs import InputRounding
from taylor_verify.judge.gates import Finding, index_of_largest, judge
from taylor_verify.records.doubles import four_digits
from taylor_verify.records.quantities import STATES
from taylor_verify.records.reason import Cause, InputShare, Reason
from taylor_verify.records.record import GateRecord, Record
from taylor_verify.records.status import GRAVITY, Status
from taylor_verify.records.verdict import Verdict

Floats = np.ndarray[Any, np.dtype[np.float64]]


@dataclass(frozen=True)
class Graded:
    """A gate: its verdict, and its errors and floors at all samples, in the order of time."""

    verdict: Verdict
    times: Floats
    errors: Floats
    attainable: Floats

    @classmethod
    def of(
        cls, verdict: Verdict, gate: GateRecord, times: Floats, attainable: Floats | None = None
    ) -> Graded:
        """Return a recorded gate, its errors to four digits; ``attainable`` replaces its floors.

        A tolerance leaves no room for rounding, so with a tolerance all digits of the largest error count.
        """
        errors = np.array(gate.errors)
        if verdict.tolerance is not None and verdict.max is not None and isfinite(verdict.max):
            errors = np.minimum(errors, verdict.max)
            errors[index_of_largest(errors)] = verdict.max
        floors = np.array(gate.attainable) if attainable is None else attainable
        return cls(verdict, times, errors, floors)

    def judged(self, terms: Reason, samples: slice = slice(None)) -> Finding:
        """Return the finding of the gate at these samples.

        A truth that is narrow enough for the rounding alone is narrow enough for the larger floor.
        """
        verdict, errors = self.verdict, self.errors[samples]
        widths = np.full(len(errors), inf if verdict.verdict is Status.UNDECIDED else 0.0)
        is_state = verdict.quantity in STATES
        compared = Errors(verdict.quantity, verdict.unit, errors, widths, {}, is_state)
        return judge(compared, self.attainable[samples], terms, verdict.tolerance)


def graded(
    verdicts: Sequence[Verdict], record: Record, inputs: InputRounding, roundoff: float
) -> list[Graded]:
    """Return every gate of a judgement, with the root sum of squares of rounding and input as its floor."""
    times, gates = np.array(record.times), []
    for verdict, gate in zip(verdicts, record.gates, strict=True):
        # The length of a quaternion does not depend on the input.
        moved = inputs.at_samples.get(gate.quantity, np.zeros(len(times)))
        both = np.hypot(np.array(gate.attainable), moved)
        worst = index_of_largest(np.array(gate.errors))
        share = InputShare(inputs.moved, roundoff, float(moved[worst]), float(both[worst]))
        terms = replace(verdict.reason, remarks=(), input=share)
        gates.append(Graded.of(replace(verdict, reason=terms), gate, times, both))
    return gates


def verdict_of(sides: Sequence[Graded], flaw: str, start: float) -> Verdict:
    """Return the worse verdict of a gate over both directions of time, or the one nearer to its bound.

    ``flaw`` names the first place where the data are not finite, if there is one; ``start`` is the time of
    the initial state.
    """
    return min((_verdict(side, flaw, start) for side in sides), key=_gravity)


def _gravity(verdict: Verdict) -> tuple[int, float]:
    ratio = verdict.ratio if verdict.tolerance is None else verdict.max
    return GRAVITY.index(verdict.verdict), -inf if ratio is None or ratio != ratio else -ratio


def _verdict(side: Graded, flaw: str, start: float) -> Verdict:
    finding = side.judged(side.verdict.reason)
    reason, worst = finding.reason, finding.worst
    verdict = replace(
        side.verdict,
        verdict=finding.status,
        max=float(side.errors[worst]),
        at=float(side.times[worst]),
        bound=finding.bound,
        reason=reason.with_remark(Cause.NOT_FINITE, flaw) if flaw else reason,
        attainable=float(side.attainable[worst]),
        ratio=finding.ratio,
        ratio_at=float(side.times[finding.ratio_at]),
    )
    return diagnosed(verdict, side.times, start, side.errors, side.attainable)


def merged(records: Sequence[Record], gates: Sequence[Graded]) -> Record | None:
    """Return the record of the longer side, with the floors that were used; None without records."""
    if not records:
        return None
    record = max(records, key=lambda r: len(r.times))
    used = {g.verdict.quantity: g for g in gates if len(g.times) == len(record.times)}
    gates_of_record = (
        replace(gate, attainable=four_digits(used[gate.quantity].attainable))
        for gate in record.gates
        if gate.quantity in used
    )
    return replace(record, gates=tuple(gates_of_record))
