"""Parts of published pages: maker, summary, legend, and how to remake the page."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from itertools import groupby
from typing import Any, Final

from taylor_verify.records.precisions import place_of_rung
from taylor_verify.records.provenance import Provenance
from taylor_verify.records.quantities import GATE_FACTOR
from taylor_verify.records.runs import Run
from taylor_verify.records.status import Status
from taylor_verify.records.store import versions
from taylor_verify.records.verdict import Verdict, summary
from taylor_verify.words.cells import figure, instant, judged, reason, worst
from taylor_verify.words.markdown import bold, bullets, code, prose, table

MADE_BY: Final = "<!-- made by taylor-verify publish; do not edit -->"


def whole(title: str, *blocks: str) -> str:
    """Return a page: its maker, its title, and the blocks that are not empty."""
    return "\n\n".join(filter(None, [f"{MADE_BY}\n# {title}", *blocks])) + "\n"


def page(title: str, verdicts: Sequence[Verdict], *parts: str) -> str:
    """Return a page of verdicts, which ends with their versions and how to remake them."""
    return whole(
        title,
        *parts,
        "## To remake this",
        "`make verify` runs the standard set and writes a copy of these pages to `reports/local/`; `make "
        "reports` rewrites the committed ones. `taylor-verify publish --from DIR` rebuilds the tables of a "
        "folder from its data.",
        f"{made_with(versions(verdicts))} Processor, Python, command and seconds of each run are in "
        "[timings.json](../data/timings.json), the SHA-256 of each scene is in "
        "[verdicts.json](../data/verdicts.json).",
    )


def counts(verdicts: Iterable[Verdict]) -> str:
    """Return the number of verdicts of each kind, the largest error over attainable, and tolerances."""
    rows = list(verdicts)
    by_status = summary(rows)
    row = [
        bold(str(count)) if count and status == Status.FAIL else str(count)
        for status, count in by_status.items()
    ]
    counted = table([f"{status}:" for status in by_status], [row])
    return "\n\n".join(filter(None, [counted, _worst(rows), _tolerated(rows)]))


def _tolerated(verdicts: Sequence[Verdict]) -> str:
    """Return the number of rows judged by a tolerance, in words; empty for none."""
    count = sum(verdict.tolerance is not None for verdict in verdicts)
    if not count:
        return ""
    return (
        f"{bold(str(count))} of them were judged by a tolerance given by the user, and not by "
        f"{GATE_FACTOR} times what is attainable."
    )


def _worst(verdicts: Sequence[Verdict]) -> str:
    lost = sum(verdict.is_compared and verdict.ratio is None for verdict in verdicts)
    gravest = worst(verdict for verdict in verdicts if verdict.ratio is not None)
    parts = [
        bold(f"{lost} of {len(verdicts)} without a finite error over attainable.") if lost else "",
        f"Largest error over attainable: {bold(figure(gravest.ratio))}, {code(gravest.quantity)} "
        f"of {code(gravest.scene)} on {gravest.rung} at t = {instant(gravest.ratio_at)}."
        if gravest
        else "",
    ]
    return " ".join(filter(None, parts)) or "Nothing was compared."


def roundoffs(verdicts: Iterable[Verdict]) -> str:
    """Return the legend of u for the rungs of the verdicts."""
    units = {verdict.rung: verdict.roundoff for verdict in verdicts if verdict.roundoff}
    each = (f"{rung} {figure(units[rung])}" for rung in sorted(units, key=place_of_rung))
    return f"u is the unit roundoff of the rung: {', '.join(each) or 'none was run'}."


def sections(runs: Iterable[Run], lay_out: Callable[[list[Run]], str]) -> str:
    """Return a section for each model and solver; ``lay_out`` writes its runs."""
    blocks = []
    groups = groupby(runs, key=lambda run: (run.model, run.solver, run.setting))
    for (model, *solver), group in groups:
        by = " ".join(map(code, filter(None, solver)))
        blocks += [f"## {model or 'Other quantities'}, by {by}", lay_out(list(group))]
    return "\n\n".join(blocks)


def unscored(runs: Iterable[Run]) -> str:
    """Return the runs without a number, with their reasons."""
    rows = [
        f"{code(run.scene)}, {run.rung}: {judged(verdict.verdict)}, {prose(reason(verdict))}"
        for run in runs
        for verdict in run.state
        if verdict.max is None
    ]
    return f"Without a number:\n\n{bullets(rows)}" if rows else ""


def packages(versions: Mapping[str, str]) -> str:
    """Return packages with their versions as a list."""
    return ", ".join(f"{name} {version}" for name, version in versions.items())


def made_with(versions: Mapping[str, str]) -> str:
    """Return the versions behind the numbers, in a sentence."""
    return f"Made with {packages(versions) or 'unknown versions'}."


def traced(provenance: Mapping[str, Any]) -> str:
    """Return the versions behind the numbers, and the processor and the command if known."""
    made = made_with(provenance.get("versions", {}))
    if "processor" not in provenance or "command" not in provenance:
        return made
    return f"{made} Machine: {prose(provenance['processor'])}. By {code(provenance['command'])}."


def made_on(origin: Provenance) -> str:
    """Return the machine, the packages and the command of a measurement."""
    machine = f"{prose(origin.processor)}; {packages(origin.versions)}"
    return f"Machine: {machine}. Made by {code(origin.command)}."
