"""The published tables as CSV: one heading line, then the numbers of the Markdown in all digits."""

from __future__ import annotations

from collections.abc import Callable, Container, Iterable
from typing import Any, Final

from taylor_verify.records.json_text import finite
from taylor_verify.records.runs import (
    Run,
    conserved_quantities,
    gravest,
    quantities_of_scene,
    runs,
)
from taylor_verify.records.verdict import Verdict
from taylor_verify.words.cells import in_roundoffs, over_attainable, word
from taylor_verify.words.sheet import sheet

_RUN: Final = ("scene", "solver", "setting", "rung")
_ERROR: Final = ("quantity", "max", "mean", "final", "at", "unit", "max_u", "mean_u")
_ACCURACY: Final = (
    *_RUN,
    *_ERROR,
    "attainable",
    "attainable_u",
    "ratio",
    "ratio_at",
    "bound",
    "steps",
    "verdict",
    "outcome",
)
_GATES: Final = (
    *_RUN,
    *_ERROR,
    "ratio",
    "ratio_at",
    "bound",
    "attainable",
    "roundoff",
    "exponent",
    "steps",
    "evaluations",
    "verdict",
    "outcome",
    "because",
    "scene_sha256",
)
_CONSERVED: Final = ("max_u", "mean_u", "at", "ratio", "verdict")
_FORMED: Final = ("max_u", "mean_u", "attainable_u", "scene_sha256")
_FIELDS: Final = tuple({*_ACCURACY, *_GATES} - {*_FORMED})


def accuracy(verdicts: Iterable[Verdict]) -> str:
    """Return a row for every state quantity of every run."""
    return sheet(_ACCURACY, (_fields(v) for run in runs(verdicts) for v in run.state))


def conserved(verdicts: Iterable[Verdict]) -> str:
    """Return a row for every run, with five columns for each quantity: ``T_max_u`` and so on."""
    judged_runs = runs(verdicts)
    quantities = conserved_quantities(judged_runs)
    names = [f"{quantity}_{field}" for quantity in quantities for field in _CONSERVED]
    rows = [_conserved_row(run, quantities_of_scene(run, judged_runs)) for run in judged_runs]
    return sheet([*_RUN, "verdict", *names], rows)


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
    names = [name for name in _GATES if name not in without]
    names += further[0] if further else ()
    return sheet(names, (_fields(v) | own for v, own in zip(rows, further, strict=True)))


def _conserved_row(run: Run, scene_quantities: Iterable[str]) -> dict[str, Any]:
    row: dict[str, Any] = {name: getattr(run, name) for name in _RUN}
    row["verdict"] = gravest(run.drifts).value if run.drifts else None
    drifts = run.conserved if run.is_scored else dict.fromkeys(scene_quantities, run.verdicts[0])
    for quantity, verdict in drifts.items():
        fields = _fields(verdict)
        row |= {f"{quantity}_{field}": fields[field] for field in _CONSERVED}
    return row


def _fields(verdict: Verdict) -> dict[str, Any]:
    """Return the fields of a verdict and its errors in u; a word replaces a maximum that is no number.

    Numbers that are quotients of two other columns have six digits.
    """
    row = {name: finite(getattr(verdict, name)) for name in _FIELDS} | {
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
