"""Solid things seen from far away: an orthographic view, and which side of an ellipsoid faces it.

A view keeps lengths across the line of sight, so that a picture has one scale. Of a convex surface a
point is seen if and only if the outward normal there points to the viewer: what is hidden is known
exactly, and no picture depends on the order in which things are painted.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from math import asin, atan2, degrees, radians
from typing import Final

import numpy as np
from numpy.typing import NDArray

Numbers = NDArray[np.float64]

# Of a closed curve on a surface.
_CORNERS: Final = 181


@dataclass(frozen=True)
class View:
    """Where the viewer stands, in degrees: ``azimuth`` about the third axis, which is upright."""

    azimuth: float
    elevation: float

    @classmethod
    def facing(cls, direction: Sequence[float], lowest: float = 12, highest: float = 28) -> View:
        """From this side, and from no height that would hide how things stand."""
        x, y, z = direction
        length = float(np.hypot(np.hypot(x, y), z)) or 1.0
        elevation = degrees(asin(max(-1.0, min(1.0, z / length))))
        side = -1.0 if elevation < 0 else 1.0
        return cls(degrees(atan2(y, x)), side * min(max(abs(elevation), lowest), highest))

    @property
    def frame(self) -> Numbers:
        """Rows: to the right, upwards, and towards the viewer."""
        az, el = radians(self.azimuth), radians(self.elevation)
        c, s, ce, se = np.cos(az), np.sin(az), np.cos(el), np.sin(el)
        return np.array([[-s, c, 0.0], [-se * c, -se * s, ce], [ce * c, ce * s, se]])

    @property
    def towards(self) -> Numbers:
        found: Numbers = self.frame[2]
        return found

    def seen(self, points: Numbers) -> Numbers:
        """Where points (n, 3) appear: to the right and upwards, shape (n, 2)."""
        found: Numbers = np.atleast_2d(points) @ self.frame[:2].T
        return found


@dataclass(frozen=True)
class Ellipsoid:
    """With its centre in the origin, semi-axes along the axes; a sphere has three equal ones."""

    semi_axes: tuple[float, float, float]

    def faces(self, points: Numbers, view: View) -> NDArray[np.bool_]:
        """Which of the points, on the surface or near it, are on the viewer's side."""
        normal = np.atleast_2d(points) / np.square(self.semi_axes)
        found: NDArray[np.bool_] = normal @ view.towards > 0
        return found

    def outline(self, view: View) -> Numbers:
        """The rim as it is seen: the points whose normal is across the line of sight."""
        # In units of the semi-axes it is the great circle perpendicular to the line of sight there.
        pole = view.towards * np.array(self.semi_axes) ** -1
        return self.circle(pole)

    def circle(self, pole: Numbers) -> Numbers:
        """The plane section through the centre which, in units of the semi-axes, has this pole."""
        unit = pole / np.linalg.norm(pole)
        other = np.eye(3)[int(np.argmin(np.abs(unit)))]
        first = np.cross(unit, other)
        first /= np.linalg.norm(first)
        second = np.cross(unit, first)
        angle = np.linspace(0, 2 * np.pi, _CORNERS)[:, None]
        found: Numbers = (np.cos(angle) * first + np.sin(angle) * second) * np.array(self.semi_axes)
        return found


def pieces(points: Numbers, mask: NDArray[np.bool_]) -> Iterator[tuple[bool, Numbers]]:
    """A line in runs that are seen or hidden throughout; neighbours share the point between them."""
    first = 0
    for last in range(1, len(points)):
        if last == len(points) - 1 or mask[last] != mask[first]:
            yield bool(mask[first]), points[first : last + 1]
            first = last
