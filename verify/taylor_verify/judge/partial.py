"""The judgement of an answer that has only some of the quantities, or velocities besides.

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
from taylor_verify.judge.inputs import Velocity, angular_velocity, linear_velocity
from taylor_verify.judge.judgement import Judgement, judgement
from taylor_verify.judge.provenance import provenance
from taylor_verify.models.problem import Problem
from taylor_verify.records.quantities import GATE_FACTOR, UNIT_QUATERNION, VELOCITIES
from taylor_verify.records.reason import Carried, Kind, Reason, RoundoffFloor
from taylor_verify.records.record import GateRecord
from taylor_verify.records.verdict import Verdict
from taylor_verify.scenes.bodies import ImmersedBody
from taylor_verify.scenes.motion import Motion
from taylor_verify.scenes.tensors import Matrix
from taylor_verify.solvers.file import Recorded
from taylor_verify.solvers.trajectory import Outcome

Quantities = Mapping[str, np.ndarray[Any, Any]]
Gated = tuple[Verdict, GateRecord]

_GUARD_DIGITS: Final = 6
# The names that a sensitivity has for the quantities of a state.
_BLOCKS: Final = {"momentum": "omega"}


def partial_judgement(problem: Problem, solver: Recorded) -> Judgement:
    """The verdicts on what the answer has. Raises Unsettled where there is no truth.

    The problem's scenes track what the answer has of attitude and centre, and no more.
    """
    own, given = solver.quantities, problem.given
    truth = _truth(problem)
    has = {"attitude" if name == "quaternion" else name for name in own}
    filled = {n: rows for n, rows in own.items() if n not in VELOCITIES or n in truth.quantities}
    filled |= {name: rows for name, rows in truth.quantities.items() if name not in has}
    apart: list[Gated] = []
    for group, velocity in _VELOCITIES.items():
        if group in own and group not in truth.quantities:
            apart.append(_velocity(problem, solver, truth, velocity))
    if "attitude" in filled and not given.body.is_free:
        # The balances of a loaded body start an arc of the exact motion from every row, for which a
        # matrix that is no rotation to the last digit will not do. States alone are compared.
        apart += _states_apart(problem, solver, truth, filled)
        filled = {n: rows for n, rows in filled.items() if n not in ("attitude", "centre")}
        problem = replace(problem, given=replace(given, track=frozenset()))
    whole = judgement(problem, solver, replace(solver, quantities=filled).solve(problem))
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
    if "linear_velocity" in has:
        found.add("velocity")
    if {"linear_impulse", "angular_impulse"} & has:
        found.add("impulse")
    for invariant in invariants(problem.given):
        blocks = {_BLOCKS.get(block, block) for block in invariant.sensitivity(truth)}
        if blocks <= has:
            found.add(invariant.name)
    return found


def _states_apart(
    problem: Problem, solver: Recorded, truth: Motion, filled: Quantities
) -> list[Gated]:
    """Attitude and centre against the truth, and nothing that is conserved."""
    given, rung = problem.given, problem.rung
    with mp.workprec(working_bits(rung.bits)):
        by_velocities = solver.carries_velocities
        base = floor(given, problem.scene, rung.unit_roundoff, 0, by_velocities)
        rows = []
        for errors in state_errors(given, truth, Motion(filled, truth.radius)):
            if errors.quantity in ("attitude", "centre"):
                attainable = base.of_state(errors)
                worst = index_of_largest(errors.doubles)
                terms = Reason(floor=base.terms(attainable, worst, Carried.ORBIT))
                rows.append(_row(problem, solver, errors, attainable, terms))
    return rows


# The velocities of a solid in a fluid: U = A x + B y, Omega = B^T x + C y.


@dataclass(frozen=True)
class _Kind:
    """One of the two velocities: its quantity, its unit, and the blocks of the energy it is made with."""

    quantity: str
    unit: str
    group: str
    of: Velocity
    carried: Carried

    def blocks(self, body: ImmersedBody) -> dict[str, Matrix]:
        """The matrices of the two impulses."""
        is_linear = self.group == "linear_velocity"
        of_x, of_y = (body.linear, body.coupling) if is_linear else (body.coupling, body.angular)
        return {"linear_impulse": of_x, "angular_impulse": of_y}


_VELOCITIES: Final = {
    kind.group: kind
    for kind in (
        _Kind("omega", "max|omega|", "omega", angular_velocity, Carried.VELOCITY),
        _Kind("velocity", "max|U|", "linear_velocity", linear_velocity, Carried.LINEAR_VELOCITY),
    )
}


@dataclass(frozen=True)
class _Exact:
    """The exact velocity, its largest size, and what a rounding of x and y makes of it."""

    rows: Any
    scale: Any
    attainable: Floats


def _velocity(problem: Problem, solver: Recorded, truth: Motion, kind: _Kind) -> Gated:
    with mp.workprec(working_bits(problem.rung.bits)):
        exact, own = _exact(problem, solver, truth, kind), solver.quantities[kind.group]
        values = norms(own - exact.rows) / exact.scale
        scales = {kind.group: exact.scale}
        errors = Errors(kind.quantity, kind.unit, values, truth.radius, scales)
        terms = Reason(floor=RoundoffFloor(kind.carried))
        row, gate = _row(problem, solver, errors, exact.attainable, terms)
        digits = truth_digits(problem.rung.bits, _GUARD_DIGITS)
        shift = angular_shift(problem.given, own, digits, kind.of)
        if shift is None:
            return row, gate
        late, left = float(shift.time_shift), shift.residual / float(exact.scale)
        remains = None if shift.kind is Kind.NONE else left
        row = replace(row, time_shift=late, residual=left, shift=shift.kind.value)
        return replace(row, remains=remains), gate


def _row(
    problem: Problem, solver: Recorded, errors: Errors, attainable: Floats, terms: Reason
) -> Gated:
    finding = judge(errors, attainable, terms)
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
        bound=float(GATE_FACTOR * attainable[worst]),
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


def _exact(problem: Problem, solver: Recorded, truth: Motion, kind: _Kind) -> _Exact:
    given = problem.given
    body = given.body
    assert isinstance(body, ImmersedBody)
    rows = kind.of(body, truth.quantities)
    sizes = norms(rows)
    scale = max(sizes) or mpf(1)
    roundoff, by_velocities = problem.rung.unit_roundoff, solver.carries_velocities
    base = floor(given, problem.scene, roundoff, 0, by_velocities)
    squares = (base.unit_roundoff * (sizes / scale).astype(float)) ** 2
    for part, matrix in kind.blocks(body).items():
        norm = np.linalg.norm(np.array([[float(v) for v in row] for row in matrix]), 2)
        alone = Errors(part, "", truth.radius, truth.radius, {part: scale})
        squares = squares + (norm * base.of_state(alone)) ** 2
    return _Exact(rows, scale, np.sqrt(squares))
