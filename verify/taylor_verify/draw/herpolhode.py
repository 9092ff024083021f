"""The herpolhode: the tip of omega in space, seen along the constant direction of the momentum H.

Without wheels and loads the tip stays in a plane across H, between two circles.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from typing import Any, Final

import numpy as np

from taylor_verify.draw.axis_path import momentum_of, upright
from taylor_verify.draw.caption import OMEGA, NotDrawn, captioned
from taylor_verify.draw.stage import CROSS, Look
from taylor_verify.draw.surface import SPHERE, Curve, Mark, Surface, figure
from taylor_verify.draw.view import Ellipsoid, View
from taylor_verify.plotting.palette import QUIET
from taylor_verify.plotting.picture import Picture
from taylor_verify.plotting.wording import plain

Document = Mapping[str, Any]

# The view straight down on the plane.
_ABOVE: Final = View(-90.0, 90.0)
_CIRCLE: Final[Look] = {"color": QUIET, "linewidth": 0.8, "dashes": (3, 2), "gid": "circle"}
# A curve that is smaller than this across H, in parts of omega, is a point.
_A_POINT: Final = 1e-7


def surface(document: Document) -> Surface:
    """Return the herpolhode of a free rigid body, with the radii that it stays between.

    Raises NotDrawn for any other scene, and if omega is along H.
    """
    course = document["course"]
    if document["body"] is None or not document["is_free"]:
        got = "a solid in a fluid" if document["body"] is None else "a torque"
        raise NotDrawn(f"expected a free rigid body, got {got} @ {document['scene']}")
    if document["rotor"] and document["damping"]:
        raise NotDrawn(f"expected H at rest in space, got damped wheels @ {document['scene']}")
    attitudes = np.array(course["attitude"]).reshape(-1, 3, 3)
    momentum, _ = momentum_of(document)
    omega = np.einsum("nij,nj->ni", attitudes, np.array(course["omega"]))
    tips = omega @ upright(attitudes[0] @ momentum[0]).T * [1, 1, 0]
    radii = np.linalg.norm(tips, axis=1)
    if not radii.max() > _A_POINT * np.abs(omega).max():
        raise NotDrawn(f"expected omega beside H, got a spin along H @ {document['scene']}")
    is_bounded = not document["damping"] and "period" in {r["name"] for r in document["analytic"]}
    bounds = [float(radii.min()), float(radii.max())] if is_bounded else []
    ring = Ellipsoid(SPHERE).circle(np.array([0.0, 0.0, 1.0]))
    return Surface(
        times=np.array(course["t"]),
        course=tips,
        letter=OMEGA,
        name=f"tip of {OMEGA} in space, seen along H",
        semi_axes=None,
        curves=tuple(Curve(r * ring, _CIRCLE, "least and greatest distance") for r in bounds),
        marks=(Mark(np.zeros(3), CROSS, "axis along H"),),
        view=_ABOVE,
    )


def picture(document: Document) -> Picture:
    """Return the herpolhode of one scene. Raises NotDrawn as `surface` does."""
    drawn = surface(document)
    radii = np.linalg.norm(drawn.course, axis=1)
    alt = (
        f"The tip of the angular velocity of {document['scene']} in space, seen along the angular "
        f"momentum: between {plain(float(radii.min()))} and {plain(float(radii.max()))} from its axis."
    )
    return captioned(document, "herpolhode", "Herpolhode", alt, partial(figure, drawn))
