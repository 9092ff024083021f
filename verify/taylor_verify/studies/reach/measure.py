"""Measurement of the reach of each precision: digits left in families of extremes.

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
from typing import Any, Final

import numpy as np
from mpmath import mp

from taylor_verify.batch.runs import run_all
from taylor_verify.exact.elements import elements
from taylor_verify.exact.route import solution
from taylor_verify.exact.solution import Unsettled
from taylor_verify.judge.errors.state import state_errors
from taylor_verify.judge.floor.arithmetic import truth_digits, working_bits
from taylor_verify.judge.floor.attainable import floor
from taylor_verify.judge.provenance import command, processor, versions
from taylor_verify.models.problem import NotRepresentable, Problem, pose
from taylor_verify.records.provenance import SceneProvenance
from taylor_verify.scenes.motion import Motion
from taylor_verify.scenes.precision import Rung
from taylor_verify.scenes.precision import rung as rung_named
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.taylor.driver import Taylor
from taylor_verify.solvers.trajectory import Outcome, Trajectory
from taylor_verify.studies.reach.document import ReachRow, ReachStudy
from taylor_verify.studies.reach.families import (
    FAMILIES,
    QUARTERS,
    Family,
    at_quarters,
    family,
    period_of,
)

# Of a truth that says only how large the motion is.
_DIGITS_OF_SCALES: Final = 15
# From this error on nothing is left, and a longer run would show nothing new.
_LOST: Final = 1.0
# Rounded data whose period differs by more are another orbit, which the rung cannot represent.
_SAME_PERIOD: Final = Fraction(1, 10)

Floats = np.ndarray[Any, np.dtype[np.float64]]
# A family by its name, and a value.
Member = tuple[str, str]


def study(finished: Callable[[str], None] = lambda label: None) -> ReachStudy:
    """Return the document of all rows; ``finished`` is called with each member as it ends."""

    def ended(member: Member, _: object) -> None:
        name, value = member
        finished(family(name).label(value))

    measured = run_all(_measured, members(), expense=_expense, ended=ended)
    return ReachStudy(
        families=tuple(one.described() for one in FAMILIES),
        rows=tuple(stored(row) for rows in measured for row in rows),
        lost=_LOST,
        provenance=SceneProvenance(versions(), processor(), command()),
    )


def members() -> list[Member]:
    """Return every value of every family with its name, small enough to send to a process."""
    return [(one.name, value) for one in FAMILIES for value in one.values]


def reaches(one: Family, value: str, rungs: Iterable[Rung]) -> list[ReachRow]:
    """Return the rows of one member on each of the rungs, with all digits."""
    scene = one.scene(value)
    rows = []
    for rung in rungs:
        nothing = ReachRow(one.name, value, rung.name, one.periods(rung.name), (), (), 0, "")
        rows.append(_followed(nothing, scene, rung))
    return _with_floors(rows, scene)


def stored(row: ReachRow) -> ReachRow:
    """Return the row in its stored form: four digits, and None for an error that is not finite."""
    errors, floors = (
        tuple(None if e is None or not isfinite(e) else float(f"{e:.4g}") for e in each)
        for each in (row.errors, row.floors)
    )
    return replace(row, errors=errors, floors=floors)


class _Another(Exception):  # noqa: N818 (it names what the rounded orbit is)
    """The rounded data have another orbit; the text says which."""


def _followed(nothing: ReachRow, scene: Scene, rung: Rung) -> ReachRow:
    """Return the row with the errors of the periods that were run, or the reason for none."""
    if reason := Taylor().unavailable(rung):
        return replace(nothing, why=reason)
    try:
        # A member that is lost within its first period is not followed further.
        first = _solved(nothing, nothing.periods[:1], scene, rung)
        error = first.errors[-1]
        is_lost = error is None or not error < _LOST
        return first if is_lost else _solved(nothing, nothing.periods, scene, rung)
    except (NotRepresentable, Unsettled, _Another) as fault:
        return replace(nothing, why=str(fault))


def _solved(nothing: ReachRow, periods: Sequence[int], scene: Scene, rung: Rung) -> ReachRow:
    """Return the row with the errors after so many periods.

    Raises NotRepresentable, Unsettled, and _Another if the rung does not have the orbit.
    """
    problem = pose(at_quarters(scene, periods), rung)
    _check_orbit(scene, problem)
    trajectory = Taylor().solve(problem)
    is_whole = trajectory.outcome is Outcome.FINISHED
    why = "" if is_whole else f"the run {trajectory.outcome.value}"
    errors = _up_to(_errors(problem, trajectory))
    return replace(nothing, errors=errors, steps=trajectory.steps, why=why)


def _check_orbit(scene: Scene, problem: Problem) -> None:
    asked, rounded = period_of(scene), elements(problem.given)
    if "period" not in rounded:
        raise _Another(f"rounded to {problem.rung.name}, the orbit is a {rounded.regime} one")
    period = rounded["period"].value
    if not abs(period - mp.convert(asked)) <= mp.convert(_SAME_PERIOD * asked):
        ratio = float(period / mp.convert(asked))
        raise _Another(f"rounded to {problem.rung.name}, its period is {ratio:.3g} times as long")


def _errors(problem: Problem, trajectory: Trajectory) -> Floats:
    """Return the largest error of all tracked quantities at every instant; NaN for NaN."""
    given, bits = problem.given, working_bits(problem.rung.bits)
    instants = given.clock.elapsed
    if trajectory.outcome is not Outcome.FINISHED:
        return np.full(len(instants), inf)
    truth = solution(given).motion(instants, truth_digits(problem.rung.bits))
    with mp.workprec(bits):
        states = state_errors(given, truth, trajectory.motion(bits))
        bounds = [(one.values + one.truth_radius).astype(float) for one in states]
    worst: Floats = np.max(bounds, axis=0)
    return worst


def _with_floors(rows: Sequence[ReachRow], scene: Scene) -> list[ReachRow]:
    """Return the rows with their floors, extended to the end of their periods.

    One orbit serves all rows, because a rung with another orbit has no run. Raises Unsettled if the
    condition of the orbit does not settle.
    """
    followed = max((one.periods[: len(one.errors)] for one in rows), key=len)
    if not followed:
        return list(rows)
    asked = at_quarters(scene, followed)
    truth = solution(asked).motion(asked.clock.elapsed, _DIGITS_OF_SCALES)
    return [_with_floor(one, asked, truth) if one.errors else one for one in rows]


def _with_floor(one: ReachRow, asked: Scene, truth: Motion) -> ReachRow:
    elapsed, count = asked.clock.elapsed, len(one.errors)
    # The orbit may be followed further than on this rung: steps are extrapolated in proportion.
    steps = round(one.steps * elapsed[-1] / elapsed[count * QUARTERS - 1])
    base = floor(asked, asked, rung_named(one.rung).unit_roundoff, steps)
    # Only the parts and their scales are asked for: the truth is compared with itself.
    states = state_errors(asked, truth, truth)
    worst = np.max([base.of_state(errors) for errors in states], axis=0)
    floors = _up_to(worst.astype(float))[: len(one.periods)]
    lost = () if floors[-1] < _LOST else (inf,) * (len(one.periods) - len(floors))
    beyond = (inf,) * (len(one.periods) - count)
    return replace(one, errors=one.errors + beyond, floors=floors + lost)


def _up_to(values: Floats) -> tuple[float, ...]:
    """Return the largest number up to the end of each group of quarters; NaN is the largest of all."""
    groups = np.max(np.reshape(values, (-1, QUARTERS)), axis=1)
    return tuple(np.maximum.accumulate(groups).tolist())


def _measured(member: Member) -> list[ReachRow]:
    name, value = member
    return reaches(family(name), value, map(rung_named, family(name).far))


def _expense(member: Member) -> float:
    """Return the rank of a member by its expense: wide rungs, then extreme values."""
    far = family(member[0]).far
    return -(1000.0 * far.get("mp237", 0) + 100.0 * far.get("f128", 0) + far.get("f64", 0) / 10)
