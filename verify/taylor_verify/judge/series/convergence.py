"""The order of convergence of a solver with fixed steps, which is judged at every step of a sweep."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from math import ceil
from os import PathLike
from typing import Any, final

from taylor_verify.judge.judgement import judgement
from taylor_verify.models.problem import NotRepresentable, Problem, pose
from taylor_verify.numbers.precision import Rung
from taylor_verify.numbers.precision import rung as rung_named
from taylor_verify.records.observed_order import SAME, Convergence, convergence
from taylor_verify.records.quantities import INITIAL
from taylor_verify.records.status import Status
from taylor_verify.records.verdict import Verdict
from taylor_verify.scenes.reading.positive import positive
from taylor_verify.scenes.reading.reader import as_scene
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.callback import Callback
from taylor_verify.solvers.solver import Solver
from taylor_verify.solvers.trajectory import Trajectory


@dataclass(frozen=True)
class Sweep:
    """The convergence of every quantity of a scene, and the verdicts with its errors."""

    quantities: Mapping[str, Convergence]
    verdicts: tuple[Verdict, ...]

    @property
    def reason(self) -> str:
        """Orders in one line: `omega is 4th order, attitude 2nd`."""
        orders = {name: convergence_of.order for name, convergence_of in self.quantities.items()}
        known = [(name, _ordinal(order)) for name, order in orders.items() if order is not None]
        words = [f"{n} {o}" if i else f"{n} is {o} order" for i, (n, o) in enumerate(known)]
        words += [f"{name} has none" for name, order in orders.items() if order is None]
        return ", ".join(words)

    def __str__(self) -> str:
        """Return the line ``reason``, followed by the reason of every quantity."""
        wide = max(map(len, self.quantities), default=0)
        rows = [f"  {name:{wide}}  {quantity.reason}" for name, quantity in self.quantities.items()]
        return "\n".join([self.reason, *rows])


def sweep(
    scene: Scene | str | PathLike[str],
    solve_with_step: Callable[[Problem, float], Any],
    steps: Sequence[float],
    rung: Rung | str = "f64",
    expected: float | None = None,
) -> Sweep:
    """Judge ``solve_with_step(problem, step) -> states`` at every step, in the scene's unit of time.

    ``states`` have the form that taylor_verify.check expects; ``expected`` is the nominal order of the
    method. A run that raises, or returns NaN, has no error at its step. Raises ValueError if the rung
    cannot represent the scene, and for a step that is not a positive number.
    """
    scene, rung = as_scene(scene), rung_named(rung)
    steps = [positive(step, f"steps[{i}]") for i, step in enumerate(steps)]
    try:
        problem = pose(scene, rung)
    except NotRepresentable as reason:
        raise ValueError(f"expected a scene that {rung.name} can hold, got: {reason}") from reason
    solvers = [_AtStep(solve_with_step, step, f"step {step:g}") for step in steps]
    judged = [judgement(problem, solver, solver.solve(problem)).verdicts for solver in solvers]
    by_step = [{verdict.quantity: verdict for verdict in verdicts} for verdicts in judged]
    verdicts = tuple(verdict for solver in judged for verdict in solver)
    quantities = {}
    for name in dict.fromkeys(
        v.quantity for v in verdicts if v.at is not None and v.quantity != INITIAL
    ):
        rows = [solver.get(name) for solver in by_step]
        # If the truth is wider than a gate allows, the error is unknown too.
        errors = [r.max if r and r.verdict is not Status.UNDECIDED else None for r in rows]
        floors = [(row.attainable or 0.0) if row else 0.0 for row in rows]
        quantities[name] = convergence(steps, errors, floors, expected)
    return Sweep(quantities, verdicts)


@final
@dataclass(frozen=True)
class _AtStep(Solver):
    """A solver that calls a function with one fixed step; it counts as many steps as fit into the span."""

    answer: Callable[[Problem, float], Any]
    step: float
    setting: str
    name: str = "fixed step"

    def solve(self, problem: Problem) -> Trajectory:
        trajectory = Callback(lambda posed: self.answer(posed, self.step)).solve(problem)
        span = max(abs(t) for t in problem.given.clock.elapsed)
        return replace(trajectory, steps=ceil(float(span) / self.step))


def _ordinal(order: float) -> str:
    """Return an order as text: `4th` for 3.97, and the number itself if it is not nearly an integer."""
    nearest = round(order)
    if not abs(order - nearest) <= SAME:
        return f"{order:.2f}th"
    ending = {1: "st", 2: "nd", 3: "rd"}.get(nearest % 10, "th")
    return f"{nearest}{ending if nearest not in (11, 12, 13) else 'th'}"
