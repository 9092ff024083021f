"""The table of errors reached and errors attainable: by rung, then by scene."""

from __future__ import annotations

from collections.abc import Sequence
from math import inf
from statistics import median
from typing import Final

from taylor_verify.records.precisions import place_of_rung
from taylor_verify.records.quantities import GATE_FACTOR
from taylor_verify.records.runs import Run, runs
from taylor_verify.records.status import Status
from taylor_verify.records.verdict import Verdict
from taylor_verify.words.cells import (
    INFINITE,
    NOTHING,
    figure,
    instant,
    over_attainable,
    ratio,
    word,
)
from taylor_verify.words.markdown import bold, bullets, code, prose, table
from taylor_verify.words.page import counts, page, roundoffs, sections, unscored

_WHAT: Final = (
    "The attainable error is the error that would be left if every step only rounded each component "
    "once. Such roundings add up like a random walk, and the orbit propagates them. How near did each "
    "run come to this error?"
)
_MODEL: Final = (
    "It is a model of random roundings, and no bound. A run of few steps may stay far below it by "
    "chance, and the largest of hundreds of samples may be somewhat above. A gate allows "
    f"{GATE_FACTOR} times it."
)


def attainable(verdicts: Sequence[Verdict]) -> str:
    """Return the page: a line for each rung, then a line for each state quantity, rung by rung."""
    judged_runs = runs(verdicts)
    shown = [verdict for run in judged_runs for verdict in run.state]
    legend = [
        "A cell is *reached, attainable, ratio @ t*: the largest error of all samples, the attainable "
        "error at its time, and the largest ratio of the two at one sample with the time of that "
        "sample.",
        "A single 0 with the attainable error is a state without any error.",
        "A word, or a bold word after the numbers, is a verdict other than pass.",
        roundoffs(shown),
        "`gates.md` has the arithmetic of every attainable error, in words.",
    ]
    return page(
        "Attainable and reached",
        verdicts,
        f"{_WHAT} {_MODEL}",
        counts(shown),
        "## By rung",
        _by_rung(shown),
        "## How to read a cell",
        bullets(legend),
        sections(judged_runs, _section),
    )


def _by_rung(shown: Sequence[Verdict]) -> str:
    columns = [
        "rung",
        "u:",
        "errors:",
        "median ratio:",
        "ratio at most 1:",
        "largest ratio:",
        "where",
    ]
    rungs = sorted({verdict.rung for verdict in shown}, key=place_of_rung)
    return table(columns, [_rung_row(rung, [v for v in shown if v.rung == rung]) for rung in rungs])


def _rung_row(rung: str, verdicts: Sequence[Verdict]) -> list[str]:
    scored = [verdict for verdict in verdicts if verdict.is_compared]
    if not scored:
        return [rung, NOTHING, NOTHING, NOTHING, NOTHING, NOTHING, NOTHING]
    ratios = [over_attainable(verdict) for verdict in scored]
    most = max(scored, key=over_attainable)
    within = sum(value <= 1 for value in ratios)
    middle = median(ratios)
    return [
        rung,
        figure(scored[0].roundoff),
        str(len(scored)),
        figure(middle) if middle < inf else bold(INFINITE),
        f"{within} of {len(scored)}",
        ratio(most) if most.verdict is Status.PASS else bold(ratio(most)),
        f"{code(most.quantity)} of {code(most.scene)} at t = {instant(most.ratio_at)}",
    ]


def _section(group: Sequence[Run]) -> str:
    rungs = sorted({run.rung for run in group}, key=place_of_rung)
    lines: dict[tuple[str, str], dict[str, Verdict]] = {}
    for run in group:
        for verdict in run.state:
            lines.setdefault((run.scene, verdict.quantity), {})[run.rung] = verdict
    columns = ["scene", "quantity", *(f"{rung}:" for rung in rungs)]
    rows = [
        [code(scene), code(quantity), *(_cell(by_rung.get(rung)) for rung in rungs)]
        for (scene, quantity), by_rung in lines.items()
    ]
    return "\n\n".join(filter(None, [table(columns, rows), unscored(group)]))


def _cell(verdict: Verdict | None) -> str:
    if verdict is None:
        return NOTHING
    if verdict.max is None:
        return bold(prose(word(verdict)))
    if verdict.max == 0:
        return f"0, {figure(verdict.attainable)}"
    where = f" @ {instant(verdict.ratio_at)}" if verdict.ratio_at is not None else ""
    numbers = f"{figure(verdict.max)}, {figure(verdict.attainable)}, {ratio(verdict)}{where}"
    passed = verdict.verdict is Status.PASS
    return numbers if passed else f"{numbers} {bold(verdict.verdict.value)}"
