"""Verdicts compared with earlier ones: a baseline file, or a folder of published reports."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Final

from taylor_verify.batch.differences import Difference, Differences, Direction, compare, row_of
from taylor_verify.judge.judgement import Judgement
from taylor_verify.records.answers import AgainstBaseline
from taylor_verify.records.json_text import finite
from taylor_verify.records.passing import NotPassed, Passing
from taylor_verify.records.verdict import Verdict, exit_status
from taylor_verify.solvers.files.file import Recorded

if TYPE_CHECKING:
    from taylor_verify.batch.judgements import Judgements

_EDITED: Final = "is not what a run has written, by its own sum: nothing passes by it"
_WITHOUT_SUM: Final = "has no sum: nothing says that it is what a run has written"


@dataclass(frozen=True)
class Comparison(Passing):
    """Rows that were ``compared`` with earlier ones, and their differences.

    ``failures`` fail the comparison: what is worse than in a baseline, or whatever left the rounding class
    of a published row. ``undecided`` rows were asked another question before, and ``changes`` fail
    nothing; a comparison with published rows has neither. ``before`` are the earlier rows that were
    asked for again, ``notes`` what else there is to say. Nothing passes by earlier rows that are
    ``doubted``: they were edited since a run wrote them. With ``decides`` the comparison alone decides
    whether a run is red, whatever its own bounds say. The truth value is ``passed``.
    """

    compared: int
    failures: tuple[Difference, ...]
    undecided: tuple[Difference, ...]
    changes: tuple[Difference, ...]
    before: tuple[Verdict, ...]
    notes: tuple[str, ...] = ()
    decides: bool = False
    doubted: bool = False
    source: str = ""

    @property
    def exit_status(self) -> int:
        """Exit status: 1 for a failure, 3 where something or all could not be compared, else 0."""
        if self.failures:
            return 1
        return 3 if self.undecided or self.doubted or not self.compared else 0

    @property
    def passed(self) -> bool:
        """True if rows were compared and none failed or stayed undecided."""
        return self.exit_status == 0

    def document(self) -> AgainstBaseline:
        """Return the comparison as a document of `--json` has it."""
        kinds = (self.failures, self.undecided, self.changes)
        regressions, undecided, changes = (tuple(map(str, kind)) for kind in kinds)
        rows = (self.compared, regressions, undecided, changes, self.notes)
        return AgainstBaseline(self.source, *rows, "baseline" if self.decides else "bound")

    def raise_for_failure(self) -> None:
        """Raise NotPassed, an AssertionError with a line for each difference, unless it passed."""
        if not self.passed:
            lines = [str(difference) for difference in (*self.failures, *self.undecided)]
            lines += self.notes if self.doubted else ()
            raise NotPassed("\n".join(lines) or "no row was compared")


@dataclass(frozen=True, repr=False)
class ComparedJudgement(Judgement):
    """A Judgement, and its ``comparison`` with a baseline: it passes where both do.

    A comparison that ``decides`` is asked alone.
    """

    comparison: Comparison

    @property
    def passed(self) -> bool:
        """True if the comparison passed and, unless it decides alone, the judgement too."""
        return self.comparison.passed and (self.comparison.decides or super().passed)

    def raise_for_failure(self) -> None:
        """Raise NotPassed, with the lines of the comparison or else of the judgement, unless it passed."""
        self.comparison.raise_for_failure()
        super().raise_for_failure()


@dataclass(frozen=True)
class Earlier:
    """The verdicts of an earlier run, read from ``source`` before a new run begins.

    ``edited`` says whether they were changed since, and is None where there is no sum.
    """

    source: str
    verdicts: tuple[Verdict, ...]
    edited: bool | None = False

    @property
    def _notes(self) -> tuple[str, ...]:
        if self.edited is False:
            return ()
        return (f"{self.source} {_EDITED if self.edited else _WITHOUT_SUM}",)

    def compare_as_baseline(
        self, results: Judgements | Judgement, decides: bool = False
    ) -> Comparison:
        """Find regressions: errors beyond what rounding explains, worse verdicts, rows that are gone.

        Of the earlier rows those count that were asked for again: the same solver, its rungs and, where
        scenes were named, these. One trajectory file is compared with one file whatever their names are.
        With ``decides`` the comparison decides alone: what shows nothing of its own is no pass either.
        """
        before, notes = _of_one_file(self.verdicts, results)
        before = _asked_again(before, results)
        report = compare(before, results.verdicts)
        if decides:
            more = _unjudged(report.all, before, shown_verdicts(results))
            report = Differences(report.compared, (*report.all, *more))
        failures, undecided = (
            report.towards(Direction.WORSE),
            report.towards(Direction.OTHER_QUESTION),
        )
        changes = report.towards(Direction.BETTER, Direction.CHANGED, Direction.UNAVAILABLE)
        compared = report.compared, failures, undecided, changes, before, (*self._notes, *notes)
        return Comparison(*compared, decides, bool(self.edited), self.source)

    def compare_as_published(self, results: Judgements | Judgement) -> Comparison:
        """Find every number that left the rounding class of its published one, upwards or downwards."""
        before = _asked_again(self.verdicts, results)
        report = compare(before, results.verdicts)
        compared = report.compared, report.departures, (), (), before, self._notes
        return Comparison(*compared, doubted=bool(self.edited), source=self.source)


def _asked_again(before: Sequence[Verdict], results: Judgements | Judgement) -> tuple[Verdict, ...]:
    """Return the earlier rows that the call of these results has asked for again."""
    if isinstance(results, Judgement):
        runs = {verdict.run for verdict in results.verdicts}
        files = {(v.scene, v.solver, v.rung) for v in results.verdicts if v.solver == Recorded.name}
        # Of several files none may be left out, unless all have other names.
        whole = len(runs) > 1 and not runs.isdisjoint(verdict.run for verdict in before)
        return tuple(
            verdict
            for verdict in before
            if verdict.run in runs
            or (whole and (verdict.scene, verdict.solver, verdict.rung) in files)
        )
    asked = results.selection
    return tuple(v for v in before if v.solver == results.solver and asked.has(v.scene, v.rung))


def _of_one_file(
    before: tuple[Verdict, ...], results: Judgements | Judgement
) -> tuple[tuple[Verdict, ...], tuple[str, ...]]:
    """Return the earlier rows under the name of this file where both are of one file, and a note of it.

    Whoever writes a file for each run gives each a name of its own.
    """
    files = {v.setting for v in results.verdicts if v.solver == Recorded.name}
    if not isinstance(results, Judgement) or len(files) != 1:
        return before, ()
    (name,) = files
    asked = {(v.scene, v.solver, v.rung) for v in results.verdicts}
    others = {v.setting for v in before if (v.scene, v.solver, v.rung) in asked}
    if len(others) != 1 or others == files:
        return before, ()
    (other,) = others
    note = (
        f"the baseline is of the file {other}, and this is {name}: they are compared all the same"
    )
    return tuple(replace(v, setting=name) if v.setting == other else v for v in before), (note,)


def _unjudged(
    named: Iterable[Difference], before: Iterable[Verdict], now: Iterable[Verdict]
) -> Iterator[Difference]:
    """Yield the rows that are not green where no bound decides, besides those that are ``named`` already.

    A failed row without a finite error is worse than any, even if the baseline has no finite error either.
    A row that shows nothing is not compared: it is undecided, vacuous or refused, or it fails and is new.
    """
    known = {row_of(verdict) for verdict in before}
    decisive = (Direction.WORSE, Direction.OTHER_QUESTION)
    places = {row_of(difference) for difference in named if difference.direction in decisive}
    for verdict in now:
        status = exit_status([verdict])
        if status == 0 or row_of(verdict) in places:
            continue
        if status != 1:
            words = "a row that shows something", f"{verdict.verdict} ({verdict.because})"
            yield Difference.of(verdict, Direction.OTHER_QUESTION, *words)
        elif finite(verdict.max) is None:
            words = "a finite error", "no finite number"
            yield Difference.of(verdict, Direction.WORSE, *words, "max")
        elif row_of(verdict) not in known:
            words = "a row of the baseline", "a new one that fails"
            yield Difference.of(verdict, Direction.OTHER_QUESTION, *words)


def shown_verdicts(results: Judgements | Judgement) -> list[Verdict]:
    """Return the verdicts without expected ones that are not a pass, for CI systems."""
    return list(results.verdicts) if isinstance(results, Judgement) else results.unexpected
