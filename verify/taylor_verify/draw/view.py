"""Solids seen from far away: an orthographic view, and the side of an ellipsoid that faces the viewer.

A view keeps lengths across the line of sight, so that a picture has one scale. A point of a convex surface
is visible if and only if the outward normal there points to the viewer. So it is known exactly what is
hidden, and no picture depends on the order in which things are painted.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from math import asin, atan2, degrees, hypot, radians
from typing import Final

import numpy as np
from numpy.typing import NDArray

Numbers = NDArray[np.float64]
Mask = NDArray[np.bool_]

# Points of a closed curve on a surface.
_CORNERS: Final = 181
# Limits of the height of a view in degrees: a level or a steep one hides how things stand.
_LOWEST: Final = 12
_HIGHEST: Final = 28


@dataclass(frozen=True)
class View:
    """The side of the viewer in degrees: ``azimuth`` about the third axis, ``elevation`` above."""

    azimuth: float
    elevation: float

    @classmethod
    def facing(cls, direction: Sequence[float]) -> View:
        """Return the view from this side, with an elevation that is neither level nor steep."""
        x, y, z = direction
        height = degrees(asin(z / (hypot(x, y, z) or 1.0)))
        side = -1.0 if height < 0 else 1.0
        return cls(degrees(atan2(y, x)), side * min(max(abs(height), _LOWEST), _HIGHEST))

    @property
    def frame(self) -> Numbers:
        """Unit vectors as rows (3, 3): to the right, upwards, and towards the viewer."""
        az, el = radians(self.azimuth), radians(self.elevation)
        c, s, ce, se = np.cos(az), np.sin(az), np.cos(el), np.sin(el)
        return np.array([[-s, c, 0.0], [-se * c, -se * s, ce], [ce * c, ce * s, se]])

    @property
    def towards(self) -> Numbers:
        """The direction to the viewer."""
        return np.asarray(self.frame[2])

    def project(self, points: Numbers) -> Numbers:
        """Return the places of points (n, 3) on the paper: to the right and upwards, shape (n, 2)."""
        return np.asarray(np.atleast_2d(points) @ self.frame[:2].T)


@dataclass(frozen=True)
class Ellipsoid:
    """An ellipsoid about the origin, semi-axes along the axes; a sphere has three equal ones."""

    semi_axes: tuple[float, float, float]

    def faces(self, points: Numbers, view: View) -> Mask:
        """Return True for each point, on the surface or near it, that is on the viewer's side."""
        normal = np.atleast_2d(points) / np.square(self.semi_axes)
        return np.asarray(normal @ view.towards > 0)

    def outline(self, view: View) -> Numbers:
        """Return the visible rim: the points whose normal is across the line of sight."""
        # In units of the semi-axes the rim is a great circle, perpendicular to the line of sight.
        return self.circle(view.towards * np.array(self.semi_axes) ** -1)

    def circle(self, pole: Numbers) -> Numbers:
        """Return a section (n, 3) through the centre; ``pole`` is its normal in units of the semi-axes."""
        unit = pole / np.linalg.norm(pole)
        other = np.eye(3)[int(np.argmin(np.abs(unit)))]
        first = np.cross(unit, other)
        first /= np.linalg.norm(first)
        second = np.cross(unit, first)
        angle = np.linspace(0, 2 * np.pi, _CORNERS)[:, None]
        return np.asarray((np.cos(angle) * first + np.sin(angle) * second) * self.semi_axes)


def pieces(points: Numbers, mask: Mask) -> Iterator[tuple[bool, Numbers]]:
    """Yield a line in pieces that are wholly visible or wholly hidden; neighbours share a point."""
    first = 0
    for last in range(1, len(points)):
        if last == len(points) - 1 or mask[last] != mask[first]:
            yield bool(mask[first]), points[first : last + 1]
            first = last
