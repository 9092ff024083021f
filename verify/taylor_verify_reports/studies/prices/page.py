"""Page of the price of each option of a scene, made from the stored measurement."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from typing import Any, Final

from taylor_verify.records.json_text import complete
from taylor_verify.words.cells import NOTHING, figure
from taylor_verify.words.markdown import bullets, prose
from taylor_verify.words.page import made_on, whole
from taylor_verify_reports.studies.columns import Columns, csv_sheet, lay_out
from taylor_verify_reports.studies.prices.document import PRICES, PriceRow, PricesStudy

# The models by the variant of their simplest form.
_MODELS: Final = {"omega": "a rigid body", "impulse": "a solid in an ideal fluid"}

_WHAT: Final = (
    "The suite integrates only the quantities that a scene requires. This page has the prices of the "
    "options of a scene, and of different forms of the same equations. A price is the processor time of "
    "one step of the Taylor integrator at the rung's own tolerance, as a multiple of that of the barest "
    "form of its model, *omega* or *impulse*, measured in the same round on the same machine."
)
_LEGEND: Final = (
    "*operations* are the distinct sums, products and quotients of one evaluation of the equations; "
    "the integrator forms each of them once for every order of a step.",
    "*f64* and the other rungs have the median of the ratios to the barest form, in the brackets the "
    "interval that holds the median of their distribution with at least 95 %.",
    "Up to five states, code on f64 is optimised, and on f80 written out instead of looping over tables. "
    "More would compile for longer than it saves: it runs slower, which is part of the price of a sixth "
    "state.",
)

# The rows of a variant by rung.
_ByRung = Mapping[str, PriceRow]


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
    variants: dict[str, dict[str, PriceRow]] = {}
    for row in study.rows:
        if row.against == simplest:
            variants.setdefault(row.variant, {})[row.rung] = row
    if not variants:
        return []
    model, own = _MODELS[simplest], variants[simplest]
    orders = ", ".join(f"{row.order} on {rung}" for rung, row in own.items())
    return [
        f"## {model[0].upper()}{model[1:]}",
        f"The order of a step is {orders}.",
        lay_out(_columns(tuple(own)), variants.values()),
    ]


def _columns(rungs: tuple[str, ...]) -> Columns[_ByRung]:
    return (
        ("variant", lambda rows: prose(_any(rows).variant)),
        ("states:", lambda rows: str(_any(rows).states)),
        ("operations:", lambda rows: str(_any(rows).operations)),
        *((f"{rung}:", partial(_price, rung=rung)) for rung in rungs),
        ("what it is", lambda rows: prose(_any(rows).what)),
    )


def _any(rows: _ByRung) -> PriceRow:
    """Return one of the rows; all have the same variant and the same numbers of operations."""
    return next(iter(rows.values()))


def _price(rows: _ByRung, rung: str) -> str:
    if rung not in rows:
        return NOTHING
    median, low, high = rows[rung].step_ratio
    return f"{figure(median)} [{figure(low)}, {figure(high)}]" if low != high else figure(median)


def _method(study: PricesStudy) -> list[str]:
    method = study.method
    rounds = ", ".join(f"{rung} {count}" for rung, count in method.rounds.items())
    return [
        f"One process, processor time, rounds in which every variant has its turn in an order drawn "
        f"anew (seed {method.seed}): {rounds}. Each turn lasts at least "
        f"{figure(method.least_seconds)} s and is as many runs of the same stretch as that takes.",
        "Compiling, sampling and the exact solution are not in a price.",
        made_on(study.provenance),
    ]


# The sheet.


def sheet(study: PricesStudy) -> str:
    """Return a CSV row for every variant and rung."""
    return csv_sheet(map(_priced, study.rows))


def _priced(row: PriceRow) -> dict[str, Any]:
    median, low, high = row.step_ratio
    ratio = {"step_ratio": median, "step_low": low, "step_high": high}
    return {**complete(row), **ratio}
