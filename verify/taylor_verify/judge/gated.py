"""The gates of a run: for each quantity its errors, the floor that they are compared with, and the verdict.

The floor is whole before the gate is judged: the roundings of the steps, and for an answer from elsewhere
the rounding of the input.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from math import fsum, inf
from typing import Any, Final

import numpy as np
from mpmath import mp

from taylor_verify.exact.conditioning.loaded import Linearised, truth
from taylor_verify.exact.solution import Solution
from taylor_verify.judge.diagnosis import diagnosed
from taylor_verify.judge.errors.laws import Laws
from taylor_verify.judge.errors.measured import Comparison, Measured
from taylor_verify.judge.errors.shift import Shift
from taylor_verify.judge.errors.state import Errors, Floats
from taylor_verify.judge.floor.arithmetic import truth_digits, working_bits
from taylor_verify.judge.floor.attainable import Floor, floor
from taylor_verify.judge.floor.counted_steps import Steps
from taylor_verify.judge.floor.rounded_input import InputRounding
from taylor_verify.judge.gates import Finding, index_of_largest, judge
from taylor_verify.judge.judged_rows import Run
from taylor_verify.records.reason import Carried, InputShare, Reason, RoundoffFloor
from taylor_verify.records.record import GateRecord, four_digits
from taylor_verify.records.status import Status
from taylor_verify.records.verdict import Verdict
from taylor_verify.scenes.mpfr import in_mpfr

_OF_VELOCITY: Final = {"omega": Carried.VELOCITY, "linear_velocity": Carried.LINEAR_VELOCITY}


@dataclass(frozen=True)
class Gate:
    """The errors of one quantity and the ``attainable`` error at all samples; ``terms`` explain the latter.

    ``shift`` is the shift of time behind the errors of a state. ``is_shifted_whole`` is True if it uses all
    samples.
    """

    run: Run
    errors: Errors
    attainable: Floats
    terms: Reason
    shift: Shift | None = None
    is_shifted_whole: bool = False

    def with_input(self, inputs: InputRounding, roundoff: float) -> Gate:
        """Return the gate whose floor is the root sum of squares of the roundings and of the input.

        Errors that agree to four digits are equal, so that the first of them is the largest.
        """
        # The length of a quaternion does not depend on the input.
        moved = inputs.at_samples.get(self.errors.quantity, np.zeros(len(self.attainable)))
        both = np.hypot(self.attainable, moved)
        largest, errors = np.max(self.errors.values), np.array(four_digits(self.errors.values))
        worst = index_of_largest(errors)
        if self.tolerance is not None:
            # A tolerance leaves no room for rounding.
            errors = np.fmin(errors, largest)
            errors[worst] = largest
        share = InputShare(inputs.moved, roundoff, float(moved[worst]), float(both[worst]))
        return replace(
            self,
            errors=replace(self.errors, values=errors),
            attainable=both,
            terms=replace(self.terms, input=share),
        )

    @property
    def tolerance(self) -> float | None:
        """The tolerance of the caller; None if the bound follows from the arithmetic."""
        return self.run.tolerances.of(self.errors.quantity)

    @cached_property
    def finding(self) -> Finding:
        """The comparison of all samples with their bounds."""
        return judge(self.errors, self.attainable, self.terms, self.tolerance)

    @property
    def is_explained(self) -> bool:
        """True if roundings explain the errors. Their shift of time differs on every machine."""
        return self.finding.status is Status.PASS and self.finding.is_rounding

    @cached_property
    def verdict(self) -> Verdict:
        """The verdict on the quantity."""
        finding, times, errors = self.finding, self.run.times, self.errors.values
        reason, late = finding.reason, dict[str, Any]()
        if self.shift is not None:
            late = self.shift.numbers()
            reason = reason if self.is_explained else replace(reason, shift=self.shift.terms())
        verdict = self.run.verdict(
            self.errors.quantity,
            finding.status,
            max=float(errors[finding.worst]),
            mean=_mean(errors),
            final=float(errors[-1]),
            at=float(times[finding.worst]),
            unit=self.errors.unit,
            bound=finding.bound,
            tolerance=finding.tolerance,
            reason=reason,
            attainable=float(self.attainable[finding.worst]),
            ratio=finding.ratio,
            ratio_at=float(times[finding.ratio_at]),
            change=self.errors.change,
            **late,
        )
        errors, floors = (np.array(four_digits(x)) for x in (errors, self.attainable))
        return diagnosed(verdict, times, self.run.start, errors, floors)

    @cached_property
    def record(self) -> GateRecord:
        """The terms of the gate to the four digits that pictures need."""
        is_shown = self.shift is not None and self.is_shifted_whole and not self.is_explained
        return GateRecord(
            quantity=self.errors.quantity,
            unit=self.errors.unit,
            errors=four_digits(self.errors.values),
            attainable=four_digits(self.attainable),
            truth_radius=_bound(float(np.max(self.errors.truth_radius))),
            shifts=four_digits(self.shift.at_samples if self.shift and is_shown else ()),
        )


def gates_of(run: Run, steps: Steps, inputs: InputRounding | None = None) -> list[Gate]:
    """Return the gates of all quantities that an answer determines.

    ``inputs`` are the effect of the input's rounding on an answer from elsewhere. Raises Unsettled if the
    exact motion cannot be computed.
    """
    problem, solver, rung = run.problem, run.solver, run.problem.rung
    bits, digits = working_bits(rung.bits), truth_digits(rung.bits)
    roundoff, velocities = rung.unit_roundoff, solver.carries_velocities
    with mp.workprec(bits):
        base = floor(problem.given, problem.scene, roundoff, steps.counted, velocities)
    answer, exact = run.trajectory.quantities, truth(problem.given, digits)
    compared = Comparison(problem.given, exact, answer, digits, bits)
    measured = compared.measured(base.nodes)
    with mp.workprec(bits):
        gates = _Gates(run, base, steps, measured)
        every = [*gates.states(), *gates.conserved(), *gates.sound_attitude()]
        every += [*gates.velocities(), *gates.laws(exact, digits, bits)]
    if any(np.isnan(gate.attainable).any() for gate in every):
        raise OverflowError("a floor is beyond the doubles")
    return [gate.with_input(inputs, float(roundoff)) if inputs else gate for gate in every]


@dataclass(frozen=True)
class _Gates:
    """The gates of what was ``measured``; ``floor`` is the roundoff floor of the counted ``steps``."""

    run: Run
    floor: Floor
    steps: Steps
    measured: Measured

    def states(self) -> Iterator[Gate]:
        measured = self.measured
        for errors, shift in zip(measured.states, measured.shifts, strict=True):
            attainable = self.floor.of_state(errors)
            terms = self._terms(errors, attainable, Carried.ORBIT)
            yield Gate(self.run, errors, attainable, terms, shift, measured.is_shifted_whole)

    def conserved(self) -> Iterator[Gate]:
        """Yield the gates of drifts by rounding the momenta."""
        at_nodes = in_mpfr(self.measured.at_nodes)
        for invariant, errors in self.measured.drifts:
            (scale,) = errors.parts.values()
            if invariant.name in self.measured.worked:
                attainable = self.floor.of_values(invariant, at_nodes, scale)
                terms = self._terms(errors, attainable, Carried.WORK)
                yield Gate(self.run, errors, attainable, terms)
                continue
            attainable = self.floor.of_gradients(invariant, at_nodes, scale)
            terms = self._terms(errors, attainable, Carried.GRADIENT)
            yield Gate(self.run, errors, attainable, replace(terms, conserved=invariant.because))

    def sound_attitude(self) -> Iterator[Gate]:
        """Yield the gate of quaternions not of unit length, or of matrices that are no rotations.

        There is none if they are sound to roundoff. A length that is not finite is a failure of the
        attitude.
        """
        excess = self.measured.excess
        if excess is not None and np.isfinite(excess).all():
            has_matrices = "quaternion" not in self.run.trajectory.quantities
            gate = Gate(self.run, *self.floor.lengths(excess, has_matrices))
            if gate.finding.status is Status.FAIL:
                yield gate

    def velocities(self) -> Iterator[Gate]:
        for one in self.measured.velocities:
            attainable = self.floor.of_velocity(one.group, one.errors, one.sizes)
            terms = Reason(floor=RoundoffFloor(_OF_VELOCITY[one.group]))
            yield Gate(self.run, one.errors, attainable, terms, one.shift)

    def laws(self, exact: Solution, digits: int, bits: int) -> Iterator[Gate]:
        """Yield the gates of held values against their laws, where truth and orbit come together."""
        given, orbit = self.run.problem.given, self.floor.orbit
        if not isinstance(exact, Linearised):
            return
        motion = exact.motion(given.clock.elapsed, digits)
        roundoff = float(self.run.problem.rung.unit_roundoff)
        answer = self.run.trajectory.quantities
        for errors, attainable in Laws(given, motion, orbit, answer, bits, roundoff):
            yield Gate(self.run, errors, attainable, Reason(floor=RoundoffFloor(Carried.LAW)))

    def _terms(self, errors: Errors, attainable: Floats, carried: Carried) -> Reason:
        terms = self.floor.terms(attainable, errors, carried)
        return Reason(floor=terms, claim=self.steps.claim)


def _mean(errors: Floats) -> float:
    """Return the mean; infinite if the sum overflows."""
    try:
        return fsum(errors) / len(errors)
    except OverflowError:
        return inf


def _bound(radius: float) -> float:
    """Return a radius rounded up to three digits: further digits depend on how the truth was computed."""
    return float(f"{1.006 * radius:.3g}")
