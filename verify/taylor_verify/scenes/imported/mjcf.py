"""MJCF: the inertia of a body from <inertial>.

``fullinertia`` is M(1,1), M(2,2), M(3,3), M(1,2), M(1,3), M(2,3): tensor components about the centre of
mass, in the axes of the body. ``diaginertia`` is in the axes of the inertial frame, which quat, euler or
axisangle turns. A quaternion has its scalar first. Angles are in degrees unless <compiler angle> says
radian. A small letter of ``eulerseq`` turns about a moving axis, a capital about a fixed one. (MuJoCo, XML
reference.)
"""

from __future__ import annotations

from collections import ChainMap
from collections.abc import Iterator
from typing import Final

from taylor_verify.numbers.tensors import ZERO_VECTOR, Matrix, Vector
from taylor_verify.records.faults import cut, shown
from taylor_verify.scenes import turns
from taylor_verify.scenes.imported.attributes import Reading
from taylor_verify.scenes.imported.link import Candidate, Format, Link
from taylor_verify.scenes.imported.tree import Node
from taylor_verify.scenes.imported.water import Water
from taylor_verify.scenes.motion import IDENTITY, Quaternion

# Elements that hold bodies without being one.
_AROUND: Final = ("worldbody", "frame", "replicate")
_TURNS: Final = ("quat", "euler", "axisangle", "xyaxes", "zaxis")
# The number of numbers of each orientation that is read.
_LENGTHS: Final = {"quat": 4, "euler": 3, "axisangle": 4}
_BY_QUATERNION: Final = (
    "The tensor was turned by quat, exactly: MuJoCo divides it by its length, and so does this."
)
_AXES: Final = dict(zip("xyz", turns.AXES, strict=True))
_ORDER: Final = ("M(1,1)", "M(2,2)", "M(3,3)", "M(1,2)", "M(1,3)", "M(2,3)")

_Turn = tuple[Quaternion, tuple[str, ...]]


def candidates(root: Node) -> list[Candidate]:
    """Return every body, in the order of the file; one without a name is ``#`` and its number."""
    bodies = [body for part in root.named("worldbody") for body in _below(part)]
    return [
        Candidate(body.attributes.get("name", f"#{number}"), body.child("inertial"))
        for number, body in enumerate(bodies, 1)
    ]


def _below(part: Node) -> Iterator[Node]:
    for node in part.named("body", *_AROUND):
        if node.name == "body":
            yield node
        yield from _below(node)


def link(root: Node, name: str, inertial: Node, reading: Reading) -> Link | None:
    """Return the inertia of one body; None after a fault."""
    # Of several <compiler> the last one counts.
    settings = dict(ChainMap(*(node.attributes for node in reversed(root.named("compiler")))))
    is_valid = _takes_inertial(root, settings, reading)
    mass = reading.positive(inertial, inertial.attributes.get("mass"), "mass")
    centre = reading.vector(inertial, inertial.attributes.get("pos"), "pos")
    tensor = _tensor(inertial, reading)
    turn = _turn(inertial, settings, reading)
    if not is_valid or mass is None or centre is None or tensor is None or turn is None:
        return None
    inertia, left_out = turns.turned(tensor, turn[0]), tuple(_fluid(root))
    return Link(name, mass, centre, inertia, remarks=turn[1], water=Water(left_out=left_out))


def _fluid(root: Node) -> Iterator[str]:
    """Yield what MuJoCo's fluid is, which acts on bodies there and not in the scene."""
    for node in root.named("option"):
        for key in ("density", "viscosity", "wind"):
            if any(word.strip("0.+-e") for word in node.attributes.get(key, "").split()):
                yield (
                    f'MuJoCo\'s {key} = "{cut(node.attributes[key])}" acts on the body there: write it as '
                    "text in `moment`, or take model kirchhoff with `force` and `couple`"
                )
    everything = [*root.all()]
    dampings = (n.attributes.get("damping", "0") for n in everything if "joint" in n.name)
    if any(damping != "0" for damping in dampings):
        yield "the damping of joints is left out: write `damping`"
    if any(node.children for node in root.named("actuator")):
        yield "actuators are left out: write what they do as text in `moment`, or in `force` and `couple`"
    shapes = {n.attributes.get("fluidshape") for n in everything if n.name == "geom"}
    if "ellipsoid" in shapes:
        yield (
            'MuJoCo\'s fluidshape = "ellipsoid" gives geoms an added mass and drag: model kirchhoff '
            "takes an added mass as `added_mass` beside `mass` and `inertia`"
        )


