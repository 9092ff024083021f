"""The polhode: the angular velocity on the ellipsoid of inertia.

T is conserved, so omega stays on the surface omega.I omega = 2T, whose semi-axes along the principal axes
are sqrt(2T/J_i). With damping omega sinks below the surface of the start.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from math import sqrt
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from taylor_verify.draw.caption import NotDrawn, captioned
from taylor_verify.draw.stage import END, START, Look, Stage, scale
from taylor_verify.draw.view import Ellipsoid, Numbers, View
from taylor_verify.plotting.picture import Picture
from taylor_verify.plotting.sheet import Entry
from taylor_verify.plotting.wording import plain

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Document = Mapping[str, Any]

# In inches.
_HEIGHT: Final = 3.5
_STAGE: Final = 4.2
_BORDER: Final[Look] = {
    "color": "#8A5A00",
    "linewidth": 0.8,
    "dashes": (4, 2),
    "gid": "separatrix",
}
# Beyond this squared distance a course has left the surface; below it is the rounding of nine digits.
_OFF: Final = 1e-6
_WIDTH: Final = 2.0
_OMEGA: Final = "\N{GREEK SMALL LETTER OMEGA}"
# The axis that the curve goes round faces the reader; the two others are seen from the side.
_FACING: Final = (1.0, 0.55, 0.45)


@dataclass(frozen=True)
class Series:
    """The curve in principal axes, one row a time.

    ``separatrices`` are the curves through the middle axis; none where two moments are equal.
    """

    semi_axes: tuple[float, float, float]
    course: Numbers
    separatrices: tuple[Numbers, ...]

    @property
    def sinks(self) -> bool:
        """True if the course leaves the surface: damping takes energy from the body, or adds some."""
        q = np.square(self.course / np.array(self.semi_axes)).sum(axis=1)
        return bool(np.abs(q - 1).max() > _OFF)


def series(portrait: Document) -> Series:
    """Return the curve.

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
    return Series((a, b, c), own, tuple(_separatrices(Ellipsoid((a, b, c)), moments)))


def picture(portrait: Document) -> Picture:
    """Return the polhode of one scene. Raises NotDrawn as `series` does."""
    curve = series(portrait)
    alt = (
        f"The angular velocity of {portrait['scene']} on its ellipsoid of inertia, whose semi-axes are "
        f"{', '.join(plain(a) for a in curve.semi_axes)}: "
    )
    words = {0: "the exact course.", 1: "it sinks below it.", -1: "it rises above it."}
    alt += words[int(np.sign(portrait["damping"]))]
    return captioned(portrait, "polhode", "Polhode", alt, partial(_figure, curve))


def _separatrices(surface: Ellipsoid, moments: Numbers) -> list[Numbers]:
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
    return [surface.circle(pole) for pole in poles]


def facing(course: Numbers, semi_axes: Sequence[float]) -> View:
    """Return the view in which the curve, and the axis that it goes round, face the reader."""
    q = course / np.array(semi_axes)
    mean = q.mean(axis=0)
    order = np.argsort(-np.abs(mean))
    direction = np.zeros(3)
    for weight, i in zip(_FACING, order, strict=True):
        direction[i] = weight if mean[i] >= 0 else -weight
    # Where the curve has no upper side, the view is from above.
    if order[0] != 2:
        direction[2] = abs(direction[2])
    return View.facing([float(v) for v in direction])


def _figure(curve: Series, words: str) -> Figure:
    """Draw the course, darker as time goes on, with its start and its end."""
    stage = _stage(curve)
    # The surface does not hide a curve that has sunk below it.
    over = replace(stage, surface=None) if curve.sinks else stage
    over.course(curve.course, _WIDTH, 3)
    for point, look, name in ((curve.course[0], START, "start"), (curve.course[-1], END, "end")):
        over.mark(point, look, gid=name)
    entries: list[Entry] = [
        ({"color": scale()(0.6), "linewidth": _WIDTH}, f"{_OMEGA}, darker with time")
    ]
    entries += [(START, "start"), (END, "end")]
    entries += [(_BORDER, "separatrices")] if curve.separatrices else []
    stage.legend(entries, f"Faint: on the far side. {words}", 3.2)
    return stage.figure


def _stage(curve: Series) -> Stage:
    """Return the ellipsoid with its separatrices and the names of its axes."""
    view = facing(curve.course, curve.semi_axes)
    stage = Stage.around(Ellipsoid(curve.semi_axes), view, _STAGE, _HEIGHT, curve.course)
    for separatrix in curve.separatrices:
        stage.line(separatrix, 2, _BORDER)
    axes = zip(
        "\N{SUBSCRIPT ONE}\N{SUBSCRIPT TWO}\N{SUBSCRIPT THREE}", curve.semi_axes, strict=True
    )
    names = [f"{_OMEGA}{subscript} = {semi_axis:.3g}" for subscript, semi_axis in axes]
    stage.name_axes(curve.semi_axes, names)
    return stage
