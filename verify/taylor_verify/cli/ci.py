"""Outputs for a CI from a verb that judges: --junit, --github, --baseline, --gate."""

from __future__ import annotations

import argparse
import os
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any, Final

from taylor_verify.batch.comparison import Comparison, Earlier, read_baseline, shown_verdicts
from taylor_verify.batch.judgements import Judgements
from taylor_verify.batch.report import remarks, write_junit
from taylor_verify.cli.answer import WRONG_CALL, WrongCall, graver, wrong_calls
from taylor_verify.cli.folders import writable_file
from taylor_verify.cli.streams import tell_runner
from taylor_verify.judge.judgement import Judgement
from taylor_verify.publish.ci.annotations import annotation_lines
from taylor_verify.publish.ci.step_summary import step_summary
from taylor_verify.records.answers import AgainstBaseline
from taylor_verify.records.json_text import complete
from taylor_verify.records.verdict import Verdict, exit_status
from taylor_verify.scenes.reading.faults import Refused

# Where GitHub's runner wants the summary of a step.
_SUMMARY: Final = "GITHUB_STEP_SUMMARY"
# What fails nothing must not bury what does.
_MOST_CHANGES: Final = 10


@dataclass(frozen=True)
class Outputs:
    """The files and comparisons asked for, known to be possible before the work begins."""

    junit: Path | None
    github: bool
    baseline: Earlier | None
    by_baseline: bool


@dataclass(frozen=True)
class Told:
    """Keys for the document, messages for stderr, the exit status, and what decided it if not the rows."""

    document: dict[str, Any]
    messages: Sequence[str]
    status: int
    decision: str = ""

    @property
    def stated_status(self) -> int | None:
        """The exit status that follows from the rows; None where a baseline alone has decided it."""
        return None if self.decision else self.status

    def closing(self, text: Callable[[], str]) -> Callable[[], str]:
        """Return the text with the decision as its last line."""
        return (lambda: f"{text()}\n{self.decision}") if self.decision else text


def outputs(options: argparse.Namespace) -> Outputs:
    """Return what was asked for. Raises WrongCall for a file that cannot be written, or is no baseline."""
    junit = None if options.junit is None else writable_file(options.junit, "--junit")
    by_baseline = options.gate == "baseline"
    if by_baseline and options.baseline is None:
        raise WrongCall("expected --baseline FILE beside --gate baseline, got none @ --gate")
    if by_baseline and getattr(options, "against", None) is not None:
        raise WrongCall("expected one comparison to decide, got --against too @ --gate baseline")
    baseline = None if options.baseline is None else _baseline(options.baseline)
    return Outputs(junit, options.github, baseline, by_baseline)


def tell(asked: Outputs, results: Judgements | Judgement, status: int) -> Told:
    """Compare with the baseline and write what was asked for; ``status`` is that of the results."""
    document: dict[str, Any] = {}
    messages: list[str] = []
    comparison, decision = None, ""
    if asked.baseline is not None:
        comparison = asked.baseline.compare_as_baseline(results, asked.by_baseline)
        document["baseline"] = complete(_against(asked.baseline.source, comparison))
        messages += _messages(asked.baseline.source, comparison)
        if not comparison.compared:
            messages.append(_nothing_shared(asked.baseline.verdicts, results.verdicts))
        if comparison.decides and status != WRONG_CALL:
            status = comparison.exit_status
            decision = _decision(asked.baseline.source, comparison, results.verdicts)
        status = graver(status, comparison.exit_status)
    writers: list[Callable[[], list[str]]] = []
    if asked.junit is not None:
        writers.append(partial(_write_junit, asked.junit, results, comparison))
    if asked.github:
        writers.append(partial(_write_github, results, comparison, decision))
    for write in writers:
        try:
            messages += write()
        except OSError as error:
            # A run that took hours is shown in any case.
            messages.append(f"expected to write, got {error.strerror} @ {error.filename}")
            status = WRONG_CALL
    return Told(document, messages, status, decision)


def _decision(file: str, comparison: Comparison, verdicts: Iterable[Verdict]) -> str:
    """Return the last line of a text whose exit status is that of the comparison alone."""
    others = sum(exit_status([verdict]) != 0 for verdict in verdicts)
    if comparison.failures:
        found = f"{len(comparison.failures)} regressions"
    elif not comparison.compared:
        found = "no row was compared"
    else:
        undecided = len(comparison.undecided)
        found = f"{undecided} not comparable" if undecided else "no regression"
    return (
        f"decided by the baseline {file} alone: {found}; no pass by their own bounds: {others} rows"
    )


def _write_junit(
    file: Path, results: Judgements | Judgement, comparison: Comparison | None
) -> list[str]:
    write_junit(file, results, comparison)
    return [f"wrote {file}"]


def _write_github(
    results: Judgements | Judgement, comparison: Comparison | None, decision: str
) -> list[str]:
    verdicts, remarked = shown_verdicts(results), remarks(results, comparison)
    by_remarks = comparison is not None and comparison.decides
    for line in annotation_lines(verdicts, remarked, by_remarks):
        tell_runner(line)
    file = os.environ.get(_SUMMARY)
    if not file:
        return [f"no step summary: {_SUMMARY} is not set"]
    # Other commands of the same step have theirs in the same file.
    with open(file, "a", encoding="utf-8") as summary:
        summary.write(step_summary(verdicts, remarked, decision))
    return []


# The baseline.


def _baseline(file: str) -> Earlier:
    if Path(file).is_dir():
        raise WrongCall(
            f"expected a file, got a folder (its rows are in {file}/data/verdicts.json) "
            f"@ --baseline {file}"
        )
    with wrong_calls(" (--baseline)", (Refused, ValueError)):
        return read_baseline(file)


def _against(file: str, comparison: Comparison) -> AgainstBaseline:
    departures = (comparison.failures, comparison.undecided, comparison.changes)
    regressions, undecided, changes = (tuple(map(str, kind)) for kind in departures)
    gate = "baseline" if comparison.decides else "bound"
    told = (regressions, undecided, changes, comparison.notes, gate)
    return AgainstBaseline(file, comparison.compared, *told)


def _messages(file: str, comparison: Comparison) -> list[str]:
    failures, undecided, changes = comparison.failures, comparison.undecided, comparison.changes
    lines = [f"regression: {departure}" for departure in failures]
    lines += [f"not comparable: {departure}" for departure in undecided]
    lines += [f"changed, no regression: {departure}" for departure in changes[:_MOST_CHANGES]]
    more = len(changes) - _MOST_CHANGES
    lines += [f"changed, no regression: {more} more, all in the document of --json"] * (more > 0)
    counts = f"{len(failures)} regressions, {len(undecided)} not comparable"
    rows = (
        f"{comparison.compared} rows compared with {file}: {counts}, {len(changes)} other changes"
    )
    return [*lines, *comparison.notes, rows]


def _nothing_shared(before: Iterable[Verdict], now: Iterable[Verdict]) -> str:
    """Return why the baseline shows nothing; a program under another command line is another solver."""
    solvers = [sorted({f"`{v.solver}`" for v in rows}) for rows in (before, now)]
    was, made = (", ".join(names) or "none" for names in solvers)
    why = "" if was == made else f": its solver is {was}, and this run's is {made}"
    if not why:
        # Files of one solver; or one solver on other scenes or rungs.
        names = [sorted({v.setting for v in rows if v.setting}) for rows in (before, now)]
        if names[0] != names[1]:
            why = (
                f": its file is {', '.join(names[0]) or 'none'}, and this one {', '.join(names[1])}"
            )
    return f"nothing of the baseline was run again, so nothing is shown{why}"
