"""Outputs for a CI from a verb that judges: --junit, --github, --baseline, --gate."""

from __future__ import annotations

import argparse
import os
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from taylor_verify.cli.answer import WRONG_CALL, WrongCall, graver
from taylor_verify.cli.streams import tell_runner

if TYPE_CHECKING:
    from taylor_verify.batch.comparison import Comparison, Earlier
    from taylor_verify.batch.judgements import Judgements
    from taylor_verify.judge.judgement import Judgement
    from taylor_verify.records.verdict import Verdict

# Where GitHub's runner wants the summary of a step.
_SUMMARY = "GITHUB_STEP_SUMMARY"
# What fails nothing must not bury what does.
_MOST_CHANGES = 10
BOUND, BASELINE = "bound", "baseline"


def add_options(verb: argparse.ArgumentParser) -> None:
    """Add the options of every verb whose answer is verdicts."""
    verb.add_argument(
        "--explain", action="store_true", help="show the arithmetic of every bound as well"
    )
    verb.add_argument("--junit", metavar="FILE", help="write the verdicts there as JUnit XML")
    verb.add_argument(
        "--github",
        action="store_true",
        help="annotations for GitHub on stderr, and a summary to the file $GITHUB_STEP_SUMMARY",
    )
    verb.add_argument(
        "--baseline",
        metavar="FILE",
        help="fail if a row is worse than in that document of --json (or verdicts.json of --out) "
        "by more than rounding explains",
    )
    verb.add_argument(
        "--gate",
        choices=(BOUND, BASELINE),
        default=BOUND,
        help="what decides the exit status: the bounds (and --baseline besides), or the baseline alone, so "
        "that an answer beyond its bounds is kept from getting worse; default: bound",
    )


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
    by_baseline = options.gate == BASELINE
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
        document["baseline"] = _document(asked.baseline.source, comparison)
        messages += _messages(asked.baseline.source, comparison)
        if not comparison.compared:
            messages.append(_nothing_shared(asked.baseline.verdicts, results.verdicts))
        if comparison.decides and status != WRONG_CALL:
            status = comparison.exit_status
            decision = _decision(asked.baseline.source, comparison, results.verdicts)
        status = graver(status, comparison.exit_status)
    for write in (_write_junit, _write_github):
        try:
            messages += write(asked, results, comparison, decision)
        except OSError as error:
            # A run that took hours is shown in any case.
            messages.append(f"expected to write, got {error.strerror} @ {error.filename}")
            status = WRONG_CALL
    return Told(document, messages, status, decision)


def _decision(file: str, comparison: Comparison, verdicts: Iterable[Verdict]) -> str:
    """Return the last line of a text whose exit status is that of the comparison alone."""
    from taylor_verify.records.verdict import exit_status

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
    asked: Outputs, results: Judgements | Judgement, comparison: Comparison | None, decision: str
) -> list[str]:
    del decision
    if asked.junit is None:
        return []
    from taylor_verify.batch.report import write_junit

    write_junit(asked.junit, results, comparison)
    return [f"wrote {asked.junit}"]


def _write_github(
    asked: Outputs, results: Judgements | Judgement, comparison: Comparison | None, decision: str
) -> list[str]:
    if not asked.github:
        return []
    from taylor_verify.batch.comparison import shown_verdicts
    from taylor_verify.batch.report import remarks
    from taylor_verify.publish.ci.annotations import annotation_lines
    from taylor_verify.publish.ci.step_summary import step_summary

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
    from taylor_verify.batch.comparison import read_baseline
    from taylor_verify.scenes.reading.faults import Refused

    if Path(file).is_dir():
        raise WrongCall(
            f"expected a file, got a folder (its rows are in {file}/data/verdicts.json) "
            f"@ --baseline {file}"
        )
    try:
        return read_baseline(file)
    except (Refused, ValueError) as error:
        raise WrongCall(f"{error} (--baseline)") from error


def _document(file: str, comparison: Comparison) -> dict[str, Any]:
    from taylor_verify.records.answers import AgainstBaseline
    from taylor_verify.records.json_text import complete

    departures = (comparison.failures, comparison.undecided, comparison.changes)
    regressions, undecided, changes = (tuple(map(str, kind)) for kind in departures)
    gate = BASELINE if comparison.decides else BOUND
    against = AgainstBaseline(
        file, comparison.compared, regressions, undecided, changes, comparison.notes, gate
    )
    found: dict[str, Any] = complete(against)
    return found


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


def writable_file(name: str, option: str) -> Path:
    """The file, its folder tried out before hours of work end in a refusal to write."""
    import tempfile

    path = Path(name)
    try:
        if not name or path.is_dir():
            raise IsADirectoryError(0, "a folder" if name else "an empty name")
        nearest = next(p for p in path.absolute().parents if p.exists())
        with tempfile.TemporaryFile(dir=nearest):
            return path
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise WrongCall(
            f"expected a file that can be written, got {name!r} ({reason}) @ {option}"
        ) from error
