"""Curves and marks on an ellipsoid about the origin, with the legend: one picture of all."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Final

import numpy as np

from taylor_verify.draw.stage import END, START, Look, Stage, scale
from taylor_verify.draw.view import Ellipsoid, Numbers, View
from taylor_verify.plotting.sheet import Entry

if TYPE_CHECKING:
    from matplotlib.figure import Figure

# In inches.
_HEIGHT: Final = 3.8
_STAGE: Final = 4.2
_LEGEND: Final = 3.5
_TIME: Final = 0.75
_WIDTH: Final = 1.8
# Beyond this squared distance a course has left the surface; below it is the rounding of nine digits.
_OFF: Final = 1e-6
# The axis that the curve goes round faces the reader; the two others are seen from the side.
_FACING: Final = (1.0, 0.55, 0.45)
SPHERE: Final = (1.0, 1.0, 1.0)


@dataclass(frozen=True)
class Part:
    """A line of points (n, 3) or a mark at one point (3,), with its look and its name in the legend."""

    points: Numbers
    look: Look
    name: str


@dataclass(frozen=True)
class Surface:
    """A course (n, 3) at its times (n,), which darkens with time, and what is drawn beside it.

    ``letter`` names the vector whose course it is. ``axes`` are the names of the axes of the ellipsoid.
    """

    times: Numbers
    course: Numbers
    letter: str
    name: str
    semi_axes: tuple[float, float, float] = SPHERE
    axes: tuple[str, ...] = ("1", "2", "3")
    curves: tuple[Part, ...] = ()
    marks: tuple[Part, ...] = ()

    @property
    def sinks(self) -> bool:
        """True if the course leaves the surface: damping takes energy from the body, or adds some."""
        q = np.square(self.course / np.array(self.semi_axes)).sum(axis=1)
        return bool(np.abs(q - 1).max() > _OFF)

    @property
    def side(self) -> View:
        """The view in which the course, and the axis that it goes round, face the reader."""
        mean = (self.course / np.array(self.semi_axes)).mean(axis=0)
        order = np.argsort(-np.abs(mean))
        direction = np.zeros(3)
        direction[order] = np.where(mean[order] >= 0, _FACING, np.negative(_FACING))
        # Where the curve has no upper side, the view is from above.
        if order[0] != 2:
            direction[2] = abs(direction[2])
        return View.facing([float(v) for v in direction])

    @property
    def ends(self) -> tuple[Part, Part]:
        """The start and the end of the course."""
        start = Part(self.course[0], {**START, "gid": "start"}, "start")
        return start, Part(self.course[-1], {**END, "gid": "end"}, "end")


def figure(drawn: Surface, words: str) -> Figure:
    """Return the picture; ``words`` stand below the legend."""
    solid = Ellipsoid(drawn.semi_axes)
    stage = Stage.around(solid, drawn.side, _STAGE, _HEIGHT, drawn.course)
    stage.name_axes(drawn.semi_axes, drawn.axes)
    for curve in drawn.curves:
        stage.line(curve.points, 2, curve.look)
    # The surface does not hide a course that has sunk below it.
    over = replace(stage, surface=None) if drawn.sinks else stage
    over.course(drawn.course, _WIDTH, 3)
    for mark in (*drawn.marks, *drawn.ends):
        over.mark(mark.points, mark.look)
    entries: list[Entry] = [({"color": scale()(0.6), "linewidth": _WIDTH}, drawn.name)]
    styles = {each.name: each.look for each in (*drawn.curves, *drawn.ends, *drawn.marks)}
    entries += [(look, name) for name, look in styles.items()]
    stage.legend(entries, f"Faint: on the far side. {words}", _LEGEND)
    stage.time_bar(drawn.times, _TIME)
    return stage.figure
