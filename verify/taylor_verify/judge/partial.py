"""The judgement of an answer that has only some of the quantities, or the angular velocity besides.

What is missing is taken from the truth, so that the equations of the judge have all they ask for; no
row that rests on it is reported.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, Final

import numpy as np
from mpmath import mp, mpf

from taylor_verify.exact.invariants import invariants
from taylor_verify.exact.route import solution
from taylor_verify.judge.angular_shift import angular_shift
from taylor_verify.judge.arithmetic import truth_digits, working_bits
from taylor_verify.judge.attainable import Floats, floor
from taylor_verify.judge.errors import Errors, norms, state_errors
from taylor_verify.judge.gates import index_of_largest, judge
from taylor_verify.judge.inputs import angular_velocity
from taylor_verify.judge.judgement import Judgement, judgement
from taylor_verify.judge.provenance import provenance
from taylor_verify.judge.tolerances import NO_TOLERANCES, Tolerances
from taylor_verify.models.problem import Problem
from taylor_verify.records.quantities import UNIT_QUATERNION
from taylor_verify.records.reason import Carried, Kind, Reason, RoundoffFloor
from taylor_verify.records.record import GateRecord
from taylor_verify.records.verdict import Verdict
from taylor_verify.scenes.bodies import ImmersedBody
from taylor_verify.scenes.motion import Motion
from taylor_verify.solvers.file import Recorded
from taylor_verify.solvers.trajectory import Outcome

Quantities = Mapping[str, np.ndarray[Any, Any]]
Gated = tuple[Verdict, GateRecord]

_GUARD_DIGITS: Final = 6
# The names that a sensitivity has for the quantities of a state.
_BLOCKS: Final = {"momentum": "omega"}


def partial_judgement(
    problem: Problem, solver: Recorded, tolerances: Tolerances = NO_TOLERANCES
) -> Judgement:
    """The verdicts on what the answer has. Raises Unsettled where there is no truth.

    The problem's scenes track what the answer has of attitude and centre, and no more.
    """
    own, given = solver.quantities, problem.given
    truth = _truth(problem)
    has = {"attitude" if name == "quaternion" else name for name in own}
    filled = {n: rows for n, rows in own.items() if n != "omega" or n in truth.quantities}
    filled |= {name: rows for name, rows in truth.quantities.items() if name not in has}
    apart: list[Gated] = []
    if "omega" not in truth.quantities and "omega" in own:
        apart.append(_angular_velocity(problem, solver, truth, tolerances))
    if "attitude" in filled and not given.body.is_free:
        # The balances of a loaded body start an arc of the exact motion from every row, for which a
        # matrix that is no rotation to the last digit will not do. States alone are compared.
        apart += _states_apart(problem, solver, truth, filled, tolerances)
        filled = {n: rows for n, rows in filled.items() if n not in ("attitude", "centre")}
        problem = replace(problem, given=replace(given, track=frozenset()))
    answer = replace(solver, quantities=filled).solve(problem)
    whole = judgement(problem, solver, answer, tolerances=tolerances)
    if whole.record is None:
        return whole
    sound = _rows_resting_on(problem, truth, has)
    pairs = [*zip(whole.verdicts, whole.record.gates, strict=True), *apart]
    kept = [(verdict, gate) for verdict, gate in pairs if verdict.quantity in sound]
    record = replace(whole.record, gates=tuple(gate for _, gate in kept))
    return Judgement(tuple(verdict for verdict, _ in kept), record)


def _truth(problem: Problem) -> Motion:
    digits = truth_digits(problem.rung.bits, _GUARD_DIGITS)
    return solution(problem.given).motion(problem.given.clock.elapsed, digits)


def _rows_resting_on(problem: Problem, truth: Motion, has: set[str]) -> set[str]:
    """The quantities of a verdict all of whose ingredients the answer has."""
    found = has & {"omega", "attitude", "centre"}
    found.add(UNIT_QUATERNION)
    if {"linear_impulse", "angular_impulse"} & has:
        found.add("impulse")
    for invariant in invariants(problem.given):
        blocks = {_BLOCKS.get(block, block) for block in invariant.sensitivity(truth)}
        if blocks <= has:
            found.add(invariant.name)
    return found


def _states_apart(
    problem: Problem,
    solver: Recorded,
    truth: Motion,
    filled: Quantities,
    tolerances: Tolerances,
) -> list[Gated]:
    """Attitude and centre against the truth, and nothing that is conserved."""
    given, rung = problem.given, problem.rung
    with mp.workprec(working_bits(rung.bits)):
        base = floor(given, problem.scene, rung.unit_roundoff, 0)
        rows = []
        for errors in state_errors(given, truth, Motion(filled, truth.radius)):
            if errors.quantity in ("attitude", "centre"):
                attainable = base.of_state(errors)
                worst = index_of_largest(errors.doubles)
                terms = Reason(floor=base.terms(attainable, worst, Carried.ORBIT))
                rows.append(_row(problem, solver, errors, attainable, terms, tolerances))
    return rows


# The angular velocity of a solid in a fluid: Omega = B^T x + C y.


@dataclass(frozen=True)
class _Omega:
    """The exact angular velocity, its largest size, and what a rounding of x and y makes of it."""

    rows: Any
    scale: Any
    attainable: Floats


def _angular_velocity(
    problem: Problem, solver: Recorded, truth: Motion, tolerances: Tolerances
) -> Gated:
    with mp.workprec(working_bits(problem.rung.bits)):
        exact = _omega(problem, truth)
        values = norms(solver.quantities["omega"] - exact.rows) / exact.scale
        errors = Errors("omega", "max|omega|", values, truth.radius, {"omega": exact.scale})
        terms = Reason(floor=RoundoffFloor(Carried.VELOCITY))
        row, gate = _row(problem, solver, errors, exact.attainable, terms, tolerances)
        digits = truth_digits(problem.rung.bits, _GUARD_DIGITS)
        shift = angular_shift(problem.given, solver.quantities["omega"], digits)
        if shift is None:
            return row, gate
        late, left = float(shift.time_shift), shift.residual / float(exact.scale)
        remains = None if shift.kind is Kind.NONE else left
        row = replace(row, time_shift=late, residual=left, shift=shift.kind.value)
        return replace(row, remains=remains), gate


def _row(
    problem: Problem,
    solver: Recorded,
    errors: Errors,
    attainable: Floats,
    terms: Reason,
    tolerances: Tolerances,
) -> Gated:
    finding = judge(errors, attainable, terms, tolerances.of(errors.quantity))
    instants, worst, values = problem.given.clock.instants, finding.worst, errors.values
    verdict = Verdict(
        scene=problem.scene.name,
        solver=solver.name,
        rung=problem.rung.name,
        setting=solver.setting,
        quantity=errors.quantity,
        verdict=finding.status,
        outcome=Outcome.FINISHED.value,
        max=float(values[worst]),
        mean=float(sum(values) / len(values)),
        final=float(values[-1]),
        at=float(instants[worst]),
        unit=errors.unit,
        bound=finding.bound,
        tolerance=finding.tolerance,
        reason=finding.reason,
        attainable=float(attainable[worst]),
        ratio=finding.ratio,
        ratio_at=float(instants[finding.ratio_at]),
        roundoff=float(problem.rung.unit_roundoff),
        provenance=provenance(problem.scene.digest),
    )
    gate = GateRecord(
        quantity=errors.quantity,
        unit=errors.unit,
        errors=tuple(float(v) for v in values),
        attainable=tuple(float(a) for a in attainable),
        truth_radius=float(max(errors.truth_radius)),
    )
    return verdict, gate


def _omega(problem: Problem, truth: Motion) -> _Omega:
    given = problem.given
    body = given.body
    assert isinstance(body, ImmersedBody)
    rows = angular_velocity(body, truth.quantities)
    sizes = norms(rows)
    scale = max(sizes) or mpf(1)
    base = floor(given, problem.scene, problem.rung.unit_roundoff, 0)
    squares = (base.unit_roundoff * (sizes / scale).astype(float)) ** 2
    for part, matrix in (("linear_impulse", body.coupling), ("angular_impulse", body.angular)):
        norm = np.linalg.norm(np.array([[float(v) for v in row] for row in matrix]), 2)
        alone = Errors(part, "", truth.radius, truth.radius, {part: scale})
        squares = squares + (norm * base.of_state(alone)) ** 2
    return _Omega(rows, scale, np.sqrt(squares))
