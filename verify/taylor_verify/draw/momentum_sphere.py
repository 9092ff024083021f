"""The momentum of a body on its sphere |H|, with the curves of equal energy and the steady spins.

|H| and T are conserved, H = I omega + h with the momentum h of wheels. So H runs along a curve of equal T
on a sphere in the body. The steady spins are where T is stationary: a spin is unstable at a saddle, and a
separatrix goes through it. With two equal moments a whole circle can be steady, with three every H.
"""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from taylor_verify.draw.caption import NotDrawn, captioned
from taylor_verify.draw.spins import ZERO, Spin, Wheels
from taylor_verify.draw.stage import START, Look, Stage
from taylor_verify.draw.view import Ellipsoid, Numbers, View
from taylor_verify.plotting.palette import INK, PAPER
from taylor_verify.plotting.picture import Picture
from taylor_verify.plotting.sheet import Entry
from taylor_verify.plotting.wording import plain

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Document = Mapping[str, Any]

# In inches.
_HEIGHT: Final = 4.0
_STAGE: Final = 4.4
_COURSE: Final[Look] = {"color": "#0B5FA5", "linewidth": 2.2, "gid": "course"}
_LEVEL: Final[Look] = {"color": "#9AA5AE", "linewidth": 0.6, "gid": "level"}
SEPARATRIX: Final[Look] = {"color": "#A83C00", "linewidth": 1.1, "gid": "separatrix"}
_SPIN: Final[Look] = {"linestyle": "none", "markeredgecolor": INK, "markeredgewidth": 0.9}
STABLE: Final[Look] = {**_SPIN, "marker": "o", "markersize": 5.5, "markerfacecolor": "#1C8578"}
UNSTABLE: Final[Look] = {**_SPIN, "marker": "X", "markersize": 7, "markerfacecolor": "#E0714F"}
CIRCLE: Final[Look] = {"color": "#1C8578", "linewidth": 1.6, "dashes": (1, 1.2), "gid": "circle"}
_ROTOR: Final[Look] = {**_SPIN, "marker": "D", "markersize": 8, "markerfacecolor": PAPER}
# Curves between neighbouring energies of steady spins.
_LEVELS: Final = 5
# A point is in front if it is nearer to the viewer than the rim by this part of |H|.
_INSIDE: Final = 0.25
# Intervals of the grid on which curves of equal energy are searched, from pole to pole.
_ROWS: Final = 120
# Newton steps from the grid onto the curve.
_STEPS: Final = 4
# Levels are drawn between two energies that differ by more than this part of the whole range.
_SAME: Final = 1e-6


@dataclass(frozen=True)
class Series:
    """The course of H in principal axes, the wheels, and every steady spin with this |H|.

    ``circle`` has the points (n, 3) of a circle of steady spins; none where there is no circle.
    """

    course: Numbers
    wheels: Wheels
    size: float
    spins: tuple[Spin, ...]
    circle: Numbers

    @property
    def saddles(self) -> list[float]:
        """The energies of the unstable spins."""
        momenta = [spin.momentum for spin in self.spins if not spin.stable]
        energies = self.wheels.energy(np.array(momenta).reshape(-1, 3))
        return sorted({float(energy) for energy in energies})

    @property
    def words(self) -> str:
        """A sentence on the steady spins; two are there at least, unless every H is one."""
        if not self.spins and not self.wheels.rotor.any():
            return "Every H is that of a steady spin: the moments agree to eight digits."
        if not self.spins:
            return "The steady spins are not marked: their digits do not come apart."
        unstable = sum(not spin.stable for spin in self.spins)
        marked = f"{len(self.spins)} steady spins are marked, {unstable} of them unstable"
        beside = ", and a circle of steady spins: two moments agree to eight digits"
        return f"{marked}{beside if len(self.circle) else ''}."


def series(document: Document) -> Series:
    """Return the sphere of a free rigid body, with wheels or without.

    Raises NotDrawn for another scene, and for a body without momentum.
    """
    body, course = document["body"], document["course"]
    if body is None or not document["is_free"] or document["damping"]:
        load = "damping" if document["damping"] else "a torque"
        got = "a solid in a fluid" if body is None else load
        raise NotDrawn(
            f"expected a free rigid body without damping, got {got} @ {document['scene']}"
        )
    axes, moments = np.array(body["axes"]), np.array(body["principal_moments"])
    wheels = Wheels.of(moments, axes @ np.array(document["rotor"] or [0.0] * 3))
    momenta = (np.array(course["omega"]) @ axes.T) * moments + wheels.rotor
    size, of_wheels = float(np.linalg.norm(momenta[0])), float(np.linalg.norm(wheels.rotor))
    # Where the wheels cancel the momentum of the body, only the rounding of the digits is left.
    if not size > ZERO * of_wheels:
        raise NotDrawn(f"expected a body with momentum, got none @ {document['scene']}")
    spins = _spins(document, wheels, size) if of_wheels else wheels.without_rotor(size)
    # Beside a circle there are two spins; more of them belong to moments that are nearly equal.
    circle = wheels.circle(size) if len(spins) == 2 else np.empty((0, 3))
    return Series(momenta, wheels, size, tuple(spins), circle)


def _spins(document: Document, wheels: Wheels, size: float) -> list[Spin]:
    """Return the steady spins with wheels; rates and stability come from the elements of the orbit."""
    numbers = {row["name"]: float(row["value"]) for row in document["analytic"]}
    spins: list[Spin] = []
    pending: list[Numbers] = []
    k = 1
    while (rate := numbers.get(f"spin_{k}")) is not None:
        # Two spins beside an axis without h have one rate, and stand side by side.
        pending = pending or wheels.at(rate / size, size)
        spins.append(Spin(pending.pop(0), f"spin_{k}_growth" not in numbers))
        k += 1
    return spins


