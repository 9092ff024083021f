"""The kinds of pictures of a motion, by name, and those of them that a scene has."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from typing import Final

from taylor_verify.draw import axis_path, centre_path, components, polhode, spheres
from taylor_verify.draw.caption import Document, NotDrawn
from taylor_verify.plotting.picture import Picture

# In the order in which they are written.
KINDS: Final[Mapping[str, Callable[[Document], Picture]]] = {
    "polhode": polhode.picture,
    "time": components.picture,
    "axis": axis_path.picture,
    "spheres": spheres.picture,
    "path": centre_path.picture,
}


def pictures(document: Document, names: Sequence[str] = ()) -> dict[str, Picture]:
    """Return the pictures of these names, or all that the scene has.

    ``document`` is the motion (draw.drawn_course.motion); ``names`` are those of `draw --only`. Raises
    NotDrawn for unknown names and for pictures that the scene does not have, with all faults at once.
    """
    if not names:
        return dict(_all(document))
    pictures_by_name, faults = {}, []
    for name in names:
        try:
            if name not in KINDS:
                raise NotDrawn(f"expected a picture ({', '.join(KINDS)}), got {name!r} @ --only")
            pictures_by_name[name] = KINDS[name](document)
        except NotDrawn as fault:
            faults.append(str(fault))
    if faults:
        possible = ", ".join(name for name, _ in _all(document))
        raise NotDrawn("\n".join([*faults, f"{document['scene']} has these pictures: {possible}"]))
    return pictures_by_name


def _all(document: Document) -> Iterator[tuple[str, Picture]]:
    for name, make in KINDS.items():
        with suppress(NotDrawn):
            yield name, make(document)
