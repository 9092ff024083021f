"""The study of growth: ensembles of starts, followed over decades of time.

growth.json        the published ensembles: of every quantity its root mean squares and the gate
growth-long.json   the same for the long run, which is made on request
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any, Final

from taylor_verify.records.status import Status
from taylor_verify.words.cells import NOTHING, figure, judged
from taylor_verify.words.csv_sheet import sheet as csv_sheet
from taylor_verify.words.markdown import bold, bullets, code, prose
from taylor_verify.words.page_parts import made_on, whole
from taylor_verify_reports.studies.columns import Columns, lay_out
from taylor_verify_reports.studies.growth.grown import (
    EXACT,
    Ensemble,
    GrowthOfQuantity,
    GrowthStudy,
    Number,
)
from taylor_verify_reports.studies.stored import Stored
from taylor_verify_reports.studies.study import Measured, NotMeasured, Option, Progress, Study

GROWTH: Final = Stored(GrowthStudy, "growth")
LONG: Final = Stored(GrowthStudy, "growth", stem="growth-long")

_WHAT: Final = (
    "If roundings are independent of each other, they change a conserved quantity like a random walk, "
    "which grows as the square root of time. The error of the phase, whose rate depends on the "
    "conserved quantities, then grows with the power 3/2 of time. This is Brouwer's law. Errors of "
    "constant sign, however small, grow with the powers 1 and 2 instead, and dominate a long run. "
    "Each ensemble here is a scene and starts within one per cent of it, followed by the Taylor "
    "integrator and compared with the exact motion of the same rounded data."
)
_LEGEND: Final = (
    "*rms* is the root mean square over the starts at the first and the last instant: drifts relative "
    "to the quantity's own size, the state relative to its largest, *phase* in radians of the orbit's "
    "period. *walks* is the last one over u times the square root of the steps, where u is the rung's "
    "unit roundoff. A random walk with steps of one u has 1.",
    "*exponent* is the mean of the slopes of all starts, log error against log time, with Student's "
    "interval at 99 %. It needs no assumption on the distribution of errors. *late* is the exponent "
    "of the second half of the decades.",
    "The word names the exponent that the interval contains: bounded 0, random walk ½, bias 1. Phase "
    "and state have one more, because they follow the rate (and *jitter* ½, *constant rate* 1). The "
    "word is *unclear* if the interval contains several exponents, and *between* if it contains none. "
    "Every interval counts as at least a twentieth wide on either side, because no error is a pure "
    "power of time.",
)
_NO_CONSERVATION: Final = (
    "A small drift does not prove a small error of the state. The error of the phase beside it is "
    "larger, by a factor that grows with time."
)

_LEANING: Final = (
    "**Where roundings lean to one side.** A product with a coefficient of many random digits is "
    "rounded up as far as down. A coefficient that is a rounded small fraction, such as 1/6, leaves "
    "remainders that are nearly thirds of a unit in the last place. The coefficient's own rounding "
    "moves all of them to one side. The mean rounding is then up to a sixth of a unit, and its sign "
    "depends on the size of the other factor. An orbit that favours a size has a bias, which no "
    "tolerance removes. Examples with round numbers are therefore hard ones."
)
_REMAKE: Final = (
    "`taylor-verify publish growth` repeats the measurement, and writes "
    f"[growth.json](../{GROWTH.name}) and this page. It takes minutes on all cores.",
    "`taylor-verify publish growth --long` follows the long run of 100 million periods in the same "
    "way, in an hour or more.",
    "Roundings differ between processors, and so do the last digits here. The exponents are the same "
    "within their intervals.",
)


def find(folder: Path) -> GrowthStudy | None:
    """Return the published runs and the long ones as one document; None if there are no runs.

    Raises OSError for files that cannot be read and ValueError for files that hold something else.
    """
    stored = [study for study in (GROWTH.find(folder), LONG.find(folder)) if study and study.runs]
    if not stored:
        return None
    runs = tuple(run for study in stored for run in study.runs)
    left_out = tuple(line for study in stored for line in study.left_out)
    return GrowthStudy(runs, left_out, stored[0].provenance)


def page(study: GrowthStudy) -> str:
    """Return the whole page."""
    runs = study.runs
    return whole(
        "How errors grow with time",
        _WHAT,
        _gates(runs),
        bullets(prose(f"Left out: {line}.") for line in study.left_out),
        bullets(_LEGEND),
        *(block for run in runs for block in _section(run)),
        "## The gate",
        _gate_in_words(runs),
        _LEANING,
        _NO_CONSERVATION,
        "## To remake this",
        bullets([*_REMAKE, made_on(study.provenance)]),
    )


def _gates(runs: Iterable[Ensemble]) -> str:
    """Return the number of gates that passed, and the names of the others."""
    gates = [(run, row, row.gate) for run in runs for row in run.quantities if row.gate]
    failed = [
        f"{code(row.quantity)} of {_name(run)}"
        for run, row, gate in gates
        if gate.verdict is not Status.PASS
    ]
    counts = f"{len(gates) - len(failed)} of {len(gates)} gates passed."
    return f"{counts} Worse than a random walk: {'; '.join(failed)}." if failed else counts


def _section(run: Ensemble) -> list[str]:
    lost = bold(f" {run.lost} of them did not reach the end.") if run.lost else ""
    first, last = (f"{count:.3g}".replace("e+0", "e") for count in (run.counts[0], run.counts[-1]))
    return [
        f"## {_name(run)}",
        f"{prose(run.why.capitalize())}. {run.lanes} starts from {first} to {last} periods of "
        f"{figure(run.period)} each, {figure(run.steps[-1])} steps.{lost}",
        lay_out(_QUANTITY, run.quantities),
    ]


_QUANTITY: Final[Columns[GrowthOfQuantity]] = (
    ("quantity", lambda row: code(row.quantity)),
    ("rms, first:", lambda row: figure(row.rms[0])),
    ("rms, last:", lambda row: figure(row.rms[-1])),
    ("walks:", lambda row: figure(row.in_walks)),
    ("exponent:", lambda row: _interval(row.word, row.exponent, row.low, row.high)),
    ("word", lambda row: prose(row.word)),
    ("late", lambda row: _interval(row.late_word, *row.late)),
    ("no worse than a walk", lambda row: _gate(row)),
)


def _gate(row: GrowthOfQuantity) -> str:
    gate = row.gate
    return f"{judged(gate.verdict)}, chance {figure(gate.chance)}" if gate else NOTHING


def _interval(word: str, value: Number, low: Number, high: Number) -> str:
    if word == EXACT or value is None or low is None or high is None:
        return NOTHING
    return f"{value:.2f} [{low:.2f}, {high:.2f}]"


def _gate_in_words(runs: Sequence[Ensemble]) -> str:
    rates = {row.gate.false_alarm for run in runs for row in run.quantities if row.gate}
    rate = figure(max(rates)) if rates else NOTHING
    return (
        "*no worse than a walk* compares the last decade with those before it. A walk's increments "
        "over the square roots of their times are independent numbers of one variance. The covariance "
        "of its integral turns a phase into such numbers too. Therefore the ratio of the late squares "
        "to the early ones has Fisher's distribution for every start, for any size of its roundings, "
        "and all starts together are chi-square. *chance* is the probability that a true walk looks "
        f"this bad. The gate fails below {rate}, which is the probability that a true walk fails. The "
        "state has no gate, because an error without a sign has no such distribution; its growth is "
        "that of the phase."
    )


def _name(run: Ensemble) -> str:
    return f"{run.scene} on {run.rung}, {run.solver}"


# The sheet.


def sheet(study: GrowthStudy) -> str:
    """Return a CSV row for every quantity of every ensemble: its exponent with interval, and its gate."""
    rows = [_grown(run, row) for run in study.runs for row in run.quantities]
    return csv_sheet(list(rows[0]) if rows else [], rows)


def _grown(run: Ensemble, row: GrowthOfQuantity) -> dict[str, Any]:
    late, late_low, late_high = row.late
    return {
        "scene": run.scene,
        "solver": run.solver,
        "rung": run.rung,
        "quantity": row.quantity,
        "starts": run.lanes,
        "lost": run.lost,
        "period": run.period,
        "periods_first": run.counts[0],
        "periods_last": run.counts[-1],
        "steps_last": run.steps[-1],
        "rms_first": row.rms[0],
        "rms_last": row.rms[-1],
        **{name: getattr(row, name) for name in ("in_walks", "exponent", "low", "high", "word")},
        "late": late,
        "late_low": late_low,
        "late_high": late_high,
        "late_word": row.late_word,
        "level": row.level,
        "gate": row.gate.verdict.value if row.gate else None,
        **{name: getattr(row.gate, name, None) for name in ("law", "chance", "false_alarm")},
        "scene_sha256": run.digest,
    }


# The study.


def _measure(
    folder: Path, progress: Progress, periods: float | None = None, long: bool = False
) -> Measured:
    """Follow the published ensembles, or the long one alone."""
    from taylor_verify_reports.studies.growth import experiment

    def ended(label: str, done: int, total: int) -> None:
        progress.say(f"{label}: piece {done} of {total}")

    questions = experiment.long() if long else experiment.published()
    try:
        study = experiment.followed(questions, ended, periods)
    except ValueError as error:
        raise NotMeasured(str(error)) from error
    return Measured((LONG if long else GROWTH).write(folder, study))


def _periods(text: str) -> float:
    from taylor_verify.scenes.reading.table import exact_number

    try:
        return float(exact_number(text))
    except (OverflowError, ValueError) as error:
        raise ValueError(f"expected a number of periods, got {text!r}") from error


STUDY: Final = Study(
    name="growth",
    title="how drift and phase grow over decades of time",
    duration="ten minutes, all cores; with --long an hour or more",
    measure=_measure,
    find=find,
    page=lambda study, folder: page(study),
    sheet=sheet,
    options=(
        Option("periods", "follow no ensemble for more than N periods", _periods),
        Option("long", "follow only the ensemble of 100 million periods"),
    ),
)
