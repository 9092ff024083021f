"""The directions in the body of H of a rigid body, or of both impulses of a solid, on the unit sphere."""

from __future__ import annotations

from functools import partial
from typing import Final

import numpy as np

from taylor_verify.draw.axis_path import momentum_of
from taylor_verify.draw.caption import Document, NotDrawn, captioned
from taylor_verify.draw.stage import Look
from taylor_verify.draw.surface import Part, Surface, figure
from taylor_verify.draw.view import Numbers
from taylor_verify.plotting.picture import Picture

_SECOND: Final[Look] = {"color": "#A83C00", "linewidth": 1.5, "dashes": (4, 1.4), "gid": "course"}
_NAMES: Final = {"x": "linear_impulse", "y": "angular_impulse"}
# A vector below this part of its largest value has no direction.
_ZERO: Final = 1e-9


def surface(document: Document) -> Surface:
    """Return the directions of H, or of x and y, without a vector that is zero at some time.

    Raises NotDrawn for a rigid body under loads, and for a body without momentum.
    """
    if document["body"] is not None and not document["is_free"]:
        raise NotDrawn(f"expected a body without loads, got a torque @ {document['scene']}")
    directions = _directions(document)
    if not directions:
        raise NotDrawn(f"expected a momentum with a direction, got zero @ {document['scene']}")
    (letter, first), *others = directions.items()
    return Surface(
        times=np.array(document["course"]["t"]),
        course=first,
        letter=letter,
        name=f"direction of {letter} in the body",
        curves=tuple(Part(rows, _SECOND, f"direction of {name}") for name, rows in others),
    )


def _directions(document: Document) -> dict[str, Numbers]:
    course, directions = document["course"], {}
    vectors = {letter: np.array(course[name]) for letter, name in _NAMES.items() if name in course}
    if document["body"] is not None:
        vectors = {"H": momentum_of(document)[0]}
    # Where wheels cancel the momentum of the body, only the rounding of the digits is left.
    wheels = float(np.linalg.norm(document["rotor"] or [0.0]))
    for letter, rows in vectors.items():
        sizes = np.linalg.norm(rows, axis=1, keepdims=True)
        if sizes.min() > _ZERO * max(sizes.max(), wheels):
            unit = rows / sizes
            # A vector that turns round from one time to the next was zero between.
            if np.all(np.sum(unit[1:] * unit[:-1], axis=1) > 0):
                directions[letter] = unit
    return directions


def picture(document: Document) -> Picture:
    """Return the sphere of one scene. Raises NotDrawn as `surface` does."""
    drawn = surface(document)
    letters = " and ".join([drawn.letter, *("y" for _ in drawn.curves)])
    alt = f"Directions of {letters} of {document['scene']} in the body, on the unit sphere."
    return captioned(document, "spheres", "Momenta on the sphere", alt, partial(figure, drawn))