def picture(document: Document) -> Picture:
    """Return the momentum sphere of one scene. Raises NotDrawn as `series` does."""
    sphere = series(document)
    alt = (
        f"The momentum of {document['scene']} on the sphere |H| = {plain(sphere.size)} in the body, with "
        f"curves of equal energy. {sphere.words}"
    )
    return captioned(document, "momentum", "Momentum sphere", alt, partial(_figure, sphere))


def _figure(sphere: Series, caption: str) -> Figure:
    surface = Ellipsoid((sphere.size,) * 3)
    stage = Stage.around(surface, _view(sphere), _STAGE, _HEIGHT)
    levels = _levels(sphere)
    for energies, zorder, look in ((levels, 1.5, _LEVEL), (sphere.saddles, 2, SEPARATRIX)):
        for lines in level_lines(sphere.wheels, sphere.size, energies):
            for line in lines:
                stage.line(line, zorder, look)
    stage.line(sphere.course, 3, _COURSE)
    if len(sphere.circle):
        stage.line(sphere.circle, 2, CIRCLE)
    for spin in sphere.spins:
        stage.mark(spin.momentum, STABLE if spin.stable else UNSTABLE, gid="spin")
    entries: list[Entry] = [(_COURSE, "H of this motion"), (START, "start")]
    entries += [(_LEVEL, "equal energy T")] if levels else []
    entries += [(SEPARATRIX, "separatrices")] if sphere.saddles else []
    entries += [(STABLE, "stable steady spin")] if any(s.stable for s in sphere.spins) else []
    entries += [(UNSTABLE, "unstable steady spin")] if sphere.saddles else []
    entries += [(CIRCLE, "circle of steady spins")] if len(sphere.circle) else []
    if sphere.wheels.rotor.any():
        direction = sphere.wheels.rotor / np.linalg.norm(sphere.wheels.rotor)
        stage.mark(direction * sphere.size, _ROTOR, gid="wheels")
        entries += [(_ROTOR, "direction of the wheels' h")]
    stage.mark(sphere.course[0], START, gid="start")
    subscripts = "\N{SUBSCRIPT ONE}\N{SUBSCRIPT TWO}\N{SUBSCRIPT THREE}"
    stage.name_axes((sphere.size,) * 3, [f"H{subscript}" for subscript in subscripts])
    stage.legend(entries, f"Principal axes of the body. Faint: on the far side. {caption}", 3.4)
    return stage.figure


def _view(sphere: Series) -> View:
    """Return the view that has most of the course and of the steady spins in front, saddles first."""
    unstable = np.array([s.momentum for s in sphere.spins if not s.stable] or np.empty((0, 3)))
    stable = np.array([s.momentum for s in sphere.spins if s.stable] or np.empty((0, 3)))

    def in_front(view: View) -> float:
        saddles, centres, course = (
            np.asarray(points @ view.towards > _INSIDE * sphere.size)
            for points in (unstable, stable, sphere.course)
        )
        return float(2 * saddles.sum() + 0.8 * centres.sum() + 3 * course.mean())

    return max((View(a, e) for e in (24.0, -24.0) for a in range(20, 380, 15)), key=in_front)


def _levels(sphere: Series) -> list[float]:
    """Return energies between those of the steady spins, evenly spaced along the sphere."""
    low, high = (float(v[0]) for v in sphere.wheels.extremes(np.array([sphere.size])))
    ends = [low, *sphere.saddles, high]
    turns = (1 - np.cos(np.pi * np.arange(1, _LEVELS) / _LEVELS)) / 2
    return [
        a + (b - a) * float(part)
        for a, b in itertools.pairwise(ends)
        if b - a > _SAME * (high - low)
        for part in turns
    ]


def level_lines(wheels: Wheels, size: float, levels: Sequence[float]) -> list[list[Numbers]]:
    """Return for each level the curves T = level on the sphere |G| = size, each a line (n, 3)."""
    from contourpy import contour_generator

    polar = np.linspace(0, np.pi, _ROWS + 1)
    azimuth = np.linspace(0, 2 * np.pi, 2 * _ROWS + 1)
    energies = wheels.energy(_points(*np.meshgrid(polar, azimuth, indexing="ij")) * size)
    chart = contour_generator(x=azimuth, y=polar, z=energies)
    return [
        [
            _on_level(wheels, size, level, _points(line[:, 1], line[:, 0]))
            for line in map(np.asarray, chart.lines(level))
        ]
        for level in levels
    ]


def _points(polar: Numbers, azimuth: Numbers) -> Numbers:
    """Return unit vectors, their third component along the last axis of the chart."""
    across = np.sin(polar)
    return np.stack([across * np.cos(azimuth), across * np.sin(azimuth), np.cos(polar)], axis=-1)


def _on_level(wheels: Wheels, size: float, level: float, directions: Numbers) -> Numbers:
    """Move points across the curve until their energy is that of the level; near a saddle they stay."""
    points = directions * size
    scale = size**2 / float(wheels.moments.min())
    for _ in range(_STEPS):
        slope = (points - wheels.rotor) / wheels.moments
        slope -= (slope * points).sum(axis=1, keepdims=True) * points / size**2
        steep = np.square(slope).sum(axis=1)
        away = level - wheels.energy(points)
        part = np.where(steep * size**2 > 1e-6 * scale**2, away / np.maximum(steep, 1e-300), 0.0)
        points = points + part[:, None] * slope
        points *= size / np.linalg.norm(points, axis=1, keepdims=True)
    return points
