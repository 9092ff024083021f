"""A motion to be animated: the body in space, a curve in the body, and components against time.

Space is turned so that a constant H points upwards. The course is the exact one of the other pictures:
between two rows the body turns by a tenth of a radian, or by more if it turns very often.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, Final

import numpy as np

from taylor_verify.draw import components, mesh, polhode, spheres
from taylor_verify.draw.axis_path import momentum_of
from taylor_verify.draw.caption import NotDrawn, caption
from taylor_verify.draw.mesh import Mesh
from taylor_verify.draw.momentum_sphere import level_lines
from taylor_verify.draw.momentum_sphere import series as sphere_of
from taylor_verify.draw.view import Numbers

Document = Mapping[str, Any]

# Seconds for a turn, so that the eye can follow.
_TURN: Final = 2.4
# Limits of the whole animation, in seconds.
_SHORTEST, _LONGEST = 6.0, 40.0
# The length of the axes of a body without a shape, in parts of its path.
_FRAME: Final = 0.09
# A direction or an attitude that changes by less than this is constant.
_STILL: Final = 1e-6
# Beyond this squared distance, in units of the semi-axes, a course has left the surface.
_OFF: Final = 1e-6
OMEGA: Final = "\N{GREEK SMALL LETTER OMEGA}"


@dataclass(frozen=True)
class Inset:
    """A curve in the body on its ellipsoid, with other curves on it; ``letter`` names the axes."""

    semi_axes: tuple[float, float, float]
    course: Numbers
    curves: tuple[Numbers, ...]
    letter: str
    name: str

    @property
    def sinks(self) -> bool:
        """True if the course leaves the surface, as damping lets it."""
        inside = np.square(self.course / np.array(self.semi_axes)).sum(axis=1)
        return bool(np.abs(inside - 1).max() > _OFF)


@dataclass(frozen=True)
class Moving:
    """Data of an animation at its times (n,): attitudes (n, 3, 3), and centres (n, 3) or None, in space.

    ``rows`` (n, 3) are the components against time, with their ``letter`` and ``heading``; ``flips`` are
    times. ``arrow`` is True if H points upwards. The animation plays for so many ``seconds``.
    """

    title: str
    alt: str
    caption: str
    times: Numbers
    attitudes: Numbers
    centres: Numbers | None
    body: Mesh
    arrow: bool
    inset: Inset | None
    rows: Numbers
    letter: str
    heading: str
    flips: tuple[float, ...]
    seconds: float

    @property
    def middle(self) -> Numbers:
        """The point in the middle of the picture."""
        if self.centres is None:
            return np.zeros(3)
        return np.asarray((self.centres.min(axis=0) + self.centres.max(axis=0)) / 2)

    @property
    def reach(self) -> float:
        """The largest distance of anything from the middle, at any time."""
        if self.centres is None:
            return max(self.body.reach, 1.0)
        away = np.linalg.norm(self.centres - self.middle, axis=1)
        return float(away.max()) + self.body.reach

    def until(self, part: float) -> Moving:
        """Return the beginning of the motion; ``part`` is its share of the whole, from 0 to 1."""
        last = max(2, round(part * (len(self.times) - 1)) + 1)
        inset = self.inset and replace(self.inset, course=self.inset.course[:last])
        elapsed = abs(self.times[last - 1] - self.times[0])
        return replace(
            self,
            times=self.times[:last],
            attitudes=self.attitudes[:last],
            centres=None if self.centres is None else self.centres[:last],
            inset=inset,
            rows=self.rows[:last],
            flips=tuple(t for t in self.flips if abs(t - self.times[0]) <= elapsed),
            seconds=self.seconds * part,
        )


def moving(document: Document) -> Moving:
    """Return the animation of a motion; ``document`` is that of draw.course.motion.

    Raises NotDrawn for a body that does not move.
    """
    course = document["course"]
    attitudes = np.array(course["attitude"]).reshape(-1, 3, 3)
    centres = np.array(course["centre"]) if "centre" in course else None
    is_moving = np.ptp(attitudes, axis=0).max() > _STILL or (
        centres is not None and np.ptp(centres, axis=0).max() > 0
    )
    if not is_moving:
        raise NotDrawn(f"expected a motion to animate, got a body at rest @ {document['scene']}")
    upright = _upright(document, attitudes)
    parts = components.series(document)
    panel = parts.panels[0]
    times = course["t"]
    body = _body(document, centres)
    return Moving(
        title=document["title"],
        alt=f"{document['scene']} from t = {times[0]:g} to t = {times[-1]:g}, moving: {body.name}.",
        caption=caption(document),
        times=np.array(times),
        attitudes=attitudes if upright is None else upright @ attitudes,
        centres=centres,
        body=body,
        arrow=upright is not None,
        inset=_inset(document),
        rows=panel.rows,
        letter=panel.letter,
        heading=panel.name,
        flips=parts.flips,
        seconds=_seconds(attitudes),
    )


def _upright(document: Document, attitudes: Numbers) -> Numbers | None:
    """Return the rotation of space that makes H point upwards; None if H has no constant direction."""
    if document["body"] is None:
        return None
    momentum, _ = momentum_of(document)
    in_space = np.einsum("nij,nj->ni", attitudes, momentum)
    sizes = np.linalg.norm(in_space, axis=1, keepdims=True)
    if not sizes.min() > 0 or np.abs(in_space / sizes - in_space[0] / sizes[0]).max() > _STILL:
        return None
    up = in_space[0] / sizes[0]
    first = np.eye(3)[int(np.abs(up).argmin())]
    first = first - (first @ up) * up
    first /= np.linalg.norm(first)
    return np.array([first, np.cross(up, first), up])


def _body(document: Document, centres: Numbers | None) -> Mesh:
    body, shape = document["body"], document["semi_axes"]
    if body is not None:
        return mesh.rigid(np.array(body["principal_moments"]), np.array(body["axes"]))
    if shape is not None:
        return mesh.ellipsoid(shape)
    extent = 0.0 if centres is None else float(np.ptp(centres, axis=0).max())
    return mesh.frame(_FRAME * extent or 1.0)


def _inset(document: Document) -> Inset | None:
    """Return the curve in the body: the polhode, H of a body with wheels, or the linear impulse."""
    if document["body"] is None:
        try:
            directions = spheres.series(document).directions
        except NotDrawn:
            return None
        letter, rows = next(iter(directions.items()))
        return Inset((1.0, 1.0, 1.0), rows, (), letter, f"direction of {letter} in the body")
    try:
        curve = polhode.series(document)
        name = f"polhode: {OMEGA} in the body"
        return Inset(curve.semi_axes, curve.course, curve.separatrices, OMEGA, name)
    except NotDrawn:
        pass
    try:
        sphere = sphere_of(document)
    except NotDrawn:
        return None
    lines = level_lines(sphere.wheels, sphere.size, sphere.saddles)
    curves = tuple(line for level in lines for line in level)
    return Inset((sphere.size,) * 3, sphere.course, curves, "H", "H in the body, on its sphere")


def _seconds(attitudes: Numbers) -> float:
    """Return how long the motion plays, so that the eye can follow each turn."""
    cosines = (np.einsum("nij,nij->n", attitudes[1:], attitudes[:-1]) - 1) / 2
    turns = float(np.arccos(np.clip(cosines, -1, 1)).sum()) / (2 * np.pi)
    return min(max(_TURN * turns, _SHORTEST), _LONGEST)
