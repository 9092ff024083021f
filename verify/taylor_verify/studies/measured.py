"""What was measured, as CSV: the rows of a stored measurement, with every digit and a heading line.

A page shows the few numbers that a reader asks for first. Its sheet has them all, one row for each, and in
every row what it belongs to: a program needs no page to read it.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from itertools import zip_longest
from typing import Any, Final

from taylor_verify.claims.document import ClaimRow, ClaimsStudy
from taylor_verify.records.json_text import complete
from taylor_verify.studies.accuracy.sheet import sheet
from taylor_verify.studies.growth.document import Ensemble, GrowthOfQuantity
from taylor_verify.studies.prices.document import PriceRow, PricesStudy
from taylor_verify.studies.reach.document import ReachRow
from taylor_verify.studies.worst.document import WorstStudy

Row = Mapping[str, Any]

_GROWTH: Final = (
    *("scene", "solver", "rung", "quantity", "starts", "lost", "period"),
    *("periods_first", "periods_last", "steps_last", "rms_first", "rms_last", "in_walks"),
    *("exponent", "low", "high", "word", "late", "late_low", "late_high", "late_word"),
    *("level", "gate", "law", "chance", "false_alarm", "scene_sha256"),
)
_REACH: Final = (
    "family",
    "value",
    "rung",
    "periods",
    "error",
    "attainable",
    "lost",
    "steps",
    "why",
)
_PRICES: Final = (
    *("rung", "variant", "against", "states", "parameters", "sums", "products", "quotients"),
    *("order", "steps_per_time", "microseconds", "step_ratio", "step_low", "step_high"),
    *("time_ratio", "time_low", "time_high", "error", "ratio_at_equal_error", "what"),
)
_WORST: Final = (
    *("family", "what", "rung", "judged", "ratio", "quantity", "max", "verdict", "scene"),
    "factor",
)
_CLAIMS: Final = (
    *("id", "verdict", "statement", "correction", "condition", "counterexample"),
    *("residual", "residual_transcribed", "bound", "because", "domain", "method", "mutations"),
    *("lost", "open", "void", "remark"),
)


def growth(runs: Iterable[Ensemble]) -> str:
    """Return a row for every quantity of every ensemble: its exponent with the interval, and its gate."""
    return sheet(_GROWTH, (_grown(run, row) for run in runs for row in run.quantities))


def _grown(run: Ensemble, row: GrowthOfQuantity) -> dict[str, Any]:
    late, late_low, late_high = row.late
    shared = ("scene", "solver", "rung", "lost", "period")
    own = ("quantity", "in_walks", "exponent", "low", "high", "word", "late_word", "level")
    return {
        **{name: getattr(run, name) for name in shared},
        **{name: getattr(row, name) for name in own},
        "starts": run.lanes,
        "periods_first": run.counts[0],
        "periods_last": run.counts[-1],
        "steps_last": run.steps[-1],
        "rms_first": row.rms[0],
        "rms_last": row.rms[-1],
        "late": late,
        "late_low": late_low,
        "late_high": late_high,
        "gate": row.gate.verdict.value if row.gate else None,
        **{name: getattr(row.gate, name, None) for name in ("law", "chance", "false_alarm")},
        "scene_sha256": run.digest,
    }


def reach(rows: Iterable[ReachRow]) -> str:
    """Return a row for every number of periods; one row, with the reason, where nothing was run."""
    return sheet(_REACH, (found for row in rows for found in _reached(row)))


def _reached(row: ReachRow) -> Iterator[dict[str, Any]]:
    """Yield the rows of a run. An error that is missing stands for a motion that was lost."""
    own = {name: getattr(row, name) for name in ("family", "value", "rung", "steps", "why")}
    if not row.errors:
        yield own
        return
    for periods, error, floor in zip_longest(row.periods, row.errors, row.floors):
        lost = "yes" if error is None else "no"
        yield {**own, "periods": periods, "error": error, "attainable": floor, "lost": lost}


def prices(study: PricesStudy) -> str:
    """Return a row for every variant and rung; the prices at equal error are those of f64."""
    at_equal = {one.variant: one.ratio for one in study.equal}
    return sheet(_PRICES, (_priced(row, at_equal) for row in study.rows))


def _priced(row: PriceRow, at_equal: Mapping[str, float | None]) -> dict[str, Any]:
    step, step_low, step_high = row.step_ratio
    time, time_low, time_high = row.time_ratio
    intervals = {
        **{"step_ratio": step, "step_low": step_low, "step_high": step_high},
        **{"time_ratio": time, "time_low": time_low, "time_high": time_high},
    }
    equal = at_equal.get(row.variant) if row.rung == "f64" else None
    return {**complete(row), **intervals, "ratio_at_equal_error": equal}


def worst(study: WorstStudy) -> str:
    """Return a row for every family."""
    shared = {"rung": study.rung, "factor": study.factor}
    rows = ({**complete(row), **shared, "family": row.name} for row in study.families)
    return sheet(_WORST, rows)


def claims(study: ClaimsStudy) -> str:
    """Return a row for every entry of the ledger."""
    return sheet(_CLAIMS, (_claimed(row) for row in study.claims))


def _claimed(row: ClaimRow) -> dict[str, Any]:
    residual = complete(row.residual)
    return {
        **complete(row),
        "residual": residual["statement"],
        "residual_transcribed": residual["transcribed"],
        "mutations": "; ".join(row.mutations),
    }
