"""What a CI gets from a verb that judges: --junit, --github, --baseline."""

from __future__ import annotations

import argparse
import os
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from taylor_verify.cli.answer import FAIL, PASS, UNDECIDED, WRONG_CALL, WrongCall
from taylor_verify.cli.streams import tell_runner

if TYPE_CHECKING:
    from taylor_verify.expected import Held
    from taylor_verify.judge import baseline
    from taylor_verify.judge.rounding_class import Departure
    from taylor_verify.publish.ci.case import Remark
    from taylor_verify.records.status import Status
    from taylor_verify.records.verdict import Verdict

# Where GitHub's runner wants the summary of a step.
_SUMMARY = "GITHUB_STEP_SUMMARY"
# What fails nothing must not bury what does.
_MOST_CHANGES = 10
_NOTHING = "nothing was judged"
# The graver first: a call that went wrong has shown nothing at all.
_GRAVITY = (WRONG_CALL, FAIL, UNDECIDED, PASS)


def add_options(verb: argparse.ArgumentParser) -> None:
    """The options, for every verb whose answer is verdicts."""
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


@dataclass(frozen=True)
class Outputs:
    """What was asked for, found to be possible before the work began."""

    junit: Path | None
    github: bool
    baseline_file: str
    baseline: tuple[Verdict, ...] | None


@dataclass(frozen=True)
class Told:
    """What came of it: keys for the document, messages for stderr, an exit status."""

    document: dict[str, Any]
    messages: Sequence[str]
    status: int


def outputs(options: argparse.Namespace) -> Outputs:
    """WrongCall for a file that cannot be written, and for a baseline that is none."""
    junit = None if options.junit is None else _writable_file(options.junit)
    baseline = None if options.baseline is None else _baseline(options.baseline)
    return Outputs(junit, options.github, options.baseline or "", baseline)


def tell(
    asked: Outputs,
    verdicts: Sequence[Verdict],
    status: int,
    of: Iterable[Verdict] | None = None,
    expected: Held | None = None,
) -> Told:
    """Compare with the baseline and write what was asked for.

    ``status`` is that of the verdicts, ``of`` the rows of the baseline that were asked for again
    (all, unless given). What is not a pass and came as ``expected`` is left out of what is written,
    because a CI knows no such thing; what did not come as expected is remarked on.
    """
    document: dict[str, Any] = {}
    messages: list[str] = []
    remarks = _unexpected(expected, verdicts) if expected is not None else []
    if asked.baseline is not None:
        from taylor_verify.judge.baseline import hold

        before = list(asked.baseline if of is None else of)
        held = hold(before, verdicts)
        document["baseline"] = _document(asked.baseline_file, held)
        messages += _messages(asked.baseline_file, held)
        if not held.compared:
            messages.append(_nothing_shared(asked.baseline, verdicts))
        remarks += _remarks(held, [*verdicts, *before])
        status = graver(status, held.status)
    shown = [v for v in verdicts if expected is None or expected.met(v) is None]
    for write in (_write_junit, _write_github):
        try:
            messages += write(asked, shown, remarks)
        except OSError as error:
            # A run that took hours is shown in any case.
            messages.append(f"expected to write, got {error.strerror} @ {error.filename}")
            status = WRONG_CALL
    return Told(document, messages, status)


def graver(*statuses: int) -> int:
    return min(statuses, key=_GRAVITY.index)


def _write_junit(asked: Outputs, verdicts: Sequence[Verdict], remarks: list[Remark]) -> list[str]:
    if asked.junit is None:
        return []
    from taylor_verify.publish.ci.junit import junit
    from taylor_verify.publish.replacement import replace_files

    text = junit(verdicts, remarks)
    replace_files(asked.junit.parent, {asked.junit.name: text})
    return [f"wrote {asked.junit}"]


def _write_github(asked: Outputs, verdicts: Sequence[Verdict], remarks: list[Remark]) -> list[str]:
    if not asked.github:
        return []
    from taylor_verify.publish.ci.annotations import annotation_lines
    from taylor_verify.publish.ci.step_summary import step_summary

    for line in annotation_lines(verdicts, remarks):
        tell_runner(line)
    file = os.environ.get(_SUMMARY)
    if not file:
        return [f"no step summary: {_SUMMARY} is not set"]
    # Other commands of the same step have theirs in the same file.
    with open(file, "a", encoding="utf-8") as summary:
        summary.write(step_summary(verdicts, remarks))
    return []


