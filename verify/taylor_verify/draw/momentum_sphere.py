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
from typing import Any, Final

import numpy as np

from taylor_verify.draw.caption import SUBSCRIPTS, NotDrawn, captioned
from taylor_verify.draw.stage import Look
from taylor_verify.draw.surface import Curve, Mark, Surface, figure
from taylor_verify.draw.view import Ellipsoid, Numbers
from taylor_verify.plotting.palette import INK, PAPER
from taylor_verify.plotting.picture import Picture
from taylor_verify.plotting.wording import plain

Document = Mapping[str, Any]

_LEVEL: Final[Look] = {"color": "#9AA5AE", "linewidth": 0.6, "gid": "level"}
_SEPARATRIX: Final[Look] = {"color": "#A83C00", "linewidth": 1.1, "gid": "separatrix"}
_CIRCLE: Final[Look] = {"color": "#1C8578", "linewidth": 1.6, "dashes": (1, 1.2), "gid": "circle"}
_MARK: Final[Look] = {"linestyle": "none", "markeredgecolor": INK, "markeredgewidth": 0.9}
_SPIN: Final[Look] = {**_MARK, "gid": "spin"}
_STABLE: Final[Look] = {**_SPIN, "marker": "o", "markersize": 5.5, "markerfacecolor": "#1C8578"}
_UNSTABLE: Final[Look] = {**_SPIN, "marker": "X", "markersize": 7, "markerfacecolor": "#E0714F"}
_WHEELS: Final[Look] = {**_MARK, "marker": "D", "markersize": 8, "markerfacecolor": PAPER}
# Moments and wheels have nine digits: what agrees to eight counts as equal.
_ZERO: Final = 1e-8
# Curves between neighbouring energies of steady spins, and the least part of all energies between them.
_LEVELS: Final = 5
_SAME: Final = 1e-6
# Intervals of the grid on which curves of equal energy are searched, from pole to pole.
_ROWS: Final = 240


@dataclass(frozen=True)
class Spins:
    """A body in its principal axes: three moments, the momentum h of wheels, and the size of H.

    ``stable`` and ``unstable`` are the momenta of its steady spins; ``circle`` has the points (n, 3) of a
    circle of them, and none where there is no circle.
    """

    moments: Numbers
    wheels: Numbers
    size: float
    stable: tuple[Numbers, ...] = ()
    unstable: tuple[Numbers, ...] = ()

    def energy(self, momenta: Numbers) -> Numbers:
        """Return T = omega.I omega/2 of momenta (..., 3)."""
        return np.asarray(np.square(momenta - self.wheels) @ (1 / self.moments) / 2)

    @property
    def saddles(self) -> list[float]:
        """The energies of the unstable spins."""
        return sorted({float(self.energy(momentum)) for momentum in self.unstable})

    @property
    def circle(self) -> Numbers:
        """The steady spins across the axis of the third moment, if two are equal and h is along it."""
        pair = [k for k in range(3) if self.equals(k) == 2]
        if not pair or self.wheels[pair].any():
            return np.empty((0, 3))
        (third,) = {0, 1, 2} - set(pair)
        along = self.wheels[third] / (1 - self.moments[third] / self.moments[pair[0]])
        radius = np.sqrt(max(self.size**2 - along**2, 0.0))
        across = Ellipsoid((radius,) * 3).circle(np.eye(3)[third])
        return np.asarray(across[: len(across) * bool(radius)] + along * np.eye(3)[third])

    def equals(self, k: int) -> int:
        """Return how many of the three moments are equal to this one."""
        return int(
            np.count_nonzero(np.abs(self.moments - self.moments[k]) <= _ZERO * self.moments[k])
        )

    @property
    def words(self) -> str:
        """A sentence on the steady spins; two are there at least, unless every H is one."""
        count = len(self.stable) + len(self.unstable)
        if not count and not self.wheels.any():
            return "Every H is that of a steady spin: the moments agree to eight digits."
        if not count:
            return "The steady spins are not marked: their digits do not come apart."
        marked = f"{count} steady spins are marked, {len(self.unstable)} of them unstable"
        beside = ", and a circle of steady spins: two moments agree to eight digits"
        return f"{marked}{beside if len(self.circle) else ''}."


def spins(document: Document) -> Spins:
    """Return the steady spins of a free rigid body with the momentum of a scene, wheels or none.

    Raises NotDrawn for another scene, and for a body without momentum.
    """
    body = document["body"]
    if body is None or not document["is_free"] or document["damping"]:
        load = "damping" if document["damping"] else "a torque"
        got = "a solid in a fluid" if body is None else load
        raise NotDrawn(
            f"expected a free rigid body without damping, got {got} @ {document['scene']}"
        )
    moments = np.array(body["principal_moments"])
    wheels = np.array(body["axes"]) @ np.array(document["rotor"] or [0.0] * 3)
    h = float(np.linalg.norm(wheels))
    size = float(np.linalg.norm(_momenta(document, moments, wheels)[0]))
    # Where the wheels cancel the momentum of the body, only the rounding of the digits is left.
    if not size > _ZERO * h:
        raise NotDrawn(f"expected a body with momentum, got none @ {document['scene']}")
    # Exact zeros where h has only the rounding of its digits.
    bare = Spins(moments, np.where(np.abs(wheels) > _ZERO * h, wheels, 0.0), size)
    return _with_wheels(document, bare) if h else _without_wheels(bare)


def _momenta(document: Document, moments: Numbers, wheels: Numbers) -> Numbers:
    omega = np.array(document["course"]["omega"]) @ np.array(document["body"]["axes"]).T
    return np.asarray(omega * moments + wheels)


