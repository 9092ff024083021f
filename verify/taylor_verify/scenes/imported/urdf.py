"""URDF: the inertia of a link from <mass>, <origin> and <inertia>.

The tensor is about the centre of mass, in the axes of <origin>; ``ixy`` is a tensor component, -int xy dm;
``rpy`` are turns in radians about the fixed axes x, y, z (wiki.ros.org/urdf/XML/link).
"""

from __future__ import annotations

from fractions import Fraction
from typing import Final

from taylor_verify.numbers.tensors import ZERO_VECTOR
from taylor_verify.scenes import turns
from taylor_verify.scenes.imported.attributes import Reading
from taylor_verify.scenes.imported.link import Candidate, Format, Link
from taylor_verify.scenes.imported.tree import Node

COMPONENTS: Final = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")


def candidates(root: Node) -> list[Candidate]:
    """Return every link of a robot."""
    return [
        Candidate(node.attributes.get("name", ""), node.child("inertial"))
        for node in root.named("link")
    ]


def link(root: Node, name: str, inertial: Node, reading: Reading) -> Link | None:
    """Return the inertia of one link; None after a fault."""
    del root
    mass_node, tensor_node = (_part(inertial, part, reading) for part in ("mass", "inertia"))
    origin = inertial.child("origin") or Node("origin", {}, inertial.line)
    mass = mass_node and reading.positive(mass_node, mass_node.attributes.get("value"), "mass")
    tensor = tensor_node and reading.tensor(
        tensor_node,
        [reading.number(tensor_node, tensor_node.attributes.get(key), key) for key in COMPONENTS],
    )
    centre = reading.vector(origin, origin.attributes.get("xyz"), "xyz", default=ZERO_VECTOR)
    angles = reading.vector(origin, origin.attributes.get("rpy"), "rpy", default=ZERO_VECTOR)
    if not isinstance(mass, Fraction) or not isinstance(tensor, tuple) or not centre or not angles:
        return None
    inertia = turns.turned(tensor, turns.roll_pitch_yaw(angles))
    return Link(name, mass, centre, inertia, remarks=turns.remarks_on("rpy", angles))


def _part(inertial: Node, name: str, reading: Reading) -> Node | None:
    node = inertial.child(name)
    if node is None:
        reading.fault(f"<{name}>", "nothing", inertial)
    return node


FORMAT: Final = Format(
    name="URDF",
    root="robot",
    link_word="link",
    without_inertial="a link without <inertial> has no mass of its own",
    candidates=candidates,
    link=link,
)
