"""Scenes from other people's descriptions of bodies: URDF, SDF and MJCF.

tree         XML, without document types and of bounded size
attributes   numbers of such a file, or faults with their line
urdf, sdf, mjcf   the links of a file, and the inertia of one
link         the inertia of a link: mass, centre, tensor, added mass
gazebo       the plugins that act on a link
water        what water does to a link: added mass, drag, current, weight and buoyancy
thrusters, volumes   thrusters, and the volume that floats
scene_text   the text of a scene
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Final, NamedTuple

from taylor_verify.records.faults import Faults, Refused, cut
from taylor_verify.scenes.imported import mjcf, sdf, urdf
from taylor_verify.scenes.imported.attributes import Reading
from taylor_verify.scenes.imported.gazebo import surrounded
from taylor_verify.scenes.imported.link import Candidate, Format
from taylor_verify.scenes.imported.scene_text import scene_text
from taylor_verify.scenes.imported.tree import Node, read_document

_FORMATS: Final[Mapping[str, Format]] = {
    form.root: form for form in (urdf.FORMAT, sdf.FORMAT, mjcf.FORMAT)
}
_ROOTS: Final = ", ".join(f"{form.name} with <{form.root}>" for form in _FORMATS.values())
_OTHER_ROOTS: Final = {
    "mujocoinclude": "it is a part of an MJCF file: name the file that includes it",
    "gazebo": "it is older than SDF 1.2: `gz sdf -p FILE` converts it",
    "world": "put it into <sdf version='1.10'>",
    "model": "a model.config names its SDF file; name that one",
}


class Imported(NamedTuple):
    """The text of a scene, with the link and the format that it was made from, and what was left out."""

    text: str
    link: str
    form: str
    warnings: tuple[str, ...] = ()


def import_scene(path: Path, link: str | None = None) -> Imported:
    """Write a scene from a URDF, SDF or MJCF file.

    ``link`` names the link or body; it may be left out where one alone has an inertia. The start and
    the times of the scene are placeholders, and its comments say where each number came from. Raises
    Refused for a file that cannot be read, for no link or several, and with every fault of the link.
    """
    root = read_document(path)
    form = _format(root, path)
    reading = Reading(path.name, Faults())
    chosen = _chosen(form.candidates(root), link, form, path)
    assert chosen.inertial is not None
    parsed_link = form.link(root, chosen.name, chosen.inertial, reading)
    if parsed_link is not None:
        parsed_link = surrounded(parsed_link, root, reading)
    if parsed_link is None or reading.faults.lines:
        raise Refused(reading.faults.lines)
    text = scene_text(parsed_link, form.name, path.name)
    return Imported(text, parsed_link.name, form.name, parsed_link.water.left_out)


def _format(root: Node, path: Path) -> Format:
    """Return the format of the file by its root element."""
    if root.name == urdf.FORMAT.root and any(node.name.startswith("xacro:") for node in root.all()):
        line = f"expected a URDF file, got one that xacro has yet to expand @ {path}"
        raise Refused([f"{line} (write `xacro {path.name} > robot.urdf`, and name that file)"])
    form = _FORMATS.get(root.name)
    if form is None:
        mend = _OTHER_ROOTS.get(root.name, "")
        line = f"expected {_ROOTS}, got <{cut(root.name)}> @ {path}"
        raise Refused([f"{line} ({mend})" if mend else line])
    return form


def _chosen(candidates: list[Candidate], link: str | None, form: Format, path: Path) -> Candidate:
    """Return the link that is meant. Raises Refused, with the names of all, if it is none or several."""
    with_inertia = [candidate for candidate in candidates if candidate.inertial is not None]
    if link is None:
        meant, place = with_inertia, str(path)
    else:
        meant = [candidate for candidate in candidates if candidate.is_called(link)]
        place = f"--link of {path}"
    if len(meant) == 1 and meant[0].inertial is not None:
        return meant[0]
    expected, mend = f"a {form.link_word} with <inertial>", form.without_inertial
    if link is None and meant:
        expected, got, mend = f"--link with the name of one {form.link_word}", "none", _names(meant)
    elif link is None:
        got = f"{len(candidates)} without" if candidates else "none"
    elif len(meant) == 1:
        got = f"{cut(link)} without"
    else:
        expected, mend = (
            f"the name of one {form.link_word}",
            f"known: {_names(meant or with_inertia)}",
        )
        got = f"{cut(link)}, which is the name of {len(meant)}" if meant else cut(link)
    raise Refused([f"expected {expected}, got {got} @ {place} ({mend})"])


def _names(candidates: list[Candidate]) -> str:
    return ", ".join(candidate.name for candidate in candidates) or "none has <inertial>"
