"""Picture of the time on each rung, relative to f64: a line for each scene or solver.

Ratios with the same label make one line.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial
from typing import TYPE_CHECKING, Final

from taylor_verify.plotting.log_axes import widened
from taylor_verify.plotting.named import Named
from taylor_verify.plotting.palette import QUIET
from taylor_verify.plotting.picture import Picture
from taylor_verify.plotting.sheet import Frame, add_axes, blank, draw_legend
from taylor_verify.plotting.style import PAGE_WIDTH, look_of_line
from taylor_verify.plotting.wording import stem_of, times
from taylor_verify.records.precisions import bits_of, place_of_rung
from taylor_verify_reports.pictures.ratio import Ratio, check

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

# In inches.
_FRAME: Final = Frame(left=0.66, low=0.74, width=PAGE_WIDTH - 0.74, height=2.6)
_HEIGHT: Final = 3.5
# The least distance of two names of rungs below the axis, as part of the axis.
_NEAR: Final = 0.045


def picture(scene: str, ratios: Sequence[Ratio]) -> Picture:
    """Return the picture of ratios to the time on f64; ``scene`` is the common part of their names.

    The ends of a ratio are those of the interval for its median, at 95 %.

    Raises ValueError for invalid ratios, and for a rung without a number of bits.
    """
    check(ratios)
    for i, point in enumerate(ratios):
        if not bits_of(point.rung) > 0:
            raise ValueError(
                f"expected a rung, such as f64 or mp237, got {point.rung!r} @ ratios[{i}]"
            )
    lines: dict[str, list[Ratio]] = {point.label: [] for point in ratios}
    for point in sorted(ratios, key=lambda point: (bits_of(point.rung), place_of_rung(point.rung))):
        lines[point.label].append(point)
    words = "; ".join(
        f"{label}: {', '.join(f'{point.rung} {times(point.ratio)}' for point in line)}"
        for label, line in lines.items()
    )
    alt = (
        f"Time of a solve against the bits of the rung on {scene}, both logarithmic, as "
        f"a multiple of the time on f64. {words}."
    )
    title = f"Time by rung: {scene}"
    return Picture(stem_of({"scene": scene}, "rungs"), title, alt, partial(_figure, lines))


def _figure(lines: Mapping[str, Sequence[Ratio]]) -> Figure:
    from taylor_verify.plotting.labels import write_names

    figure = blank(_HEIGHT)
    axes = add_axes(figure, _FRAME)
    every = [point for line in lines.values() for point in line]
    ends = [end for point in every for end in (point.least, point.greatest)]
    axes.set(xscale="log", yscale="log", ylim=widened([*ends, 1.0], 0.08, 0.12))
    axes.set(xlim=widened([float(bits_of(point.rung)) for point in every], 0.05, 0.2))
    axes.set(xlabel="rung, by the bits of its significand", ylabel="time over that on f64")
    axes.yaxis.set_major_formatter("{x:g}")
    _name_rungs(axes, sorted({point.rung for point in every}, key=bits_of))
    axes.grid(visible=True)
    axes.axhline(1, color=QUIET, linewidth=0.8, zorder=1)
    named = []
    for i, (label, line) in enumerate(lines.items()):
        look = look_of_line(i)
        bits, ratios = [bits_of(point.rung) for point in line], [point.ratio for point in line]
        for x, point in zip(bits, line, strict=True):
            spread = [[point.ratio - point.least], [point.greatest - point.ratio]]
            axes.errorbar(
                [x],
                [point.ratio],
                spread,
                fmt="none",
                ecolor=look.colour,
                elinewidth=0.8,
                capsize=2,
            )
        axes.plot(bits, ratios, gid=label, zorder=3, **look.line)
        named.append(Named(label, look.colour, [[*zip(bits, ratios, strict=True)]]))
    write_names(axes, named)
    if any(point.least < point.greatest for point in every):
        bar = {"color": QUIET, "linewidth": 0.6, "marker": "|", "markersize": 6}
        draw_legend(figure, [(bar, "interval of the median, 95 %")])
    return figure


def _name_rungs(axes: Axes, rungs: Sequence[str]) -> None:
    """Set a tick for every rung; of two names that are too near, the second is written lower."""
    from matplotlib.ticker import NullLocator

    bits = [bits_of(rung) for rung in rungs]
    places = axes.transAxes.inverted().transform(axes.transData.transform([(b, 1) for b in bits]))
    names: list[str] = []
    for i, rung in enumerate(rungs):
        is_near = i > 0 and places[i][0] - places[i - 1][0] < _NEAR
        lower = is_near and not names[-1].startswith("\n")
        names.append(f"\n{rung}" if lower else rung)
    axes.set_xticks(bits, names)
    axes.xaxis.set_minor_locator(NullLocator())