def _takes_inertial(root: Node, settings: dict[str, str], reading: Reading) -> bool:
    """Return True if MuJoCo uses <inertial> as it is written; a setting that changes it is a fault."""
    ignored = {
        "inertiafromgeom": settings.get("inertiafromgeom", "auto") == "true",
        "settotalmass": not settings.get("settotalmass", "-1").strip().startswith("-"),
        "coordinate": settings.get("coordinate", "local") == "global",
    }
    for key in (key for key, is_set in ignored.items() if is_set):
        expected = "<inertial> to hold as it is written"
        got = f'{key}="{settings[key]}", which changes it'
        reading.fault(expected, got, root.named("compiler")[-1])
    return not any(ignored.values())


def _tensor(inertial: Node, reading: Reading) -> Matrix | None:
    written = inertial.attributes
    diagonal, full = written.get("diaginertia"), written.get("fullinertia")
    if (diagonal is None) == (full is None):
        got = "none of them" if full is None else "both"
        reading.fault("one of diaginertia and fullinertia", got, inertial)
        return None
    if full is None:
        three = reading.vector(inertial, diagonal, "diaginertia")
        six = None if three is None else (*three, *ZERO_VECTOR)
    else:
        six = reading.vector(inertial, full, f"fullinertia ({' '.join(_ORDER)})", length=6)
    if six is None:
        return None
    xx, yy, zz, xy, xz, yz = six
    return reading.tensor(inertial, [xx, xy, xz, yy, yz, zz])


def _turn(inertial: Node, settings: dict[str, str], reading: Reading) -> _Turn | None:
    """Return the turn of the inertial frame, and remarks on it; None after a fault."""
    written = [key for key in _TURNS if key in inertial.attributes]
    if not written:
        return IDENTITY, ()
    got = " and ".join(written)
    if "fullinertia" in inertial.attributes:
        reading.fault("no orientation beside fullinertia, as MuJoCo has it", got, inertial)
        return None
    if len(written) > 1:
        reading.fault("one orientation", got, inertial)
        return None
    (key,) = written
    if key not in _LENGTHS:
        mend = "write the same orientation as quat"
        reading.fault("quat, euler or axisangle", key, inertial, mend)
        return None
    numbers = reading.vector(inertial, inertial.attributes[key], key, length=_LENGTHS[key])
    if numbers is None:
        return None
    degrees = settings.get("angle", "degree") == "degree"
    if key == "euler":
        return _euler(inertial, numbers, settings.get("eulerseq", "xyz"), degrees, reading)
    if key == "quat":
        if not any(numbers):
            text = inertial.attributes[key]
            reading.fault("a quaternion that is not zero", shown(text), inertial)
            return None
        w, x, y, z = numbers
        return (w, x, y, z), (_BY_QUATERNION,)
    axis, angle = numbers[:3], numbers[3]
    if not any(axis):
        reading.fault("an axis that is not zero", "0 0 0", inertial)
        return None
    turn = turns.Turn(axis, angle, degrees)
    return turns.combined([turn]), turns.remarks_on("axisangle, by", (angle,), degrees)


def _euler(
    inertial: Node, angles: Vector, sequence: str, degrees: bool, reading: Reading
) -> _Turn | None:
    if len(sequence) != 3 or not set(sequence.lower()) <= set(_AXES):
        reading.fault("three letters of x y z X Y Z for eulerseq", shown(sequence), inertial)
        return None
    each: list[turns.Turn] = []
    for letter, angle in zip(sequence, angles, strict=True):
        turn = turns.Turn(_AXES[letter.lower()], angle, degrees)
        each.insert(len(each) if letter.islower() else 0, turn)
    name = f"euler (eulerseq {sequence})"
    return turns.combined(each), turns.remarks_on(name, angles, degrees)


FORMAT: Final = Format(
    name="MJCF",
    root="mujoco",
    link_word="body",
    without_inertial="write <inertial>: geoms are not read, nor files that <include> names; MuJoCo has the "
    "numbers of the compiled model as body_mass, body_ipos, body_iquat and body_inertia",
    candidates=candidates,
    link=link,
)
