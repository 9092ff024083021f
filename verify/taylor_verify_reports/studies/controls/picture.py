"""Picture of errors before and after the best shift of time, a line for each error.

A right answer that comes late has no error of conserved quantities. A long line means that a shift of time
explains the error, and a short line that the motion itself is wrong.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial
from math import inf
from typing import TYPE_CHECKING, Any, Final

from taylor_verify.plotting.picture import Picture
from taylor_verify.plotting.wording import plain, stem_of
from taylor_verify.records.reason import Kind
from taylor_verify.records.verdict import Verdict
from taylor_verify_reports.pictures.dumbbells import (
    FULL,
    HOLLOW,
    Dumbbell,
    Layout,
    draw_dumbbells,
)

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_LAYOUT: Final = Layout(
    marks={"error": (FULL, "error"), "residual": (HOLLOW, "left after the best shift of time")},
    left=2.75,
    right=0.75,
    axis="largest error (relative; attitude in rad)",
    values="shift (time)",
    note="On the right the shift of time, late above zero.",
)

Row = Mapping[str, Any]


def series(verdicts: Sequence[Verdict]) -> list[Row]:
    """Return {solver, quantity, kind, error, residual, shift} of each error that a shift of time explains.

    ``shift`` is in the scene's unit of time. The rows of one solver stay together. Solvers for which a
    shift explains most come first.
    """
    rows: list[Row] = [
        {
            "solver": row.solver,
            "quantity": row.quantity,
            "kind": row.shift,
            "error": row.max,
            "residual": row.residual,
            "shift": row.time_shift,
        }
        for row in verdicts
        if _is_drawable(row)
    ]
    best: dict[str, float] = {}
    for row in rows:
        left = row["residual"] / row["error"]
        best[row["solver"]] = min(left, best.get(row["solver"], left))
    return sorted(rows, key=lambda row: (best[row["solver"]], row["solver"]))


def _is_drawable(row: Verdict) -> bool:
    """Return True if a shift explains a part, and a logarithmic axis can show the error and the rest."""
    is_shifted = row.time_shift is not None and row.shift not in (None, Kind.NONE)
    return is_shifted and all(size and 0 < size < inf for size in (row.max, row.residual))


def picture(verdicts: Sequence[Verdict], scene: str) -> Picture:
    """Return the picture of verdicts; ``scene`` is their common name. Raises ValueError without a shift."""
    rows = series(verdicts)
    if not rows:
        raise ValueError(f"expected an error with its shift of time, got none @ {scene}")
    sizes = "; ".join(
        f"{row['solver']}, {row['quantity']}: error {plain(row['error'])}, {plain(row['residual'])} left "
        f"after a shift of {plain(row['shift'])}"
        for row in rows
    )
    alt = f"Errors of {scene} and what the best shift of time leaves of each, logarithmic. {sizes}."
    title = f"Shift of time and residual: {scene}"
    return Picture(stem_of({"scene": scene}, "shifts"), title, alt, partial(_figure, rows))


def _figure(rows: Sequence[Row]) -> Figure:
    lines = [
        Dumbbell(
            label,
            {"residual": row["residual"], "error": row["error"]},
            f"{row['shift']:+.2g}".replace("-", "\N{MINUS SIGN}"),
        )
        for label, row in zip(_labels(rows), rows, strict=True)
    ]
    return draw_dumbbells(lines, _LAYOUT)


def _labels(rows: Sequence[Row]) -> list[str]:
    """Return the quantity of each row, with its solver in the first row of that solver."""
    solvers = ["", *(row["solver"] for row in rows)]
    return [
        row["quantity"]
        if row["solver"] == before
        else f"{row['solver'].replace('-', ' ')}: {row['quantity']}"
        for before, row in zip(solvers, rows, strict=False)
    ]
