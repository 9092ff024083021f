"""Reach of each precision: digits left along families of extreme scenes, after more and more periods.

Every member of a family is solved once on a rung, at the quarters of its 1st, 3rd, 10th ... period. The
digits left after N periods are -log10 of the largest error at any instant up to then, compared with the
exact motion of the data that the solver was given. The attainable error is the judge's own, for the same
orbit, instants and steps. An error of 1 is the size of the motion: no digits are left.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from fractions import Fraction
from math import inf, isfinite
from typing import Final

import numpy as np
from mpmath import mp

from taylor_verify.batch.work import run_all
from taylor_verify.exact.elements import elements
from taylor_verify.exact.route import solution
from taylor_verify.exact.solution import Unsettled
from taylor_verify.judge.errors.state import state_errors
from taylor_verify.judge.floor.arithmetic import truth_digits, working_bits
from taylor_verify.models.problem import NotRepresentable, Problem, pose
from taylor_verify.numbers.precision import Rung
from taylor_verify.numbers.precision import rung as rung_named
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.taylor.driver import Taylor
from taylor_verify.solvers.trajectory import Outcome, Trajectory
from taylor_verify.tradeoff.attainability import Floats, floors
from taylor_verify_reports.studies.hard.hard_scenes import LOST, ReachRow
from taylor_verify_reports.studies.hard.members import (
    FOLLOWED,
    QUARTERS,
    Followed,
    at_quarters,
    period_of,
)

# If rounding changes the period by a larger part, the rung cannot represent the orbit.
_SAME_PERIOD: Final = Fraction(1, 10)

# A family by its place in FOLLOWED, and a value: cheap to send to a process.
Member = tuple[int, str]


def members() -> list[Member]:
    """Return the members of all families."""
    return [(place, value) for place, family in enumerate(FOLLOWED) for value in family.members]


def measure(finished: Callable[[str], None] = lambda label: None) -> tuple[ReachRow, ...]:
    """Return all rows in their stored form; ``finished`` is called with each member as it ends."""

    def ended(member: Member, _: object) -> None:
        finished(f"{FOLLOWED[member[0]].name} {member[1]}")

    measured = run_all(_measured, members(), expense=_expense, ended=ended)
    return tuple(stored(row) for rows in measured for row in rows)


def _measured(member: Member) -> list[ReachRow]:
    family = FOLLOWED[member[0]]
    return reaches(family, member[1], map(rung_named, family.most_periods))


def _expense(member: Member) -> float:
    """Return a number that is the lower, the longer a member takes; periods on wide rungs weigh most."""
    weights = {"mp237": 1000.0, "f128": 100.0, "f64": 0.1}
    periods = FOLLOWED[member[0]].most_periods
    return -sum(weight * periods.get(rung, 0) for rung, weight in weights.items())


def stored(row: ReachRow) -> ReachRow:
    """Return the row in its stored form: four digits, and None for an error that is not finite."""
    errors, floors = (
        tuple(None if e is None or not isfinite(e) else float(f"{e:.4g}") for e in each)
        for each in (row.errors, row.floors)
    )
    return replace(row, errors=errors, floors=floors)


def reaches(family: Followed, value: str, rungs: Iterable[Rung]) -> list[ReachRow]:
    """Return the rows of one member on each of the rungs, with all digits.

    Raises ValueError for a scene without a period, and Unsettled if its floor cannot be computed.
    """
    scene = family.members[value]
    rows = [
        _followed(ReachRow(family.name, value, rung.name, family.periods(rung.name)), scene, rung)
        for rung in rungs
    ]
    return _with_floors(rows, scene)


# Errors.


class _OtherOrbit(Exception):  # noqa: N818 (it names what the rung has)
    """The data rounded to the rung have another orbit; the text says which."""


def _followed(empty: ReachRow, scene: Scene, rung: Rung) -> ReachRow:
    """Return the row with the errors of the periods that were run, or the reason for none."""
    if reason := Taylor().unavailable(rung):
        return replace(empty, why=reason)
    try:
        # A member that is lost within its first period is not followed further.
        first = _solved(empty, empty.periods[:1], scene, rung)
        error = first.errors[-1]
        is_lost = error is None or not error < LOST
        return first if is_lost else _solved(empty, empty.periods, scene, rung)
    except (NotRepresentable, Unsettled, _OtherOrbit) as fault:
        return replace(empty, why=str(fault))


def _solved(empty: ReachRow, periods: Sequence[int], scene: Scene, rung: Rung) -> ReachRow:
    """Return the row with the errors after each number of periods.

    Raises NotRepresentable, Unsettled, and _OtherOrbit if the rung cannot represent the orbit.
    """
    problem = pose(at_quarters(scene, periods), rung)
    _check_orbit(scene, problem)
    trajectory = Taylor().solve(problem)
    is_whole = trajectory.outcome is Outcome.FINISHED
    why = "" if is_whole else f"the run {trajectory.outcome.value}"
    errors = up_to(_errors(problem, trajectory))
    return replace(empty, errors=errors, steps=trajectory.steps, why=why)


def _check_orbit(scene: Scene, problem: Problem) -> None:
    """Raise _OtherOrbit if the rounded data have no period, or a very different one."""
    asked, rounded = period_of(scene), elements(problem.given)
    if "period" not in rounded:
        raise _OtherOrbit(f"rounded to {problem.rung.name}, the orbit is a {rounded.regime} one")
    period = rounded["period"].value
    if not abs(period - mp.convert(asked)) <= mp.convert(_SAME_PERIOD * asked):
        ratio = float(period / mp.convert(asked))
        raise _OtherOrbit(
            f"rounded to {problem.rung.name}, its period is {ratio:.3g} times as long"
        )


def _errors(problem: Problem, trajectory: Trajectory) -> Floats:
    """Return the largest error of all tracked quantities at every instant.

    An error is NaN if the answer is, and infinite for a run that did not finish.
    """
    given, bits = problem.given, working_bits(problem.rung.bits)
    instants = given.clock.elapsed
    if trajectory.outcome is not Outcome.FINISHED:
        return np.full(len(instants), inf)
    truth = solution(given).motion(instants, truth_digits(problem.rung.bits))
    with mp.workprec(bits):
        states = state_errors(given, truth, trajectory.motion(bits))
        bounds = [errors.values + errors.truth_radius for errors in states]
    worst: Floats = np.max(bounds, axis=0)
    return worst


# Floors.


def _with_floors(rows: Sequence[ReachRow], scene: Scene) -> list[ReachRow]:
    """Return the rows with their floors, extended to the end of their periods.

    All rows have the same orbit, because a rung that rounds it to another orbit was not run. Raises
    Unsettled if the conditioning of the orbit cannot be computed.
    """
    followed = max((row.periods[: len(row.errors)] for row in rows), key=len)
    if not followed:
        return list(rows)
    asked = at_quarters(scene, followed)
    return [_with_floor(row, asked) if row.errors else row for row in rows]


def _with_floor(row: ReachRow, asked: Scene) -> ReachRow:
    elapsed, count = asked.clock.elapsed, len(row.errors)
    # Another rung may have been followed further: the steps are then extrapolated in proportion.
    steps = round(row.steps * elapsed[-1] / elapsed[count * QUARTERS - 1])
    attainable = up_to(floors(asked, asked, rung_named(row.rung), steps))[: len(row.periods)]
    lost = () if attainable[-1] < LOST else (inf,) * (len(row.periods) - len(attainable))
    beyond = (inf,) * (len(row.periods) - count)
    return replace(row, errors=row.errors + beyond, floors=attainable + lost)


def up_to(values: Floats) -> tuple[float, ...]:
    """Return the largest number up to the end of each group of quarters; NaN is the largest of all."""
    groups = np.max(np.reshape(values, (-1, QUARTERS)), axis=1)
    return tuple(np.maximum.accumulate(groups).tolist())
