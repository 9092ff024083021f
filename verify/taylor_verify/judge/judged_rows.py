"""The rows and the record of a judgement, and the run that they are about."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from taylor_verify.exact.route import solution
from taylor_verify.judge.floor.arithmetic import truth_digits
from taylor_verify.judge.provenance import provenance
from taylor_verify.judge.tolerances import Tolerances
from taylor_verify.models.problem import Problem
from taylor_verify.numbers.precision import Rung, hexadecimal
from taylor_verify.records.faults import shown
from taylor_verify.records.record import GateRecord, Record
from taylor_verify.records.status import Status
from taylor_verify.records.verdict import Verdict
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.solver import Solver
from taylor_verify.solvers.trajectory import Outcome, Trajectory

Floats = np.ndarray[Any, np.dtype[np.float64]]


def verdict_on(
    scene: Scene,
    solver: Solver,
    rung: Rung,
    quantity: str,
    status: Status,
    outcome: Outcome,
    **numbers: Any,
) -> Verdict:
    """Return the verdict on one quantity of a run, with its provenance."""
    return Verdict(
        scene=scene.name,
        solver=solver.name,
        rung=rung.name,
        setting=solver.setting,
        quantity=quantity,
        verdict=status,
        outcome=outcome.value,
        provenance=provenance(scene.digest),
        **numbers,
    )


@dataclass(frozen=True)
class Run:
    """A run: the problem, the solver and its answer, shared by all verdicts."""

    problem: Problem
    solver: Solver
    trajectory: Trajectory
    tolerances: Tolerances

    def verdict(self, quantity: str, status: Status, **numbers: Any) -> Verdict:
        """Return the verdict on a quantity, with the costs of the answer."""
        problem, trajectory = self.problem, self.trajectory
        return verdict_on(
            problem.scene,
            self.solver,
            problem.rung,
            quantity,
            status,
            trajectory.outcome,
            roundoff=float(problem.rung.unit_roundoff),
            steps=trajectory.steps,
            evaluations=trajectory.evaluations,
            seconds=trajectory.seconds,
            **numbers,
        )

    @cached_property
    def times(self) -> Floats:
        """Times of the samples."""
        return np.array([float(t) for t in self.problem.given.clock.instants])

    @property
    def start(self) -> float:
        """Time of the initial state."""
        return float(self.problem.given.clock.start)


def question_record(problem: Problem) -> dict[str, Any]:
    """Return what the record of a run holds of its question alone."""
    exact, units = solution(problem.given), problem.units
    return {
        "equations": problem.form.text(),
        "parameters": {n: hexadecimal(value) for n, value in problem.parameter.items()},
        "units": {n: shown(getattr(units, n)) for n in ("time", "momentum", "impulse")},
        "regime": exact.regime,
        "route": exact.route,
        "truth_digits": truth_digits(problem.rung.bits),
        "unit_roundoff": float(problem.rung.unit_roundoff),
    }


def run_record(run: Run, gates: Iterable[GateRecord]) -> Record:
    """Return the record of a run whose quantities were compared."""
    problem, trajectory = run.problem, run.trajectory
    scene = problem.scene
    return Record(
        scene=scene.name,
        title=scene.title,
        solver=run.solver.name,
        rung=problem.rung.name,
        track=tuple(sorted(scene.track)),
        **question_record(problem),
        outcome=trajectory.outcome.value,
        steps=trajectory.steps,
        times=tuple(run.times.tolist()),
        gates=tuple(gates),
    )
