"""The path of the body's axis on the unit sphere in space, darker as time goes on.

The axis is the axis of symmetry, or for a rigid body the principal axis that its angular velocity goes
round. Its direction in space is its column of R. Where no load acts, the angular momentum or the linear
impulse keeps its direction in space, and the picture marks that direction.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from taylor_verify.draw.caption import captioned
from taylor_verify.draw.stage import END, START, Look, Stage, scale
from taylor_verify.draw.view import Ellipsoid, Numbers, View
from taylor_verify.plotting.picture import Picture

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Document = Mapping[str, Any]

# In inches.
_HEIGHT: Final = 3.4
_STAGE: Final = 4.2
_SPHERE: Final = Ellipsoid((1.0, 1.0, 1.0))
# A course has nine digits: a direction that changes by less than this stands still.
_AT_REST: Final = 1e-6
_WIDTH: Final = 1.3
_FIXED: Final[Look] = {
    "linestyle": "none",
    "marker": "x",
    "markersize": 6,
    "markeredgecolor": "#A83C00",
    "markeredgewidth": 1.6,
}


@dataclass(frozen=True)
class Series:
    """The axis in space, one unit vector a time, and its number in the body.

    ``fixed`` is the direction of the momentum in space, None if it changes. ``fixed_name`` names that
    vector.
    """

    times: Numbers
    path: Numbers
    axis: int
    fixed: Numbers | None
    fixed_name: str


def series(portrait: Document) -> Series:
    """Return the path of the axis."""
    course = portrait["course"]
    attitudes = np.array(course["attitude"]).reshape(-1, 3, 3)
    axis = _axis_of(portrait)
    momentum, name = momentum_of(portrait)
    fixed = fixed_direction(np.einsum("nij,nj->ni", attitudes, momentum))
    return Series(np.array(course["t"]), attitudes[:, :, axis - 1], axis, fixed, name)


def fixed_direction(vectors: Numbers) -> Numbers | None:
    """Return the unit vector along all vectors (n, 3); None if their direction changes."""
    sizes = np.linalg.norm(vectors, axis=1, keepdims=True)
    if not sizes.min() > 0:
        return None
    directions = vectors / sizes
    return directions[0] if np.abs(directions - directions[0]).max() <= _AT_REST else None


def _axis_of(portrait: Document) -> int:
    """Return 1, 2 or 3: the axis of symmetry, or the axis that the polhode goes round; else the third."""
    if portrait["axis"]:
        return int(portrait["axis"])
    body = portrait["body"]
    choose = {"min-axis": np.argmin, "max-axis": np.argmax}.get(portrait["regime"])
    if body is None or choose is None:
        return 3
    principal = np.array(body["axes"])[choose(body["principal_moments"])]
    return int(np.argmax(np.abs(principal))) + 1


def momentum_of(portrait: Document) -> tuple[Numbers, str]:
    """Return a vector in body axes and its name: H = I omega + h of a rigid body, x of a solid in a fluid.

    The tensor I is computed from the principal moments and axes.
    """
    course, body = portrait["course"], portrait["body"]
    if body is None:
        return np.array(course["linear_impulse"]), "linear impulse"
    axes = np.array(body["axes"])
    tensor = axes.T @ np.diag(body["principal_moments"]) @ axes
    wheels = np.array(portrait["rotor"] or [0.0] * 3)
    momenta: Numbers = np.array(course["omega"]) @ tensor + wheels
    return momenta, "angular momentum"


def picture(portrait: Document) -> Picture:
    """Return the path of one scene's axis."""
    track = series(portrait)
    still = "" if track.fixed is None else f" The direction of the {track.fixed_name} is marked."
    alt = (
        f"Body axis {track.axis} of {portrait['scene']} on the unit sphere in space, from "
        f"t = {track.times[0]:g} to t = {track.times[-1]:g}, darker as time goes on.{still}"
    )
    return captioned(portrait, "axis", "Axis in space", alt, partial(_figure, track))


def _figure(track: Series, words: str) -> Figure:
    stage = Stage.around(_SPHERE, View.facing(_middle(track.path)), _STAGE, _HEIGHT)
    stage.course(track.path, _WIDTH, 3)
    marks = [(track.path[0], START, "start"), (track.path[-1], END, "end")]
    if track.fixed is not None:
        marks.append((track.fixed, _FIXED, track.fixed_name))
    for point, look, name in marks:
        stage.mark(point, look, clip_on=False, gid=name)
    stage.name_axes(_SPHERE.semi_axes, ("x", "y", "z (space)"))
    path = {"color": scale()(0.6), "linewidth": _WIDTH}
    entries = [(path, f"body axis {track.axis}"), *((look, name) for _, look, name in marks)]
    stage.legend(entries, f"Faint: on the far side. {words}".rstrip(), 2.8)
    stage.time_bar(track.times, 0.85)
    return stage.figure


def _middle(path: Numbers) -> list[float]:
    mean = path.mean(axis=0)
    # A path all round the sphere has no middle: any view is as good.
    return mean.tolist() if float(np.linalg.norm(mean)) > 0.05 else [1.0, 0.7, 0.5]
