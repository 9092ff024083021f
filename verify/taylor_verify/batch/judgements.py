"""The judgements of many runs as one result: what was judged, what was expected, what was left out."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, Final, overload

from taylor_verify.batch.chosen_scenes import Selection
from taylor_verify.batch.comparison import Comparison
from taylor_verify.batch.expectations import Agreement, compare_with_expectations
from taylor_verify.judge.judgement import Judgement
from taylor_verify.records.answers import LeftOut, LikelyCause
from taylor_verify.records.json_text import complete
from taylor_verify.records.passing import NotPassed, Passing
from taylor_verify.records.record import Record
from taylor_verify.records.showing import counts, dataframe, html_table
from taylor_verify.records.status import Status
from taylor_verify.records.sums import with_sum
from taylor_verify.records.verdict import Verdict, summary
from taylor_verify.words.account import account

if TYPE_CHECKING:
    import pandas

# A notebook shows so many runs; `to_dataframe` has all of them.
_MOST_SHOWN: Final = 40


@dataclass(frozen=True, eq=False, repr=False)
class Judgements(Passing, Sequence[Judgement]):
    """A sequence of Judgement, in the order of the scenes and of the rungs within each.

    It equals a list of the same judgements. ``comparison`` is that with a baseline, where one was given.
    Its truth value is ``passed``.
    """

    judgements: tuple[Judgement, ...]
    selection: Selection
    solver: str
    comparison: Comparison | None = None

    @overload
    def __getitem__(self, index: int) -> Judgement: ...
    @overload
    def __getitem__(self, index: slice) -> tuple[Judgement, ...]: ...
    def __getitem__(self, index: int | slice) -> Judgement | tuple[Judgement, ...]:
        return self.judgements[index]

    def __len__(self) -> int:
        return len(self.judgements)

    def __iter__(self) -> Iterator[Judgement]:
        return iter(self.judgements)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Sequence) and [*self] == [*other]

    __hash__ = None  # type: ignore[assignment]

    @cached_property
    def verdicts(self) -> tuple[Verdict, ...]:
        """Verdicts of all runs."""
        return tuple(verdict for judgement in self.judgements for verdict in judgement.verdicts)

    @property
    def records(self) -> list[Record]:
        """The records of the runs that were compared with an exact motion."""
        return [one.record for one in self.judgements if one.record is not None]

    @cached_property
    def agreement(self) -> Agreement:
        """The verdicts on extremes beside what cases/extremes/EXPECTED.toml expects of them."""
        return compare_with_expectations(self.verdicts)

    @property
    def unexpected(self) -> list[Verdict]:
        """The verdicts without those that are no pass and came as expected."""
        return self.agreement.unexpected

    @property
    def exit_status(self) -> int:
        """The exit status of `taylor-verify run`.

        0 all is as it should be; 1 a gate failed, or an extreme was not as expected; 3 something is
        undecided and nothing failed. Where nothing was judged: 2 if a package is missing, 0 if this machine
        lacks every number format asked for, 3 otherwise. The comparison with a baseline counts too, and
        alone where it decides.
        """
        own = self.agreement.exit_status
        if self.comparison is None or own == 2:
            return own
        if self.comparison.decides:
            return self.comparison.exit_status
        # A failure is graver than what is undecided.
        return next((k for k in (1, 3) if k in (own, self.comparison.exit_status)), 0)

    @property
    def unjudged(self) -> str:
        """The reasons why nothing was judged; empty where something was."""
        return self.agreement.unjudged

    @property
    def passed(self) -> bool:
        """True if something was judged, and the exit status is 0."""
        return not self.unjudged and self.exit_status == 0

    def raise_for_failure(self) -> None:
        """Raise NotPassed, an AssertionError, unless the result passed.

        Its text has every verdict that is neither a pass nor as expected, and every mismatch.
        """
        if self.passed:
            return
        if self.comparison is not None:
            self.comparison.raise_for_failure()
        others = [v for v in self.unexpected if v.verdict is not Status.PASS]
        lines = account(others, self.causes, self.notes)
        lines += [str(mismatch) for mismatch in self.agreement.mismatches]
        raise NotPassed("\n".join(lines))

    @property
    def summary(self) -> dict[str, int]:
        """The number of verdicts of each status."""
        return summary(self.verdicts)

    def document(self) -> dict[str, Any]:
        """Return the document of `taylor-verify run --json`."""
        document: dict[str, Any] = {
            "verdicts": [self.agreement.row(verdict) for verdict in self.verdicts],
            "summary": self.summary,
        }
        if self.agreement.expected:
            document["expected"] = complete(self.agreement.document())
        if self.selection.left_out:
            document["left_out"] = [complete(one) for one in self.left_out]
        if self.causes:
            document["causes"] = [complete(cause) for cause in self.causes]
        if self.notes:
            document["notes"] = list(self.notes)
        if self.comparison is not None:
            document["baseline"] = complete(self.comparison.document())
        return with_sum(document)

    @property
    def causes(self) -> tuple[LikelyCause, ...]:
        """The likely causes of what failed, each with its scene and rung."""
        return tuple(cause for judgement in self.judgements for cause in judgement.causes)

    @property
    def notes(self) -> tuple[str, ...]:
        """The notes on the answers, each behind its scene and rung."""
        return tuple(
            f"{judgement.verdicts[0].scene} {judgement.verdicts[0].rung}: {note}"
            for judgement in self.judgements
            for note in judgement.notes
        )

    @property
    def left_out(self) -> tuple[LeftOut, ...]:
        """The runs of a folder that were not made, and why."""
        return tuple(LeftOut(*run, why) for run, why in self.selection.left_out.items())

    def to_dataframe(self) -> pandas.DataFrame:
        """Return a pandas.DataFrame with a row for each verdict, and the fields of a Verdict as columns.

        ``expected`` is the verdict that was expected of an extreme, and None elsewhere. Raises
        ModuleNotFoundError without pandas (``pip install pandas``).
        """
        rows = (self.agreement.row(verdict) for verdict in self.verdicts)
        return dataframe(
            {**row, "expected": row.get("expected", {}).get("verdict")} for row in rows
        )

    def __repr__(self) -> str:
        runs = "1 run" if len(self) == 1 else f"{len(self)} runs"
        word = "passed" if self.passed else "not passed"
        return f"<Judgements of {runs} by {self.solver}: {word}; {counts(self.verdicts)}>"

    def _repr_html_(self) -> str:
        shown = self.judgements[:_MOST_SHOWN]
        rows = ((j.verdicts[0].scene, j.verdicts[0].rung, counts(j.verdicts)) for j in shown)
        more = len(self) - _MOST_SHOWN
        rest = f"<p>and {more} more runs: see <code>to_dataframe()</code></p>" if more > 0 else ""
        return html_table(repr(self)[1:-1], ("scene", "rung", "verdicts"), rows) + rest
