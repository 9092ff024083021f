# /// script
# requires-python = ">=3.10"
# dependencies = []
# ///
"""A worked example: the classical Runge-Kutta method as a program that can be judged.

    taylor-verify run euler/generic --solver "process:python rk4.py step=0.01"

question.py reads the question and writes the answer, equations.py has the equations; both stand beside it,
and nothing but the standard library is needed. ``step`` is the longest step, in the scene's own time.
"""

from __future__ import annotations

import math
import time
from itertools import pairwise

from question import Question, Row, Settings, Solved, answer, equations_of

EVALUATIONS = 4


def solve(question: Question, settings: Settings) -> Solved:
    equations = equations_of(question)

    def rates(state: Row) -> Row:
        return [question.sign * rate for rate in equations(state, question.parameters)]

    def ahead(state: Row, h: float) -> Row:
        k1 = rates(state)
        k2 = rates(moved(state, h / 2, k1))
        k3 = rates(moved(state, h / 2, k2))
        k4 = rates(moved(state, h, k3))
        slopes = zip(state, k1, k2, k3, k4, strict=True)
        return [s + h / 6 * (a + 2 * b + 2 * c + d) for s, a, b, c, d in slopes]

    began = time.perf_counter()
    rows, steps = [question.state], 0
    for before, instant in pairwise(question.instants):
        # Whole steps of equal length from sample to sample, so that none is interpolated.
        count = math.ceil((instant - before) / settings.step)
        state: Row = rows[-1]
        for _ in range(count):
            state = ahead(state, (instant - before) / count)
        rows.append(list(state))
        steps += count
    return Solved(
        rows, steps, EVALUATIONS * steps, time.perf_counter() - began, compile_seconds=0.0
    )


def moved(state: Row, h: float, rates: Row) -> Row:
    return [s + h * rate for s, rate in zip(state, rates, strict=True)]


if __name__ == "__main__":
    answer(solve)
