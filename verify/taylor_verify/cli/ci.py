"""Outputs for a CI from a verb that judges: --junit, --github, --baseline, --gate."""

from __future__ import annotations

import argparse
import os
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from taylor_verify.batch.comparison import Comparison, Earlier, shown_verdicts
from taylor_verify.batch.earlier_file import read_baseline
from taylor_verify.batch.judgements import Judgements
from taylor_verify.batch.report import remarks, write_junit
from taylor_verify.cli.answer import WRONG_CALL, Answer, WrongCall, graver, wrong_calls
from taylor_verify.cli.folders import not_written, unwritable, writable_file
from taylor_verify.cli.streams import tell_runner
from taylor_verify.judge.judgement import Judgement
from taylor_verify.records.faults import Refused
from taylor_verify.records.json_text import complete
from taylor_verify.records.regular_file import open_without_waiting
from taylor_verify.records.status import Status
from taylor_verify.records.sums import with_sum
from taylor_verify.records.verdict import Verdict, exit_status
from taylor_verify.words.annotations import annotation_lines
from taylor_verify.words.case import cases
from taylor_verify.words.opening import opening
from taylor_verify.words.step_summary import step_summary

# The variable that names the file for the summary of a step, set by GitHub's runner.
_SUMMARY: Final = "GITHUB_STEP_SUMMARY"
# The most changes that are named: more would hide the regressions.
_MOST_CHANGES: Final = 10


@dataclass(frozen=True)
class Outputs:
    """Files and comparisons that were asked for, checked before the work begins."""

    junit: Path | None
    github: bool
    baseline: Earlier | None
    by_baseline: bool


def outputs(options: argparse.Namespace) -> Outputs:
    """Return the outputs that were asked for.

    Raises WrongCall for a file that cannot be written, and for one that is no baseline.
    """
    junit = None if options.junit is None else writable_file(options.junit, "--junit")
    if junit is not None:
        with unwritable("a file that can be written", options.junit, "--junit"):
            # Nobody shall take the verdicts of an earlier call for those of one that comes to none.
            junit.unlink(missing_ok=True)
    by_baseline = options.gate == "baseline"
    if by_baseline and options.baseline is None:
        raise WrongCall("expected --baseline FILE beside --gate baseline, got none @ --gate")
    if by_baseline and getattr(options, "against", None) is not None:
        raise WrongCall("expected one comparison to decide, got --against too @ --gate baseline")
    baseline = None if options.baseline is None else _baseline(options.baseline)
    return Outputs(junit, options.github, baseline, by_baseline)


def concluded(
    asked: Outputs,
    results: Judgements | Judgement,
    status: int,
    document: Mapping[str, Any],
    text: Callable[[int | None], str],
) -> Answer:
    """Return the answer behind a comparison with the baseline, and write what was asked for.

    ``status`` is that of the results. ``text`` is called with the status that follows from the rows. If the
    baseline alone decides, it is called with None, and a last line says so.
    """
    content, messages, nothing = dict(document), list[str](), list[str]()
    comparison, decision = None, ""
    if asked.baseline is not None:
        source = asked.baseline.source
        comparison = asked.baseline.compare_as_baseline(results, asked.by_baseline)
        content["baseline"] = complete(comparison.document())
        messages += _messages(source, comparison)
        if not comparison.compared:
            nothing = [_nothing_shared(asked.baseline.verdicts, results.verdicts)]
            messages += nothing
        elif others := sorted(
            {v.scene for v in asked.baseline.verdicts} - {v.scene for v in results.verdicts}
        ):
            messages.append(
                f"scenes of the baseline that this call did not ask for: {', '.join(others)}"
            )
        if comparison.decides and status != WRONG_CALL:
            status = comparison.exit_status
            decision = _decision(source, comparison, results.verdicts)
        status = graver(status, comparison.exit_status)
    for write, option in ((_write_junit, "--junit"), (_write_github, "--github")):
        try:
            messages += write(asked, results, comparison, decision)
        except OSError as error:
            # A run that took hours is shown in any case.
            messages.append(not_written(error, option))
            status = WRONG_CALL
    last = f"\n{decision}" if decision else ""
    stated = None if decision else status
    failing = [*nothing, *_failing(results, comparison)]
    return Answer(status, with_sum(content), lambda: f"{text(stated)}{last}", messages, failing)


def _failing(results: Judgements | Judgement, comparison: Comparison | None) -> Iterator[str]:
    """Yield the lines on each row that is no pass: its sentences, with its run where there are several."""
    verdicts = shown_verdicts(results)
    by_comparison = comparison is not None and comparison.decides
    is_one_run = len({verdict.run for verdict in verdicts}) == 1
    for case in cases(verdicts, remarks(results, comparison), by_comparison):
        if case.counted is not Status.PASS and not case.is_harmless:
            run = (
                ""
                if is_one_run
                else f"{' '.join(filter(None, (case.scene, case.rung, case.mark)))} "
            )
            first, *others = case.sentences
            yield f"{case.counted}  {run}{first}"
            yield from others


def _decision(file: str, comparison: Comparison, verdicts: Iterable[Verdict]) -> str:
    """Return the last line of a text whose exit status is that of the comparison alone."""
    others = sum(exit_status([verdict]) != 0 for verdict in verdicts)
    if comparison.failures:
        outcome = f"{len(comparison.failures)} regressions"
    elif not comparison.compared:
        outcome = "no row was compared"
    else:
        undecided = len(comparison.undecided)
        outcome = f"{undecided} not comparable" if undecided else "no regression"
        outcome += ", by rows that were edited" * comparison.doubted
    return f"decided by the baseline {file} alone: {outcome}; no pass by their own bounds: {others} rows"


def _write_junit(
    asked: Outputs, results: Judgements | Judgement, comparison: Comparison | None, decision: str
) -> list[str]:
    del decision
    if asked.junit is None:
        return []
    write_junit(asked.junit, results, comparison)
    return [f"wrote {asked.junit}"]


def _write_github(
    asked: Outputs, results: Judgements | Judgement, comparison: Comparison | None, decision: str
) -> list[str]:
    if not asked.github:
        return []
    verdicts, remarked = shown_verdicts(results), remarks(results, comparison)
    by_remarks = comparison is not None and comparison.decides
    for line in annotation_lines(verdicts, remarked, by_remarks):
        tell_runner(line)
    file = os.environ.get(_SUMMARY)
    if not file:
        return [f"no step summary: {_SUMMARY} is not set"]
    # Other commands of the same step have theirs in the same file.
    with open(file, "a", encoding="utf-8", opener=open_without_waiting) as summary:
        summary.write(
            step_summary(verdicts, remarked, decision or opening(verdicts, results.causes))
        )
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
    """Return why the baseline shows nothing. A program with another command line is another solver."""
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
