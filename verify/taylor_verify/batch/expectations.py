"""Comparison of verdicts with the expected ones of the extremes, whose correct answers are not all `pass`.

The verdicts themselves are not changed. An expected verdict does not change the exit status. An expected
verdict that is missing, or an unexpected one, is a mismatch and fails.

The file speaks of the bounds that follow from the arithmetic. A row that was judged by a tolerance is
compared with nothing: its verdict counts as it stands.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence, Set
from dataclasses import dataclass, field
from typing import Any

from taylor_verify.batch.differences import Difference, Direction, row_of
from taylor_verify.records.answers import ExpectationsMet
from taylor_verify.records.status import Status
from taylor_verify.records.verdict import Verdict, exit_status
from taylor_verify.scenes.expected import Expectation, Expectations, Row, is_extreme, shipped
from taylor_verify.solvers.registry import TAYLOR
from taylor_verify.solvers.trajectory import Outcome

_PASS = Expectation(Status.PASS.value, "")


@dataclass(frozen=True)
class Agreement:
    """The ``verdicts`` of runs beside the expected ones.

    ``expected`` has every row that the file names; ``mismatches`` are the rows that differ from it.
    """

    verdicts: Sequence[Verdict]
    expected: Mapping[Row, Expectation] = field(default_factory=dict)
    mismatches: tuple[Difference, ...] = ()

    def met(self, verdict: Verdict) -> Expectation | None:
        """Return the expectation of a row that is no pass and came as expected; None for all others."""
        expectation = self.expected.get(row_of(verdict))
        if expectation is None or verdict.verdict is Status.PASS:
            return None
        return expectation if expectation.verdict == verdict.verdict.value else None

    @property
    def unexpected(self) -> list[Verdict]:
        """The verdicts without those that are no pass and came as expected."""
        return [verdict for verdict in self.verdicts if self.met(verdict) is None]

    @property
    def exit_status(self) -> int:
        """Exit status: 1 for a mismatch; else the status of the rows that did not come as expected.

        Where nothing was judged it is that of `unjudged_status`.
        """
        if self.mismatches:
            return 1
        if self.unjudged:
            return unjudged_status({verdict.outcome for verdict in self.verdicts})
        return exit_status(self.unexpected)

    @property
    def unjudged(self) -> str:
        """The reasons why nothing was judged; empty where something was, or came as expected."""
        if any(v.verdict is not Status.UNAVAILABLE or self.met(v) for v in self.verdicts):
            return ""
        return "; ".join(dict.fromkeys(v.because for v in self.verdicts)) or "no run was asked for"

    def row(self, verdict: Verdict) -> dict[str, Any]:
        """Return the row as JSON has it, with what was expected of it where the file speaks of it."""
        expectation = self.expected.get(row_of(verdict))
        if expectation is None:
            return verdict.row()
        is_met = expectation.verdict == verdict.verdict.value
        expected = {"verdict": expectation.verdict, "why": expectation.why, "met": is_met}
        return {**verdict.row(), "expected": expected}

    def document(self) -> ExpectationsMet:
        """Return the number of answers besides `pass` that came as expected, and every mismatch."""
        met = len(self.verdicts) - len(self.unexpected)
        return ExpectationsMet(met, tuple(map(str, self.mismatches)))


def unjudged_status(outcomes: Set[str]) -> int:
    """Return the exit status where nothing was judged, by the outcomes of all rows.

    2 if a package is missing, 0 if the machine lacks every number format asked for, 3 otherwise.
    """
    if Outcome.NO_PACKAGE.value in outcomes:
        return 2
    return 0 if outcomes == {Outcome.NO_FORMAT.value} else 3


def compare_with_expectations(
    verdicts: Sequence[Verdict], expectations: Expectations | None = None
) -> Agreement:
    """Compare every run of an extreme by the shipped solver with the shipped file, or with another.

    A run that this machine has no number type for, and every other run, is compared with nothing.
    """
    runs: dict[tuple[str, str], dict[str, Verdict]] = {}
    for verdict in verdicts:
        if is_extreme(verdict.scene) and (verdict.solver, verdict.setting) == (TAYLOR, ""):
            runs.setdefault((verdict.scene, verdict.rung), {})[verdict.quantity] = verdict
    if not runs:
        return Agreement(verdicts)
    expectations = expectations or shipped()
    expected: dict[Row, Expectation] = {}
    mismatches: list[Difference] = []
    for run, by_quantity in runs.items():
        foreseen = expectations.of_run(*run)
        if not foreseen and all(v.verdict is Status.UNAVAILABLE for v in by_quantity.values()):
            continue
        for quantity in dict.fromkeys((*by_quantity, *foreseen)):
            if quantity in by_quantity and by_quantity[quantity].tolerance is not None:
                continue
            row, wanted = (*run, quantity), foreseen.get(quantity, _PASS)
            expected[row] = wanted
            got = by_quantity[quantity].verdict.value if quantity in by_quantity else "no row"
            if got != wanted.verdict:
                # To the better or to the worse, it is a failure.
                why = f" ({wanted.why})" if wanted.why else ""
                words = f"{wanted.verdict}{why}", got
                mismatches.append(Difference(*row, "", *words, TAYLOR, "", Direction.CHANGED))
    return Agreement(verdicts, expected, tuple(mismatches))
