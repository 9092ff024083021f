"""The contract of a solver, and the solver that calls a user's function."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass
from fractions import Fraction
from numbers import Rational
from time import perf_counter
from typing import Any, ClassVar, Final, final

import numpy as np
from mpmath import mp

from taylor_verify.models.problem import Problem, pose
from taylor_verify.numbers.precision import Rung
from taylor_verify.scenes.bodies import Body
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.trajectory import Outcome, Trajectory
from taylor_verify.solvers.values import Value, as_mpf, exact

_RATIONAL_BITS = 4000
# What acts on a body, in the words of a sentence.
_ACTING: Final = {
    "rotor": "wheels",
    "moment": "a moment",
    "manufactured": "a moment that changes with time",
}


class Lack(str):
    """The reason why a solver cannot run, as a sentence, with its kind as an ``outcome``.

    NO_PACKAGE: the sentence ends with the command that installs it. NO_FORMAT: the machine has no such
    numbers. UNSUITED: the solver is not made for the question.
    """

    outcome: Outcome

    def __new__(cls, sentence: str, outcome: Outcome) -> Lack:
        lack = super().__new__(cls, sentence)
        lack.outcome = outcome
        return lack


class Solver(ABC):
    """Something that answers a problem with a trajectory and never raises for a failed run.

    ``name`` is the word of the command line; ``setting`` distinguishes two uses of one solver. A solver
    that ``carries_velocities`` rounds U and Omega of a solid in a fluid, not the impulses.
    ``counts_steps`` is True for solvers whose steps are counted by code of this project. For all others
    the judge limits the claimed steps to a plausible number. Only one that ``takes_loads`` is asked about
    a body under loads that a scene writes down.
    """

    name: str
    setting: str = ""
    carries_velocities: bool = False
    counts_steps: ClassVar[bool] = False
    takes_loads: ClassVar[bool] = False

    def problem(self, scene: Scene, rung: Rung) -> Problem:
        """Return the problem that the solver is asked, with the data that it takes, rounded once.

        Raises NotRepresentable where the rung cannot hold them.
        """
        return pose(scene, rung)

    @abstractmethod
    def solve(self, problem: Problem) -> Trajectory:
        """Return the states at the problem's times, or the outcome that prevented them."""

    def unavailable(self, rung: Rung) -> str:
        """Return the reason why this machine cannot run the solver on that rung; empty where it can.

        A sentence that is no Lack says that the solver is not made for the rung.
        """
        del rung
        return ""

    def unsuited(self, problem: Problem) -> str:
        """Return the reason, known before, why the solver is not made for a problem; empty where it is."""
        if problem.given.body.loads is None or self.takes_loads:
            return ""
        return f"{self.name} does not take loads that a scene writes down"


@final
@dataclass(frozen=True)
class Callback(Solver):
    """A user's function as a solver: ``answer(problem)`` returns states of shape (samples, n).

    Columns: omega, or x and y; then q0..q3 where the attitude is tracked, then the centre where it is, then
    the tracked states of the scene's own. A Python or NumPy number, a Fraction or an mpf is taken exactly.
    A masked number and a table with named columns are refused. An exception is a failed run, and so is
    `sys.exit` with any code; an interrupt stays an interrupt.
    """

    answer: Callable[[Problem], Any]
    name: str = "callback"
    takes_loads = True

    def solve(self, problem: Problem) -> Trajectory:
        began = perf_counter()
        try:
            answered = self.answer(problem)
            if fault := _no_array(answered):
                return Trajectory(Outcome.MISSHAPEN, detail=fault)
            states = np.asarray(answered)
        except (Exception, SystemExit) as error:  # a user's code: its exception is its outcome
            return raised(error)
        seconds = perf_counter() - began
        layout = columns(problem)
        expected = (len(problem.times), sum(width for _, width in layout))
        if states.shape != expected:
            detail = f"expected states of shape {expected}, got {states.shape}"
            return Trajectory(Outcome.MISSHAPEN, detail=detail, seconds=seconds)
        try:
            numbers = np.array([[_as_mpf(v) for v in row] for row in states], dtype=object)
        except TypeError as error:
            return Trajectory(Outcome.MISSHAPEN, detail=str(error), seconds=seconds)
        ends = np.cumsum([width for _, width in layout])[:-1]
        parts = np.split(numbers, ends, axis=1)
        quantities = {name: part for (name, _), part in zip(layout, parts, strict=True)}
        return Trajectory(Outcome.FINISHED, quantities, seconds=seconds)


def float64_alone(name: str, rung: Rung) -> str:
    """Return the reason why a solver made in float64 cannot run on that rung; empty where it can."""
    return "" if rung.name == "f64" else f"{name} is made in float64: f64 alone"


def made_without(name: str, body: Body, takes: Collection[str] = ()) -> str:
    """Return the reason why a solver that takes no more than this is not made for a body; or empty."""
    for part in body.acting:
        if part not in takes:
            return f"{name} is made for a body without {_ACTING.get(part, part)}"
    return ""


def refused(reason: str) -> Trajectory:
    """Return the trajectory of a solver that is not made for the problem, for this reason."""
    return Trajectory(Outcome.UNSUITED, detail=reason)


def not_started(reason: str) -> Trajectory:
    """Return the trajectory of a solver that is not started, with the outcome of what it lacks."""
    outcome = reason.outcome if isinstance(reason, Lack) else Outcome.NOT_STARTED
    return Trajectory(outcome, detail=str(reason))


def raised(error: BaseException) -> Trajectory:
    """Return the trajectory of a solver that ended with an error, a `sys.exit` included."""
    detail = f"{type(error).__name__}: {error}".removesuffix(": ")
    return Trajectory(Outcome.RAISED, detail=detail)


def _no_array(answered: Any) -> str:
    """Return the reason why an answer is no array of numbers; empty where it is one.

    NumPy drops a mask, and a table's columns have names that say more than their order.
    """
    mend = "hand over its columns in the order of a state, as an array"
    if isinstance(answered, Mapping):
        return f"expected an array of states, got a dict ({mend}, or check(scene, the_dict))"
    if hasattr(answered, "columns"):
        return f"expected an array of states, got a {type(answered).__name__} ({mend})"
    rows = answered if isinstance(answered, list | tuple) else [answered]
    masks = [np.ma.getmaskarray(row) for row in rows if isinstance(row, np.ma.MaskedArray)]
    masked = sum(int(np.sum(mask)) for mask in masks)
    return f"expected states without a mask, got {masked} masked numbers" if masked else ""


def columns(problem: Problem) -> list[tuple[str, int]]:
    """Return the quantities of a state row in their order, each with its number of columns.

    ``omega`` 3, or ``linear_impulse`` 3 and ``angular_impulse`` 3 (body axes); then ``quaternion`` 4
    (scalar first, body to space) and ``centre`` 3 (space axes), as far as they are tracked; then the
    tracked states of the scene's own.
    """
    return [(group.name, len(group.columns)) for group in problem.scene.groups]


def _as_mpf(value: Any) -> Any:
    """Return the mpf equal to a number; NaN and infinity stay what they are, and fail every gate.

    A rational that is no binary fraction is rounded to 4000 bits. Raises TypeError for what is no
    real number.
    """
    if isinstance(value, mp.mpf):
        return value
    if isinstance(value, Rational) and not isinstance(value, bool):
        number: Value = Fraction(int(value.numerator), int(value.denominator))
    elif isinstance(value, np.floating | float):
        number = exact(value)
    else:
        raise TypeError(f"expected real numbers, got {value!r} of type {type(value).__name__}")
    return as_mpf(number, _RATIONAL_BITS)
