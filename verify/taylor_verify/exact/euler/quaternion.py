"""Unit quaternions in balls."""

from __future__ import annotations

from collections.abc import Sequence

from flint import arb

from taylor_verify.exact.balls import ball
from taylor_verify.scenes import motion, tensors

Quaternion = list[arb]  # scalar first, body to space


def unit(quaternion: motion.Quaternion) -> Quaternion:
    """The quotient of a rational quaternion by its norm."""
    length = ball(tensors.dot(quaternion, quaternion)).sqrt()
    return [ball(component) / length for component in quaternion]


def turn(axis: Sequence[arb], half_angle: arb) -> Quaternion:
    """The rotation about a unit axis; continuous in the angle, so that its sign is too."""
    sin, cos = half_angle.sin_cos()
    return [cos, *(sin * component for component in axis)]
