"""The herpolhode: the tip of omega in space, seen along the constant direction of the momentum H.

Without wheels and loads the tip stays in a plane across H, between two circles.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from taylor_verify.draw.axis_path import momentum_of
from taylor_verify.draw.caption import NotDrawn, captioned
from taylor_verify.draw.stage import END, START, Look, Stage, scale
from taylor_verify.draw.view import Numbers, View
from taylor_verify.plotting.palette import QUIET
from taylor_verify.plotting.picture import Picture
from taylor_verify.plotting.sheet import Entry
from taylor_verify.plotting.wording import plain

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Document = Mapping[str, Any]

# In inches.
_HEIGHT: Final = 3.9
_STAGE: Final = 4.2
_WIDTH: Final = 1.5
# The view straight down on the plane.
_ABOVE: Final = View(-90.0, 90.0)
_CORNERS: Final = 181
_CIRCLE: Final[Look] = {"color": QUIET, "linewidth": 0.8, "dashes": (3, 2), "gid": "circle"}
_H: Final[Look] = {
    "linestyle": "none",
    "marker": "x",
    "markersize": 7,
    "markeredgecolor": "#A83C00",
    "markeredgewidth": 1.6,
    "gid": "H",
}
# A curve that is smaller than this across H, in parts of omega, is a point.
_A_POINT: Final = 1e-7


@dataclass(frozen=True)
class Series:
    """The tip of omega across H, (n, 2), at its times (n,); the radii that it stays between, or None."""

    times: Numbers
    tips: Numbers
    circles: tuple[float, float] | None


def series(document: Document) -> Series:
    """Return the herpolhode of a free rigid body.

    Raises NotDrawn for any other scene, and if omega is along H.
    """
    course = document["course"]
    if document["body"] is None or not document["is_free"]:
        got = "a solid in a fluid" if document["body"] is None else "a torque"
        raise NotDrawn(f"expected a free rigid body, got {got} @ {document['scene']}")
    if document["rotor"] and document["damping"]:
        raise NotDrawn(f"expected H at rest in space, got damped wheels @ {document['scene']}")
    attitudes = np.array(course["attitude"]).reshape(-1, 3, 3)
    momentum, _ = momentum_of(document)
    H = attitudes[0] @ momentum[0]  # noqa: N806 (as in the text)
    omega = np.einsum("nij,nj->ni", attitudes, np.array(course["omega"]))
    first = np.eye(3)[int(np.abs(H).argmin())]
    across = first - (first @ H) * H / (H @ H or 1.0)
    across /= np.linalg.norm(across)
    frame = np.array([across, np.cross(H, across) / (np.linalg.norm(H) or 1.0)])
    tips = omega @ frame.T
    radii = np.linalg.norm(tips, axis=1)
    if not radii.max() > _A_POINT * np.abs(omega).max():
        raise NotDrawn(f"expected omega beside H, got a spin along H @ {document['scene']}")
    is_bounded = not document["damping"] and "period" in {r["name"] for r in document["analytic"]}
    circles = (float(radii.min()), float(radii.max())) if is_bounded else None
    return Series(np.array(course["t"]), tips, circles)


def picture(document: Document) -> Picture:
    """Return the herpolhode of one scene. Raises NotDrawn as `series` does."""
    curve = series(document)
    radii = np.linalg.norm(curve.tips, axis=1)
    alt = (
        f"The tip of the angular velocity of {document['scene']} in space, seen along the angular "
        f"momentum: between {plain(float(radii.min()))} and {plain(float(radii.max()))} from its axis."
    )
    return captioned(document, "herpolhode", "Herpolhode", alt, partial(_figure, curve))


def _figure(curve: Series, words: str) -> Figure:
    rings = [_ring(radius) for radius in curve.circles or ()]
    flat = np.column_stack([curve.tips, np.zeros(len(curve.tips))])
    spots = np.concatenate([curve.tips, np.zeros((1, 2)), *(ring[:, :2] for ring in rings)])
    stage = Stage.showing(spots, _ABOVE, _STAGE, _HEIGHT)
    for ring in rings:
        stage.line(ring, 1, _CIRCLE)
    stage.course(flat, _WIDTH, 3)
    stage.mark(np.zeros(3), _H)
    stage.mark(flat[0], START, gid="start")
    stage.mark(flat[-1], END, gid="end")
    entries: list[Entry] = [
        (
            {"color": scale()(0.6), "linewidth": _WIDTH},
            "tip of \N{GREEK SMALL LETTER OMEGA} in space",
        ),
        (START, "start"),
        (END, "end"),
        (_H, "axis along H"),
        *([(_CIRCLE, "least and greatest distance")] if rings else []),
    ]
    stage.legend(entries, f"Seen along H. {words}", 3.2)
    stage.time_bar(curve.times, 0.85)
    return stage.figure


def _ring(radius: float) -> Numbers:
    angle = np.linspace(0, 2 * np.pi, _CORNERS)
    return radius * np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
