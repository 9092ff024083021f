"""What a shift of time leaves of an error: a line for each, from the error to what is left of it.

An answer that is right but late errs in no conserved quantity. Where the line is long, lateness explains
the error; where it is short, the motion itself is another one.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial
from math import isfinite
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
_ERROR: Final = "#A83C00"
_REST: Final = "#0072B2"
_NOTE: Final = "On the right the shift of time, late above zero."


def series(verdicts: Sequence[Verdict]) -> list[dict[str, Any]]:
    """Return {solver, quantity, error, residual, shift, kind} of the rows that a shift explains.

    The rows of one solver stay together, those for which a shift explains the most first.
    """
    found: list[dict[str, Any]] = [
        {
            **{"solver": row.solver, "quantity": row.quantity, "kind": row.shift},
            **{"error": row.max, "residual": row.residual, "shift": row.time_shift},
        }
        for row in verdicts
        if _is_drawable(row)
    ]
    best = {
        solver: min(one["residual"] / one["error"] for one in found if one["solver"] == solver)
        for solver in dict.fromkeys(one["solver"] for one in found)
    }
    return sorted(found, key=lambda one: (best[one["solver"]], one["solver"]))


def _is_drawable(row: Verdict) -> bool:
    """Return True if a shift explains anything, and both sizes can stand on a logarithmic axis."""
    sizes = (row.max, row.residual)
    is_shifted = row.time_shift is not None and row.shift not in (None, Kind.NONE)
    return is_shifted and all(size is not None and isfinite(size) and size > 0 for size in sizes)


def picture(verdicts: Sequence[Verdict], scene: str) -> Picture:
    """``scene`` says what the rows have in common. Raises ValueError for rows without any shift."""
    found = series(verdicts)
    if not found:
        raise ValueError(f"expected an error with its shift of time, got none @ {scene}")
    said = "; ".join(
        f"{one['solver']}, {one['quantity']}: error {plain(one['error'])}, {plain(one['residual'])} left "
        f"after a shift of {plain(one['shift'])}"
        for one in found
    )
    alt = f"Errors of {scene} and what the best shift of time leaves of each, logarithmic. {said}."
    title = f"Shift of time and residual: {scene}"
    return Picture(stem_of({"scene": scene}, "shifts"), title, alt, partial(_figure, found))


def _figure(found: Sequence[Mapping[str, Any]]) -> Figure:
    entries = _entries()
    foot = foot_of(entries, _NOTE)
    height = _LINE * len(found)
    figure = blank(foot + BELOW + height + HEADING)
    frame = Frame(_LEFT, foot + BELOW, PAGE_WIDTH - _LEFT - _RIGHT, height)
    axes = add_axes(figure, frame)
    axes.set(xscale="log", ylim=(len(found) - 0.5, -0.5))
    axes.set(xlim=widened([one[key] for one in found for key in ("error", "residual")], 0.04, 0.04))
    axes.set_yticks(range(len(found)), [_label(one, i, found) for i, one in enumerate(found)])
    axes.xaxis.set_major_formatter(lambda value, _: power_of_ten(value))
    axes.set_xlabel("largest error (relative; attitude in rad)")
    axes.grid(True, axis="x", which="major")
    axes.tick_params(axis="y", length=0)
    axes.set_title("shift (time)", pad=4, loc="right", x=1.0 + _RIGHT / frame.width, fontsize=SMALL)
    for line, one in enumerate(found):
        _draw(axes, line, one)
    draw_legend(figure, entries, _NOTE)
    return figure


def _label(one: Mapping[str, Any], i: int, found: Sequence[Mapping[str, Any]]) -> str:
    """The solver once, and the quantity of each."""
    is_first = i == 0 or found[i - 1]["solver"] != one["solver"]
    name = one["solver"].replace("-", " ")
    return f"{name}: {one['quantity']}" if is_first else one["quantity"]


def _draw(axes: Axes, line: int, one: Mapping[str, Any]) -> None:
    axes.plot([one["residual"], one["error"]], [line, line], color=QUIET, linewidth=1.0, zorder=2)
    for key, look in (("error", _AT_ERROR), ("residual", _AT_REST)):
        axes.plot([one[key]], [line], zorder=3, gid=key, **look)
    axes.annotate(
        f"{one['shift']:+.2g}".replace("-", "\N{MINUS SIGN}"),
        (1.0, line),
        (6, 0),
        xycoords=("axes fraction", "data"),
        textcoords="offset points",
        va="center_baseline",
        size=SMALL,
        color=INK,
        annotation_clip=False,
    )


_MARK: Final[Mapping[str, Any]] = {"linestyle": "none", "markeredgewidth": 1.1}
_AT_ERROR: Final[Mapping[str, Any]] = {
    **_MARK,
    **{"marker": "o", "markersize": 5, "markerfacecolor": _ERROR, "markeredgecolor": _ERROR},
}
_AT_REST: Final[Mapping[str, Any]] = {
    **_MARK,
    **{"marker": "D", "markersize": 4.5, "markerfacecolor": PAPER, "markeredgecolor": _REST},
}


def _entries() -> list[Entry]:
    return [(dict(_AT_ERROR), "error"), (dict(_AT_REST), "left after the best shift of time")]
