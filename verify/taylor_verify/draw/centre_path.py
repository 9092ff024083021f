"""The path of the body's origin through the fluid, with its projections and the body on the way.

One scale for all three directions. The walls behind carry the path's projections on them. The body is drawn
at equal intervals of time: an ellipsoid by its sections, and the frame of a body that has no shape.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from taylor_verify.draw.caption import Document, NotDrawn, captioned
from taylor_verify.draw.stage import END, START, Look, Stage, scale, stretches
from taylor_verify.draw.view import Ellipsoid, Numbers, View
from taylor_verify.plotting.picture import Picture
from taylor_verify.plotting.sheet import Entry, blank
from taylor_verify.plotting.style import PAGE_WIDTH, QUIET

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


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
_SEAM: Final[Look] = {"color": "#43525C", "linewidth": 0.6}
_COLOURS: Final = ("#A83C00", "#1C8578", "#0B5FA5")
# The sides from which a path may be seen, in degrees.
_AZIMUTHS: Final = (-62, -50, -40, -28, 28, 40, 50, 62)
_ELEVATION: Final = 22.0


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
        half = np.sqrt(np.square(self.attitudes[places] * self.semi_axes).sum(axis=2))
        return np.concatenate([self.path, self.path[places] + half, self.path[places] - half])


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
    stage, low, high = _stage(track.extent)
    walls = np.where(stage.view.towards > 0, low, high)
    for i in range(3):
        shadow = track.path.copy()
        shadow[:, i] = walls[i]
        stage.axes.plot(*shadow.T, zorder=1, **_SHADOW)
    for colour, piece in stretches(track.path):
        stage.axes.plot(*piece.T, color=colour, linewidth=_WIDTH, zorder=4, gid="path")
    _draw_solids(stage.axes, track, _AXIS * float((high - low).max()))
    for row, look, name in ((0, START, "start"), (-1, END, "end")):
        stage.axes.plot(*track.path[row][:, None], zorder=6, gid=name, **look)
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
        return [(_SEAM, "the solid, in its own size")]
    return [({"color": colour}, f"body axis {k}") for k, colour in enumerate(_COLOURS, start=1)]


def _stage(extent: Numbers) -> tuple[Stage, Numbers, Numbers]:
    """Return a box in space that has the extent in it, at one scale, with two of its corners."""
    from matplotlib.ticker import MaxNLocator

    low, high = _box(extent)
    view, figure = _view(extent), blank(_HEIGHT)
    axes: Any = figure.add_axes(
        (0.02, 0.04, _STAGE / PAGE_WIDTH - 0.02, 0.96),
        projection="3d",
        proj_type="ortho",
        azim=view.azimuth,
        elev=view.elevation,
        computed_zorder=False,
    )
    axes.set_box_aspect(high - low, zoom=0.88)
    for side, first, last in zip("xyz", low, high, strict=True):
        axes.set(**{f"{side}lim": (first, last), f"{side}label": side})
        axis = getattr(axes, f"{side}axis")
        axis.set_major_locator(MaxNLocator(4, steps=[1, 2, 2.5, 5, 10]))
        axis.set_pane_color("#FAFAFA")
        axis.labelpad = -1.0 if side == "z" else 4.0
    axes.tick_params(pad=0)
    return Stage(figure, axes, view, _STAGE), low, high


def _box(points: Numbers) -> tuple[Numbers, Numbers]:
    """Return two opposite corners of a box with room about the points."""
    low, high = points.min(axis=0), points.max(axis=0)
    longest = float((high - low).max()) or 1.0
    half = np.maximum((high - low) / 2 + _MARGIN * longest, _LEAST_SIDE * longest / 2)
    middle = (low + high) / 2
    return middle - half, middle + half


def _view(path: Numbers) -> View:
    """Return the view in which the path is widest, among views that show every wall."""
    views = [View(float(azimuth), _ELEVATION) for azimuth in _AZIMUTHS]
    return max(views, key=lambda view: round(float(np.ptp(view.project(path)[:, 0])), 6))


def _draw_solids(axes: Axes, track: Series, length: float) -> None:
    """Draw the body at a few instants: the sections of an ellipsoid across its axes, or a frame."""
    for row in track.instants:
        attitude, centre = track.attitudes[row], track.path[row]
        if track.semi_axes:
            for pole in np.eye(3):
                section = Ellipsoid(track.semi_axes).circle(pole) @ attitude.T + centre
                axes.plot(*section.T, zorder=5, gid="solid", **_SEAM)
        else:
            for axis, colour in zip(attitude.T, _COLOURS, strict=True):
                ends = np.array([centre, centre + length * axis])
                axes.plot(*ends.T, color=colour, linewidth=1.3, zorder=5, gid="solid")
