"""Picture of a sweep: the share of judged rows with an error over the roundoff floor above a size."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Final

from taylor_verify.plotting.log_axes import number_axes, widened
from taylor_verify.plotting.palette import INK, QUIET
from taylor_verify.plotting.picture import Picture
from taylor_verify.plotting.sheet import name_lines, sheet
from taylor_verify.plotting.style import look_of_line
from taylor_verify.plotting.wording import plain
from taylor_verify.records.quantities import INITIAL
from taylor_verify.records.sweep import Spread, SweepSummary

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Points = list[tuple[float, float]]

STEM: Final = "summary"
# In inches.
_HEIGHT: Final = 3.2


def picture(summary: SweepSummary) -> Picture:
    """Return the picture of a sweep. Raises ValueError if no error over attainable is above zero."""
    drawn = [each for each in summary.quantities if each.quantity != INITIAL and _points(each)]
    if not drawn:
        raise ValueError("expected an error above zero, got none @ sweep")
    largest = "; ".join(
        f"{each.quantity} {plain(each.ratio.largest)}"
        for each in drawn
        if each.ratio is not None and each.ratio.largest is not None
    )
    return Picture(
        STEM,
        f"Error over the roundoff floor of {summary.total} bodies: {summary.name}",
        f"Of {summary.total} bodies of {summary.name}, the share of the judged rows whose largest error, "
        f"by {summary.solver} on {summary.rung}, is above a multiple of the roundoff floor; both axes are "
        f"logarithmic, a body fails above {summary.bound}, and the largest error is drawn at half a row. "
        f"The largest: {largest}.",
        partial(_figure, summary, drawn),
    )


def _points(spread: Spread) -> Points:
    """Return the points of a line; the largest error lies at half a row."""
    least = 0.5 / spread.judged if spread.judged else 1.0
    return [(size, max(share, least)) for size, share in spread.above]


def _figure(summary: SweepSummary, drawn: list[Spread]) -> Figure:
    figure, (axes,) = sheet(1, [], height=_HEIGHT)
    lines = [_points(each) for each in drawn]
    sizes = [size for points in lines for size, _ in points]
    shares = [share for points in lines for _, share in points]
    axes.set(xscale="log", yscale="log")
    axes.set(xlabel="error over the roundoff floor", ylabel="share of judged rows above it")
    axes.set(xlim=widened([*sizes, summary.factor], 0.03, 0.12))
    axes.set(ylim=widened([*shares, 1.0], 0.06, 0.06))
    number_axes(axes)
    axes.set_title(
        f"{summary.name}: {summary.total} bodies, {summary.solver} on {summary.rung}", pad=6
    )
    if summary.tolerance is None:
        _draw_gate(axes, summary.factor)
    for i, (each, points) in enumerate(zip(drawn, lines, strict=True)):
        axes.plot(
            *zip(*points, strict=True),
            color=look_of_line(i).colour,
            linewidth=1.2,
            gid=each.quantity,
            label=each.quantity,
            zorder=3,
        )
    name_lines(axes)
    return figure


def _draw_gate(axes: Axes, factor: int) -> None:
    """Draw the bound of a gate, which a tolerance replaces by one of another size on each body."""
    axes.axvline(factor, color=QUIET, linewidth=0.9, linestyle=(0, (1, 2)), gid="gate")
    axes.annotate(
        "gate ",
        (factor, 1.0),
        xycoords=("data", "axes fraction"),
        xytext=(-2, -9),
        textcoords="offset points",
        color=INK,
        ha="right",
        size="small",
    )
