"""The judgement of an answer with only some of the quantities, or with additional velocities.

Missing quantities are filled in from the truth, because the judge needs all of them; no row that depends
on a filled-in quantity is reported.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, Final

import numpy as np
from mpmath import mp, mpf

from taylor_verify.exact.invariants import invariants
from taylor_verify.exact.route import solution
from taylor_verify.exact.solution import Solution
from taylor_verify.judge.costs import Costs
from taylor_verify.judge.errors.angular_shift import angular_shift
from taylor_verify.judge.errors.measured import MOST_SHIFTED, Comparison
from taylor_verify.judge.errors.state import Distances, Errors, Series, States, largest, norms
from taylor_verify.judge.floor.arithmetic import truth_digits, working_bits
from taylor_verify.judge.floor.attainable import Floats, Floor, floor
from taylor_verify.judge.judgement import Judgement, judgement
from taylor_verify.judge.rows import Gated, Run
from taylor_verify.judge.tolerances import NO_TOLERANCES, Tolerances
from taylor_verify.judge.velocities import velocity, velocity_forms
from taylor_verify.models.problem import Problem
from taylor_verify.records.quantities import (
    GROUPS,
    QUANTITIES,
    TRACKED,
    UNIT_QUATERNION,
    VELOCITIES,
)
from taylor_verify.records.reason import Carried, Kind, Reason, RoundoffFloor
from taylor_verify.scenes.instants import evenly
from taylor_verify.scenes.motion import Clock, Motion
from taylor_verify.solvers.files.file import Recorded
from taylor_verify.solvers.trajectory import ByRows, rows_at

Quantities = Mapping[str, np.ndarray[Any, Any]]

_GUARD_DIGITS: Final = 6
# The names of a state's quantities in a sensitivity, where they differ.
_BLOCKS: Final = {"momentum": "omega"}


def partial_judgement(
    problem: Problem, solver: Recorded, tolerances: Tolerances = NO_TOLERANCES
) -> Judgement:
    """Return the verdicts on the quantities of the answer. Raises Unsettled if there is no truth.

    The problem's scenes track attitude and centre only if the answer has them.
    """
    own, given = solver.quantities, problem.given
    exact = solution(given)
    digits = truth_digits(problem.rung.bits, _GUARD_DIGITS)
    one_row = exact.motion(given.clock.elapsed[:1], digits)
    has = {"attitude" if name == "quaternion" else name for name in own}
    filled = Filled(
        own,
        tuple(name for name in own if name not in VELOCITIES or name in one_row.quantities),
        tuple(name for name in one_row.quantities if name not in has),
        lambda places: exact.motion([given.clock.elapsed[k] for k in places], digits),
        len(given.clock.instants),
    )
    run = Run(problem, solver, solver.solve(problem), tolerances)
    apart = [
        _velocity(run, exact, group)
        for group in _CARRIED
        if group in own and group not in one_row.quantities
    ]
    if "attitude" in filled and not given.body.is_conservative:
        # The balances of a loaded body start an arc of the exact motion from every row. They need a
        # matrix that is a rotation to the last digit, so only the states are compared here.
        apart += _states_apart(run, exact, filled)
        filled = filled.without("attitude", "centre")
        problem = replace(problem, given=replace(given, track=frozenset()))
    answer = replace(solver, quantities=filled).solve(problem)
    whole = judgement(problem, solver, answer, tolerances=tolerances)
    if whole.record is None:
        return whole
    sound = _rows_resting_on(problem, one_row, has)
    pairs = [*zip(whole.verdicts, whole.record.gates, strict=True), *apart]
    sound_pairs = [(verdict, gate) for verdict, gate in pairs if verdict.quantity in sound]
    record = replace(whole.record, gates=tuple(gate for _, gate in sound_pairs))
    return Judgement(tuple(verdict for verdict, _ in sound_pairs), record)


@dataclass(frozen=True)
class Filled(ByRows):
    """The quantities of an answer, with the truth in place of missing quantities.

    ``exact`` returns the truth in some rows, and ``count`` is the number of all rows.
    """

    own: Quantities
    has: tuple[str, ...]
    lacks: tuple[str, ...]
    exact: Callable[[Sequence[int]], Motion]
    count: int

    def rows(self, places: Sequence[int]) -> dict[str, np.ndarray[Any, Any]]:
        own = rows_at(self.own, places)
        rows = {name: own[name] for name in self.has}
        if self.lacks:
            truth = self.exact(places)
            rows |= {name: truth[name] for name in self.lacks}
        return rows

    def without(self, *names: str) -> Filled:
        has, lacks = (
            tuple(name for name in group if name not in names) for group in (self.has, self.lacks)
        )
        return replace(self, has=has, lacks=lacks)

    def __iter__(self) -> Iterator[str]:
        return iter((*self.has, *self.lacks))


def _rows_resting_on(problem: Problem, truth: Motion, has: set[str]) -> set[str]:
    """Return the quantities of verdicts that need nothing but what the answer has."""
    quantities = {UNIT_QUATERNION, *(GROUPS[name].quantity for name in has)}
    for invariant in invariants(problem.given):
        blocks = {_BLOCKS.get(block, block) for block in invariant.sensitivity(truth)}
        if blocks <= has:
            quantities.add(invariant.name)
    return quantities


def _comparison(run: Run, exact: Solution, quantities: Quantities) -> Comparison:
    bits = run.problem.rung.bits
    digits = truth_digits(bits, _GUARD_DIGITS)
    return Comparison(run.problem.given, exact, quantities, digits, working_bits(bits))


def _floor(run: Run) -> Floor:
    problem, by_velocities = run.problem, run.solver.carries_velocities
    roundoff = problem.rung.unit_roundoff
    return floor(problem.given, problem.scene, roundoff, steps=0, velocities=by_velocities)


def _states_apart(run: Run, exact: Solution, filled: Quantities) -> list[Gated]:
    """Return the gates of attitude and centre, without conserved quantities."""
    compared = _comparison(run, exact, filled)
    tracked, rows = TRACKED[compared.scene.model], []
    states = [errors for errors in compared.states() if errors.quantity in tracked]
    with mp.workprec(compared.bits):
        base = _floor(run)
        for errors in states:
            attainable = base.of_state(errors)
            terms = base.terms(attainable, errors, Carried.ORBIT)
            rows.append(run.gated_in_full(errors, attainable, Reason(floor=terms)))
    return rows


# The velocities of a solid in a fluid: U = A x + B y, Omega = B^T x + C y.

_CARRIED: Final = {"omega": Carried.VELOCITY, "linear_velocity": Carried.LINEAR_VELOCITY}


def _velocity(run: Run, exact: Solution, group: str) -> Gated:
    compared, given = _comparison(run, exact, run.trajectory.quantities), run.problem.given
    errors, sizes = _velocity_errors(compared, group)
    with mp.workprec(compared.bits):
        scale = errors.parts[group]
        attainable = _velocity_attainable(run, group, sizes, scale)
        reason = Reason(floor=RoundoffFloor(_CARRIED[group]))
        row, gate = run.gated_in_full(errors, attainable, reason)
        places = evenly(len(sizes), MOST_SHIFTED)
        clock = Clock(given.clock.start, tuple(given.clock.instants[k] for k in places))
        own = rows_at(compared.quantities, places)[group]
        shift = angular_shift(replace(given, clock=clock), own, compared.digits, group)
        if shift is None:
            return row, gate
        late, left = float(shift.time_shift), shift.residual / float(scale)
        remains = None if shift.kind is Kind.NONE else left
        row = replace(row, time_shift=late, residual=left, shift=shift.kind.value)
        return replace(row, remains=remains), gate


def _velocity_errors(compared: Comparison, group: str) -> tuple[Errors, Floats]:
    """Return the errors of a velocity, and its size at every sample relative to the largest."""
    body, quantity = compared.scene.body, QUANTITIES[GROUPS[group].quantity]
    states, sizes, radii = States(), Series(), Series()
    for block in compared.blocks(Costs()):
        with mp.workprec(compared.bits):
            rows = velocity(group, body, block.truth.quantities)
            size, distances = norms(rows), norms(block.own[group] - rows)
            zeros, most = {group: 0 * block.truth.radius}, {group: largest(size)}
            block_distances = Distances(
                quantity.name, quantity.unit, {group: distances}, zeros, most
            )
            scale = states.add(block_distances)[group]
            sizes.add(size, scale)
            radii.add(block.truth.radius, mpf(1))
    (errors,) = states.errors()
    errors = replace(errors, truth_radius=radii.joined()[0], is_state=False)
    return errors, sizes.joined()[0]


def _velocity_attainable(run: Run, group: str, sizes: Floats, scale: Any) -> Floats:
    """Return the error that the rounding of x and y, and of the velocity itself, leaves."""
    base = _floor(run)
    squares = (base.unit_roundoff * sizes) ** 2
    for part, matrix in velocity_forms(run.problem.given.body).forms[group].items():
        norm = np.linalg.norm(np.array(matrix, dtype=float), 2)
        alone = Errors(part, "", sizes, sizes, {part: scale})
        squares = squares + (norm * base.of_state(alone)) ** 2
    attainable: Floats = np.sqrt(squares)
    return attainable
