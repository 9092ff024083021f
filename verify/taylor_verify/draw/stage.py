"""A stage: axes without lines that show a body, and curves on it or in space, from one side.

Lines and marks that face the reader are drawn in full, the rest faintly. A scale of colours runs from light
to dark.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import hypot
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from taylor_verify.draw.caption import NotDrawn
from taylor_verify.draw.view import Ellipsoid, Numbers, View, pieces
from taylor_verify.plotting.sheet import Entry, Frame, add_axes, blank, draw_legend
from taylor_verify.plotting.style import INK, PAGE_WIDTH, PAPER, QUIET, SMALL

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.colors import Colormap
    from matplotlib.figure import Figure

Look = dict[str, Any]

_SURFACE: Final = "#F3F5F7"
_WIRE: Final = "#BFC6CC"
# The opacity of lines and of marks on the far side.
_FAINT: Final = 0.28
_FAINT_MARK: Final = 0.4

# Room for a name beside the outermost spots, and above and below them, in inches.
_ASIDE: Final = 0.62
_ABOVE: Final = 0.12
# The ends of an axis and of its name beyond the surface, in parts of the semi-axis.
_STUB: Final = 0.24
_NAME: Final = 0.36

# Light to dark: distinct in grey and to any colour vision. The lightest part is left out: paper is white.
_SCALE: Final = "cividis_r"
_FROM: Final = 0.06
# The number of pieces of a course, each of one colour.
_STRETCHES: Final = 40

_EDGE: Final[Look] = {"linestyle": "none", "markeredgecolor": INK, "markeredgewidth": 0.9}
START: Final[Look] = {**_EDGE, "marker": "o", "markersize": 5, "markerfacecolor": PAPER}
END: Final[Look] = {**_EDGE, "marker": "s", "markersize": 5, "markerfacecolor": INK}
CROSS: Final[Look] = {
    **_EDGE,
    "marker": "x",
    "markersize": 6,
    "markeredgecolor": "#A83C00",
    "markeredgewidth": 1.6,
}


@dataclass(frozen=True)
class Stage:
    """Axes on the left ``width`` inches of a figure; on the right there is room for the legend.

    ``surface`` hides what is behind it. Without one, nothing is hidden.
    """

    figure: Figure
    axes: Axes
    view: View
    width: float
    surface: Ellipsoid | None = None

    @classmethod
    def around(
        cls, surface: Ellipsoid, view: View, width: float, height: float, also: Numbers
    ) -> Stage:
        """Return a stage of this size in inches, at one scale, with a surface.

        Of the surface it shows the filled rim, and the three sections across its axes. The points of
        ``also`` are within the stage, even if they lie beyond the surface.
        """
        figure = blank(height)
        axes = add_axes(figure, Frame(0.0, 0.0, width, height))
        axes.axis("off")
        rim = view.project(surface.outline(view))
        names = view.project(np.diag(surface.semi_axes) * (1 + _NAME))
        spots = np.concatenate([rim, names, view.project(also)])
        low, high = spots.min(axis=0), spots.max(axis=0)
        if not np.isfinite([low, high]).all():
            raise NotDrawn("expected a motion whose numbers doubles hold, got one beyond them")
        room = np.array([width - 2 * _ASIDE, height - 2 * _ABOVE])
        unit = float(((high - low) / room).max())
        half = unit * np.array([width, height]) / 2
        middle = (low + high) / 2
        axes.set_xlim(middle[0] - half[0], middle[0] + half[0])
        axes.set_ylim(middle[1] - half[1], middle[1] + half[1])
        axes.fill(*rim.T, facecolor=_SURFACE, edgecolor=QUIET, linewidth=0.7, zorder=0)
        stage = cls(figure, axes, view, width, surface)
        for pole in np.eye(3):
            stage.line(surface.circle(pole), 1, {"color": _WIRE, "linewidth": 0.5})
        return stage

    def faces(self, points: Numbers) -> Any:
        """Return True for each point that no surface hides."""
        if self.surface is None:
            return np.ones(len(np.atleast_2d(points)), dtype=bool)
        return self.surface.faces(points, self.view)

    def line(self, points: Numbers, zorder: float, look: Look) -> None:
        """Draw a line, on the surface where there is one."""
        for is_seen, piece in pieces(self.view.project(points), self.faces(points)):
            # Round ends of faint lines would overlap and show as dots.
            side: Look = {"solid_capstyle": "round", "zorder": zorder}
            if not is_seen:
                side = {"solid_capstyle": "butt", "zorder": 0.5, "alpha": _FAINT}
            self.axes.plot(*piece.T, **look, **side)

    def course(self, points: Numbers, width: float, zorder: float) -> None:
        """Draw a line that darkens as time goes on."""
        for k, (colour, piece) in enumerate(stretches(points)):
            look = {"color": colour, "linewidth": width, "gid": "path"}
            self.line(piece, zorder + k / _STRETCHES, look)

    def mark(self, point: Numbers, look: Look) -> None:
        """Draw a mark above all lines."""
        alpha = 1.0 if self.faces(point)[0] else _FAINT_MARK
        self.axes.plot(*self.view.project(point).T, alpha=alpha, zorder=6, **look)

    def name_axes(self, semi_axes: Sequence[float], names: Sequence[str]) -> None:
        """Draw the axes where they leave the surface, each with its name."""
        for direction, name in zip(np.diag(semi_axes), names, strict=True):
            tail, head = self.view.project(np.array([direction, direction * (1 + _STUB)]))
            arrow = {"arrowstyle": "-|>", "color": QUIET, "linewidth": 0.8, "mutation_scale": 6}
            self.axes.annotate(
                "",
                head,
                tail,
                arrowprops={**arrow, "shrinkA": 0, "shrinkB": 0},
                zorder=3 if self.faces(direction)[0] else 0.2,
            )
            right, up = head - tail
            x, y = map(float, self.view.project(direction * (1 + _NAME))[0])
            side = "left" if right > 0 else "right"
            self.axes.text(
                x,
                y,
                name,
                size=SMALL,
                color=INK,
                ha="center" if abs(right) < 0.4 * hypot(right, up) else side,
                va="center_baseline" if abs(up) < abs(right) else "center",
                zorder=6,
                gid="name",
                bbox={"facecolor": PAPER, "alpha": 0.7, "linewidth": 0, "pad": 0.3},
            )

    def legend(self, entries: Sequence[Entry], note: str, top: float, indent: float = 0.0) -> None:
        """Write the legend beside the stage; its top is this many inches above the foot."""
        left = self.width - indent
        draw_legend(self.figure, entries, note, Frame(left, 0.0, PAGE_WIDTH - left, top))

    def time_bar(self, times: Numbers, low: float) -> None:
        """Draw the colours of a course from start to end, unless these are the same double.

        ``low`` is the distance of the bar from the foot, in inches.
        """
        from matplotlib.cm import ScalarMappable
        from matplotlib.colors import Normalize
        from matplotlib.ticker import MaxNLocator

        if times[0] == times[-1]:
            return
        axes = add_axes(self.figure, Frame(self.width, low, PAGE_WIDTH - self.width - 0.2, 0.12))
        # The end is dark, also where time runs backward.
        colours = scale() if times[-1] > times[0] else scale().reversed()
        mapped = ScalarMappable(Normalize(float(times.min()), float(times.max())), colours)
        bar = self.figure.colorbar(mapped, cax=axes, orientation="horizontal")
        bar.outline.set_linewidth(0.5)
        bar.outline.set_edgecolor(QUIET)
        axes.xaxis.set_major_locator(MaxNLocator(4, steps=[1, 2, 5, 10]))
        axes.set_xlabel("time t", size=SMALL)
        axes.tick_params(labelsize=SMALL)


def stretches(points: Numbers) -> Iterator[tuple[Any, Numbers]]:
    """Yield the pieces of a course, each with the colour of its time."""
    bounds = np.linspace(0, len(points) - 1, _STRETCHES + 1).round().astype(int)
    for k, (first, last) in enumerate(pairwise(bounds)):
        yield scale()((k + 0.5) / _STRETCHES), points[first : last + 1]


def scale() -> Colormap:
    """Return the colours of time, from the start (light) to the end (dark)."""
    import matplotlib
    from matplotlib.colors import ListedColormap

    return ListedColormap(matplotlib.colormaps[_SCALE](np.linspace(_FROM, 1.0, 256)))
