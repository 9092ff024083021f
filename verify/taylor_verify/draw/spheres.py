"""The directions of both impulses of a solid in a fluid, in the body, on the unit sphere."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from typing import Any, Final

import numpy as np

from taylor_verify.draw.caption import NotDrawn, captioned
from taylor_verify.draw.stage import Look
from taylor_verify.draw.surface import Curve, Surface, figure
from taylor_verify.draw.view import Numbers
from taylor_verify.plotting.picture import Picture

Document = Mapping[str, Any]

_SECOND: Final[Look] = {"color": "#A83C00", "linewidth": 1.5, "dashes": (4, 1.4), "gid": "course"}
_NAMES: Final = {"x": "linear_impulse", "y": "angular_impulse"}
# An impulse below this part of its largest value has no direction.
_ZERO: Final = 1e-9


def surface(document: Document) -> Surface:
    """Return the directions of x and y, without an impulse that is zero at some time.

    Raises NotDrawn for a rigid body, and for a body without impulses.
    """
    if document["body"] is not None:
        raise NotDrawn(f"expected a solid in a fluid, got a rigid body @ {document['scene']}")
    directions = _directions(document["course"])
    if not directions:
        raise NotDrawn(f"expected impulses with a direction, got zero @ {document['scene']}")
    (letter, first), *others = directions.items()
    return Surface(
        times=np.array(document["course"]["t"]),
        course=first,
        letter=letter,
        name=f"direction of {letter} in the body",
        curves=tuple(Curve(rows, _SECOND, f"direction of {name}") for name, rows in others),
    )


def _directions(course: Mapping[str, Any]) -> dict[str, Numbers]:
    directions = {}
    for letter, name in _NAMES.items():
        rows = np.array(course[name])
        sizes = np.linalg.norm(rows, axis=1, keepdims=True)
        if sizes.min() > _ZERO * sizes.max():
            directions[letter] = rows / sizes
    return directions


def picture(document: Document) -> Picture:
    """Return the sphere of one scene. Raises NotDrawn as `surface` does."""
    drawn = surface(document)
    letters = " and ".join([drawn.letter, *("y" for _ in drawn.curves)])
    alt = f"Directions of the impulses {letters} of {document['scene']} in the body, on the unit sphere."
    return captioned(document, "spheres", "Impulses on the sphere", alt, partial(figure, drawn))
