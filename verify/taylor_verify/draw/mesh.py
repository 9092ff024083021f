"""Bodies as faces that can be turned: a brick, a racket, a top, an ellipsoid, or a block without a shape.

A face is a convex polygon in body axes with the name of its colour. ``plus`` and ``minus`` are the two
ends of the axis that turns over, ``side`` and ``edge`` the rest of a body.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import sqrt
from typing import Final

import numpy as np

from taylor_verify.draw.view import Ellipsoid, Numbers

# The least thickness of a body, in parts of its length: a thinner one could not be seen edge on.
_THINNEST: Final = 0.05
# A body whose greatest moment is, within this part, the sum of the others is flat: it is drawn as a racket.
_FLAT: Final = 0.06
_RING: Final = 36
# The height of a top; its rim is at distance 1 from its tip.
LID: Final = 0.88
_STRINGS: Final = 6
_MERIDIANS: Final = 32
_PARALLELS: Final = 16


@dataclass(frozen=True)
class Face:
    """A convex polygon (n, 3), its corners in order, or a line of two points; and its colour's name."""

    corners: Numbers
    colour: str

    @property
    def is_line(self) -> bool:
        """True for two points."""
        return len(self.corners) == 2

    @property
    def normal(self) -> Numbers:
        """The unit vector outwards. At the pole of an ellipsoid two corners are one."""
        a, b, c, *rest = self.corners
        normal = np.cross(b - a, c - a)
        if not normal.any():
            normal = np.cross(c - a, rest[0] - a)
        return np.asarray(normal / np.linalg.norm(normal))


@dataclass(frozen=True)
class Mesh:
    """All faces of a body, and its name in words."""

    faces: tuple[Face, ...]
    name: str

    @property
    def reach(self) -> float:
        """The distance of the farthest corner from the origin."""
        return max(float(np.linalg.norm(face.corners, axis=1).max()) for face in self.faces)


def rigid(moments: Numbers, axes: Numbers) -> Mesh:
    """Return a brick or a racket with these principal moments, its farthest corner at distance 1.

    The rows of ``axes`` are the principal axes. A flat body whose two smaller moments differ is a racket.
    The moments of the brick are as near to ``moments`` as those of a real body can be.
    """
    low, middle, high = np.argsort(moments, kind="stable")
    turned = np.array([axes[low], axes[middle], np.cross(axes[low], axes[middle])])
    is_flat = abs(moments[high] - moments[middle] - moments[low]) < _FLAT * moments[high]
    if is_flat and moments[middle] - moments[low] > _FLAT * moments[high]:
        return _fitted(_racket(), turned, "a racket")
    squares = moments.sum() - 2 * moments
    sides = np.sqrt(np.maximum(squares, 0))
    sides = np.maximum(sides, _THINNEST * sides.max())[[low, middle, high]]
    return _fitted(list(box(sides, _BRICK)), turned, "a brick with these moments")


# Colours of the faces at both ends of the axes of least, middle and greatest moment.
_BRICK: Final = (("side", "edge"), ("plus", "minus"), ("side", "edge"))


def box(half: Sequence[float] | Numbers, colours: Sequence[tuple[str, str]]) -> Iterator[Face]:
    """Yield the faces of a box about the origin; ``half`` are half its sides."""
    for i, names in enumerate(colours):
        j, k = (i + 1) % 3, (i + 2) % 3
        for sign, colour in zip((1.0, -1.0), names, strict=True):
            corners = np.zeros((4, 3))
            corners[:, i] = sign * half[i]
            corners[:, j] = np.array([-1, 1, 1, -1]) * half[j] * sign
            corners[:, k] = np.array([-1, -1, 1, 1]) * half[k]
            yield Face(corners, colour)


def _fitted(faces: Sequence[Face], axes: Numbers, name: str) -> Mesh:
    """Return the faces turned to these axes, with the farthest corner at distance 1."""
    far = max(float(np.linalg.norm(face.corners, axis=1).max()) for face in faces)
    return Mesh(tuple(Face(face.corners @ axes / far, face.colour) for face in faces), name)


def _racket() -> list[Face]:
    """Return a racket: its handle along axis 1, its head in the plane of axes 1 and 2."""
    head, half = np.array([0.52, 0.0]), np.array([0.60, 0.46])
    angle = np.linspace(0, 2 * np.pi, _RING + 1)
    unit = np.column_stack([np.cos(angle), np.sin(angle)])
    outer, inner = head + unit * half, head + unit * (half - 0.085)
    faces = []
    for (a, b), (c, d), (u, v) in zip(
        pairwise(outer), pairwise(inner), pairwise(unit), strict=True
    ):
        colour = "plus" if u[1] + v[1] > 0 else "minus"
        faces += _slab([a, b, d, c], 0.055, colour)
    faces += _strings(head, half - 0.06)
    for sign, colour in ((1.0, "plus"), (-1.0, "minus")):
        fork = np.array([[-0.32, 0.0], [-0.32, 0.045], [0.14, 0.35], [0.06, 0.26]]) * [1, sign]
        faces += _slab(fork, 0.05, colour)
    for near, far in pairwise(np.linspace(-1.15, -0.3, 6)):
        grip = np.array([[near, -0.065], [far, -0.065], [far, 0.065], [near, 0.065]])
        faces += _slab(grip, 0.065, "side" if near < -0.6 else "edge")
    return faces


