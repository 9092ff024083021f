"""A judgement graded anew, with the rounding of the input in what is attainable.

It works on the record, which is everything a run was judged by: the errors and floors of every gate at
every sample. Of two judgements that go either way in time from one start the graver counts.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import isfinite
from typing import Any

import numpy as np

from taylor_verify.judge.diagnosis import diagnosed
from taylor_verify.judge.errors.state import Errors
from taylor_verify.judge.floor.inputs import InputRounding
from taylor_verify.judge.gates import index_of_largest, judge
from taylor_verify.judge.judgement import Judgement
from taylor_verify.records.doubles import four_digits
from taylor_verify.records.quantities import STATES
from taylor_verify.records.reason import Cause, InputShare, Reason
from taylor_verify.records.record import GateRecord, Record
from taylor_verify.records.status import GRAVITY, Status
from taylor_verify.records.verdict import Verdict

Floats = np.ndarray[Any, np.dtype[np.float64]]


@dataclass(frozen=True)
class Graded:
    """One gate: its verdict, and its terms at all samples in the order of time from the start.

    A truth that was narrow enough for the rounding alone is so for the larger floor: ``is_doubtful``
    tells a gate for which it was not.
    """

    verdict: Verdict
    times: Floats
    errors: Floats
    attainable: Floats
    is_doubtful: bool
    terms: Reason

    @classmethod
    def of(
        cls, verdict: Verdict, gate: GateRecord, times: Floats, attainable: Floats, terms: Reason
    ) -> Graded:
        """A gate whose verdict tells whether the truth was narrow enough."""
        is_doubtful = verdict.verdict is Status.UNDECIDED
        return cls(verdict, times, _errors(verdict, gate), attainable, is_doubtful, terms)


def _errors(verdict: Verdict, gate: GateRecord) -> Floats:
    """The errors at all samples, to the four digits of the record.

    A tolerance has no rounding to leave room for: of the largest error all digits count then.
    """
    errors = np.array(gate.errors)
    if verdict.tolerance is not None and verdict.max is not None and isfinite(verdict.max):
        errors = np.minimum(errors, verdict.max)
        errors[index_of_largest(errors)] = verdict.max
    return errors


def graded(judgement: Judgement, inputs: InputRounding, roundoff: float) -> list[Graded]:
    """Every gate of a judgement, its floor the root of the squares of rounding and input."""
    record = judgement.record
    if record is None:
        return []
    gates = zip(judgement.verdicts, record.gates, strict=True)
    return [_graded(v, g, np.array(record.times), inputs, roundoff) for v, g in gates]


def _graded(
    verdict: Verdict, gate: GateRecord, times: Floats, inputs: InputRounding, roundoff: float
) -> Graded:
    rounding = np.array(gate.attainable)
    # The length of a quaternion owes nothing to the input.
    moved = inputs.at_samples.get(gate.quantity, np.zeros(len(rounding)))
    both = np.hypot(rounding, moved)
    worst = index_of_largest(np.array(gate.errors))
    share = InputShare(inputs.moved, roundoff, float(moved[worst]), float(both[worst]))
    terms = replace(verdict.reason, remarks=(), input=share)
    return Graded.of(verdict, gate, times, both, terms)


def verdict_of(sides: Sequence[Graded], flaw: str, start: float) -> Verdict:
    """The verdict of one gate: that of the direction of time which is graver, or else nearer to it.

    ``flaw`` says where the data have no finite number, if there is such a place; ``start`` is the time of
    the initial state.
    """
    return min((_verdict(side, flaw, start) for side in sides), key=_gravity)


def _gravity(verdict: Verdict) -> tuple[int, float]:
    ratio = verdict.ratio if verdict.tolerance is None else verdict.max
    told = float("inf") if ratio is None or ratio != ratio else ratio
    return GRAVITY.index(verdict.verdict), -told


def _verdict(side: Graded, flaw: str, start: float) -> Verdict:
    gate, times, attainable = side.verdict, side.times, side.attainable
    widths = np.full(len(times), np.inf if side.is_doubtful else 0.0)
    is_state = gate.quantity in STATES
    errors = Errors(gate.quantity, gate.unit, side.errors, widths, {}, is_state)
    finding = judge(errors, attainable, side.terms, gate.tolerance)
    worst = finding.worst
    verdict = replace(
        gate,
        verdict=finding.status,
        max=float(side.errors[worst]),
        at=float(times[worst]),
        bound=finding.bound,
        reason=finding.reason.with_remark(Cause.NOT_FINITE, flaw) if flaw else finding.reason,
        attainable=float(attainable[worst]),
        ratio=finding.ratio,
        ratio_at=float(times[finding.ratio_at]),
    )
    return diagnosed(verdict, times, start, side.errors, attainable)


def merged(records: Sequence[Record], gates: Sequence[Graded]) -> Record | None:
    """The record of the longer side, with the floors that were used; None where there is none."""
    if not records:
        return None
    record = max(records, key=lambda r: len(r.times))
    used = {g.verdict.quantity: g for g in gates if len(g.times) == len(record.times)}
    kept = tuple(
        replace(gate, attainable=four_digits(used[gate.quantity].attainable))
        for gate in record.gates
        if gate.quantity in used
    )
    return replace(record, gates=kept)
