"""Errors beside what a shift of time leaves of them: a line for each, from the one to the other.

An answer that is right but late errs in no conserved quantity. Where the line is long, lateness explains
the error; where it is short, the motion itself is another one.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial
from math import inf
from typing import TYPE_CHECKING, Any, Final

from taylor_verify.publish.pictures.log_axes import widened
from taylor_verify.publish.pictures.palette import INK, PAPER, QUIET
from taylor_verify.publish.pictures.picture import Picture
from taylor_verify.publish.pictures.sheet import (
    BELOW,
    HEADING,
    Entry,
    Frame,
    add_axes,
    blank,
    draw_legend,
    foot_of,
)
from taylor_verify.publish.pictures.style import PAGE_WIDTH, SMALL
from taylor_verify.publish.pictures.wording import plain, power_of_ten, stem_of
from taylor_verify.records.reason import Kind
from taylor_verify.records.verdict import Verdict

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

# In inches.
_LEFT: Final = 2.75
_RIGHT: Final = 0.75
_LINE: Final = 0.19
_NOTE: Final = "On the right the shift of time, late above zero."
_ERROR: Final = "#A83C00"
_MARK: Final[Mapping[str, Any]] = {"linestyle": "none", "markeredgewidth": 1.1}
_MARKS: Final[Mapping[str, Entry]] = {
    "error": (
        {
            **{**_MARK, "marker": "o", "markersize": 5},
            **{"markerfacecolor": _ERROR, "markeredgecolor": _ERROR},
        },
        "error",
    ),
    "residual": (
        {
            **{**_MARK, "marker": "D", "markersize": 4.5},
            **{"markerfacecolor": PAPER, "markeredgecolor": "#0072B2"},
        },
        "left after the best shift of time",
    ),
}

Row = Mapping[str, Any]


def series(verdicts: Sequence[Verdict]) -> list[Row]:
    """Return {solver, quantity, error, residual, shift, kind} of the rows that a shift explains.

    The rows of one solver stay together, those for which a shift explains the most first.
    """
    found: list[Row] = [
        {
            **{"solver": row.solver, "quantity": row.quantity, "kind": row.shift},
            **{"error": row.max, "residual": row.residual, "shift": row.time_shift},
        }
        for row in verdicts
        if _is_drawable(row)
    ]
    best: dict[str, float] = {}
    for row in found:
        left = row["residual"] / row["error"]
        best[row["solver"]] = min(left, best.get(row["solver"], left))
    return sorted(found, key=lambda row: (best[row["solver"]], row["solver"]))


def _is_drawable(row: Verdict) -> bool:
    """Return True if a shift explains anything, and both sizes can stand on a logarithmic axis."""
    is_shifted = row.time_shift is not None and row.shift not in (None, Kind.NONE)
    return is_shifted and all(size and 0 < size < inf for size in (row.max, row.residual))


def picture(verdicts: Sequence[Verdict], scene: str) -> Picture:
    """Return the picture of rows that have ``scene`` in common. Raises ValueError without any shift."""
    found = series(verdicts)
    if not found:
        raise ValueError(f"expected an error with its shift of time, got none @ {scene}")
    each = "; ".join(
        f"{row['solver']}, {row['quantity']}: error {plain(row['error'])}, {plain(row['residual'])} left "
        f"after a shift of {plain(row['shift'])}"
        for row in found
    )
    alt = f"Errors of {scene} and what the best shift of time leaves of each, logarithmic. {each}."
    title = f"Shift of time and residual: {scene}"
    return Picture(stem_of({"scene": scene}, "shifts"), title, alt, partial(_figure, found))


def _figure(found: Sequence[Row]) -> Figure:
    entries = list(_MARKS.values())
    foot = foot_of(entries, _NOTE)
    height = _LINE * len(found)
    figure = blank(foot + BELOW + height + HEADING)
    frame = Frame(_LEFT, foot + BELOW, PAGE_WIDTH - _LEFT - _RIGHT, height)
    axes = add_axes(figure, frame)
    axes.set(xscale="log", ylim=(len(found) - 0.5, -0.5))
    axes.set(xlim=widened([row[key] for row in found for key in _MARKS], 0.04, 0.04))
    axes.set_yticks(range(len(found)), _labels(found))
    axes.xaxis.set_major_formatter(lambda value, _: power_of_ten(value))
    axes.set_xlabel("largest error (relative; attitude in rad)")
    axes.grid(True, axis="x", which="major")
    axes.tick_params(axis="y", length=0)
    axes.set_title("shift (time)", pad=4, loc="right", x=1.0 + _RIGHT / frame.width, fontsize=SMALL)
    for line, row in enumerate(found):
        _draw(axes, line, row)
    draw_legend(figure, entries, _NOTE)
    return figure


def _labels(found: Sequence[Row]) -> list[str]:
    """Return the quantity of each row, with its solver where that is another one."""
    solvers = ["", *(row["solver"] for row in found)]
    return [
        row["quantity"]
        if row["solver"] == before
        else f"{row['solver'].replace('-', ' ')}: {row['quantity']}"
        for before, row in zip(solvers, found, strict=False)
    ]


def _draw(axes: Axes, line: int, row: Row) -> None:
    axes.plot([row["residual"], row["error"]], [line, line], color=QUIET, linewidth=1.0, zorder=2)
    for key, (look, _) in _MARKS.items():
        axes.plot([row[key]], [line], zorder=3, gid=key, **look)
    axes.annotate(
        f"{row['shift']:+.2g}".replace("-", "\N{MINUS SIGN}"),
        (1.0, line),
        (6, 0),
        xycoords=("axes fraction", "data"),
        textcoords="offset points",
        va="center_baseline",
        size=SMALL,
        color=INK,
        annotation_clip=False,
    )
