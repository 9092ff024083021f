"""The rows and records that a judgement is written down in: a verdict, the terms of its gate, a run."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from fractions import Fraction
from math import fsum, inf
from typing import Any

import numpy as np

from taylor_verify.exact.solution import Solution
from taylor_verify.judge.errors.state import Errors, Floats
from taylor_verify.judge.gates import Finding
from taylor_verify.judge.provenance import provenance
from taylor_verify.models.problem import Problem
from taylor_verify.records.doubles import Doubles, four_digits
from taylor_verify.records.record import GateRecord, Record
from taylor_verify.records.status import Status
from taylor_verify.records.verdict import Verdict
from taylor_verify.scenes.precision import Rung, hexadecimal
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.solver import Solver
from taylor_verify.solvers.trajectory import Outcome, Trajectory


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


def numbers_of(
    errors: Errors, attainable: Floats, finding: Finding, instants: Sequence[Fraction]
) -> dict[str, Any]:
    """Return the numbers of a verdict on a compared quantity, by the names of its fields."""
    worst = finding.worst
    return {
        "max": float(errors.doubles[worst]),
        "mean": _mean(errors.doubles),
        "final": float(errors.doubles[-1]),
        "at": float(instants[worst]),
        "unit": errors.unit,
        "bound": finding.bound,
        "tolerance": finding.tolerance,
        "reason": finding.reason,
        "attainable": float(attainable[worst]),
        "ratio": finding.ratio,
        "ratio_at": float(instants[finding.ratio_at]),
        "change": errors.change,
    }


def _mean(errors: Floats) -> float:
    """Return the mean; infinite where the sum is beyond doubles."""
    try:
        return fsum(errors) / len(errors)
    except OverflowError:
        return inf


def gate_record(errors: Errors, attainable: Floats, shifts: Iterable[float] = ()) -> GateRecord:
    """Return the terms of a gate at every sample, to the four digits that a picture needs."""
    return GateRecord(
        quantity=errors.quantity,
        unit=errors.unit,
        errors=four_digits(errors.doubles),
        attainable=four_digits(attainable),
        truth_radius=_bound(float(np.max(errors.widths))),
        shifts=four_digits(shifts),
    )


def _bound(radius: float) -> float:
    """Three digits, and not less: the rest tells how the truth was come by, which may differ by run."""
    return float(f"{1.006 * radius:.3g}")


def run_record(
    problem: Problem,
    solver: str,
    trajectory: Trajectory,
    exact: Solution,
    digits: int,
    gates: tuple[GateRecord, ...],
) -> Record:
    """Return the record of a run whose quantities were compared."""
    scene, units = problem.scene, problem.units
    return Record(
        scene=scene.name,
        title=scene.title,
        solver=solver,
        rung=problem.rung.name,
        track=tuple(sorted(scene.track)),
        equations=problem.form.text(),
        parameters={n: hexadecimal(value) for n, value in problem.parameter.items()},
        units={
            "time": str(units.time),
            "momentum": str(units.momentum),
            "impulse": str(units.impulse),
        },
        regime=exact.regime,
        route=exact.route,
        truth_digits=digits,
        outcome=trajectory.outcome.value,
        steps=trajectory.steps,
        unit_roundoff=float(problem.rung.unit_roundoff),
        times=Doubles(float(t) for t in problem.given.clock.instants),
        gates=gates,
    )
