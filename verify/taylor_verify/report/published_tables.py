"""The published tables as Markdown, from verdicts alone."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Final

from taylor_verify.records.runs import (
    Run,
    conserved_quantities,
    gravest,
    quantities_of_scene,
    runs,
)
from taylor_verify.records.status import Status
from taylor_verify.records.verdict import Verdict
from taylor_verify.words.cells import NOTHING, judged, peak, verdict_table, worst_ratio
from taylor_verify.words.markdown import bold, bullets, code, prose, table
from taylor_verify.words.page_parts import counts, page, roundoffs, sections, unscored

if TYPE_CHECKING:
    from taylor_verify.words.entry import Page

_MEANINGS: Final[Mapping[Status, str]] = {
    Status.PASS: "the error of every sample is within its bound",
    Status.FAIL: "an error exceeds its bound or is no number, or the solver did not finish",
    Status.UNDECIDED: "the exact solution is not known sharply enough to judge by",
    Status.VACUOUS: "roundoff alone may be as large as the motion: no answer could fail",
    Status.REFUSED: "the numbers of this rung cannot hold the scene",
    Status.UNAVAILABLE: "this machine does not have the rung",
}
_RATIO: Final = (
    "*Over attainable* is the largest ratio, over all samples, of the error to the error that perfect "
    "rounding of every step would leave on this orbit"
)
_CONTENTS: Final = (
    (
        "[State errors](accuracy.md)",
        "`gates.csv`",
        "the error of what each scene tracks, beside that of perfect rounding",
    ),
    ("[Conserved quantities](conserved.md)", "`gates.csv`", "their drift, a run a line"),
    (
        "Gates",
        "`gates.csv`",
        "every verdict, its bound and the reason of the bound: `gates.md`",
    ),
)
_PAPER: Final = (
    "`make paper` makes a paper of the studies' results, with its tables as LaTeX and CSV, in "
    "`reports/paper`. It is not committed, nor are the tables for searching: `taylor-verify publish "
    "--missing` makes the sheets, CSV with every digit, and `gates.md`, a line for every verdict."
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


def readme(verdicts: Sequence[Verdict], others: Iterable[Page] = ()) -> str:
    """Return the index of the tables, and how to read a cell; ``others`` are further pages."""
    how = [
        "Numbers have three significant digits, and all digits in the CSV. Times have up to six "
        "digits.",
        f"A word replaces a missing number: the verdict, or the outcome of a failed run. {NOTHING} is "
        "an empty cell.",
        "An error is absolute or relative as its unit says, and also given in u, the unit roundoff "
        "2^-p of a rung of p bits: 1 u is the largest error of one rounding.",
        f"{_RATIO}. A ratio near 1 is the best that the arithmetic allows.",
        "In the CSV the word is in the column of the maximum, and empty cells have no mark; `max_u` "
        "and `mean_u` are in u.",
    ]
    meanings = [[judged(status), text] for status, text in _MEANINGS.items()]
    besides = [
        [
            entry.link("tables"),
            code(Path(entry.sheet).name) if entry.has_sheet else NOTHING,
            entry.what,
        ]
        for entry in others
    ]
    return page(
        "Tables",
        verdicts,
        table(["table", "every digit", "what it has"], _CONTENTS),
        table(["besides", "every digit", "what it has"], besides) if besides else "",
        counts(verdicts),
        "## How to read a cell",
        bullets(how),
        table(["verdict", "meaning"], meanings),
        "## To print and to cite",
        _PAPER,
        "## Scenes",
        table(["scene", "rungs", "SHA-256"], _scenes(verdicts)),
    )


def _scenes(verdicts: Sequence[Verdict]) -> list[list[str]]:
    """Return every scene with its rungs and the digest of its text."""
    rungs: dict[str, list[str]] = {}
    digests: dict[str, str] = {}
    for run in runs(verdicts):
        rungs.setdefault(run.scene, []).append(run.rung)
        digests[run.scene] = str(run.verdicts[0].provenance.get("scene", ""))
    return [
        [code(scene), ", ".join(dict.fromkeys(names)), code(digests[scene]) or NOTHING]
        for scene, names in rungs.items()
    ]
