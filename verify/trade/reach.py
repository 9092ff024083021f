"""How far each precision carries: digits left of families of extremes, over their number and periods.

Every member of a family is solved once on a rung, at the quarters of its 1st, 3rd, 10th ... period. The
digits left after N periods are -log10 of the largest error at any instant up to then, against the
exact motion of the data that the solver was given; the attainable error beside it is the judge's own, of
the same orbit, instants and steps. An error of 1 is the size of the motion: from there on none are left.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from math import ceil, inf, isfinite, log10
from typing import Any, Final

import numpy as np
from mpmath import mp

from verify.exact.elements import elements
from verify.exact.route import solution
from verify.judge.attainable import floor
from verify.judge.errors import largest, state_errors
from verify.judge.provenance import provenance
from verify.models.problem import NotRepresentable, Problem, pose
from verify.scenes.precision import Rung
from verify.scenes.precision import rung as rung_named
from verify.scenes.scene import Scene
from verify.solvers.taylor.driver import Taylor
from verify.solvers.trajectory import Outcome, Trajectory
from verify.standard import available_cores, on_all_cores
from verify.trade.families import QUARTERS, Family, at_quarters, families, family, period_of

# As the judge has them.
_MORE_DIGITS: Final = 3
_SPARE_BITS: Final = 96
# From here on nothing is left, and a longer run would tell nothing new.
_LOST: Final = 1.0
# Rounded data whose period is off by more are another orbit: the rung cannot hold the number asked for.
_SAME_PERIOD: Final = Fraction(1, 10)


@dataclass(frozen=True)
class Reach:
    """One member of a family on one rung, after each number of ``periods``.

    ``errors`` and ``floors`` are the largest up to then, as many as there are periods; an error of a run
    that was lost is inf from there on. Both are empty where nothing was run, and ``why`` says why.
    """

    family: str
    value: str
    rung: str
    periods: tuple[int, ...]
    errors: tuple[float, ...] = ()
    floors: tuple[float, ...] = ()
    steps: int = 0
    why: str = ""

    def row(self) -> dict[str, Any]:
        """As JSON holds it: an error that is not finite is None, and stands for a lost motion."""
        return {
            "family": self.family,
            "value": self.value,
            "rung": self.rung,
            "periods": list(self.periods),
            "errors": [_finite(error) for error in self.errors],
            "floors": [_finite(error) for error in self.floors],
            "steps": self.steps,
            "why": self.why,
        }


def document(finished: Callable[[str], None] | None = None) -> dict[str, Any]:
    """Every row of what is published; ``finished`` is told each member of a family as it ends."""
    found = families()
    asked = [Member(one.name, value) for one in found for value in one.values]

    def tell(member: Member) -> None:
        if finished is not None:
            finished(member.label)

    reaches = on_all_cores(_measured, asked, _expense, tell, available_cores())
    return {
        "families": [_described(one) for one in found],
        "rows": [one.row() for member in reaches for one in member],
        "lost": _LOST,
        "provenance": provenance(""),
    }


@dataclass(frozen=True)
class Member:
    """One value of one family, by name: what a process is sent."""

    family: str
    value: str
    rungs: tuple[str, ...] = field(default=())

    @property
    def label(self) -> str:
        return family(self.family).label(self.value)


def members() -> int:
    """How many members all families have together."""
    return sum(len(one.values) for one in families())


def reach(one: Family, value: str, rung: Rung) -> Reach:
    """What is left of one member on one rung."""
    scene, periods = one.scene(value), one.periods(rung.name)
    nothing = Reach(one.name, value, rung.name, periods)
    if reason := Taylor().unavailable(rung):
        return _because(nothing, reason)
    try:
        # A member that is lost within a period is not followed for a thousand.
        first = _after(scene, periods[:1], rung)
        rest = first if not first.errors[-1] < _LOST else _after(scene, periods, rung)
    except (NotRepresentable, _Another) as fault:
        return _because(nothing, str(fault))
    return Reach(
        *(one.name, value, rung.name, periods),
        errors=_to_the_end(rest.errors, periods),
        floors=_to_the_end(rest.floors, periods),
        steps=rest.steps,
        why=rest.why,
    )


class _Another(Exception):  # noqa: N818 (it names what the rounded orbit is)
    """Rounding the data makes another orbit of them; the text says which."""


@dataclass(frozen=True)
class _Followed:
    """A run: for every number of periods the largest error and floor up to then."""

    errors: tuple[float, ...]
    floors: tuple[float, ...]
    steps: int
    why: str = ""


def _after(scene: Scene, periods: Sequence[int], rung: Rung) -> _Followed:
    """Raises NotRepresentable, and _Another where the rung has no such orbit."""
    asked = at_quarters(scene, periods)
    problem = pose(asked, rung)
    _check_orbit(scene, problem)
    trajectory = Taylor().solve(problem)
    if trajectory.outcome is not Outcome.FINISHED:
        why = f"the run {trajectory.outcome.value}"
        return _Followed((inf,), (inf,), trajectory.steps, why)
    errors, floors = _errors_and_floors(asked, problem, trajectory)
    return _Followed(_up_to(errors), _up_to(floors), trajectory.steps)


def _check_orbit(scene: Scene, problem: Problem) -> None:
    asked, found = period_of(scene), elements(problem.given)
    if "period" not in found:
        raise _Another(f"rounded to {problem.rung.name}, the orbit is a {found.regime} one")
    period = found["period"].value
    if not abs(period - mp.convert(asked)) <= mp.convert(_SAME_PERIOD * asked):
        ratio = float(period / mp.convert(asked))
        raise _Another(f"rounded to {problem.rung.name}, its period is {ratio:.3g} times as long")


def _errors_and_floors(
    asked: Scene, problem: Problem, trajectory: Trajectory
) -> tuple[list[float], list[float]]:
    """At every instant the largest of all tracked quantities; NaN where an answer is no number."""
    rung, given = problem.rung, problem.given
    digits = ceil(rung.bits * log10(2)) + _MORE_DIGITS
    truth = solution(given).motion(given.clock.elapsed, digits)
    with mp.workprec(rung.bits + _SPARE_BITS):
        states = state_errors(given, truth, trajectory.motion(rung.bits + _SPARE_BITS))
        base = floor(given, asked, truth, rung.unit_roundoff, trajectory.steps)
        bounds = [one.values + one.truth_radius for one in states]
        errors = [float(largest(row)) for row in zip(*bounds, strict=True)]
        floors = np.max([base.of_state(one) for one in states], axis=0)
    return errors, floors.tolist()


def _up_to(values: Sequence[float]) -> tuple[float, ...]:
    """The largest up to the end of each group of quarters."""
    return tuple(
        float(largest(values[: end + QUARTERS])) for end in range(0, len(values), QUARTERS)
    )


def _to_the_end(values: Sequence[float], periods: Sequence[int]) -> tuple[float, ...]:
    """Beyond where a run was given up it is lost."""
    return (*values, *(inf for _ in periods[len(values) :]))


def _because(nothing: Reach, why: str) -> Reach:
    return Reach(nothing.family, nothing.value, nothing.rung, nothing.periods, why=why)


def _measured(member: Member) -> list[Reach]:
    one = family(member.family)
    return [reach(one, member.value, rung_named(name)) for name in member.rungs or one.far]


def _expense(member: Member) -> float:
    """The longest first: the wide rungs of a family, whose periods are long where it is extreme."""
    far = family(member.family).far
    return -(1000.0 * far.get("mp237", 0) + 100.0 * far.get("f128", 0) + far.get("f64", 0) / 10)


def _described(one: Family) -> dict[str, Any]:
    return {
        "name": one.name,
        "title": one.title,
        "symbol": one.symbol,
        "extreme": one.extreme,
        "values": list(one.values),
        "rungs": dict(one.far),
    }


def rows(reaches: Iterable[Reach]) -> list[dict[str, Any]]:
    return [one.row() for one in reaches]


def _finite(value: float) -> float | None:
    return float(f"{value:.4g}") if isfinite(value) else None
