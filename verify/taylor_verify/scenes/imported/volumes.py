"""Volume of the collision shapes of an SDF link, which the plugin Buoyancy of gz-sim displaces."""

from __future__ import annotations

from fractions import Fraction
from functools import reduce
from operator import mul
from typing import Final, NamedTuple

from taylor_verify.numbers import tensors
from taylor_verify.numbers.tensors import ZERO_VECTOR, Vector
from taylor_verify.scenes.imported.attributes import Reading
from taylor_verify.scenes.imported.tree import Node

GRAVITY: Final = (Fraction(0), Fraction(0), Fraction("-9.8"))
"""Gravity of a world that does not write its own (sdformat, sdf/1.10/world.sdf)."""
_PI: Final = Fraction("3.14159265358979323846")


class Displaced(NamedTuple):
    volume: Fraction
    centre: Vector
    sentence: str


def displaced(link: Node, reading: Reading) -> Displaced | None:
    """Return volume and centre of all collision shapes; None without one, or where one is not read."""
    volume, moment = Fraction(0), ZERO_VECTOR
    for collision in link.named("collision"):
        size, place = _volume(collision, reading), _place(collision, reading)
        if size is None or place is None:
            return None
        volume += size
        moment = tensors.plus(moment, tensors.scaled(size, place))
    if not volume:
        return None
    centre = tensors.scaled(1 / volume, moment)
    return Displaced(
        volume, centre, "the volume is that of the collision shapes (pi to 20 decimals)"
    )


def _place(collision: Node, reading: Reading) -> Vector | None:
    """Return where a shape is; a turn does not move its volume."""
    pose = collision.child("pose")
    if pose is None or not pose.text.strip():
        return ZERO_VECTOR
    if pose.attributes.get("relative_to", "").strip():
        return None
    numbers = reading.vector(pose, pose.text, "pose", length=len(pose.text.split()))
    return None if numbers is None else numbers[:3]


def _volume(collision: Node, reading: Reading) -> Fraction | None:
    shapes = [shape for node in collision.named("geometry") for shape in node.children]
    if len(shapes) != 1:
        return None
    (shape,) = shapes
    match shape.name:
        case "box":
            edges = reading.inner(shape, "size")
            return reduce(mul, edges) if edges else None
        case "sphere":
            radius = reading.inner(shape, "radius", 1)
            return _PI * 4 / 3 * radius[0] ** 3 if radius else None
        case "ellipsoid":
            radii = reading.inner(shape, "radii")
            return _PI * 4 / 3 * reduce(mul, radii) if radii else None
        case "cylinder" | "capsule":
            radius, length = (reading.inner(shape, name, 1) for name in ("radius", "length"))
            if not radius or not length:
                return None
            ends = Fraction(4, 3) * radius[0] if shape.name == "capsule" else 0
            return _PI * radius[0] ** 2 * (length[0] + ends)
    return None
