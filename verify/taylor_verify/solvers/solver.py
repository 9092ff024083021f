"""The contract of a solver."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Collection
from typing import ClassVar, Final

from taylor_verify.models.problem import Problem, pose
from taylor_verify.numbers.precision import Rung
from taylor_verify.scenes.bodies import Body
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.trajectory import Outcome, Trajectory

# Characters of an error's text that a verdict holds.
_LONGEST: Final = 2000
# What acts on a body, in the words of a sentence.
_ACTING: Final = {
    "rotor": "wheels",
    "moment": "a moment",
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
    if len(detail) > _LONGEST:
        detail = f"{detail[:_LONGEST]} ... ({len(detail)} characters)"
    return Trajectory(Outcome.RAISED, detail=detail)


def columns(problem: Problem) -> list[tuple[str, int]]:
    """Return the quantities of a state row in their order, each with its number of columns.

    ``omega`` 3, or ``linear_impulse`` 3 and ``angular_impulse`` 3 (body axes); then ``quaternion`` 4
    (scalar first, body to space) and ``centre`` 3 (space axes), as far as they are tracked; then the
    tracked states of the scene's own.
    """
    return [(group.name, len(group.columns)) for group in problem.scene.groups]
