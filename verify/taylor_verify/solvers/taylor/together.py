"""Many problems at once: in float64 those of one form go side by side in heyoka's batches."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Sequence
from fractions import Fraction
from time import perf_counter
from typing import Any, Final

from taylor_verify.models.problem import Problem
from taylor_verify.solvers.taylor.alike import Alike
from taylor_verify.solvers.taylor.driver import Taylor
from taylor_verify.solvers.taylor.lanes import Lanes, prepare, propagate
from taylor_verify.solvers.taylor.numbers import arithmetic
from taylor_verify.solvers.trajectory import Outcome, Postponed, Trajectory

_BATCHED: Final = "f64"
# That many numbers at most are asked for together: eight megabytes, and some copies.
_MOST_NUMBERS: Final = 2**20


def solve_together(
    problems: Sequence[Problem], tolerance: Fraction | None = None
) -> list[Trajectory]:
    """Return the trajectory of each problem, in their order; ``tolerance`` is as in Taylor.

    Problems on f64 with one form and as many samples go side by side, several in each instruction. Among 64
    of them, one takes two fifths to a ninth of the time that it takes alone, and is rounded otherwise. The
    seconds of a trajectory are its share. All other problems are solved one by one.
    """
    alone = Taylor(tolerance=tolerance)
    answers: dict[int, Trajectory] = {}
    for places in _alike(problems):
        some = [problems[place] for place in places]
        if some[0].rung.name == _BATCHED and not alone.unavailable(some[0].rung):
            answers |= zip(places, _side_by_side(some, tolerance), strict=True)
        else:
            answers |= zip(places, map(alone.solve, some), strict=True)
    return [answers[place] for place in range(len(problems))]


def _alike(problems: Sequence[Problem]) -> Iterator[list[int]]:
    """Yield the places of problems of one rung and form with as many samples, not too many together."""
    groups: defaultdict[Any, list[int]] = defaultdict(list)
    for place, problem in enumerate(problems):
        groups[problem.rung.name, problem.form, len(problem.times)].append(place)
    for (_, form, samples), places in groups.items():
        most = max(1, _MOST_NUMBERS // (samples * len(form.states)))
        yield from (places[first : first + most] for first in range(0, len(places), most))


def _side_by_side(problems: Sequence[Problem], tolerance: Fraction | None) -> list[Trajectory]:
    began = perf_counter()
    alike = Alike.of(problems)
    prepare(alike.form, tolerance)
    ready = perf_counter()
    lanes = propagate(alike, tolerance)
    share = (perf_counter() - ready) / len(problems)
    compiling = (ready - began) / len(problems)
    return [
        answer(problem, lanes, place, seconds=share, compile_seconds=compiling)
        for place, problem in enumerate(problems)
    ]


def answer(
    problem: Problem, lanes: Lanes, place: int, seconds: float, compile_seconds: float
) -> Trajectory:
    """Return the trajectory of the problem in a lane, with the times that are its own."""
    outcome, steps = lanes.outcomes[place], int(lanes.steps[place])
    is_finished = outcome is Outcome.FINISHED
    exact = arithmetic(problem.rung).exact
    return Trajectory(
        outcome,
        Postponed(problem, lanes.rows[:, place].T, exact) if is_finished else {},
        steps=steps,
        evaluations=steps * lanes.order,
        seconds=seconds,
        compile_seconds=compile_seconds,
    )
