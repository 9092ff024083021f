"""The contract of a solver, and the solver that is a callable of one's own."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from time import perf_counter
from typing import Any, final

import numpy as np
from mpmath import mp

from verify.models.problem import Problem
from verify.scenes.precision import Rung
from verify.solvers.trajectory import Outcome, Trajectory


class Solver(ABC):
    """Something that answers a problem with a trajectory and never raises for a failed run.

    ``name`` is the word of the command line; ``setting`` tells two uses of one solver apart.
    """

    name: str
    setting: str = ""

    @abstractmethod
    def solve(self, problem: Problem) -> Trajectory:
        """The states at the problem's times, or the outcome that prevented them."""

    def unavailable(self, rung: Rung) -> str:
        """Why this machine cannot run the solver on that rung; empty where it can."""
        del rung
        return ""


@final
@dataclass(frozen=True)
class Callback(Solver):
    """A solver of one's own: ``answer(problem)`` returns states of shape (samples, n).

    Columns: omega, or x and y; then q0..q3 where the attitude is tracked, then the centre where it
    is. Any real number that is a Python float, an int, an mpf or a NumPy scalar is taken exactly.
    """

    answer: Callable[[Problem], Any]
    name: str = "callback"
    setting: str = ""

    def solve(self, problem: Problem) -> Trajectory:
        began = perf_counter()
        try:
            states = np.asarray(self.answer(problem))
        except Exception as error:  # a stranger's code: whatever it raises is its outcome
            return Trajectory(Outcome.RAISED, detail=f"{type(error).__name__}: {error}")
        seconds = perf_counter() - began
        layout = columns(problem)
        expected = (len(problem.times), sum(width for _, width in layout))
        if states.shape != expected:
            detail = f"expected states of shape {expected}, got {states.shape}"
            return Trajectory(Outcome.MISSHAPEN, detail=detail, seconds=seconds)
        held = np.array([[_held(v) for v in row] for row in states], dtype=object)
        quantities, left = {}, 0
        for quantity, width in layout:
            quantities[quantity] = held[:, left : left + width]
            left += width
        return Trajectory(Outcome.FINISHED, quantities, seconds=seconds)


def columns(problem: Problem) -> list[tuple[str, int]]:
    """The quantities of a state row in their order, each with its number of columns."""
    if problem.scene.model == "euler":
        layout = [("omega", 3)]
    else:
        layout = [("linear_impulse", 3), ("angular_impulse", 3)]
    if "attitude" in problem.scene.track:
        layout.append(("quaternion", 4))
    if "centre" in problem.scene.track:
        layout.append(("centre", 3))
    return layout


def _held(value: Any) -> Any:
    """The mpf equal to a number; NaN and infinity stay what they are, and fail every gate."""
    if isinstance(value, mp.mpf):
        return value
    if isinstance(value, (np.floating, float)):
        if not np.isfinite(value):
            return mp.mpf(float(value))
        numerator, denominator = value.as_integer_ratio()
    else:
        numerator, denominator = int(value), 1
    with mp.workprec(max(numerator.bit_length(), 2)):
        return mp.ldexp(mp.mpf(numerator), 1 - denominator.bit_length())