def _without_wheels(bare: Spins) -> Spins:
    """Two spins along the axis of each moment that no other equals; unstable along the middle axis."""
    order = np.argsort(bare.moments)
    poles = {int(k): bare.size * np.eye(3)[k] for k in order if bare.equals(int(k)) == 1}
    middle = poles.pop(int(order[1]), None) if len(poles) == 3 else None
    stable = tuple(sign * pole for pole in poles.values() for sign in (1, -1))
    unstable = () if middle is None else (middle, -middle)
    return Spins(bare.moments, bare.wheels, bare.size, stable, unstable)


def _with_wheels(document: Document, bare: Spins) -> Spins:
    """The spins at the rates mu |H| of the orbit's numbers, H_k = h_k/(1 - mu J_k)."""
    numbers = {row["name"]: float(row["value"]) for row in document["analytic"]}
    momenta: dict[bool, list[Numbers]] = {True: [], False: []}
    pending: list[Numbers] = []
    for k in itertools.count(1):
        if (rate := numbers.get(f"spin_{k}")) is None:
            break
        # Two spins beside an axis without h have one rate, and stand side by side.
        pending = pending or _at(bare, rate / bare.size)
        momenta[f"spin_{k}_growth" not in numbers].append(pending.pop(0))
    return Spins(bare.moments, bare.wheels, bare.size, tuple(momenta[True]), tuple(momenta[False]))


def _at(bare: Spins, rate: float) -> list[Numbers]:
    """Return the momenta with a steady spin at this mu: one, or two along an axis without h."""
    below = 1 - rate * bare.moments
    momentum = np.divide(bare.wheels, below, out=np.zeros(3), where=bare.wheels != 0)
    axis = int(np.abs(below).argmin())
    if bare.wheels[axis] or abs(below[axis]) > _ZERO:
        return [momentum]
    along = np.zeros(3)
    along[axis] = np.sqrt(max(bare.size**2 - float(momentum @ momentum), 0.0))
    return [momentum + along, momentum - along]


def surface(document: Document) -> Surface:
    """Return the course of H with all that stands still beside it. Raises NotDrawn as `spins` does."""
    steady = spins(document)
    curves = [Curve(line, _LEVEL, "equal energy T") for line in _lines(steady, _levels(steady))]
    curves += [Curve(line, _SEPARATRIX, "separatrices") for line in _lines(steady, steady.saddles)]
    if len(steady.circle):
        curves.append(Curve(steady.circle, _CIRCLE, "circle of steady spins"))
    marks = [Mark(momentum, _STABLE, "stable steady spin") for momentum in steady.stable]
    marks += [Mark(momentum, _UNSTABLE, "unstable steady spin") for momentum in steady.unstable]
    if steady.wheels.any():
        direction = steady.size / np.linalg.norm(steady.wheels) * steady.wheels
        marks.append(Mark(direction, _WHEELS, "direction of the wheels' h"))
    return Surface(
        times=np.array(document["course"]["t"]),
        course=_momenta(document, steady.moments, steady.wheels),
        letter="H",
        name="H in the body",
        semi_axes=(steady.size,) * 3,
        axes=tuple(f"H{subscript}" for subscript in SUBSCRIPTS),
        curves=tuple(curves),
        marks=tuple(marks),
    )


def picture(document: Document) -> Picture:
    """Return the momentum sphere of one scene. Raises NotDrawn as `spins` does."""
    steady = spins(document)
    alt = (
        f"The momentum of {document['scene']} on the sphere |H| = {plain(steady.size)} in the body, with "
        f"curves of equal energy. {steady.words}"
    )
    drawn = partial(figure, surface(document))
    return captioned(document, "momentum", "Momentum sphere", alt, drawn)


# Curves of equal energy.


def _levels(steady: Spins) -> list[float]:
    """Return energies between those of the steady spins, evenly spaced along the sphere."""
    energies = steady.energy(_grid()[2] * steady.size)
    low, high = float(energies.min()), float(energies.max())
    turns = (1 - np.cos(np.pi * np.arange(1, _LEVELS) / _LEVELS)) / 2
    return [
        a + (b - a) * float(part)
        for a, b in itertools.pairwise([low, *steady.saddles, high])
        if b - a > _SAME * (high - low)
        for part in turns
    ]


def _lines(steady: Spins, levels: Sequence[float]) -> list[Numbers]:
    """Return the curves on which T has one of these values, each a line (n, 3)."""
    from contourpy import contour_generator

    polar, azimuth, directions = _grid()
    chart = contour_generator(x=azimuth, y=polar, z=steady.energy(directions * steady.size))
    lines = [np.asarray(line) for level in levels for line in chart.lines(level)]
    return [steady.size * _points(line[:, 1], line[:, 0]) for line in lines]


def _grid() -> tuple[Numbers, Numbers, Numbers]:
    """Return polar angles, azimuths and the unit vectors at them, (n, m, 3)."""
    polar = np.linspace(0, np.pi, _ROWS + 1)
    azimuth = np.linspace(0, 2 * np.pi, 2 * _ROWS + 1)
    return polar, azimuth, _points(*np.meshgrid(polar, azimuth, indexing="ij"))


def _points(polar: Numbers, azimuth: Numbers) -> Numbers:
    """Return unit vectors, their third component along the last axis of the chart."""
    across = np.sin(polar)
    return np.stack([across * np.cos(azimuth), across * np.sin(azimuth), np.cos(polar)], axis=-1)
