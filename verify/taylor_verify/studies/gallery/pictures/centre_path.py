"""The path of the body's origin through the fluid, with its projections and the body's axis on the way.

One scale for all three directions. The walls behind carry the path's projections on them; short lines are
the body's axis at equal intervals of time, from the origin of the body forward.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from taylor_verify.publish.pictures.palette import FAINT, INK, PAPER, QUIET
from taylor_verify.publish.pictures.picture import Picture
from taylor_verify.publish.pictures.sheet import Entry, Frame, blank, draw_legend
from taylor_verify.publish.pictures.style import PAGE_WIDTH, SMALL
from taylor_verify.publish.pictures.wording import stem_of
from taylor_verify.studies.gallery.pictures.axis_path import axis_of
from taylor_verify.studies.gallery.pictures.solids import draw_bar, scale, stage
from taylor_verify.studies.gallery.pictures.view import Numbers, View

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Document = Mapping[str, Any]

# In inches.
_HEIGHT: Final = 4.3
_STAGE: Final = 4.6
_STRETCHES: Final = 40
_GLYPHS: Final = 24
# A glyph is so long, and the box so much wider than the path, in parts of the longest side.
_GLYPH: Final = 0.07
_MARGIN: Final = 0.08
# No side of the box is shorter than this part of the longest one.
_LEAST_SIDE: Final = 0.35
_GLYPH_COLOUR: Final = "#A83C00"
_SHADOW: Final[Mapping[str, Any]] = {"color": "#A9B2BA", "linewidth": 0.8, "gid": "projection"}
_SIDES: Final = ("x", "y", "z")
# Degrees; and from an edge to the middle of a number and of the side's letter, in points.
_AZIMUTHS: Final = (-62, -50, -40, -28, 28, 40, 50, 62)
_ELEVATION: Final = 22.0
_NUMBER: Final = 11.0
_LETTER: Final = 27.0
_BELOW: Final = 0.42


@dataclass(frozen=True)
class Series:
    """The origin of the body and its axis in space, one row a time; ``axis`` is its number."""

    times: Numbers
    path: Numbers
    directions: Numbers
    axis: int


@dataclass(frozen=True)
class _Box:
    """Two opposite corners, and for each side the wall that is behind."""

    low: Numbers
    high: Numbers
    walls: Numbers

    @classmethod
    def of(cls, points: Numbers, view: View) -> _Box:
        low, high = points.min(axis=0), points.max(axis=0)
        longest = float((high - low).max()) or 1.0
        half = np.maximum((high - low) / 2 + _MARGIN * longest, _LEAST_SIDE * longest / 2)
        middle = (low + high) / 2
        low, high = middle - half, middle + half
        return cls(low, high, np.where(view.towards > 0, low, high))

    @property
    def corners(self) -> Numbers:
        pairs = np.stack([self.low, self.high])
        return np.array(
            [[pairs[i, 0], pairs[j, 1], pairs[k, 2]] for i, j, k in np.ndindex(2, 2, 2)]
        )


def series(portrait: Document) -> Series:
    """Raises ValueError for a scene that tracks no centre."""
    course = portrait["course"]
    if "centre" not in course:
        raise ValueError(f"expected a scene with its centre, got none @ {portrait['scene']}")
    axis = axis_of(portrait)
    attitudes = np.array(course["attitude"]).reshape(-1, 3, 3)
    return Series(
        np.array(course["t"]), np.array(course["centre"]), attitudes[:, :, axis - 1], axis
    )


def picture(portrait: Document) -> Picture:
    """The path of one scene. Raises ValueError as `series` does."""
    found = series(portrait)
    first, last = (_told(found.path[k]) for k in (0, -1))
    alt = (
        f"The origin of the body of {portrait['scene']} in space, from {first} at t = "
        f"{found.times[0]:g} to {last} at t = {found.times[-1]:g}, with its projections on three walls "
        f"and the direction of body axis {found.axis} along the way."
    )
    title = f"Path through the fluid: {portrait['scene']}"
    return Picture(stem_of(portrait, "centre"), title, alt, partial(_figure, found))


def _told(point: Numbers) -> str:
    return f"({', '.join(f'{v:.3g}' for v in point)})"


def _figure(found: Series) -> Figure:
    from matplotlib.colors import Normalize

    figure = blank(_HEIGHT)
    view = _view(found.path)
    box = _Box.of(found.path, view)
    axes = stage(figure, Frame(0.0, 0.0, _STAGE, _HEIGHT), view.seen(box.corners), _BELOW)
    _draw_walls(axes, view, box)
    for i in range(3):
        shadow = found.path.copy()
        shadow[:, i] = box.walls[i]
        axes.plot(*view.seen(shadow).T, zorder=1, **_SHADOW)
    _draw_path(axes, view, found)
    _draw_glyphs(axes, view, found, _GLYPH * float((box.high - box.low).max()))
    right = PAGE_WIDTH - _STAGE
    legend = Frame(_STAGE - 0.05, 2.2, right, 1.2)
    draw_legend(
        figure,
        _entries(found),
        "One scale in all directions, the scene's own unit of length.",
        legend,
    )
    norm = Normalize(float(found.times.min()), float(found.times.max()))
    is_backward = bool(found.times[-1] < found.times[0])
    draw_bar(figure, Frame(_STAGE, 1.3, right - 0.15, 0.12), norm, "time t", is_backward)
    return figure


def _view(path: Numbers) -> View:
    """Of some sides from which no wall is seen edge on, the one that shows most of the path's way."""
    views = [View(float(azimuth), _ELEVATION) for azimuth in _AZIMUTHS]
    return max(views, key=lambda view: round(float(np.ptp(view.seen(path)[:, 0])), 6))


