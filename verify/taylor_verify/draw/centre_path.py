"""The path of the body's origin through the fluid, with its projections and the body on the way.

One scale for all three directions. The walls behind carry the path's projections on them. The body is drawn
at equal intervals of time: an ellipsoid in its own size, and the frame of a body that has no shape.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from taylor_verify.draw.caption import NotDrawn, captioned
from taylor_verify.draw.solid import AXES, by_depth, draw_ellipsoid, draw_frame, reach
from taylor_verify.draw.stage import END, START, Look, Stage, scale
from taylor_verify.draw.view import Numbers, View
from taylor_verify.plotting.palette import FAINT, INK, QUIET
from taylor_verify.plotting.picture import Picture
from taylor_verify.plotting.sheet import Entry
from taylor_verify.plotting.style import SMALL

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Document = Mapping[str, Any]

# In inches.
_HEIGHT: Final = 4.3
_STAGE: Final = 4.6
# The length of the axes of a frame, and the room beside the path, in parts of the longest side of the box.
_AXIS: Final = 0.077
_MARGIN: Final = 0.08
# No side of the box is shorter than this part of the longest one.
_LEAST_SIDE: Final = 0.35
# The greatest number of solids on a path, and their distance from each other in parts of their size.
_FRAMES: Final = 10
_APART: Final = 1.25
_WIDTH: Final = 1.8
_SHADOW: Final[Look] = {"color": "#A9B2BA", "linewidth": 0.8, "gid": "projection"}
_SIDES: Final = ("x", "y", "z")
# The sides from which a path may be seen, in degrees.
_AZIMUTHS: Final = (-62, -50, -40, -28, 28, 40, 50, 62)
_ELEVATION: Final = 22.0
# The distance from an edge to the middle of a number, and of the side's letter, in points.
_NUMBER: Final = 11.0
_LETTER: Final = 27.0
# The room above and below the box, in inches.
_BELOW: Final = 0.42


@dataclass(frozen=True)
class Series:
    """The path of the origin (n, 3) and the attitudes (n, 3, 3) in space, at the times (n,).

    ``semi_axes`` are those of an ellipsoid, else None.
    """

    times: Numbers
    path: Numbers
    attitudes: Numbers
    semi_axes: tuple[float, float, float] | None

    @property
    def instants(self) -> list[int]:
        """The rows at which the body is drawn: as many as fit beside each other."""
        arc = float(np.linalg.norm(np.diff(self.path, axis=0), axis=1).sum())
        size = 2 * max(self.semi_axes) if self.semi_axes else arc / _FRAMES
        count = int(min(max(arc / (_APART * size or 1.0), 1), _FRAMES))
        return [int(k) for k in np.linspace(0, len(self.path) - 1, count + 1).round()]

    @property
    def extent(self) -> Numbers:
        """Points that the box has to contain: the path, and the solids on it."""
        if self.semi_axes is None:
            return self.path
        places = self.instants
        half = reach(np.array(self.semi_axes), self.attitudes[places])
        return np.concatenate([self.path, self.path[places] + half, self.path[places] - half])


@dataclass(frozen=True)
class _Box:
    """Box by two opposite corners, and for each side the wall that is behind."""

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
    def longest(self) -> float:
        """The length of the longest side."""
        return float((self.high - self.low).max())

    @property
    def corners(self) -> Numbers:
        pairs = np.stack([self.low, self.high])
        return np.array(
            [[pairs[i, 0], pairs[j, 1], pairs[k, 2]] for i, j, k in np.ndindex(2, 2, 2)]
        )


def series(portrait: Document) -> Series:
    """Return the path and the body on it. Raises NotDrawn for a scene that tracks no centre."""
    course = portrait["course"]
    if "centre" not in course:
        raise NotDrawn(f"expected a scene with its centre, got none @ {portrait['scene']}")
    attitudes = np.array(course["attitude"]).reshape(-1, 3, 3)
    shape = portrait["semi_axes"]
    return Series(
        np.array(course["t"]),
        np.array(course["centre"]),
        attitudes,
        None if shape is None else (shape[0], shape[1], shape[2]),
    )


def picture(portrait: Document) -> Picture:
    """Return the path of one scene. Raises NotDrawn as `series` does."""
    track = series(portrait)
    first, last = (f"({', '.join(f'{v:.3g}' for v in track.path[k])})" for k in (0, -1))
    alt = (
        f"The origin of the body of {portrait['scene']} in space, from {first} at t = "
        f"{track.times[0]:g} to {last} at t = {track.times[-1]:g}, with its projections on three walls "
        f"and {'the ellipsoid itself' if track.semi_axes else 'the axes of the body'} along the way."
    )
    return captioned(portrait, "centre", "Path through the fluid", alt, partial(_figure, track))


def _figure(track: Series, words: str) -> Figure:
    view = _view(track.extent)
    box = _Box.of(track.extent, view)
    stage = Stage.showing(view.project(box.corners), view, _STAGE, _HEIGHT, _BELOW)
    _draw_walls(stage, box)
    for i in range(3):
        shadow = track.path.copy()
        shadow[:, i] = box.walls[i]
        stage.axes.plot(*view.project(shadow).T, zorder=1, **_SHADOW)
    stage.course(track.path, _WIDTH, 4)
    _draw_solids(stage, track, _AXIS * box.longest)
    stage.mark(track.path[0], START, gid="start")
    stage.mark(track.path[-1], END, gid="end")
    entries: list[Entry] = [
        ({"color": scale()(0.6), "linewidth": _WIDTH}, "origin of the body"),
        *_body_entries(track),
        (_SHADOW, "projections"),
        (START, "start"),
        ({**END, "markerfacecolor": QUIET}, "end"),
    ]
    note = f"One scale in all directions, the scene's own unit of length. {words}".rstrip()
    stage.legend(entries, note, 4.1, indent=0.05)
    stage.time_bar(track.times, 0.5)
    return stage.figure


def _body_entries(track: Series) -> list[Entry]:
    if track.semi_axes:
        look = {"marker": "o", "markersize": 8, "markerfacecolor": "#E8EEF2", "linestyle": "none"}
        return [({**look, "markeredgecolor": "#43525C"}, "the solid, in its own size")]
    return [({"color": colour}, f"body axis {k}") for k, colour in enumerate(AXES, start=1)]


def _view(path: Numbers) -> View:
    """Return the view in which the path is widest, among views that show every wall."""
    views = [View(float(azimuth), _ELEVATION) for azimuth in _AZIMUTHS]
    return max(views, key=lambda view: round(float(np.ptp(view.project(path)[:, 0])), 6))


def _draw_walls(stage: Stage, box: _Box) -> None:
    """Draw three walls with a grid, and numbers along the edges where two of them end."""
    from matplotlib.ticker import MaxNLocator

    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        wall = np.array([box.walls] * 5)
        wall[:, j] = np.array([box.low[j], box.high[j], box.high[j], box.low[j], box.low[j]])
        wall[:, k] = np.array([box.low[k], box.low[k], box.high[k], box.high[k], box.low[k]])
        look: Look = {"facecolor": "#FAFAFA", "edgecolor": FAINT, "linewidth": 0.6}
        stage.axes.fill(*stage.view.project(wall).T, **look, zorder=0)
    for i in range(3):
        low, high = float(box.low[i]), float(box.high[i])
        count = max(2, round(5 * (high - low) / box.longest))
        values = MaxNLocator(count, steps=[1, 2, 2.5, 5, 10]).tick_values(low, high)
        _draw_ticks(stage, box, i, [float(v) for v in values if low <= v <= high])


def _draw_ticks(stage: Stage, box: _Box, i: int, ticks: list[float]) -> None:
    """Draw the grid across both walls that the side belongs to, and numbers at its front edge."""
    others = [n for n in range(3) if n != i]
    for value in ticks:
        for n, m in (others, others[::-1]):
            line = np.array([box.walls, box.walls])
            line[:, i] = value
            line[:, n] = (box.low[n], box.high[n])
            line[:, m] = box.walls[m]
            stage.axes.plot(*stage.view.project(line).T, color=FAINT, linewidth=0.5, zorder=0.1)
    edge, outward = _edge(stage.view, box, i)
    middle = (box.low[i] + box.high[i]) / 2
    texts = [(v, _NUMBER, f"{v:g}".replace("-", "\N{MINUS SIGN}")) for v in ticks]
    for value, away, words in [*texts, (middle, _LETTER, _SIDES[i])]:
        edge[i] = value
        stage.axes.annotate(
            words,
            stage.view.project(edge)[0],
            (float(outward[0]) * away, float(outward[1]) * away),
            textcoords="offset points",
            size=SMALL,
            color=INK,
            ha="center",
            va="center",
            zorder=6,
            gid="tick",
        )


def _edge(view: View, box: _Box, i: int) -> tuple[Numbers, Numbers]:
    """Return a point of the edge where the numbers of side i stand, and the way outwards on the paper.

    On the ground it is the edge opposite the wall, for the upright side the leftmost edge.
    """
    ground = (0, 1) if i == 2 else (1 - i,)
    edges = []
    for n in ground:
        point = box.walls.copy()
        point[n] = box.high[n] if box.walls[n] == box.low[n] else box.low[n]
        edges.append((point, view.project(np.sign(point - box.walls))[0]))
    point, way = min(edges, key=lambda edge: float(view.project(edge[0])[0, 0]))
    outward = np.array([-1.0, 0.0]) if i == 2 else way / np.linalg.norm(way)
    return point, outward


def _draw_solids(stage: Stage, track: Series, length: float) -> None:
    """Draw the body at a few instants, the nearest last."""
    rows = track.instants
    for layer, k in enumerate(by_depth(track.path[rows], stage.view)):
        row, at = rows[k], 4.5 + layer / 10
        if track.semi_axes:
            draw_ellipsoid(stage, track.semi_axes, track.attitudes[row], track.path[row], at)
        else:
            draw_frame(stage, length, track.attitudes[row], track.path[row], at)