def _slab(corners: Sequence[Numbers] | Numbers, half: float, colour: str) -> list[Face]:
    """Return a prism over a convex polygon of the plane; ``half`` is its thickness on either side."""
    flat = np.asarray(corners, dtype=float)
    turn = sum(
        float(p[0] * q[1] - p[1] * q[0])
        for p, q in zip(flat, np.roll(flat, -1, axis=0), strict=True)
    )
    flat = flat if turn > 0 else flat[::-1]
    top = np.column_stack([flat, np.full(len(flat), half)])
    low = np.column_stack([flat, np.full(len(flat), -half)])
    sides = [
        Face(np.array([low[k], low[(k + 1) % len(flat)], top[(k + 1) % len(flat)], top[k]]), colour)
        for k in range(len(flat))
    ]
    return [Face(top, colour), Face(low[::-1], colour), *sides]


def _strings(head: Numbers, half: Numbers) -> Iterator[Face]:
    """Yield the strings of the head, lines of two points."""
    for axis, count in ((0, _STRINGS + 1), (1, _STRINGS)):
        for part in np.linspace(-0.82, 0.82, count):
            ends = np.zeros((2, 3))
            ends[:, 1 - axis] = part * half[1 - axis]
            ends[:, axis] = np.array([-1, 1]) * np.sqrt(1 - part**2) * half[axis]
            ends[:, :2] += head
            yield Face(ends, "string")


def ellipsoid(semi_axes: Sequence[float]) -> Mesh:
    """Return an ellipsoid in its own size; the colours of its octants alternate."""
    faces = []
    polar = np.linspace(0, np.pi, _PARALLELS + 1)
    azimuth = np.linspace(0, 2 * np.pi, _MERIDIANS + 1)
    for i, (a, b) in enumerate(pairwise(polar)):
        for k, (c, d) in enumerate(pairwise(azimuth)):
            angles = [(b, c), (b, d), (a, d), (a, c)]
            corners = np.array(
                [[np.sin(p) * np.cos(q), np.sin(p) * np.sin(q), np.cos(p)] for p, q in angles]
            )
            is_odd = (2 * i // _PARALLELS + 4 * k // _MERIDIANS) % 2
            faces.append(Face(corners * np.array(semi_axes), "minus" if is_odd else "side"))
    return Mesh(tuple(faces), "the solid, in its own size")


def block(mass_matrix: Numbers, least: float) -> Mesh:
    """Return a block for a body in a fluid without a shape: the less mass along an axis, the longer.

    A body resists an acceleration along its length less than one across it. ``mass_matrix`` (6, 6) is that
    of (x, y) = M (U, Omega); the block has about its radius of gyration, and at least the size ``least``.
    """
    masses, columns = np.linalg.eigh(mass_matrix[:3, :3])
    axes = np.array([*columns.T[:2], np.cross(columns[:, 0], columns[:, 1])])
    gyration = sqrt(np.trace(mass_matrix[3:, 3:]) / np.trace(mass_matrix[:3, :3]))
    half = max(gyration, least / 2) * np.maximum(masses[0] / masses, _THINNEST)
    faces = [Face(face.corners @ axes, face.colour) for face in box(half, _BLOCK)]
    return Mesh(tuple(faces), "a block, longest where it has the least mass with that of the fluid")


# Colours of the faces at both ends of the axes of least, middle and greatest mass.
_BLOCK: Final = (("side", "edge"), ("side", "edge"), ("plus", "minus"))


def top(towards: Numbers) -> Mesh:
    """Return a top that is held at its tip, the origin; its lid is in this direction, in body axes."""
    along = towards / np.linalg.norm(towards)
    across = Ellipsoid((1.0,) * 3).circle(along)[:: 180 // _RING]
    rim = LID * along + np.sqrt(1 - LID**2) * across
    sides = [
        Face(np.array([np.zeros(3), p, q]), ("plus", "minus")[4 * k // _RING % 2])
        for k, (p, q) in enumerate(pairwise(rim))
    ]
    return Mesh((*sides, Face(rim[:0:-1], "side")), "a top, held at its tip")
