"""The pictures that there are of a motion, by name: which of them a scene has, and what each shows."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from typing import Any, Final

from taylor_verify.draw import (
    axis_path,
    bifurcation,
    centre_path,
    components,
    herpolhode,
    momentum_sphere,
    polhode,
    spheres,
)
from taylor_verify.draw.caption import NotDrawn
from taylor_verify.publish.pictures.picture import Picture

Document = Mapping[str, Any]

# In the order in which they are written.
KINDS: Final[Mapping[str, Callable[[Document], Picture]]] = {
    "polhode": polhode.picture,
    "momentum": momentum_sphere.picture,
    "bifurcation": bifurcation.picture,
    "time": components.picture,
    "herpolhode": herpolhode.picture,
    "axis": axis_path.picture,
    "spheres": spheres.picture,
    "path": centre_path.picture,
}


def pictures(document: Document, names: Sequence[str] = ()) -> dict[str, Picture]:
    """Return the pictures of these names, or all that the scene has.

    ``document`` is the motion (draw.course.motion); ``names`` are those of `draw --only`. Raises NotDrawn
    for a name that is none, and for one that the scene has not, all of them at once.
    """
    if not names:
        return dict(_all(document))
    found, faults = {}, []
    for name in names:
        try:
            if name not in KINDS:
                raise NotDrawn(f"expected a picture ({', '.join(KINDS)}), got {name!r} @ --only")
            found[name] = KINDS[name](document)
        except NotDrawn as fault:
            faults.append(str(fault))
    if faults:
        raise NotDrawn("\n".join(faults))
    return found


def _all(document: Document) -> Iterator[tuple[str, Picture]]:
    for name, make in KINDS.items():
        with suppress(NotDrawn):
            yield name, make(document)
