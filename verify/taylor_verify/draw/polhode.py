"""The polhode: the angular velocity on the ellipsoid of inertia.

T is conserved, so omega stays on the surface omega.I omega = 2T, whose semi-axes along the principal axes
are sqrt(2T/J_i). With damping omega sinks below the surface of the start.
"""

from __future__ import annotations

from functools import partial
from math import sqrt
from typing import Final

import numpy as np

from taylor_verify.draw.caption import OMEGA, SUBSCRIPTS, Document, NotDrawn, captioned
from taylor_verify.draw.stage import Look
from taylor_verify.draw.surface import Part, Surface, figure
from taylor_verify.draw.view import Ellipsoid, Numbers
from taylor_verify.plotting.picture import Picture
from taylor_verify.plotting.wording import plain

_BORDER: Final[Look] = {
    "color": "#8A5A00",
    "linewidth": 0.8,
    "dashes": (4, 2),
    "gid": "separatrix",
}
_WORDS: Final = {0: "the exact course.", 1: "it sinks below it.", -1: "it rises above it."}


def surface(portrait: Document) -> Surface:
    """Return the curve in principal axes, and the separatrices where no two moments are equal.

    Raises NotDrawn for a scene without such a surface: a solid in a fluid, a torque, wheels, rest.
    """
    body, course = portrait["body"], portrait["course"]
    is_free = any(row["name"] == "T" for row in portrait["analytic"])
    if body is None or "omega" not in course or not is_free:
        got = "a solid in a fluid" if body is None else "a motion without a constant energy"
        raise NotDrawn(f"expected a free rigid body, got {got} @ {portrait['scene']}")
    if portrait["rotor"]:
        raise NotDrawn(f"expected a body without wheels, got a rotor @ {portrait['scene']}")
    axes, moments = np.array(body["axes"]), np.array(body["principal_moments"])
    own = np.array(course["omega"]) @ axes.T
    twice = float(moments @ np.square(own[0]))
    if not twice > 0:
        raise NotDrawn(f"expected a body that turns, got one at rest @ {portrait['scene']}")
    a, b, c = (sqrt(twice / moment) for moment in moments)
    return Surface(
        times=np.array(course["t"]),
        course=own,
        letter=OMEGA,
        name=f"polhode: {OMEGA} in the body",
        semi_axes=(a, b, c),
        axes=tuple(f"{OMEGA}{s} = {v:.3g}" for s, v in zip(SUBSCRIPTS, (a, b, c), strict=True)),
        curves=tuple(
            Part(section, _BORDER, "separatrices") for section in _separatrices((a, b, c), moments)
        ),
    )


def picture(portrait: Document) -> Picture:
    """Return the polhode of one scene. Raises NotDrawn as `surface` does."""
    drawn = surface(portrait)
    alt = (
        f"The angular velocity of {portrait['scene']} on its ellipsoid of inertia, whose semi-axes are "
        f"{', '.join(plain(a) for a in drawn.semi_axes)}: "
        f"{_WORDS[int(np.sign(portrait['damping']))]}"
    )
    return captioned(portrait, "polhode", "Polhode", alt, partial(figure, drawn))


def _separatrices(semi_axes: tuple[float, float, float], moments: Numbers) -> list[Numbers]:
    """Return the two plane sections through the middle axis on which H^2 = 2T J2.

    With the moments J1 > J2 > J3 there J1 (J1 - J2) omega_1^2 = J3 (J2 - J3) omega_3^2. In units of the
    semi-axes this is (J1 - J2) q_1^2 = (J2 - J3) q_3^2.
    """
    low, middle, high = np.argsort(moments)
    lower, upper = moments[middle] - moments[low], moments[high] - moments[middle]
    if not min(lower, upper) > 1e-9 * moments[high]:
        return []
    poles = np.zeros((2, 3))
    poles[:, high], poles[:, low] = sqrt(upper), [sqrt(lower), -sqrt(lower)]
    return [Ellipsoid(semi_axes).circle(pole) for pole in poles]
