"""Thrusters of gz-sim and uuv_simulator as texts of force and couple, each with a thrust of its own."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from typing import Final, NamedTuple

from taylor_verify.numbers import tensors
from taylor_verify.numbers.rotation import rotation_matrix
from taylor_verify.numbers.tensors import ZERO_VECTOR, Matrix, Vector
from taylor_verify.scenes import turns
from taylor_verify.scenes.imported.attributes import Reading, is_true
from taylor_verify.scenes.imported.link import Link
from taylor_verify.scenes.imported.tree import Node, Scoped
from taylor_verify.scenes.imported.water import Water, term

_DIGITS: Final = 12
_FRAMES: Final = ("relative_to", "frame", "rotation_format")


class _Pose(NamedTuple):
    place: Vector
    turn: Matrix


_AT_REST: Final = _Pose(ZERO_VECTOR, turns.AXES)


def with_thruster(
    water: Water, link: Link, item: Scoped, everything: Sequence[Scoped], reading: Reading
) -> Water:
    """Return the water with one more thruster of this link, its thrust zero until it is written."""
    name = item.node.written("joint_name") or item.node.written("jointName")
    joints = [i.node for i in everything if i.node.name == "joint" and i.scope == item.scope]
    joint = next((node for node in joints if node.attributes.get("name") == name), None)
    if joint is not None and f"{item.scope}{_linked(joint, 'parent')}" != link.name:
        return water
    line = None if joint is None else _line(joint, link, item.scope, everything, reading)
    if line is None:
        sentence = (
            f"the thruster of line {item.node.line} is left out: write its thrust as text in `force` and "
            "`couple`"
        )
        return water.without(sentence)
    place, axis = line
    thrust = f"thrust{len(water.thrusts) + 1}"
    six = (*axis, *tensors.cross(place, axis))
    terms = tuple(
        (*texts, *term(entry, thrust)) for texts, entry in zip(water.terms, six, strict=True)
    )
    return replace(water, terms=terms, thrusts=(*water.thrusts, (thrust, name)))


def _linked(joint: Node, end: str) -> str:
    """Return the link at one end of a joint, which SDF writes as text and URDF as an attribute."""
    node = joint.child(end)
    return "" if node is None else node.attributes.get("link", node.text).strip()


def _line(
    joint: Node, link: Link, scope: str, everything: Sequence[Scoped], reading: Reading
) -> tuple[Vector, Vector] | None:
    """Return a point and the unit vector of the axis of a joint in the axes of the link; None if unread."""
    origin, node = joint.child("origin"), joint.child("axis")
    if origin is not None or (node is not None and "xyz" in node.attributes):
        pose: _Pose | None = _of_urdf(origin, reading)
        text = (node.attributes.get("xyz") if node else None) or "1 0 0"
    else:
        ends = [f"{scope}{_linked(joint, 'child')}", link.name]
        named = [(i.name, i.node) for i in everything if i.node.name == "link"]
        links = [node for end in ends for name, node in named if name == end]
        poses = [_of_sdf(part, reading) for part in (*links, joint)]
        pose = _between(*poses) if len(poses) == 3 else None
        text = (node.written("xyz") if node else "") or "0 0 1"
    axis = reading.vector(joint, text, "axis")
    if pose is None or axis is None or not any(axis):
        return None
    turned = tensors.apply(pose.turn, axis)
    length = Fraction(float(tensors.dot(axis, axis)) ** 0.5)
    return _rounded(pose.place), _rounded(tensors.scaled(1 / length, turned))


def _rounded(vector: Vector) -> Vector:
    return tuple(Fraction(round(entry * 10**_DIGITS), 10**_DIGITS) for entry in vector)


def _of_urdf(origin: Node | None, reading: Reading) -> _Pose:
    if origin is None:
        return _AT_REST
    place, angles = (
        reading.vector(origin, origin.attributes.get(key), key, default=ZERO_VECTOR)
        for key in ("xyz", "rpy")
    )
    return _Pose(place or ZERO_VECTOR, _turn(angles or ZERO_VECTOR))


def _of_sdf(part: Node, reading: Reading) -> _Pose | None:
    """Return the pose of a link in its model, or of a joint in its child; None relative to a frame."""
    node = part.child("pose")
    if node is None or not node.text.strip():
        return _AT_REST
    if any(node.attributes.get(key, "").strip() for key in _FRAMES):
        return None
    six = reading.vector(node, node.text, "pose", length=6)
    if six is None:
        return None
    return _Pose(six[:3], _turn(six[3:], is_true(node.attributes.get("degrees"))))


def _turn(angles: Vector, degrees: bool = False) -> Matrix:
    return rotation_matrix(turns.roll_pitch_yaw(angles, degrees))


def _between(child: _Pose | None, base: _Pose | None, joint: _Pose | None) -> _Pose | None:
    """Return the pose of a joint in the axes of the base link."""
    if child is None or base is None or joint is None:
        return None
    back = tensors.transpose(base.turn)
    place = tensors.plus(child.place, tensors.apply(child.turn, joint.place))
    arm = tensors.apply(back, tensors.minus(place, base.place))
    return _Pose(arm, tensors.product(back, tensors.product(child.turn, joint.turn)))
