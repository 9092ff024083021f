"""The judgement of one trajectory: every quantity compared, every comparison a verdict."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from mpmath import mp

from taylor_verify.exact.route import solution
from taylor_verify.exact.solution import Solution, Unsettled
from taylor_verify.judge.costs import CONDITION, CONSERVED, Costs
from taylor_verify.judge.diagnosis import diagnosed
from taylor_verify.judge.errors.balances import ClockWork, clock_work
from taylor_verify.judge.errors.measured import Comparison
from taylor_verify.judge.errors.shift import Shift
from taylor_verify.judge.errors.state import Errors
from taylor_verify.judge.floor.arithmetic import truth_digits, working_bits
from taylor_verify.judge.floor.attainable import Floats, Floor, floor
from taylor_verify.judge.floor.steps import Steps, count_steps
from taylor_verify.judge.floor.unit_quaternion import unit_quaternion
from taylor_verify.judge.gates import Finding, index_of_largest, judge
from taylor_verify.judge.rows import gate_record, numbers_of, run_record, verdict_on
from taylor_verify.judge.tolerances import NO_TOLERANCES, Tolerances
from taylor_verify.models.problem import Problem
from taylor_verify.records.answers import LikelyCause
from taylor_verify.records.quantities import MAIN, UNIT_QUATERNION
from taylor_verify.records.reason import Carried, Cause, Kind, Reason, stated
from taylor_verify.records.record import GateRecord, Record
from taylor_verify.records.showing import counts, dataframe, html_table
from taylor_verify.records.status import Status
from taylor_verify.records.verdict import Verdict, exit_status
from taylor_verify.scenes.mpfr import in_mpfr
from taylor_verify.scenes.precision import Rung
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.solver import Solver
from taylor_verify.solvers.trajectory import Outcome, Trajectory

if TYPE_CHECKING:
    import pandas


class NotPassed(AssertionError):
    """A judgement that is no pass; the text is every verdict that is none, with its reason."""


@dataclass(frozen=True, repr=False)
class Judgement:
    """The verdicts of one run and the record they rest on (None if the run never came to a truth).

    ``costs`` are processor seconds by stage: solving, the exact motion, the orbit's condition, ...
    ``causes`` explain nearly all of the error of a quantity that failed. The truth value of a judgement is
    ``passed``.
    """

    verdicts: tuple[Verdict, ...]
    record: Record | None
    costs: Mapping[str, float] = field(default_factory=dict, kw_only=True)
    causes: tuple[LikelyCause, ...] = field(default=(), kw_only=True)

    @property
    def passed(self) -> bool:
        """Whether a gate was judged, and nothing failed or stayed undecided."""
        was_judged = any(verdict.verdict is Status.PASS for verdict in self.verdicts)
        return was_judged and exit_status(self.verdicts) == 0

    def __bool__(self) -> bool:
        return self.passed

    def to_dataframe(self) -> pandas.DataFrame:
        """Return a pandas.DataFrame with a row for each verdict, and its fields as columns.

        Raises ModuleNotFoundError without pandas (``pip install pandas``).
        """
        return dataframe(verdict.row() for verdict in self.verdicts)

    def __repr__(self) -> str:
        first, word = self.verdicts[0], "passed" if self.passed else "not passed"
        run = " ".join(filter(None, (first.scene, first.solver, first.setting, first.rung)))
        return f"<{type(self).__name__} of {run}: {word}; {counts(self.verdicts)}>"

    def __str__(self) -> str:
        """Return the sentence of every quantity, a line each."""
        return "\n".join([repr(self)[1:-1], *(verdict.sentence for verdict in self.verdicts)])

    def _repr_html_(self) -> str:
        headings = ("quantity", "verdict", "largest error", "allowed", "unit")
        rows = (
            (v.quantity, v.verdict.value, _short(v.max), _short(v.bound), v.unit)
            for v in self.verdicts
        )
        return html_table(repr(self)[1:-1], headings, rows, [v.sentence for v in self.verdicts])

    def raise_for_failure(self) -> None:
        """Raise NotPassed, an AssertionError, unless the judgement passed."""
        if not self.passed:
            others = [v for v in self.verdicts if v.verdict is not Status.PASS]
            lines = [f"{v.verdict}  {v.scene} {v.rung} {v.sentence}" for v in others]
            lines += [cause.line for cause in self.causes]
            raise NotPassed("\n".join(lines) or "nothing was judged")


def _short(value: float | None) -> str:
    return "" if value is None else f"{value:.3g}"


@dataclass(frozen=True)
class _Run:
    """What is the same in every verdict of a run."""

    problem: Problem
    solver: Solver
    trajectory: Trajectory
    steps: Steps
    tolerances: Tolerances

    def judge(self, errors: Errors, attainable: Floats, terms: Reason) -> Finding:
        return judge(errors, attainable, terms, self.tolerances.of(errors.quantity))

    def verdict(self, quantity: str, status: Status, **numbers: Any) -> Verdict:
        problem, trajectory = self.problem, self.trajectory
        return verdict_on(
            *(problem.scene, self.solver, problem.rung, quantity, status, trajectory.outcome),
            roundoff=float(problem.rung.unit_roundoff),
            steps=trajectory.steps,
            evaluations=trajectory.evaluations,
            seconds=trajectory.seconds,
            **numbers,
        )


def judgement(
    problem: Problem,
    solver: Solver,
    trajectory: Trajectory,
    seconds: float | None = None,
    tolerances: Tolerances = NO_TOLERANCES,
) -> Judgement:
    """Compare a trajectory with the exact solution of the same rounded data, and judge it.

    ``seconds`` is how long the answer took by the caller's clock, which limits the steps that a solver
    may claim. ``tolerances`` take the place of bounds. A trajectory that is not finished, and a truth
    that cannot be had, are verdicts and raise nothing.
    """
    run = _Run(problem, solver, trajectory, Steps(trajectory.steps), tolerances)
    main = MAIN[problem.scene.model]
    if trajectory.outcome is not Outcome.FINISHED:
        status = Status.UNAVAILABLE if trajectory.outcome.is_unavailable else Status.FAIL
        return Judgement((run.verdict(main, status, reason=_unfinished(trajectory)),), None)
    exact = solution(problem.given)
    try:
        steps = count_steps(problem, solver, trajectory.steps, seconds)
        return _compare(replace(run, steps=steps), exact)
    except Unsettled as doubt:
        reason = stated(Cause.NO_TRUTH, str(doubt))
        return Judgement((run.verdict(main, Status.UNDECIDED, reason=reason),), None)


def _unfinished(trajectory: Trajectory) -> Reason:
    if trajectory.outcome.is_unavailable:
        return stated(Cause.UNFINISHED, str(trajectory.detail))
    detail = f" ({trajectory.detail})" if trajectory.detail else ""
    text = f"a run that did not finish is not scored: it {trajectory.outcome.value}{detail}"
    return stated(Cause.UNFINISHED, text)


def _compare(run: _Run, exact: Solution) -> Judgement:
    problem, trajectory = run.problem, run.trajectory
    given, bits = problem.given, problem.rung.bits
    digits, costs = truth_digits(bits), Costs()
    roundoff, by_velocities = problem.rung.unit_roundoff, run.solver.carries_velocities
    with mp.workprec(working_bits(bits)), costs.of(CONDITION):
        base = floor(given, problem.scene, roundoff, run.steps.counted, by_velocities)
    compared = Comparison(given, exact, trajectory.quantities, digits, working_bits(bits))
    measured = compared.measured(base.nodes, costs)
    with mp.workprec(working_bits(bits)):
        gated = [
            _state(run, base, errors, shift, measured.is_shifted_whole)
            for errors, shift in zip(measured.states, measured.shifts, strict=True)
        ]
        with costs.of(CONSERVED):
            work, quick = clock_work(problem.scene), in_mpfr(measured.at_nodes)
            gated += [
                _conserved(
                    run,
                    base,
                    base.of_gradients(invariant, quick, _scale(errors)),
                    errors,
                    work.get(invariant.name),
                )
                for invariant, errors in measured.drifts
            ]
            gated += _lengths(run, base, measured.excess)
    gates = tuple(gate for _, gate in gated)
    record = run_record(problem, run.solver.name, trajectory, exact, digits, gates)
    verdicts = tuple(_diagnosed(run, verdict, gate) for verdict, gate in gated)
    return Judgement(verdicts, record, costs=costs.seconds)


def _diagnosed(run: _Run, verdict: Verdict, gate: GateRecord) -> Verdict:
    clock = run.problem.given.clock
    times, errors = np.array([float(t) for t in clock.instants]), np.array(gate.errors)
    return diagnosed(verdict, times, float(clock.start), errors, np.array(gate.attainable))


def _scale(errors: Errors) -> Any:
    return next(iter(errors.parts.values()))


Gated = tuple[Verdict, GateRecord]


def _state(
    run: _Run, base: Floor, errors: Errors, shift: Shift | None, is_shifted_whole: bool
) -> Gated:
    attainable = base.of_state(errors)
    finding = run.judge(errors, attainable, _reason(run, base, errors, attainable, Carried.ORBIT))
    if shift is None:
        return _verdict(run, errors, attainable, finding), gate_record(errors, attainable)
    # A shift that roundings alone have made is another one on every machine.
    is_told = not (finding.status is Status.PASS and finding.is_rounding)
    if is_told:
        finding = replace(finding, reason=replace(finding.reason, shift=shift.terms()))
    verdict = replace(
        _verdict(run, errors, attainable, finding),
        time_shift=shift.time_shift,
        residual=shift.residual,
        shift=shift.kind.value,
        trend=shift.trend if shift.kind is Kind.DRIFTING else None,
        remains=None if shift.kind is Kind.NONE else shift.remains,
    )
    shifts = shift.at_samples if is_told and is_shifted_whole else ()
    return verdict, gate_record(errors, attainable, shifts)


def _lengths(run: _Run, base: Floor, excess: Floats | None) -> list[Gated]:
    """The row of quaternions that are no unit quaternions; none where they are."""
    allowed = run.tolerances.of(UNIT_QUATERNION)
    failed = None if excess is None else unit_quaternion(excess, base, allowed)
    if failed is None:
        return []
    errors, attainable, finding = failed
    return [(_verdict(run, errors, attainable, finding), gate_record(errors, attainable))]


def _conserved(
    run: _Run, base: Floor, attainable: Floats, errors: Errors, work: ClockWork | None
) -> Gated:
    """``attainable`` is what rounding the momenta leaves; under a clock its roundings do ``work`` too."""
    if work is not None:
        steps = max(run.steps.counted, len(base.times))
        roundoff = run.problem.rung.unit_roundoff
        attainable = np.hypot(attainable, work.drift(roundoff, steps, base.times, _scale(errors)))
    reason = _reason(run, base, errors, attainable, Carried.GRADIENT, work is not None)
    finding = run.judge(errors, attainable, reason)
    return _verdict(run, errors, attainable, finding), gate_record(errors, attainable)


def _reason(
    run: _Run,
    base: Floor,
    errors: Errors,
    attainable: Floats,
    carried: Carried,
    clock_work: bool = False,
) -> Reason:
    terms = base.terms(attainable, index_of_largest(errors.doubles), carried)
    return Reason(floor=replace(terms, clock_work=clock_work), claim=run.steps.claim)


def _verdict(run: _Run, errors: Errors, attainable: Floats, finding: Finding) -> Verdict:
    numbers = numbers_of(errors, attainable, finding, run.problem.given.clock.instants)
    return run.verdict(errors.quantity, finding.status, **numbers)


def unjudged(
    scene: Scene,
    solver: Solver,
    rung: Rung,
    status: Status,
    why: str,
    cause: Cause,
    outcome: Outcome = Outcome.NOT_REPRESENTABLE,
) -> Judgement:
    """The judgement of a run that could not begin."""
    reason = stated(cause, str(why))
    verdict = verdict_on(scene, solver, rung, MAIN[scene.model], status, outcome, reason=reason)
    return Judgement((verdict,), None)
