"""The published tables as Markdown, from verdicts alone."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Final

from taylor_verify.records.runs import Run, conserved_quantities, gravest, quantities_of_scene, runs
from taylor_verify.records.status import Status
from taylor_verify.records.verdict import Verdict
from taylor_verify.words.cells import NOTHING, judged, peak, verdict_table, worst_ratio
from taylor_verify.words.markdown import bold, bullets, code, prose, table
from taylor_verify.words.page_parts import counts, page, roundoffs, sections, unscored

_RATIO: Final = (
    "*Over attainable* is the largest ratio, over all samples, of the error to the error that perfect "
    "rounding of every step would leave on this orbit"
)
_ACCURACY: Final = (
    "scene",
    "rung",
    "quantity",
    "max:",
    "mean:",
    "at t:",
    "max, u:",
    "mean, u:",
    "over attainable:",
    "bound:",
    "steps:",
    "verdict",
)
_GATES: Final = (
    "scene",
    "rung",
    "quantity",
    "max:",
    "at t:",
    "bound:",
    "attainable:",
    "over attainable:",
    "verdict",
    "because",
)


def accuracy(verdicts: Sequence[Verdict]) -> str:
    """Return the page of the error of every state quantity of every run."""
    judged_runs = runs(verdicts)
    shown = [verdict for run in judged_runs for verdict in run.state]
    units = {verdict.quantity: verdict.unit for verdict in shown if verdict.unit}
    legend = [
        "*max* and *mean* are over all samples, *at t* is the time of the maximum.",
        f"Units: {', '.join(f'{code(name)} in {prose(unit)}' for name, unit in units.items())}.",
        roundoffs(shown),
        f"{_RATIO}. It decides the verdict; *bound* is the bound at the time of the maximum, and "
        "`gates.md` has the reason of each.",
    ]
    return page(
        "State errors",
        verdicts,
        "Every scene was integrated on every rung and compared, at every sample, with the exact "
        "solution of the same rounded data. The difference is the error of the solver.",
        counts(shown),
        bullets(legend),
        sections(judged_runs, _accuracy_section),
    )


def _accuracy_section(group: Sequence[Run]) -> str:
    rows = verdict_table(_ACCURACY, [verdict for run in group for verdict in run.state])
    return "\n\n".join(filter(None, [rows, unscored(group)]))


def conserved(verdicts: Sequence[Verdict]) -> str:
    """Return the page of the drift of every conserved quantity, a line for each run."""
    judged_runs = runs(verdicts)
    shown = [verdict for run in judged_runs for verdict in run.drifts]
    legend = [
        "A cell is *max, mean @ t of the max*, in u, each quantity relative to a scale of its own "
        f"that does not vanish. A single 0 is a quantity that is conserved exactly; {NOTHING} is a "
        "quantity that the scene does not have.",
        roundoffs(shown),
        f"{_RATIO}; the worst quantity of the line is named.",
        "Under loads these quantities change. The cell is then the part of the change that the work "
        "and the impulse of the loads do not explain.",
        "A small drift does not prove a small error of the state; see [state errors](accuracy.md).",
    ]
    return page(
        "Conserved quantities",
        verdicts,
        "The drift of every quantity that the exact motion conserves, for each run.",
        counts(shown),
        bullets(legend),
        sections(judged_runs, _conserved_section),
    )


def _conserved_section(group: Sequence[Run]) -> str:
    quantities = conserved_quantities(group)
    cells = [f"{code(name)}:" for name in quantities]
    columns = ["scene", "rung", *cells, "over attainable:", "verdict"]
    return table(columns, [_conserved_row(run, group, quantities) for run in group])


def _conserved_row(run: Run, group: Sequence[Run], quantities: Iterable[str]) -> list[str]:
    scene_quantities = quantities_of_scene(run, group)
    cells = [_drift(run, name, is_of_scene=name in scene_quantities) for name in quantities]
    verdict = judged(gravest(run.drifts)) if run.drifts else NOTHING
    return [code(run.scene), run.rung, *cells, worst_ratio(run.drifts), verdict]


def _drift(run: Run, quantity: str, is_of_scene: bool) -> str:
    """Return the cell of a conserved quantity, which the scene of a run may have or not."""
    if quantity not in run.conserved:
        is_unscored = is_of_scene and not run.is_scored
        return judged(gravest(run.verdicts)) if is_unscored else NOTHING
    verdict = run.conserved[quantity]
    text = prose(peak(verdict))
    if verdict.verdict is Status.PASS:
        return text
    return bold(text if verdict.max is None else f"{text} {verdict.verdict.value}")


def gates(verdicts: Sequence[Verdict]) -> str:
    """Return the page of every verdict with its bound and its reason."""
    legend = [
        "*max*, *bound* and *attainable* are those of the time *at t* of the largest error.",
        f"{_RATIO}; a gate asks every sample.",
        roundoffs(verdicts),
    ]
    return page(
        "Gates",
        verdicts,
        "Every quantity that was compared, its bound, and the reason of the bound.",
        counts(verdicts),
        bullets(legend),
        sections(
            runs(verdicts),
            lambda group: verdict_table(_GATES, [v for run in group for v in run.verdicts]),
        ),
    )
