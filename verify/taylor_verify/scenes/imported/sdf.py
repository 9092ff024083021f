"""SDF: the inertia of a link from <mass>, <pose>, <inertia> and <fluid_added_mass>.

The tensor is about the centre of mass, in the axes of <pose>; ``ixy`` is a tensor component, -int xy dm.
The added mass is about the origin of the link and in its axes, its rows x, y, z, p, q, r: the linear ones
first (sdformat, sdf/1.10/inertial.sdf).
"""

from __future__ import annotations

from fractions import Fraction
from itertools import combinations_with_replacement
from typing import Final

from taylor_verify.numbers import tensors
from taylor_verify.numbers.tensors import ZERO_VECTOR, Matrix, Vector
from taylor_verify.records.faults import cut, near, shown
from taylor_verify.scenes import turns
from taylor_verify.scenes.imported.attributes import Reading, is_true
from taylor_verify.scenes.imported.link import Candidate, Format, Link
from taylor_verify.scenes.imported.tree import Node, scoped
from taylor_verify.scenes.imported.urdf import COMPONENTS
from taylor_verify.scenes.motion import IDENTITY, Quaternion

_ROWS: Final = "xyzpqr"
_ADDED: Final = {
    f"{_ROWS[i]}{_ROWS[k]}": (i, k) for i, k in combinations_with_replacement(range(6), 2)
}
_ZERO: Final = Fraction(0)
# The products may be left out.
_DEFAULTS: Final = {"ixy": _ZERO, "ixz": _ZERO, "iyz": _ZERO}


def candidates(root: Node) -> list[Candidate]:
    """Return every link of every model, as ``model::link``."""
    links = (item for item in scoped(root) if item.node.name == "link")
    return [Candidate(item.name, item.node.child("inertial")) for item in links]


def link(root: Node, name: str, inertial: Node, reading: Reading) -> Link | None:
    """Return the inertia of one link; None after a fault."""
    del root
    if is_true(inertial.attributes.get("auto")):
        mend = "write <mass> and <inertia>: geometry is not read"
        reading.fault("an inertia that the file writes", 'auto="true"', inertial, mend)
        return None
    mass_node = inertial.child("mass")
    mass = reading.positive(mass_node or inertial, mass_node.text if mass_node else None, "mass")
    tensor = _tensor(inertial, reading)
    placed = _pose(inertial, reading)
    added_node = inertial.child("fluid_added_mass")
    added = None if added_node is None else _added_mass(added_node, reading)
    if mass is None or tensor is None or placed is None or (added_node and added is None):
        return None
    centre, turn, remarks = placed
    result = Link(name, mass, centre, turns.turned(tensor, turn), added, remarks)
    if added_node and not tensors.is_positive_definite(result.mass_matrix):
        expected = "a positive definite mass matrix of link and added mass"
        mend = "an added mass is minus a naval derivative"
        reading.fault(expected, "one that is not", added_node, mend)
        return None
    return result


def _tensor(inertial: Node, reading: Reading) -> Matrix | None:
    node = inertial.child("inertia")
    if node is None:
        reading.fault("<inertia>", "nothing", inertial)
        return None
    six = []
    for key in COMPONENTS:
        child = node.child(key)
        text = None if child is None else child.text
        six.append(reading.number(child or node, text, key, _DEFAULTS.get(key)))
    return reading.tensor(node, six)


def _pose(inertial: Node, reading: Reading) -> tuple[Vector, Quaternion, tuple[str, ...]] | None:
    """Return the centre of mass, the turn of the tensor's axes, and remarks on it; None after a fault."""
    node = inertial.child("pose")
    if node is None or not node.text.strip():
        return ZERO_VECTOR, IDENTITY, ()
    for key in ("relative_to", "frame"):
        if node.attributes.get(key, "").strip():
            got = f"{key} = {shown(node.attributes[key])}"
            reading.fault("a pose relative to the link", got, node, "frames are not resolved")
            return None
    form = node.attributes.get("rotation_format", "euler_rpy").strip()
    if form == "quat_xyzw":
        seven = reading.vector(node, node.text, "x y z and the quaternion x y z w", length=7)
        if seven is None:
            return None
        if not any(seven[3:]):
            reading.fault("a quaternion that is not zero", "0 0 0 0", node)
            return None
        x, y, z, w = seven[3:]
        return seven[:3], (w, x, y, z), ()
    if form != "euler_rpy":
        reading.fault("rotation_format euler_rpy or quat_xyzw", shown(form), node)
        return None
    degrees = is_true(node.attributes.get("degrees"))
    six = reading.vector(node, node.text, "x y z roll pitch yaw", length=6)
    if six is None:
        return None
    turn = turns.roll_pitch_yaw(six[3:], degrees)
    return six[:3], turn, turns.remarks_on("roll, pitch, yaw", six[3:], degrees)


def _added_mass(node: Node, reading: Reading) -> Matrix | None:
    """Return the 6x6 matrix; each missing one of its 21 elements is zero. None after a fault."""
    rows = [[_ZERO] * 6 for _ in range(6)]
    is_sound = True
    for child in node.children:
        number = None
        if child.name in _ADDED:
            number = reading.number(child, child.text, child.name)
        else:
            got = f"<{cut(child.name)}>"
            reading.fault("an element xx, xy, ... rr", got, child, near(cut(child.name), _ADDED))
        if number is None:
            is_sound = False
        else:
            i, k = _ADDED[child.name]
            rows[i][k] = rows[k][i] = number
    return tuple(map(tuple, rows)) if is_sound else None


FORMAT: Final = Format(
    name="SDF",
    root="sdf",
    link_word="link",
    without_inertial="write <inertial>; models that <include> names are not opened",
    candidates=candidates,
    link=link,
)
