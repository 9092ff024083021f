"""A film of a motion, GIF or MP4: the body in space, the curve in the body, the components against time."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from taylor_verify.draw.caption import NotDrawn
from taylor_verify.draw.components import LINES, SUBSCRIPTS
from taylor_verify.draw.mesh import Face
from taylor_verify.draw.moving import Moving
from taylor_verify.draw.polhode import facing
from taylor_verify.draw.view import Ellipsoid, Numbers, View, pieces
from taylor_verify.plotting.palette import INK, PAPER, QUIET
from taylor_verify.plotting.picture import plotting
from taylor_verify.plotting.style import SMALL

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.collections import PolyCollection
    from matplotlib.figure import Figure

ENDINGS: Final = (".gif", ".mp4")
# The size in inches, and pixels per inch.
_SIZE: Final = (8.0, 4.6)
_RESOLUTION: Final = 100
# Frames per second, and the most frames: a GIF of more would be too large for a page.
_RATE: Final = {".gif": 12, ".mp4": 30}
_MOST: Final = {".gif": 180, ".mp4": 1200}
_VIEW: Final = View(28.0, 14.0)
_COLOURS: Final = {
    "plus": "#D9541E",
    "minus": "#1F6FB2",
    "side": "#E9E4D8",
    "edge": "#B9B2A3",
    "string": "#8B8F93",
    "axis1": "#C2481A",
    "axis2": "#1C8578",
    "axis3": "#1F6FB2",
}
_LIGHT: Final = np.array([-0.45, 0.62, 0.64])
_POINT: Final[dict[str, Any]] = {
    "marker": "o",
    "markersize": 7,
    "markeredgecolor": PAPER,
    "color": "#D9541E",
}
# The length of the tail behind the point, in rows.
_TAIL: Final = 60


def film(motion: Moving, ending: str, frames: int | None = None) -> bytes:
    """Return the content of a film of a motion; of a long motion it shows the beginning.

    ``ending`` is ``.gif`` or ``.mp4``. ``frames`` is the number of frames; by default it follows from the
    length of the motion. Raises NotDrawn for an MP4 on a machine without ffmpeg.
    """
    if ending == ".mp4" and shutil.which("ffmpeg") is None:
        raise NotDrawn(
            "expected ffmpeg to make a .mp4, got none on this machine: install it, or ask for .gif or "
            ".html @ --out"
        )
    rate = _RATE[ending]
    # Below 1 for a motion that takes more than the most frames.
    part = min(1.0, _MOST[ending] / (motion.seconds * rate))
    shown = motion.until(part)
    count = frames or max(2, round(shown.seconds * rate))
    with plotting(), TemporaryDirectory() as folder:
        from matplotlib import animation

        figure, advance = _figure(shown)
        rows = np.linspace(0, len(shown.times) - 1, count).round().astype(int)
        moving = animation.FuncAnimation(
            figure, lambda row: advance(int(row)), frames=[int(row) for row in rows], blit=False
        )
        writer = animation.PillowWriter if ending == ".gif" else animation.FFMpegWriter
        file = Path(folder, f"film{ending}")
        moving.save(file, writer=writer(fps=rate), dpi=_RESOLUTION)
        return file.read_bytes()


def _figure(motion: Moving) -> tuple[Figure, Callable[[int], list[Artist]]]:
    """Return the figure, and the function that moves it to a row of the motion."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=_SIZE, dpi=_RESOLUTION)
    FigureCanvasAgg(figure)
    is_alone = motion.inset is None
    places = {
        "body": (0.01, 0.08, 0.54, 0.82),
        "inset": (0.58, 0.46, 0.4, 0.44),
        "time": (0.63, 0.13, 0.35, 0.7 if is_alone else 0.27),
    }
    figure.text(0.02, 0.945, motion.title, size=12, weight="bold", va="center")
    figure.text(0.02, 0.03, motion.caption, size=SMALL, color=QUIET, va="center")
    clock = figure.text(0.98, 0.03, "", size=SMALL, ha="right", va="center")
    movers = [
        _body(figure.add_axes(places["body"]), motion),
        *([] if is_alone else [_inset(figure.add_axes(places["inset"]), motion)]),
        _time(figure.add_axes(places["time"]), motion),
    ]

    def advance(row: int) -> list[Artist]:
        for move in movers:
            move(row)
        clock.set_text(f"t = {motion.times[row]:.1f}")
        return []

    return figure, advance


def _bare(axes: Axes, reach: float) -> None:
    """Set the axes to this distance in every direction, at one scale and without lines."""
    axes.axis("off")
    axes.set_aspect("equal")
    axes.set(xlim=(-reach, reach), ylim=(-reach, reach))


