"""Drawings of a solid on its path: an ellipsoid seen from afar, or the axes of a body without a shape."""

from __future__ import annotations

from typing import Final

import numpy as np

from taylor_verify.draw.stage import Look, Stage
from taylor_verify.draw.view import Ellipsoid, Numbers, View, pieces

AXES: Final = ("#A83C00", "#1C8578", "#0B5FA5")
_BODY: Final[Look] = {"facecolor": "#E8EEF2", "edgecolor": "#43525C", "linewidth": 0.8}
_SEAM: Final[Look] = {"color": "#8596A1", "linewidth": 0.6}
_FRAME_WIDTH: Final = 1.3
# The line behind a solid shows through.
_OPACITY: Final = 0.82


def reach(semi_axes: Numbers, attitudes: Numbers) -> Numbers:
    """Return how far an ellipsoid reaches along each axis of space, shape (n, 3)."""
    return np.asarray(np.sqrt(np.square(attitudes * semi_axes).sum(axis=2)))


def draw_ellipsoid(
    stage: Stage,
    semi_axes: tuple[float, float, float],
    attitude: Numbers,
    centre: Numbers,
    at: float,
) -> None:
    """Draw the ellipsoid with the near halves of its three sections; ``at`` is its layer."""
    surface = Ellipsoid(semi_axes)
    towards = attitude.T @ stage.view.towards
    rim = surface.circle(towards / np.array(semi_axes)) @ attitude.T + centre
    outline = stage.view.project(rim)
    stage.axes.fill(*outline.T, zorder=at, alpha=_OPACITY, gid="solid", **_BODY)
    for pole in np.eye(3):
        line = surface.circle(pole)
        near = np.asarray(line / np.square(semi_axes) @ towards > 0)
        for is_near, piece in pieces(stage.view.project(line @ attitude.T + centre), near):
            if is_near:
                stage.axes.plot(*piece.T, zorder=at + 0.01, gid="solid", **_SEAM)


def draw_frame(stage: Stage, length: float, attitude: Numbers, centre: Numbers, at: float) -> None:
    """Draw the three axes of the body from its origin, each in its colour."""
    for axis, colour in zip(attitude.T, AXES, strict=True):
        ends = stage.view.project(np.array([centre, centre + length * axis]))
        look: Look = {"color": colour, "linewidth": _FRAME_WIDTH, "solid_capstyle": "round"}
        stage.axes.plot(*ends.T, zorder=at, gid="solid", **look)


def by_depth(centres: Numbers, view: View) -> list[int]:
    """Return the places of solids from the farthest to the nearest."""
    return [int(k) for k in np.argsort(centres @ view.towards, kind="stable")]
