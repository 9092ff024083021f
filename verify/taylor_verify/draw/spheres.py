"""The directions of both impulses of a solid in a fluid, on the unit sphere in the body."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from taylor_verify.draw.caption import NotDrawn, captioned
from taylor_verify.draw.stage import START, Look, Stage
from taylor_verify.draw.view import Ellipsoid, Numbers, View
from taylor_verify.plotting.picture import Picture
from taylor_verify.plotting.sheet import Entry

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Document = Mapping[str, Any]

# In inches.
_HEIGHT: Final = 3.6
_STAGE: Final = 4.2
_SPHERE: Final = Ellipsoid((1.0, 1.0, 1.0))
_LINES: Final[Mapping[str, Look]] = {
    "x": {"color": "#0B5FA5", "linewidth": 1.8, "gid": "course"},
    "y": {"color": "#A83C00", "linewidth": 1.5, "dashes": (4, 1.4), "gid": "course"},
}
_NAMES: Final = {"x": "linear_impulse", "y": "angular_impulse"}
# An impulse below this part of its largest value has no direction.
_ZERO: Final = 1e-9


def directions_of(document: Document) -> dict[str, Numbers]:
    """Return the directions of x and y (n, 3) by letter, without an impulse that is zero at some time.

    Raises NotDrawn for a rigid body, and for a body without impulses.
    """
    if document["body"] is not None:
        raise NotDrawn(f"expected a solid in a fluid, got a rigid body @ {document['scene']}")
    directions = {}
    for letter, name in _NAMES.items():
        rows = np.array(document["course"][name])
        sizes = np.linalg.norm(rows, axis=1, keepdims=True)
        if sizes.min() > _ZERO * sizes.max():
            directions[letter] = rows / sizes
    if not directions:
        raise NotDrawn(f"expected impulses with a direction, got zero @ {document['scene']}")
    return directions


def picture(document: Document) -> Picture:
    """Return the spheres of one scene. Raises NotDrawn as `directions_of` does."""
    directions = directions_of(document)
    letters = " and ".join(directions)
    alt = f"Directions of the impulses {letters} of {document['scene']} in the body, on the unit sphere."
    return captioned(
        document, "spheres", "Impulses on the sphere", alt, partial(_figure, directions)
    )


def _figure(directions: Mapping[str, Numbers], words: str) -> Figure:
    mean = np.concatenate(list(directions.values())).mean(axis=0)
    side = mean if float(np.linalg.norm(mean)) > 0.05 else np.array([1.0, 0.7, 0.5])
    stage = Stage.around(_SPHERE, View.facing([float(v) for v in side]), _STAGE, _HEIGHT)
    entries: list[Entry] = []
    for letter, rows in directions.items():
        stage.line(rows, 3, _LINES[letter])
        stage.mark(rows[0], START, gid="start")
        entries.append((_LINES[letter], f"{letter}/|{letter}|, {_NAMES[letter].replace('_', ' ')}"))
    stage.name_axes(_SPHERE.semi_axes, ("1", "2", "3 (body)"))
    stage.legend([*entries, (START, "start")], f"Faint: on the far side. {words}", 2.9)
    return stage.figure