def _unexpected(expected: Held, verdicts: Sequence[Verdict]) -> list[Remark]:
    """A failure for each row that is not as expected, its solver's name taken from its run.

    Where the command is red because nothing was judged, every row is undecided.
    """
    from taylor_verify.publish.ci.case import Remark
    from taylor_verify.records.status import Status

    solvers = {(v.scene, v.rung): (v.solver, v.setting) for v in verdicts}
    mismatches = [
        Remark(scene, *solvers[scene, rung], rung, quantity, Status.FAIL, str(mismatch))
        for mismatch in expected.mismatches
        for scene, rung, quantity in (mismatch.row,)
    ]
    if not expected.unjudged(verdicts) or not expected.exit_status(verdicts):
        return mismatches
    # A run that is red because nothing was judged has no row of its own that is.
    return [
        Remark(v.scene, v.solver, v.setting, v.rung, v.quantity, Status.UNDECIDED, _NOTHING)
        for v in verdicts
    ]


# The baseline.


def _baseline(file: str) -> tuple[Verdict, ...]:
    from taylor_verify.judge.baseline import load
    from taylor_verify.scenes.faults import Refused

    if Path(file).is_dir():
        raise WrongCall(
            f"expected a file, got a folder (its rows are in {file}/data/verdicts.json) "
            f"@ --baseline {file}"
        )
    try:
        return load(file)
    except (Refused, ValueError) as error:
        raise WrongCall(f"{error} (--baseline)") from error


def _document(file: str, held: baseline.Held) -> dict[str, Any]:
    return {
        "file": file,
        "compared": held.compared,
        "regressions": [str(departure) for departure in held.regressions],
        "undecided": [str(departure) for departure in held.undecided],
        "changes": [str(departure) for departure in held.changes],
    }


def _messages(file: str, held: baseline.Held) -> list[str]:
    told = [f"regression: {departure}" for departure in held.regressions]
    told += [f"not comparable: {departure}" for departure in held.undecided]
    told += [f"changed, no regression: {departure}" for departure in held.changes[:_MOST_CHANGES]]
    more = len(held.changes) - _MOST_CHANGES
    told += [f"changed, no regression: {more} more, all in the document of --json"] * (more > 0)
    counts = f"{len(held.regressions)} regressions, {len(held.undecided)} not comparable"
    rows = f"{held.compared} rows compared with {file}: {counts}, {len(held.changes)} other changes"
    return [*told, rows]


def _nothing_shared(before: Iterable[Verdict], now: Iterable[Verdict]) -> str:
    """Why the baseline shows nothing; a program under another command line is another solver."""
    solvers = [sorted({f"`{v.solver}`" for v in rows}) for rows in (before, now)]
    was, made = (", ".join(names) or "none" for names in solvers)
    why = "" if was == made else f": its solver is {was}, and this run's is {made}"
    return f"nothing of the baseline was run again, so nothing is shown{why}"


def _remarks(held: baseline.Held, rows: Iterable[Verdict]) -> list[Remark]:
    from taylor_verify.records.status import Status

    # A departure names its row by scene, rung and quantity: a command has one solver.
    owners = {(v.scene, v.rung, v.quantity): (v.solver, v.setting) for v in rows}

    def remark(status: Status, prefix: str, found: Departure) -> Remark:
        from taylor_verify.publish.ci.case import Remark

        solver, setting = owners[found.scene, found.rung, found.quantity]
        text = f"{prefix}: {found}"
        return Remark(found.scene, solver, setting, found.rung, found.quantity, status, text)

    return [
        *(remark(Status.FAIL, "regression", found) for found in held.regressions),
        *(remark(Status.UNDECIDED, "not comparable", found) for found in held.undecided),
    ]


def _writable_file(name: str) -> Path:
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
            f"expected a file that can be written, got {name!r} ({reason}) @ --junit"
        ) from error
