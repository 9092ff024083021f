"""Page of the price of each option of a scene, made from the stored measurement."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any, Final

from taylor_verify.plotting.picture import Picture
from taylor_verify.records.json_text import complete
from taylor_verify.words.cells import NOTHING, figure
from taylor_verify.words.markdown import bullets, prose, table
from taylor_verify.words.page import made_on, whole
from taylor_verify.words.sheet import sheet as csv_sheet
from taylor_verify_reports.pictures.ratio import Ratio
from taylor_verify_reports.studies import figures
from taylor_verify_reports.studies.prices.document import Interval, PriceRow, PricesStudy
from taylor_verify_reports.studies.prices.picture import picture
from taylor_verify_reports.studies.stored import Stored

PRICES: Final = Stored(PricesStudy, "prices")

# The models by the variant of their simplest form.
_MODELS: Final = {"omega": "a rigid body", "impulse": "a solid in an ideal fluid"}
# The variants of the table of questions, with what is followed.
_ASKED: Final = (
    ("omega", "omega"),
    ("attitude", "omega and attitude"),
    ("impulse", "impulse"),
    ("whole", "impulse, attitude and centre"),
)

_WHAT: Final = (
    "The suite integrates only the quantities that a scene requires. This page has the prices of the "
    "options of a scene, and of different forms of the same equations. A price is a multiple of that "
    "of the barest form of its model, *omega* or *impulse*, measured in the same round on the same "
    "machine."
)

_LEGEND: Final = (
    "*operations* are the distinct sums, products and quotients of one evaluation of the equations; "
    "the integrator forms each of them once for every order of a step.",
    "*a step* and *a unit of time* are medians of the ratios to the barest form, in the brackets the "
    "interval that holds the median of their distribution with at least 95 %. A unit of time is that "
    "of the scene: faster motions have more steps in it.",
    "*error* is that of omega or of the impulses at the rung's own tolerance, the largest of all "
    "samples, relative; *at equal error* is the price of a unit of time at tolerances for which both "
    "forms achieve 1e-11, on f64.",
    "Up to five states, code on f64 is optimised, and on f80 written out instead of looping over tables. "
    "More would compile for longer than it saves: it runs slower, which is part of the price of a sixth "
    "state.",
)


def pictures(study: PricesStudy) -> list[Picture]:
    """Return a picture for each model: the price on f64 of each option of a scene."""
    drawn = []
    for simplest, model in _MODELS.items():
        rows = [
            Ratio(row.variant, row.rung, *row.step_ratio)
            for row in study.rows
            if row.against == simplest and row.rung == "f64" and row.variant != simplest
        ]
        if rows:
            drawn.append(picture(model, f"{simplest} alone", rows))
    return drawn


def page(study: PricesStudy, folder: Path) -> str:
    """Return the whole page, with the pictures that are in ``folder``/figures."""
    return whole(
        "What each thing costs",
        _WHAT,
        "## Three questions",
        "Processor time of one step of the Taylor integrator at the rung's own tolerance, in "
        "microseconds; in brackets, as a multiple of a step of *omega* on the same rung.",
        _three_questions(study.rows),
        bullets(_LEGEND),
        figures.shown(folder, pictures(study)),
        *_sections(study.rows, {row.variant: row.ratio for row in study.equal}),
        "## How it was measured",
        bullets(_method(study)),
        "## To remake this",
        "`taylor-verify publish prices` repeats the measurement, and writes "
        f"[prices.json](../{PRICES.name}) and this page. No test compares these times.",
    )


def _three_questions(rows: Iterable[PriceRow]) -> str:
    cost = {(row.variant, row.rung): row.microseconds for row in rows}
    rungs = list(dict.fromkeys(rung for _, rung in cost))
    lines = []
    for name, words in _ASKED:
        pairs = [(cost.get((name, rung)), cost.get(("omega", rung))) for rung in rungs]
        cells = [f"{figure(a)} ({figure(a / b)})" if a and b else NOTHING for a, b in pairs]
        lines.append([words, *cells])
    return table(["what is followed", *(f"{rung}:" for rung in rungs)], lines)


def _sections(rows: Sequence[PriceRow], equal: Mapping[str, float | None]) -> list[str]:
    blocks = []
    for simplest, model in _MODELS.items():
        blocks.append(f"## {model[0].upper()}{model[1:]}")
        own = [row for row in rows if row.against == simplest]
        for rung in dict.fromkeys(row.rung for row in own):
            rung_rows = [row for row in own if row.rung == rung]
            blocks += [f"On {rung}, order {rung_rows[0].order}:", _prices(rung_rows, equal)]
    return blocks


def _prices(rows: Sequence[PriceRow], equal: Mapping[str, float | None]) -> str:
    # Prices at equal error were measured on f64 alone.
    is_f64 = rows[0].rung == "f64"
    columns = [
        "variant",
        "states:",
        "operations:",
        "a step:",
        "a unit of time:",
        "error:",
        *(["at equal error:"] if is_f64 else []),
        "what it is",
    ]
    lines = [
        [
            prose(row.variant),
            str(row.states),
            str(row.sums + row.products + row.quotients),
            _ratio(row.step_ratio),
            _ratio(row.time_ratio),
            figure(row.error),
            *([figure(equal.get(row.variant))] if is_f64 else []),
            prose(row.what),
        ]
        for row in rows
    ]
    return table(columns, lines)


def _ratio(interval: Interval) -> str:
    median, low, high = interval
    return f"{figure(median)} [{figure(low)}, {figure(high)}]" if low != high else figure(median)


def _method(study: PricesStudy) -> list[str]:
    method = study.method
    rounds = ", ".join(f"{rung} {count}" for rung, count in method.rounds.items())
    return [
        f"One process, processor time, rounds in which every variant has its turn in an order drawn "
        f"anew (seed {method.seed}): {rounds}. Each turn lasts at least "
        f"{figure(method.least_seconds)} s and is as many runs of the same stretch as that takes.",
        "Compiling, sampling and the exact solution are not in a price. The errors are those of runs "
        "of the suite's own driver, compared with the exact motion.",
        made_on(study.provenance),
    ]


# The sheet.


_SHEET: Final = (
    "rung",
    "variant",
    "against",
    "states",
    "parameters",
    "sums",
    "products",
    "quotients",
    "order",
    "steps_per_time",
    "microseconds",
    "step_ratio",
    "step_low",
    "step_high",
    "time_ratio",
    "time_low",
    "time_high",
    "error",
    "ratio_at_equal_error",
    "what",
)


def sheet(study: PricesStudy) -> str:
    """Return a CSV row for every variant and rung; only rows on f64 have a price at equal error."""
    at_equal = {row.variant: row.ratio for row in study.equal}
    return csv_sheet(_SHEET, (_priced(row, at_equal) for row in study.rows))


def _priced(row: PriceRow, at_equal: Mapping[str, float | None]) -> dict[str, Any]:
    intervals = {"step": row.step_ratio, "time": row.time_ratio}
    ends = {
        f"{name}_{end}": value
        for name, interval in intervals.items()
        for end, value in zip(("ratio", "low", "high"), interval, strict=True)
    }
    equal = at_equal.get(row.variant) if row.rung == "f64" else None
    return {**complete(row), **ends, "ratio_at_equal_error": equal}
