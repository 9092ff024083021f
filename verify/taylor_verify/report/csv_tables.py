"""The sheet of all verdicts as CSV: one heading line, then the numbers of the tables in all digits."""

from __future__ import annotations

from collections.abc import Callable, Container, Iterable
from typing import Any, Final

from taylor_verify.records.json_text import finite
from taylor_verify.records.runs import runs
from taylor_verify.records.verdict import Verdict
from taylor_verify.words.cells import in_roundoffs, over_attainable, word
from taylor_verify.words.csv_sheet import sheet

_FIELDS: Final = (
    "scene",
    "solver",
    "setting",
    "rung",
    "quantity",
    "max",
    "mean",
    "final",
    "at",
    "unit",
    "max_u",
    "mean_u",
    "ratio",
    "ratio_at",
    "bound",
    "attainable",
    "attainable_u",
    "roundoff",
    "exponent",
    "steps",
    "evaluations",
    "verdict",
    "outcome",
    "because",
    "scene_sha256",
)
_FORMED: Final = ("max_u", "mean_u", "attainable_u", "scene_sha256")


def gates(
    verdicts: Iterable[Verdict],
    more: Callable[[Verdict], dict[str, Any]] | None = None,
    without: Container[str] = (),
) -> str:
    """Return a row for every verdict.

    ``more`` returns further cells of a verdict, under the same names for all verdicts. The columns
    ``without`` are left out.
    """
    rows = [v for run in runs(verdicts) for v in run.verdicts]
    further = [more(v) if more else {} for v in rows]
    names = [name for name in _FIELDS if name not in without]
    names += further[0] if further else ()
    return sheet(names, (_fields(v) | own for v, own in zip(rows, further, strict=True)))


def _fields(verdict: Verdict) -> dict[str, Any]:
    """Return the fields of a verdict and its errors in u; a word replaces a maximum that is no number.

    Numbers that are quotients of two other columns have six digits.
    """
    row = {name: finite(getattr(verdict, name)) for name in _FIELDS if name not in _FORMED} | {
        "mean_u": _short(in_roundoffs(verdict, verdict.mean)),
        "attainable_u": _short(in_roundoffs(verdict, verdict.attainable)),
        "scene_sha256": verdict.provenance.get("scene"),
    }
    if verdict.max is None:
        return row | {"max": word(verdict), "max_u": word(verdict)}
    ratio = over_attainable(verdict) if verdict.is_compared else verdict.ratio
    return row | {"max_u": _short(in_roundoffs(verdict, verdict.max)), "ratio": _short(ratio)}


def _short(number: float | None) -> float | None:
    return None if number is None else float(f"{number:.6g}")
