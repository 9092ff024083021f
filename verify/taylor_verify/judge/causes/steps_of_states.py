"""Steps of a method through a scene with states of its own: replayed from the start; no row has them all.

The error of short steps is fitted to that of the first wrong rows, in h^p; this gives the number of steps.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from fractions import Fraction
from functools import cache, partial
from itertools import pairwise
from typing import Final

import numpy as np

from taylor_verify.judge.causes.candidate import Candidate
from taylor_verify.judge.causes.changed_course import SETTLED, Courses, courses
from taylor_verify.judge.causes.changed_equations import Equations
from taylor_verify.judge.causes.float_answer import Answer, Motion
from taylor_verify.judge.causes.many_flows import Floats
from taylor_verify.judge.causes.replayed_methods import (
    METHODS,
    Method,
    explicit_with_updates,
    with_frames,
)
from taylor_verify.judge.causes.replays import LEAVES, ROUNDINGS, name_of_steps, nearest_count
from taylor_verify.judge.causes.stepped_arcs import Steps, with_steps

# The steps from row to row by which the error of a method is measured, and what may be left to first order.
_FINE: Final = 4
_NEAR: Final = 0.6
_MOST: Final = 100
_EXACT: Final = 1e-6
# A row is at an instant if it is no farther from it than this part of a step.
_APART: Final = 1e-9
# The work that all methods may cost on the first wrong rows.
_TRIED: Final = 800_000.0


def steps_of_states(answer: Answer, few: Courses) -> Iterator[Candidate]:
    """Yield the methods whose steps are the ``few`` first wrong rows, the best first."""
    answer.budget.at_least(_TRIED)
    every = list[tuple[float, Steps]]()
    for name, method in _methods(answer):
        every += _steps(few, answer.spacing, name, method)
        if every and every[-1][0] < max(_EXACT, ROUNDINGS * few.floor):
            break
    for _, steps in sorted(every, key=lambda each: each[0]):
        answer.budget.at_least(SETTLED)
        yield steps.candidate(name_of_steps(steps, answer), LEAVES, {})


def _methods(answer: Answer) -> Iterator[tuple[str, Method]]:
    explicit = ((name, method) for name, method in METHODS.items() if not method.is_dear)
    for name, method in (*explicit, *explicit_with_updates(answer.n), *with_frames()):
        yield name, replace(method, has_frame=True, run=partial(_run, method))


def _run(method: Method, answer: Answer, equations: Equations, h: float, components: int) -> Motion:
    (motion,) = courses(with_steps(replace(answer, right=equations), method, h), [{}], h)
    return motion


def _steps(few: Courses, spacing: float, name: str, method: Method) -> list[tuple[float, Steps]]:
    """Return a method with the number of steps that leaves least; none if that is much, or too dear.

    What it leaves of all quantities comes first: loads need not tell how the attitude is turned.
    """
    answer = few.answer

    @cache
    def motion(count: int) -> Motion:
        """The motion in so many steps from row to row."""
        made: Motion = method.run(answer, answer.right, spacing / count, 0)
        return made

    def error(count: int) -> Floats:
        """The error of so many steps, as `Courses.defects` has it."""
        defects = ((answer.file.v - motion(count).v) / answer.sizes).T
        return np.asarray(few.of_right - defects)

    def left(count: int) -> float:
        part = float(np.linalg.norm(few.of_right - error(count))) / few.size
        return part if np.isfinite(part) else np.inf

    with answer.budget.share(1):
        fine = error(_FINE)
        size = float(np.sum(fine**2))
        part = float(np.sum(fine * few.of_right)) / size if 0 < size < np.inf else 0.0
        if part <= 0 or np.linalg.norm(few.of_right - part * fine) > _NEAR * few.size:
            return []
        count = round(_FINE * part ** (-1 / method.order))
        if count <= _MOST:
            best = nearest_count(left, max(1, count), _MOST)
            if left(best) < max(LEAVES, ROUNDINGS * few.floor):
                steps = Steps(name, method, best, left(best), _sizes(answer, spacing / best))
                return [(max(answer.leaves(motion(best)).values()), steps)]
    return []


def _sizes(answer: Answer, h: float) -> tuple[float, ...]:
    """Return the sizes of steps of about h, which end at the rows and at the instants."""
    loads, rows = answer.right.loads, answer.times.tolist()
    assert loads is not None
    instants = (float(each.time) for each in loads.instants(Fraction(rows[-1])))
    ends = sorted({answer.begins, *rows, *(time for time in instants if time > answer.begins)})
    spans = [b - a for a, b in pairwise(ends) if b - a > _APART * h]
    return tuple(span / max(1, round(span / h)) for span in spans)
