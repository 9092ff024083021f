"""The path of the body's axis on the unit sphere in space, darker as time goes on.

The axis is the axis of symmetry, or for a rigid body the principal axis that its angular velocity goes
round. Its direction in space is its column of R. Where no load acts, the angular momentum or the linear
impulse keeps its direction in space, and the picture marks that direction.
"""

from __future__ import annotations

from functools import partial
from typing import Final

import numpy as np

from taylor_verify.draw.caption import Document, captioned
from taylor_verify.draw.stage import CROSS
from taylor_verify.draw.surface import Part, Surface, figure
from taylor_verify.draw.view import Numbers
from taylor_verify.plotting.picture import Picture

# A course has nine digits: a direction that changes by less than this stands still.
_AT_REST: Final = 1e-6


def surface(portrait: Document) -> Surface:
    """Return the path of the axis, and the direction of a momentum that space keeps."""
    course = portrait["course"]
    attitudes = np.array(course["attitude"]).reshape(-1, 3, 3)
    axis = _axis_of(portrait)
    momentum, name = momentum_of(portrait)
    fixed = fixed_direction(np.einsum("nij,nj->ni", attitudes, momentum))
    return Surface(
        times=np.array(course["t"]),
        course=attitudes[:, :, axis - 1],
        letter="",
        name=f"body axis {axis}",
        axes=("x", "y", "z (space)"),
        marks=() if fixed is None else (Part(fixed, CROSS, name),),
    )


def fixed_direction(vectors: Numbers) -> Numbers | None:
    """Return the unit vector along all vectors (n, 3); None if their direction changes."""
    sizes = np.linalg.norm(vectors, axis=1, keepdims=True)
    if not sizes.min() > 0:
        return None
    directions = vectors / sizes
    return directions[0] if np.abs(directions - directions[0]).max() <= _AT_REST else None


def upright(direction: Numbers) -> Numbers:
    """Return the rotation (3, 3) that makes a direction in space point upwards."""
    up = direction / (np.linalg.norm(direction) or 1.0)
    first = np.eye(3)[int(np.abs(up).argmin())]
    first = first - (first @ up) * up
    first /= np.linalg.norm(first)
    return np.array([first, np.cross(up, first), up])


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
    drawn = surface(portrait)
    still = "".join(f" The direction of the {mark.name} is marked." for mark in drawn.marks)
    alt = (
        f"{drawn.name.capitalize()} of {portrait['scene']} on the unit sphere in space, from "
        f"t = {drawn.times[0]:g} to t = {drawn.times[-1]:g}, darker as time goes on.{still}"
    )
    return captioned(portrait, "axis", "Axis in space", alt, partial(figure, drawn))
