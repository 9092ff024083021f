"""A motion under loads that a scene writes down, piece by piece between their switches.

A solver goes from each switch to the next and begins anew there; a switch is rounded once, as a sample
time is.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from fractions import Fraction
from typing import Any

from taylor_verify.models.problem import Problem, in_piece
from taylor_verify.solvers.trajectory import Outcome, Postponed, Trajectory

Solve = Callable[[Problem], Trajectory]


def piece_by_piece(problem: Problem, solve: Solve) -> Trajectory:
    """Return the trajectory that ``solve`` makes of each piece of time, from where the one before ended.

    ``solve`` takes a problem that begins at ``begin`` and returns states that are still to be formed.
    """
    legs = list(_legs(problem))
    if len(legs) == 1:
        return solve(problem)
    rows: list[Any] = []
    answers: list[Trajectory] = []
    state = problem.initial_momenta
    for leg, samples in legs:
        answer = solve(replace(leg, initial_momenta=state))
        answers.append(answer)
        quantities = answer.quantities
        if answer.outcome is not Outcome.FINISHED or not isinstance(quantities, Postponed):
            return _together(answers, replace(answer, quantities={}))
        rows += list(quantities.states[:samples])
        exact = quantities.exact
        state = tuple(map(exact, quantities.states[-1]))
    return _together(answers, replace(answer, quantities=Postponed(problem, rows, exact)))


def _legs(problem: Problem) -> Iterator[tuple[Problem, int]]:
    """Yield the problem of each piece of time, and how many of its times are samples.

    The last time of a piece is its end, a sample or not.
    """
    loads = problem.given.body.loads
    if loads is None or not loads.switches:
        yield problem, len(problem.times)
        return
    rounded, unit = problem.rung.round, problem.units.time
    times = list(problem.times)
    is_later = times[-1] > 0
    sign = 1 if is_later else -1
    begin, after, done = Fraction(0), Fraction(0), 0
    while True:
        piece = loads.piece(after, is_later)
        switch = piece.end if is_later else piece.begin
        end = times[-1] if switch is None else rounded(switch / unit)
        if sign * end >= sign * times[-1]:
            yield (
                replace(in_piece(problem, piece), begin=begin, times=times[done:]),
                len(times) - done,
            )
            return
        count = sum(sign * t <= sign * end for t in times[done:])
        inside = times[done : done + count]
        if end != begin:
            whole = inside if inside and inside[-1] == end else [*inside, end]
            yield replace(in_piece(problem, piece), begin=begin, times=whole), count
            done += count
        assert switch is not None
        begin, after = end, switch


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
