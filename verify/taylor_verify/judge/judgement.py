"""The judgement of one trajectory: a verdict for every compared quantity."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, fields
from typing import TYPE_CHECKING, Any

from taylor_verify.exact.route import end_of_motion
from taylor_verify.exact.solution import Unsettled
from taylor_verify.judge.first_row import initial_verdict
from taylor_verify.judge.floor.counted_steps import count_steps
from taylor_verify.judge.gated import gates_of
from taylor_verify.judge.judged_rows import Run, run_record, verdict_on
from taylor_verify.judge.tolerances import NO_TOLERANCES, Tolerances
from taylor_verify.models.problem import Problem
from taylor_verify.numbers.precision import Rung
from taylor_verify.records.answers import LikelyCause
from taylor_verify.records.passing import Passing
from taylor_verify.records.quantities import MAIN
from taylor_verify.records.reason import Carried, Cause, stated
from taylor_verify.records.record import Record
from taylor_verify.records.showing import counts, dataframe, html_table, picture
from taylor_verify.records.status import Status
from taylor_verify.records.verdict import Verdict, exit_status
from taylor_verify.scenes.doubles import within_doubles
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.solver import Solver
from taylor_verify.solvers.trajectory import Outcome, Trajectory
from taylor_verify.words.account import account
from taylor_verify.words.cells import figure

if TYPE_CHECKING:
    import pandas


@dataclass(frozen=True, repr=False)
class Judgement(Passing):
    """The verdicts of one run and the record of their numbers (None if there was nothing to compare).

    ``causes`` explain nearly all of the error of a failed quantity. ``notes`` are sentences on the answer
    itself, such as that its numbers are float32, and on what was not compared. The truth value of a
    judgement is ``passed``.
    """

    verdicts: tuple[Verdict, ...]
    record: Record | None
    causes: tuple[LikelyCause, ...] = field(default=(), kw_only=True)
    notes: tuple[str, ...] = field(default=(), kw_only=True)

    @property
    def passed(self) -> bool:
        """True if a gate was judged, and nothing failed or stayed undecided."""
        was_judged = any(verdict.verdict is Status.PASS for verdict in self.verdicts)
        return was_judged and exit_status(self.verdicts) == 0

    @property
    def remarks(self) -> tuple[str, ...]:
        """The facts that were found out about the answer, a sentence each."""
        return self.notes

    @property
    def times(self) -> Sequence[float]:
        """The times of the rows that were compared; empty where nothing was."""
        return () if self.record is None else self.record.times

    @property
    def common(self) -> dict[str, Any]:
        """The fields that every judgement has, by name, without those of a judged file."""
        return {each.name: getattr(self, each.name) for each in fields(Judgement)}

    def __getitem__(self, quantity: str) -> Verdict:
        """Return the verdict on a quantity, as ``judgement["omega"]``; KeyError with those there are."""
        for verdict in self.verdicts:
            if verdict.quantity == quantity:
                return verdict
        raise KeyError(f"{quantity}, of {', '.join(verdict.quantity for verdict in self.verdicts)}")

    def to_dataframe(self) -> pandas.DataFrame:
        """Return a pandas.DataFrame with a row for each verdict and a column for each field.

        Raises ModuleNotFoundError without pandas (``pip install pandas``).
        """
        return dataframe(verdict.row() for verdict in self.verdicts)

    def __repr__(self) -> str:
        first, word = self.verdicts[0], "passed" if self.passed else "not passed"
        run = " ".join(filter(None, (first.scene, first.solver, first.setting, first.rung)))
        return f"<{type(self).__name__} of {run}: {word}; {counts(self.verdicts)}>"

    def __str__(self) -> str:
        """Return how it ended, a line for each quantity, the likely causes and the notes."""
        return "\n".join(account(self.verdicts, self.causes, self.remarks, repr(self)[1:-1]))

    def _repr_html_(self) -> str:
        headings = ("quantity", "verdict", "largest error", "allowed", "unit")
        rows = (
            (v.quantity, v.verdict.value, figure(v.max), figure(v.bound), v.unit)
            for v in self.verdicts
        )
        table = html_table(
            repr(self)[1:-1], headings, rows, account(self.verdicts, self.causes, self.remarks)
        )
        gates = () if self.record is None else self.record.gates
        curves = {
            gate.quantity: gate.errors for gate in gates if len(gate.errors) == len(self.times)
        }
        return table + (picture(self.times, curves, "errors", log=True) if curves else "")


def judgement(
    problem: Problem,
    solver: Solver,
    trajectory: Trajectory,
    seconds: float | None = None,
    tolerances: Tolerances = NO_TOLERANCES,
) -> Judgement:
    """Judge a trajectory by comparison with the exact solution of the same rounded data.

    ``seconds`` is the time that the answer took by the caller's clock; it limits the steps that a solver
    may claim. ``tolerances`` replace the bounds. The first verdict is on the start, if a sample is there.
    An unfinished trajectory and a missing truth are verdicts; they raise nothing.
    """
    run = Run(problem, solver, trajectory, tolerances)
    main, outcome = MAIN[problem.scene.model], trajectory.outcome
    if outcome.is_unavailable:
        status, reason = Status.UNAVAILABLE, stated(Cause.UNFINISHED, str(trajectory.detail))
    elif outcome is not Outcome.FINISHED:
        detail = f" ({trajectory.detail})" if trajectory.detail else ""
        text = f"a run that did not finish is not scored: it {outcome.value}{detail}"
        status, reason = Status.FAIL, stated(Cause.UNFINISHED, text)
        if end := end_of_motion(problem.given, problem.given.clock.elapsed[-1:]):
            text = f"no exact motion is known at the last sample: {end}; the solver {outcome.value}{detail}"
            status, reason = Status.UNDECIDED, stated(Cause.NO_TRUTH, text)
    else:
        try:
            with within_doubles(problem.scene, Unsettled):
                steps = count_steps(problem, solver, trajectory.steps, seconds)
                gates = gates_of(run, steps)
                verdicts = [*initial_verdict(gates, Carried.START), *(g.verdict for g in gates)]
                record = run_record(run, [gate.record for gate in gates])
            return Judgement(tuple(verdicts), record)
        except Unsettled as doubt:
            status, reason = Status.UNDECIDED, stated(Cause.NO_TRUTH, str(doubt))
    return Judgement((run.verdict(main, status, reason=reason),), None)


def unjudged(
    scene: Scene,
    solver: Solver,
    rung: Rung,
    status: Status,
    why: str,
    cause: Cause,
    outcome: Outcome = Outcome.NOT_REPRESENTABLE,
) -> Judgement:
    """Return the judgement of a run that could not begin."""
    reason = stated(cause, str(why))
    verdict = verdict_on(scene, solver, rung, MAIN[scene.model], status, outcome, reason=reason)
    return Judgement((verdict,), None)
