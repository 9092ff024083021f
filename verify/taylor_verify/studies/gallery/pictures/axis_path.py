"""The path of the body's axis on the unit sphere in space, darker as time goes on.

The axis is that of symmetry, or for a rigid body the one that its angular velocity goes round. The column
of R that belongs to it is its direction in space. Where no load acts, the angular momentum or the linear
impulse keeps its direction in space, and that is marked.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from taylor_verify.publish.pictures.palette import INK, PAPER
from taylor_verify.publish.pictures.picture import Picture
from taylor_verify.publish.pictures.sheet import Entry, Frame, blank, draw_legend
from taylor_verify.publish.pictures.style import PAGE_WIDTH
from taylor_verify.publish.pictures.wording import stem_of
from taylor_verify.studies.gallery.pictures.solids import (
    draw_axes,
    draw_bar,
    draw_on,
    draw_surface,
    reach,
    scale,
    stage,
)
from taylor_verify.studies.gallery.pictures.view import Ellipsoid, Numbers, View

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Document = Mapping[str, Any]

# In inches.
_HEIGHT: Final = 3.4
_STAGE: Final = 4.2
_SPHERE: Final = Ellipsoid((1.0, 1.0, 1.0))
# Of one colour each.
_STRETCHES: Final = 40
# The digits of a course are nine; what turns by less than this stands still.
_AT_REST: Final = 1e-6
_MARKS: Final[Mapping[str, Any]] = {"linestyle": "none", "zorder": 6, "clip_on": False}


@dataclass(frozen=True)
class Series:
    """``path`` has the axis in space, one unit vector a time; ``fixed`` a direction that keeps still.

    ``axis`` is its number in the body, ``fixed_name`` what keeps its direction; None where nothing does.
    """

    times: Numbers
    path: Numbers
    axis: int
    fixed: Numbers | None
    fixed_name: str


def series(portrait: Document) -> Series:
    """Raises ValueError for a scene that tracks no attitude."""
    course = portrait["course"]
    if "attitude" not in course:
        raise ValueError(f"expected a scene with its attitude, got none @ {portrait['scene']}")
    attitudes = np.array(course["attitude"]).reshape(-1, 3, 3)
    axis = axis_of(portrait)
    momentum, name = _momentum(portrait)
    in_space = np.einsum("nij,nj->ni", attitudes, momentum)
    sizes = np.linalg.norm(in_space, axis=1, keepdims=True)
    still = bool((sizes > 0).all()) and bool(
        np.abs(in_space / sizes - in_space[0] / sizes[0]).max() <= _AT_REST
    )
    fixed = in_space[0] / sizes[0] if still else None
    return Series(np.array(course["t"]), attitudes[:, :, axis - 1], axis, fixed, name)


def axis_of(portrait: Document) -> int:
    """1, 2 or 3: the axis of symmetry, or of the moment that the polhode goes round; else the third."""
    if portrait["potential"]:
        return int(portrait["potential"]["variable"][1:])
    body = portrait["body"]
    choose = {"min-axis": np.argmin, "max-axis": np.argmax}.get(portrait["regime"])
    if body is None or choose is None:
        return 3
    principal = np.array(body["axes"])[choose(body["principal_moments"])]
    return int(np.argmax(np.abs(principal))) + 1


def _momentum(portrait: Document) -> tuple[Numbers, str]:
    """In body axes: H = I omega with the tensor put together of its moments and axes, or x as it is."""
    course, body = portrait["course"], portrait["body"]
    if body is None:
        return np.array(course["linear_impulse"]), "linear impulse"
    axes = np.array(body["axes"])
    tensor = axes.T @ np.diag(body["principal_moments"]) @ axes
    found: Numbers = np.array(course["omega"]) @ tensor
    return found, "angular momentum"


def picture(portrait: Document) -> Picture:
    """The path of one scene's axis. Raises ValueError as `series` does."""
    found = series(portrait)
    still = "" if found.fixed is None else f" The direction of the {found.fixed_name} is marked."
    alt = (
        f"Body axis {found.axis} of {portrait['scene']} on the unit sphere in space, from "
        f"t = {found.times[0]:g} to t = {found.times[-1]:g}, darker as time goes on.{still}"
    )
    title = f"Axis in space: {portrait['scene']}"
    return Picture(stem_of(portrait, "axis"), title, alt, partial(_figure, found))


def _figure(found: Series) -> Figure:
    from matplotlib.colors import Normalize

    figure = blank(_HEIGHT)
    view = View.facing([float(v) for v in _middle(found)])
    axes = stage(figure, Frame(0.0, 0.0, _STAGE, _HEIGHT), reach(_SPHERE, view))
    draw_surface(axes, _SPHERE, view)
    norm = Normalize(float(found.times.min()), float(found.times.max()))
    _draw_path(axes, view, found)
    _draw_marks(axes, view, found)
    draw_axes(axes, _SPHERE, view, ("x", "y", "z (space)"))
    right = PAGE_WIDTH - _STAGE
    legend = Frame(_STAGE, 1.6, right - 0.2, 1.2)
    draw_legend(figure, _entries(found), "Faint: on the far side.", legend)
    is_backward = bool(found.times[-1] < found.times[0])
    draw_bar(figure, Frame(_STAGE, 0.85, right - 0.15, 0.12), norm, "time t", is_backward)
    return figure


def _middle(found: Series) -> Numbers:
    mean: Numbers = found.path.mean(axis=0)
    # A path all round the sphere has no side.
    return mean if float(np.linalg.norm(mean)) > 0.05 else np.array([1.0, 0.7, 0.5])


def _draw_path(axes: Axes, view: View, found: Series) -> None:
    colours = scale()
    bounds = np.linspace(0, len(found.path) - 1, _STRETCHES + 1).round().astype(int)
    for k in range(_STRETCHES):
        points = found.path[bounds[k] : bounds[k + 1] + 1]
        look = {"color": colours((k + 0.5) / _STRETCHES), "linewidth": 1.3, "gid": "path"}
        draw_on(axes, _SPHERE, view, points, look, zorder=3 + k / _STRETCHES)


def _draw_marks(axes: Axes, view: View, found: Series) -> None:
    for point, look, gid in _marks(found):
        is_seen = bool(_SPHERE.faces(point, view)[0])
        spot = view.seen(point)[0]
        alpha = 1.0 if is_seen else 0.4
        axes.plot([spot[0]], [spot[1]], alpha=alpha, gid=gid, **{**_MARKS, **look})


def _marks(found: Series) -> list[tuple[Numbers, dict[str, Any], str]]:
    edge = {"markeredgecolor": INK, "markeredgewidth": 0.9}
    marks = [
        (
            found.path[0],
            {"marker": "o", "markersize": 5, "markerfacecolor": PAPER, **edge},
            "start",
        ),
        (found.path[-1], {"marker": "s", "markersize": 5, "markerfacecolor": INK, **edge}, "end"),
    ]
    if found.fixed is not None:
        cross = {"marker": "x", "markersize": 6, "markeredgecolor": "#A83C00"}
        marks.append((found.fixed, {**cross, "markeredgewidth": 1.6}, found.fixed_name))
    return marks


def _entries(found: Series) -> list[Entry]:
    line: Entry = (
        {"color": scale()(0.6), "linewidth": 1.3},
        f"body axis {found.axis}",
    )
    marks = [({**look, "linestyle": "none"}, name) for _, look, name in _marks(found)]
    return [line, *marks]
