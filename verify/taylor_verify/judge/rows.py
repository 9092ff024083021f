"""The rows and records of a judgement: a verdict, the terms of its gate, a run."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from math import fsum, inf
from typing import Any

import numpy as np

from taylor_verify.exact.solution import Solution
from taylor_verify.judge.errors.balances import ClockWork
from taylor_verify.judge.errors.shift import Shift
from taylor_verify.judge.errors.state import Errors, Floats
from taylor_verify.judge.floor.attainable import Floor
from taylor_verify.judge.floor.steps import Steps
from taylor_verify.judge.gates import judge
from taylor_verify.judge.provenance import provenance
from taylor_verify.judge.tolerances import Tolerances
from taylor_verify.models.problem import Problem
from taylor_verify.records.doubles import Doubles, four_digits
from taylor_verify.records.reason import Carried, Reason
from taylor_verify.records.record import GateRecord, Record
from taylor_verify.records.status import Status
from taylor_verify.records.verdict import Verdict
from taylor_verify.scenes.precision import Rung, hexadecimal
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.solver import Solver
from taylor_verify.solvers.trajectory import Outcome, Trajectory

Gated = tuple[Verdict, GateRecord]


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

    def gated(
        self,
        errors: Errors,
        attainable: Floats,
        reason: Reason,
        shift: Shift | None = None,
        at_samples: bool = True,
    ) -> Gated:
        """Return the verdict on errors, and the terms of their gate to the four digits that pictures need.

        A ``shift`` that roundings alone cause differs on every machine, so it is not given as a reason.
        """
        finding = judge(errors, attainable, reason, self.tolerances.of(errors.quantity))
        is_told = not (finding.status is Status.PASS and finding.is_rounding)
        reason, shifts, late = finding.reason, tuple[float, ...](), dict[str, Any]()
        if shift is not None:
            late = shift.numbers()
            reason = replace(reason, shift=shift.terms()) if is_told else reason
            shifts = shift.at_samples if is_told and at_samples else ()
        instants, worst = self.problem.given.clock.instants, finding.worst
        verdict = self.verdict(
            errors.quantity,
            finding.status,
            max=float(errors.doubles[worst]),
            mean=_mean(errors.doubles),
            final=float(errors.doubles[-1]),
            at=float(instants[worst]),
            unit=errors.unit,
            bound=finding.bound,
            tolerance=finding.tolerance,
            reason=reason,
            attainable=float(attainable[worst]),
            ratio=finding.ratio,
            ratio_at=float(instants[finding.ratio_at]),
            change=errors.change,
            **late,
        )
        gate = GateRecord(
            quantity=errors.quantity,
            unit=errors.unit,
            errors=four_digits(errors.doubles),
            attainable=four_digits(attainable),
            truth_radius=_bound(float(np.max(errors.widths))),
            shifts=four_digits(shifts),
        )
        return verdict, gate

    def gated_in_full(self, errors: Errors, attainable: Floats, reason: Reason) -> Gated:
        """Return the verdict on errors, and the terms of their gate to the last digit."""
        verdict, gate = self.gated(errors, attainable, reason)
        full, width = Doubles(errors.doubles), float(np.max(errors.widths))
        gate = replace(gate, errors=full, attainable=Doubles(attainable), truth_radius=width)
        # The seconds of an answer from another program are not known.
        return replace(verdict, seconds=None), gate


@dataclass(frozen=True)
class Gates:
    """The gates of a run: comparison of errors with the roundoff ``floor`` of the counted ``steps``."""

    run: Run
    floor: Floor
    steps: Steps

    def state(self, errors: Errors, shift: Shift | None, at_samples: bool) -> Gated:
        """Return the verdict on a state quantity, with the shift of time that explains its error."""
        attainable = self.floor.of_state(errors)
        reason = self._reason(errors, attainable, Carried.ORBIT)
        return self.run.gated(errors, attainable, reason, shift, at_samples)

    def conserved(self, errors: Errors, attainable: Floats, work: ClockWork | None) -> Gated:
        """Return the verdict on a conserved quantity.

        ``attainable`` is the drift by rounding the momenta; ``work`` is the effect of a clock's roundings.
        """
        if work is not None:
            (scale,) = errors.parts.values()
            steps, times = max(self.steps.counted, len(self.floor.times)), self.floor.times
            roundoff = self.run.problem.rung.unit_roundoff
            attainable = np.hypot(attainable, work.drift(roundoff, steps, times, scale))
        reason = self._reason(errors, attainable, Carried.GRADIENT, work is not None)
        return self.run.gated(errors, attainable, reason)

    def unit_quaternion(self, excess: Floats | None) -> list[Gated]:
        """Return the row on quaternions that are not of unit length; empty if they are, to roundoff.

        ``excess`` (n,) is |q| - 1; a length that is not finite is a failure of the attitude.
        """
        if excess is None or not np.isfinite(excess).all():
            return []
        row = self.run.gated(*self.floor.lengths(excess))
        return [row] if row[0].verdict is Status.FAIL else []

    def _reason(
        self, errors: Errors, attainable: Floats, carried: Carried, clock_work: bool = False
    ) -> Reason:
        terms = self.floor.terms(attainable, errors, carried)
        return Reason(floor=replace(terms, clock_work=clock_work), claim=self.steps.claim)


def _mean(errors: Floats) -> float:
    """Return the mean; infinite if the sum overflows."""
    try:
        return fsum(errors) / len(errors)
    except OverflowError:
        return inf


def _bound(radius: float) -> float:
    """Return a radius rounded up to three digits: further digits depend on how the truth was computed."""
    return float(f"{1.006 * radius:.3g}")


def run_record(run: Run, exact: Solution, digits: int, gates: Iterable[GateRecord]) -> Record:
    """Return the record of a run whose quantities were compared."""
    problem, trajectory = run.problem, run.trajectory
    scene, units = problem.scene, problem.units
    return Record(
        scene=scene.name,
        title=scene.title,
        solver=run.solver.name,
        rung=problem.rung.name,
        track=tuple(sorted(scene.track)),
        equations=problem.form.text(),
        parameters={n: hexadecimal(value) for n, value in problem.parameter.items()},
        units={n: str(getattr(units, n)) for n in ("time", "momentum", "impulse")},
        regime=exact.regime,
        route=exact.route,
        truth_digits=digits,
        outcome=trajectory.outcome.value,
        steps=trajectory.steps,
        unit_roundoff=float(problem.rung.unit_roundoff),
        times=Doubles(float(t) for t in problem.given.clock.instants),
        gates=tuple(gates),
    )
