"""What every published page has: its maker, a summary, a legend, and how to remake it."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from itertools import groupby
from typing import Any, Final

from taylor_verify.publish.cells import figure, instant, judged, reason
from taylor_verify.publish.markdown import bold, bullets, code, prose, table
from taylor_verify.records.precisions import place_of_rung
from taylor_verify.records.provenance import Provenance
from taylor_verify.records.quantities import GATE_FACTOR
from taylor_verify.records.runs import Run
from taylor_verify.records.status import Status
from taylor_verify.records.store import versions
from taylor_verify.records.verdict import Verdict, summary

MADE_BY: Final = "<!-- made by taylor-verify publish; do not edit -->"


def whole(title: str, *blocks: str) -> str:
    """Return a page: its maker, its title, and the blocks that are not empty, one below the other."""
    return "\n\n".join(filter(None, [f"{MADE_BY}\n# {title}", *blocks])) + "\n"


def page(title: str, verdicts: Sequence[Verdict], *parts: str) -> str:
    """Return a page of verdicts, which ends with what made them and how to remake them."""
    return whole(title, *parts, _remake(verdicts))


def counts(verdicts: Iterable[Verdict]) -> str:
    """The number of verdicts of each kind, the largest error over attainable, and what judged them."""
    found = list(verdicts)
    by_status = summary(found)
    columns = [f"{status}:" for status in by_status]
    row = [_standing_out(Status(status), count) for status, count in by_status.items()]
    return "\n\n".join(filter(None, [table(columns, [row]), _worst(found), _tolerated(found)]))


def _tolerated(verdicts: Sequence[Verdict]) -> str:
    """The number of rows whose bound is a tolerance; empty where there is none."""
    count = sum(verdict.tolerance is not None for verdict in verdicts)
    if not count:
        return ""
    return (
        f"{bold(str(count))} of them were judged by a tolerance that was asked for, and not by "
        f"{GATE_FACTOR} times what is attainable."
    )


def _standing_out(status: Status, count: int) -> str:
    return bold(str(count)) if count and status is Status.FAIL else str(count)


def _worst(verdicts: Sequence[Verdict]) -> str:
    lost = sum(verdict.is_compared and verdict.ratio is None for verdict in verdicts)
    parts = (
        [bold(f"{lost} of {len(verdicts)} without a finite error over attainable.")] if lost else []
    )
    finite = [verdict for verdict in verdicts if verdict.ratio is not None]
    if finite:
        worst = max(finite, key=lambda verdict: verdict.ratio or 0.0)
        parts.append(
            f"Largest error over attainable: {bold(figure(worst.ratio))}, {code(worst.quantity)} "
            f"of {code(worst.scene)} on {worst.rung} at t = {instant(worst.ratio_at)}."
        )
    return " ".join(parts) or "Nothing was compared."


def roundoffs(verdicts: Iterable[Verdict]) -> str:
    """The legend of u, for the rungs that occur."""
    found = {verdict.rung: verdict.roundoff for verdict in verdicts if verdict.roundoff}
    each = (f"{rung} {figure(found[rung])}" for rung in sorted(found, key=place_of_rung))
    return f"u is the unit roundoff of the rung: {', '.join(each) or 'none was run'}."


def sections(runs: Iterable[Run], lay_out: Callable[[list[Run]], str]) -> str:
    """One section for each model and solver, as ``lay_out`` writes its runs."""
    groups = groupby(runs, key=lambda run: (run.model, run.solver, run.setting))
    return "\n\n".join(f"## {_heading(*key)}\n\n{lay_out(list(group))}" for key, group in groups)


def _heading(model: str, solver: str, setting: str) -> str:
    by = " ".join(code(text) for text in (solver, setting) if text)
    return f"{model or 'Other quantities'}, by {by}"


def unscored(runs: Iterable[Run]) -> str:
    """Why the runs without a number have none."""
    rows = [
        f"{code(run.scene)}, {run.rung}: {judged(verdict.verdict)}, {prose(reason(verdict))}"
        for run in runs
        for verdict in run.state
        if verdict.max is None
    ]
    return f"Without a number:\n\n{bullets(rows)}" if rows else ""


def traced(provenance: Mapping[str, Any]) -> str:
    """What made the numbers, in a sentence or two: versions, and processor and command where known."""
    packages = (f"{name} {found}" for name, found in provenance.get("versions", {}).items())
    told = f"Made with {', '.join(packages) or 'unknown versions'}."
    if "processor" not in provenance or "command" not in provenance:
        return told
    return f"{told} Machine: {prose(provenance['processor'])}. By {code(provenance['command'])}."


def made_on(provenance: Provenance) -> str:
    """Return the machine, the packages and the command of a measurement."""
    packages = ", ".join(f"{name} {found}" for name, found in provenance.versions.items())
    return (
        f"Machine: {prose(provenance.processor)}; {packages}. Made by {code(provenance.command)}."
    )


def _remake(verdicts: Sequence[Verdict]) -> str:
    packages = (f"{package} {version}" for package, version in versions(verdicts).items())
    return "\n\n".join(
        [
            "## To remake this",
            "`make verify` runs the standard set and writes a copy of these pages to "
            "`reports/local/`; `make reports` rewrites the committed ones. `taylor-verify "
            "publish --from DIR` rebuilds the tables of a folder from its data.",
            f"Made with {', '.join(packages) or 'unknown versions'}. Processor, Python, command "
            "and seconds of each run are in [timings.json](../data/timings.json), the SHA-256 of "
            "each scene is in [verdicts.json](../data/verdicts.json).",
        ]
    )
