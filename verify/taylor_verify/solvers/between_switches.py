"""A motion under loads that a scene writes down, from each switch and each instant to the next.

A solver begins anew at a switch, and at an instant at which held states of the scene take their values.
Both are rounded once, as sample times are.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from fractions import Fraction
from typing import Any, NamedTuple

from taylor_verify.models.problem import Problem, in_piece
from taylor_verify.models.stretch import holding, taking
from taylor_verify.numbers.tensors import Vector
from taylor_verify.scenes.loads.loads import Loads
from taylor_verify.scenes.loads.states import Instant
from taylor_verify.solvers.solver import raised
from taylor_verify.solvers.trajectory import Outcome, Postponed, Trajectory

Solve = Callable[[Problem], Trajectory]


class Leg(NamedTuple):
    """The problem of a stretch of time, how many of its times are samples, and what is taken at its end.

    The last time of a leg is its end, a sample or not.
    """

    problem: Problem
    samples: int
    instant: Instant | None = None

    @property
    def ends_on_sample(self) -> bool:
        return self.samples == len(self.problem.times)


def piece_by_piece(problem: Problem, solve: Solve) -> Trajectory:
    """Return the trajectory that ``solve`` makes of each leg, from where the one before ended.

    ``solve`` takes a problem that begins at ``begin`` and returns states that are still to be formed.
    """
    loads = problem.given.body.loads
    if loads is None or not (loads.switches or problem.held_names):
        return solve(problem)
    way = _Way(problem)
    try:
        for leg in legs(problem, loads):
            if not way.goes(leg, solve):
                break
    except OverflowError:
        raise
    except (ArithmeticError, ValueError) as error:  # a held value that there is not
        return raised(error)
    return way.trajectory()


class _Way:
    """The answers to the legs so far, and the state and the held values at their end."""

    def __init__(self, problem: Problem) -> None:
        self._problem, self._state, self._held = problem, problem.initial_momenta, problem.held
        self._rows: list[list[Any]] = []
        self._answers: list[Trajectory] = []

    def goes(self, leg: Leg, solve: Solve) -> bool:
        """Go on by a leg; return False where the solver does not finish it."""
        if not self._answers:
            self._held = held_at_start(self._problem)
        posed = replace(holding(leg.problem, self._held), initial_momenta=self._state)
        answer = solve(posed)
        self._answers.append(answer)
        quantities = answer.quantities
        if answer.outcome is not Outcome.FINISHED or not isinstance(quantities, Postponed):
            return False
        self._exact = quantities.exact
        self._state = tuple(map(self._exact, quantities.states[-1]))
        before = quantities.states[: leg.samples]
        held = self._held
        if leg.instant is not None:
            self._held = taking(posed, leg.instant, self._state)
        self._rows += [[*row, *held] for row in before]
        if leg.ends_on_sample and held:
            self._rows[-1][-len(held) :] = self._held
        return True

    def trajectory(self) -> Trajectory:
        last = self._answers[-1]
        if last.outcome is not Outcome.FINISHED:
            return _together(self._answers, replace(last, quantities={}))
        return _together(
            self._answers,
            replace(last, quantities=Postponed(self._problem, self._rows, self._exactly)),
        )

    def _exactly(self, number: Any) -> Fraction:
        return number if isinstance(number, Fraction) else self._exact(number)


def held_at_start(problem: Problem) -> Vector:
    """Return the held values from the start on."""
    first = problem.takings[:1]
    if first and not first[0].time:
        return taking(problem, first[0], problem.initial_momenta)
    return problem.held


def legs(problem: Problem, loads: Loads) -> Iterator[Leg]:
    """Yield the legs of a motion, in the direction of time."""
    times, is_later = list(problem.times), problem.times[-1] > 0
    sign = 1 if is_later else -1
    piece = loads.piece(Fraction(0), is_later)
    posed = in_piece(problem, piece)
    begin, done = Fraction(0), 0
    for end, exactly, instant in _stops(problem, loads):
        if end != begin:
            first = done
            while done < len(times) and sign * times[done] <= sign * end:
                done += 1
            whole = times[first:done]
            if not whole or whole[-1] != end:
                whole.append(end)
            yield Leg(replace(posed, begin=begin, times=whole), done - first, instant)
        begin = end
        after = loads.piece(exactly, is_later)
        if after is not piece:
            piece, posed = after, in_piece(problem, after)


def _stops(problem: Problem, loads: Loads) -> Iterator[tuple[Fraction, Fraction, Instant | None]]:
    """Yield the ends of all legs in units, exactly as elapsed times, and what is taken there."""
    unit, last = problem.units.time, problem.times[-1]
    sign = 1 if last > 0 else -1
    stops: dict[Fraction, tuple[Fraction, Instant | None]] = {}
    for switch in loads.switches[::sign]:
        stops[problem.rung.round(switch / unit)] = switch, None
    for instant in problem.takings:
        exactly, _ = stops.get(instant.time / unit, (instant.time, None))
        stops[instant.time / unit] = max(exactly, instant.time), instant
    stops.setdefault(last, (last * unit, None))
    for end in sorted(stops, key=lambda time: sign * time):
        if 0 < sign * end <= sign * last:
            yield (end, *stops[end])


def _together(legs: list[Trajectory], last: Trajectory) -> Trajectory:
    """Return the whole of several legs, with the outcome and the states of the last."""
    inner = [leg.inner_seconds for leg in legs if leg.inner_seconds is not None]
    return replace(
        last,
        steps=sum(leg.steps for leg in legs),
        evaluations=sum(leg.evaluations for leg in legs),
        seconds=sum(leg.seconds for leg in legs),
        compile_seconds=sum(leg.compile_seconds for leg in legs),
        inner_seconds=sum(inner) if inner else None,
    )
