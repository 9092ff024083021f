"""Page of the price of each option of a scene, made from the stored measurement."""

from __future__ import annotations

from typing import Any, Final

from taylor_verify.records.json_text import complete
from taylor_verify.words.cells import figure
from taylor_verify.words.markdown import bullets, prose
from taylor_verify.words.page import made_on, whole
from taylor_verify_reports.studies.columns import Columns, csv_sheet, lay_out
from taylor_verify_reports.studies.prices.document import PRICES, PriceRow, PricesStudy

# The models by the variant of their simplest form.
_MODELS: Final = {"omega": "a rigid body", "impulse": "a solid in an ideal fluid"}

_WHAT: Final = (
    "The suite integrates only the quantities that a scene requires. This page has the prices of the "
    "options of a scene, and of different forms of the same equations. A price is the processor time of "
    "one step of the Taylor integrator in float64 at its own tolerance, as a multiple of that of the "
    "barest form of its model, *omega* or *impulse*, measured in the same round on the same machine."
)
_LEGEND: Final = (
    "*operations* are the distinct sums, products and quotients of one evaluation of the equations; "
    "the integrator forms each of them once for every order of a step.",
    "*price* is the median of the ratios to the barest form, in the brackets the interval that holds the "
    "median of their distribution with at least 95 %.",
    "Up to five states, the code is optimised. More would compile for longer than it saves: it runs "
    "slower, which is part of the price of a sixth state.",
)


def page(study: PricesStudy) -> str:
    """Return the whole page."""
    return whole(
        "What each thing costs",
        _WHAT,
        bullets(_LEGEND),
        *(block for simplest in _MODELS for block in _section(study, simplest)),
        "## How it was measured",
        bullets(_method(study)),
        "## To remake this",
        "`taylor-verify publish prices` repeats the measurement, and writes "
        f"[prices.json](../{PRICES.name}) and this page. No test compares these times.",
    )


def _section(study: PricesStudy, simplest: str) -> list[str]:
    rows = [row for row in study.rows if row.against == simplest]
    if not rows:
        return []
    model = _MODELS[simplest]
    return [
        f"## {model[0].upper()}{model[1:]}",
        f"The order of a step is {rows[0].order}.",
        lay_out(_COLUMNS, rows),
    ]


_COLUMNS: Final[Columns[PriceRow]] = (
    ("variant", lambda row: prose(row.variant)),
    ("states:", lambda row: str(row.states)),
    ("operations:", lambda row: str(row.operations)),
    ("price:", lambda row: _price(*row.step_ratio)),
    ("what it is", lambda row: prose(row.what)),
)


def _price(median: float, low: float | None, high: float | None) -> str:
    return f"{figure(median)} [{figure(low)}, {figure(high)}]" if low != high else figure(median)


def _method(study: PricesStudy) -> list[str]:
    method = study.method
    return [
        f"One process, processor time, {method.rounds} rounds in which every variant has its turn in an "
        f"order drawn anew (seed {method.seed}). Each turn lasts at least "
        f"{figure(method.least_seconds)} s and is as many runs of the same stretch as that takes.",
        "Compiling, sampling and the exact solution are not in a price.",
        made_on(study.provenance),
    ]


# The sheet.


def sheet(study: PricesStudy) -> str:
    """Return a CSV row for every variant."""
    return csv_sheet(map(_priced, study.rows))


def _priced(row: PriceRow) -> dict[str, Any]:
    median, low, high = row.step_ratio
    ratio = {"step_ratio": median, "step_low": low, "step_high": high}
    return {**complete(row), **ratio}
