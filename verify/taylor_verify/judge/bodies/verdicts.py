"""The verdicts on many free rigid bodies that pass clearly; all others are left to the judge of one body.

The floor, the truth and the bounds agree with those of the judge of one body to some digits. The answers
differ: a lane uses other instructions than the integrator of one body. The roundings of the two are two
draws of one sum, whose root mean square is the floor. A body is judged here only if its lane passes every
gate with an error below a quarter of the bound, 2.5 floors. The other draw would get another verdict only
above ten floors, which a sum of hundreds of roundings practically never reaches. Every other body, and so
every body that fails, is left to the judge of one body.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, Final

import numpy as np

from taylor_verify.judge.bodies.floor import Floors, nodes
from taylor_verify.judge.bodies.measured import Measured, Quantity, lengths
from taylor_verify.judge.gates import TRUTH_SHARE
from taylor_verify.judge.initial import right_start
from taylor_verify.judge.provenance import provenance
from taylor_verify.records.error_kind import ErrorKind
from taylor_verify.records.quantities import GATE_FACTOR, INITIAL
from taylor_verify.records.reason import Carried, Cause, Reason, RoundoffFloor, shown
from taylor_verify.records.status import Status
from taylor_verify.records.verdict import Verdict
from taylor_verify.scenes.precision import Rung
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.trajectory import Outcome

Floats = np.ndarray[Any, np.dtype[np.float64]]

# An error below this part of the bound is far from it.
_FAR: Final = 1 / 4
# A bound below this is far from 1, the size of the motion, at which it would forbid nothing.
_LARGEST_BOUND: Final = 1e-3


@dataclass(frozen=True)
class Gate:
    """A quantity of n bodies, with its roundoff floor ``attainable`` (n, m)."""

    quantity: Quantity
    attainable: Floats
    carried: Carried

    @property
    def is_far(self) -> Any:
        """Return True for the bodies (n) that would pass even if every error were four times as large."""
        bounds = GATE_FACTOR * self.attainable
        passes = (self.quantity.errors <= _FAR * bounds) & (bounds <= _LARGEST_BOUND)
        passes &= TRUTH_SHARE * self.quantity.widths <= _FAR * bounds
        return passes.all(axis=1)


def gates(measured: Measured, floors: Floors, inverse: Floats, roundoff: float) -> list[Gate]:
    """Return the gates of states and conserved quantities, for bodies of these inverse moments (3, n)."""
    H = measured.momentum[:, :, nodes(measured.momentum.shape[2])]
    gradients: dict[str, tuple[Floats, Floats | float]] = {
        "T": (inverse[:, :, None] * H, 0.0),
        "H2": (2 * H, 0.0),
        "H_space": (np.ones_like(H), lengths(H)),
    }
    result = []
    for quantity, by_orbit in zip(measured.states, (floors.omega, floors.attitude), strict=False):
        assert by_orbit is not None
        result.append(Gate(quantity, roundoff * by_orbit / quantity.scale[:, None], Carried.ORBIT))
    for quantity in measured.conserved:
        momentum, turn = (
            gradient / quantity.scale[:, None] for gradient in gradients[quantity.name]
        )
        drift = roundoff * floors.of_gradients(momentum, turn)
        result.append(Gate(quantity, drift, Carried.GRADIENT))
    return result


def are_unit(excess: Floats, floors: Floors, roundoff: float) -> Any:
    """Return True for the bodies (n) whose quaternions are clearly of unit length."""
    bounds = GATE_FACTOR * roundoff * np.maximum(floors.reached, 1.0)
    return (abs(excess) <= _FAR * bounds).all(axis=1)


@dataclass(frozen=True)
class Run:
    """The solver, the rung and the lanes of n bodies.

    ``times`` (n, m) are the times of the samples since the start; ``unit`` (n) is the unit of time of the
    shifts. ``steps`` (n) are the steps of each lane, each of ``evaluations`` evaluations; a lane took
    ``seconds``.
    """

    solver: str
    rung: Rung
    times: Floats
    unit: Floats
    steps: Any
    evaluations: int
    seconds: float


def verdicts(
    run: Run, scenes: Mapping[int, Scene], gates: Sequence[Gate], measured: Measured, floors: Floors
) -> dict[int, list[Verdict]]:
    """Return the verdicts on passing bodies, by place, each list in the order of the judge of one body.

    ``scenes`` maps the places of the bodies asked for to their scenes.
    """
    columns = [_columns(run, gate, floors) for gate in gates]
    known = provenance("")
    by_place = {}
    for k, scene in scenes.items():
        shared: dict[str, Any] = {
            "scene": scene.name,
            "solver": run.solver,
            "rung": run.rung.name,
            "setting": "",
            "verdict": Status.PASS,
            "outcome": Outcome.FINISHED.value,
            "roundoff": float(run.rung.unit_roundoff),
            "error_kind": ErrorKind.ROUNDOFF,
            "steps": int(run.steps[k]),
            "evaluations": int(run.steps[k]) * run.evaluations,
            "seconds": run.seconds,
            "provenance": {**known, "scene": scene.digest},
        }
        instants = _Instants(scene.clock.start, run.times[k])
        # Shifts belong to the states, which come first.
        unit = float(run.unit[k])
        late = [shifts.numbers(k, unit) for shifts in measured.shifts]
        late += [{}] * (len(columns) - len(late))
        rows = [
            _row(column, k, instants, shared | numbers)
            for column, numbers in zip(columns, late, strict=True)
        ]
        if not run.times[k, 0]:
            states = columns[: len(measured.states)]
            start = max(states, key=lambda column: column.start_ratio(k))
            rows.insert(0, _start(start, k, instants, shared))
        by_place[k] = rows
    return by_place


@dataclass(frozen=True)
class _Instants:
    start: Fraction
    times: Floats

    def __getitem__(self, place: int) -> float:
        elapsed = float(self.times[place])
        return float(self.start + Fraction(elapsed)) if self.start else elapsed


@dataclass(frozen=True)
class _Columns:
    """The numbers of one gate, as lists over the bodies; ``at`` and ``ratio_at`` are sample indices."""

    gate: Gate
    bits: int
    max: list[float]
    mean: list[float]
    final: list[float]
    at: list[int]
    attainable: list[float]
    ratio: list[float]
    ratio_at: list[int]
    steps: list[float]
    growth: list[float]
    change: list[float | None]

    def start(self, k: int) -> tuple[float, float]:
        """Return the error of a body at its first sample and the floor there, in four digits each."""
        error, value = self.gate.quantity.errors[k, 0], self.gate.attainable[k, 0]
        return shown(float(error)), shown(float(value))

    def start_ratio(self, k: int) -> float:
        """Return the error of a body at its first sample over the floor there."""
        error, value = self.start(k)
        return error / value


def _columns(run: Run, gate: Gate, floors: Floors) -> _Columns:
    errors, attainable, every = gate.quantity.errors, gate.attainable, np.arange(len(run.times))
    worst = np.argmax(errors, axis=1)
    ratios = errors / attainable
    ratio_at = np.argmax(ratios, axis=1)
    value = attainable[every, worst]
    steps = np.maximum(1, np.rint(floors.reached[every, worst]))
    growth = value / (float(run.rung.unit_roundoff) * np.sqrt(steps))
    change = gate.quantity.change
    return _Columns(
        gate,
        run.rung.bits,
        errors[every, worst].tolist(),
        np.mean(errors, axis=1).tolist(),
        errors[:, -1].tolist(),
        worst.tolist(),
        value.tolist(),
        ratios[every, ratio_at].tolist(),
        ratio_at.tolist(),
        steps.tolist(),
        growth.tolist(),
        [None] * len(every) if change is None else change.tolist(),
    )


def _row(column: _Columns, k: int, instants: _Instants, shared: dict[str, Any]) -> Verdict:
    gate, value = column.gate, column.attainable[k]
    steps, growth = round(column.steps[k]), shown(column.growth[k])
    floor = RoundoffFloor(gate.carried, shown(value), column.bits, steps, growth)
    return Verdict(
        quantity=gate.quantity.name,
        max=column.max[k],
        mean=column.mean[k],
        final=column.final[k],
        at=instants[column.at[k]],
        unit=gate.quantity.unit,
        bound=GATE_FACTOR * value,
        reason=Reason(floor=floor, factor=float(GATE_FACTOR)),
        attainable=value,
        ratio=column.ratio[k],
        ratio_at=instants[column.ratio_at[k]],
        change=column.change[k],
        until=instants[-1],
        **shared,
    )


def _start(column: _Columns, k: int, instants: _Instants, shared: dict[str, Any]) -> Verdict:
    """Return the verdict on the row at the start, from the four digits that a record stores."""
    quantity, at = column.gate.quantity, instants[0]
    error, value = column.start(k)
    reason = Reason(floor=RoundoffFloor(Carried.START, value), factor=float(GATE_FACTOR))
    return Verdict(
        quantity=INITIAL,
        max=error,
        mean=error,
        final=error,
        at=at,
        unit=quantity.unit,
        bound=GATE_FACTOR * value,
        reason=reason.with_remark(Cause.START, right_start(at)),
        attainable=value,
        ratio=error / value,
        ratio_at=at,
        until=at,
        **shared,
    )