def _draw_walls(axes: Axes, view: View, box: _Box) -> None:
    """Three walls with a grid, and numbers along the edges where two of them end."""
    from matplotlib.ticker import MaxNLocator

    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        wall = np.array([box.walls] * 5)
        wall[:, j] = np.array([box.low[j], box.high[j], box.high[j], box.low[j], box.low[j]])
        wall[:, k] = np.array([box.low[k], box.low[k], box.high[k], box.high[k], box.low[k]])
        axes.fill(*view.seen(wall).T, facecolor="#FAFAFA", edgecolor=FAINT, linewidth=0.6, zorder=0)
    span = float((box.high - box.low).max())
    for i in range(3):
        count = max(2, round(5 * float(box.high[i] - box.low[i]) / span))
        values = MaxNLocator(count, steps=[1, 2, 2.5, 5, 10]).tick_values(box.low[i], box.high[i])
        ticks = [float(v) for v in values if box.low[i] <= v <= box.high[i]]
        _draw_ticks(axes, view, box, i, ticks)


def _draw_ticks(axes: Axes, view: View, box: _Box, i: int, ticks: list[float]) -> None:
    """Lines of the grid across both walls that the side belongs to, and numbers at its front edge."""
    others = [n for n in range(3) if n != i]
    for value in ticks:
        for n, m in (others, others[::-1]):
            line = np.array([box.walls, box.walls])
            line[:, i] = value
            line[:, n] = (box.low[n], box.high[n])
            line[:, m] = box.walls[m]
            axes.plot(*view.seen(line).T, color=FAINT, linewidth=0.5, zorder=0.1)
    edge, outward = _edge(view, box, i)
    for value in ticks:
        edge[i] = value
        _write(axes, view, edge, outward * _NUMBER, f"{value:g}".replace("-", "\N{MINUS SIGN}"))
    edge[i] = (box.low[i] + box.high[i]) / 2
    _write(axes, view, edge, outward * _LETTER, _SIDES[i])


def _edge(view: View, box: _Box, i: int) -> tuple[Numbers, Numbers]:
    """A point of the edge along side i where its numbers stand, and the way outwards on the paper.

    On the ground that is the edge before the wall; of the upright ones the leftmost.
    """
    ground = (0, 1) if i == 2 else (1 - i,)
    edges = []
    for n in ground:
        point = box.walls.copy()
        point[n] = box.high[n] if box.walls[n] == box.low[n] else box.low[n]
        edges.append((point, view.seen(np.sign(point - box.walls))[0]))
    point, way = min(edges, key=lambda edge: float(view.seen(edge[0])[0, 0]))
    outward = np.array([-1.0, 0.0]) if i == 2 else way / np.linalg.norm(way)
    return point, outward


def _write(axes: Axes, view: View, point: Numbers, offset: Numbers, words: str) -> None:
    axes.annotate(
        words,
        view.seen(point)[0],
        (float(offset[0]), float(offset[1])),
        textcoords="offset points",
        size=SMALL,
        color=INK,
        ha="center",
        va="center",
        zorder=6,
        gid="tick",
    )


def _draw_path(axes: Axes, view: View, found: Series) -> None:
    colours, spots = scale(), view.seen(found.path)
    bounds = np.linspace(0, len(spots) - 1, _STRETCHES + 1).round().astype(int)
    for k in range(_STRETCHES):
        piece = spots[bounds[k] : bounds[k + 1] + 1]
        axes.plot(
            *piece.T,
            color=colours((k + 0.5) / _STRETCHES),
            linewidth=1.8,
            solid_capstyle="round",
            zorder=4,
            gid="path",
        )


def _draw_glyphs(axes: Axes, view: View, found: Series, length: float) -> None:
    rows = np.linspace(0, len(found.path) - 1, _GLYPHS).round().astype(int)
    for row in rows:
        ends = view.seen(
            np.array([found.path[row], found.path[row] + length * found.directions[row]])
        )
        axes.plot(*ends.T, color=_GLYPH_COLOUR, linewidth=0.9, zorder=3.5, gid="axis")
        axes.plot(*ends[:1].T, marker="o", markersize=1.8, color=_GLYPH_COLOUR, zorder=5)
    start, end = view.seen(found.path[[0, -1]])
    edge: dict[str, Any] = {"linestyle": "none", "markeredgecolor": INK, "markeredgewidth": 0.9}
    edge |= {"zorder": 6, "markersize": 5}
    axes.plot(*start[:, None], marker="o", markerfacecolor=PAPER, gid="start", **edge)
    axes.plot(*end[:, None], marker="s", markerfacecolor=INK, gid="end", **edge)


def _entries(found: Series) -> list[Entry]:
    mark = {"linestyle": "none", "markersize": 5, "markeredgecolor": INK, "markeredgewidth": 0.9}
    return [
        ({"color": scale()(0.6), "linewidth": 1.8}, "origin of the body"),
        ({"color": _GLYPH_COLOUR, "linewidth": 0.9}, f"body axis {found.axis}"),
        ({"color": _SHADOW["color"], "linewidth": 0.8}, "projections"),
        ({**mark, "marker": "o", "markerfacecolor": PAPER}, "start"),
        ({**mark, "marker": "s", "markerfacecolor": QUIET}, "end"),
    ]