def _body(axes: Axes, motion: Moving) -> Callable[[int], None]:
    from matplotlib.collections import PolyCollection

    _bare(axes, motion.reach * (1.2 if motion.arrow else 1.05))
    project = _VIEW.project
    if motion.arrow:
        stem = project(
            np.array([[0, 0, -1.05], [0, 0, 1.02], [0, 0, 0.95], [0, 0, 1.14]]) * motion.reach
        )
        axes.plot(*stem[:2].T, color=QUIET, linewidth=0.8, dashes=(1.5, 4), zorder=1)
        arrow = {"arrowstyle": "-|>", "color": INK, "linewidth": 1.6, "mutation_scale": 11}
        axes.annotate(
            "", stem[3], stem[2], arrowprops={**arrow, "shrinkA": 0, "shrinkB": 0}, zorder=4
        )
        axes.annotate("H", stem[3], (7, -6), textcoords="offset points")
    path = None
    if motion.centres is not None:
        places = project(motion.centres - motion.middle)
        axes.plot(*places.T, color="#C3CCD3", linewidth=0.9, zorder=1)
        (path,) = axes.plot([], [], color="#7A5AA6", linewidth=1.8, zorder=2)
    faces = PolyCollection([], zorder=3, linewidths=0.4)
    axes.add_collection(faces)

    def move(row: int) -> None:
        centre = np.zeros(3) if motion.centres is None else motion.centres[row] - motion.middle
        _turn(faces, motion.body.faces, motion.attitudes[row], centre)
        if path is not None:
            path.set_data(*places[: row + 1].T)

    return move


def _turn(
    drawn: PolyCollection, faces: tuple[Face, ...], attitude: Numbers, centre: Numbers
) -> None:
    """Move the faces to their places: only those that face the viewer, the farthest first."""
    shown = []
    for face in faces:
        corners = face.corners @ attitude.T + centre
        depth = float(corners.mean(axis=0) @ _VIEW.towards)
        colour = _COLOURS[face.colour]
        if not face.is_line:
            normal = _VIEW.frame @ (attitude @ face.normal)
            if normal[2] <= 0:
                continue
            colour = shaded(colour, min(0.66 + 0.5 * max(0.0, float(normal @ _LIGHT)), 1.12))
        shown.append((depth, _VIEW.project(corners), colour))
    shown.sort(key=lambda item: item[0])
    drawn.set_verts([points for _, points, _ in shown])
    colours = [colour for _, _, colour in shown]
    drawn.set_facecolor(colours)
    drawn.set_edgecolor(colours)


def shaded(colour: str, light: float) -> str:
    """Return the colour, darker for a light below 1 and paler for a light above 1."""
    target, part = (255, light - 1) if light > 1 else (0, 1 - light)
    parts = (int(colour[k : k + 2], 16) for k in (1, 3, 5))
    return "#" + "".join(f"{round(v + (target - v) * part):02X}" for v in parts)


def _inset(axes: Axes, motion: Moving) -> Callable[[int], None]:
    inset = motion.inset
    assert inset is not None
    view, surface = facing(inset.course, inset.semi_axes), Ellipsoid(inset.semi_axes)
    _bare(axes, 1.34 * max(inset.semi_axes))
    axes.set_title(inset.name, size=SMALL, color=QUIET, weight="normal", pad=2)
    axes.fill(
        *view.project(surface.outline(view)).T, facecolor="#EEF2F5", edgecolor=QUIET, linewidth=0.7
    )
    lines: list[tuple[Numbers, dict[str, Any]]] = [
        *((surface.circle(pole), {"color": "#C3CCD3", "linewidth": 0.6}) for pole in np.eye(3)),
        *((curve, {"color": "#A9792B", "linewidth": 0.9}) for curve in inset.curves),
        (inset.course, {"color": QUIET, "linewidth": 1.0}),
    ]
    for points, look in lines:
        is_inside = inset.sinks and points is inset.course
        near = np.ones(len(points), dtype=bool) if is_inside else surface.faces(points, view)
        for is_near, piece in pieces(view.project(points), near):
            axes.plot(*piece.T, alpha=1.0 if is_near else 0.3, **look)
    for k, axis in enumerate(np.diag(inset.semi_axes)):
        size = 0.2 * max(inset.semi_axes) / inset.semi_axes[k]
        words = f"{inset.letter}{SUBSCRIPTS[k]}"
        x, y = map(float, view.project(axis * (1 + size))[0])
        axes.text(x, y, words, size=SMALL, ha="center", va="center")
    (tail,) = axes.plot([], [], color="#D9541E", linewidth=2.2, zorder=4)
    (point,) = axes.plot([], [], zorder=5, **_POINT)

    def move(row: int) -> None:
        tail.set_data(*view.project(inset.course[max(0, row - _TAIL) : row + 1]).T)
        point.set_data(*view.project(inset.course[row]).T)

    return move


def _time(axes: Axes, motion: Moving) -> Callable[[int], None]:
    from matplotlib.ticker import MaxNLocator

    for k, (look, values) in enumerate(zip(LINES, motion.rows.T, strict=True)):
        axes.plot(motion.times, values, label=f"{motion.letter}{SUBSCRIPTS[k]}", **look)
    for flip in motion.flips:
        axes.axvline(flip, color="#C3CCD3", linewidth=0.7, zorder=0)
    axes.xaxis.set_major_locator(MaxNLocator(5, steps=[1, 2, 5, 10]))
    axes.yaxis.set_major_locator(MaxNLocator(4, steps=[1, 2, 5, 10]))
    axes.set(xlim=sorted((motion.times[0], motion.times[-1])), xlabel="time t")
    axes.legend(
        loc="lower left",
        bbox_to_anchor=(0, 1.0),
        ncols=3,
        frameon=False,
        fontsize=SMALL,
        borderpad=0.1,
    )
    cursor = axes.axvline(motion.times[0], color=INK, linewidth=1.2)

    def move(row: int) -> None:
        cursor.set_xdata([motion.times[row]] * 2)

    return move
