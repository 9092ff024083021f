"""The bifurcations of a body with wheels: how many steady spins it has, and which of them are stable.

Left, the wheels are those of the scene and |H| varies. The energy of each steady spin is drawn, from 0 for
the least to 1 for the greatest with that |H|. In each cusp two spins more are born, one of them stable.
Right, |H| is that of the scene and the wheels vary, in a plane of h. A steady spin is a normal from the
point K^(1/2) h to the ellipsoid p.I p = |H|^2: the border is a section of the ellipsoid's evolute.
"""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from taylor_verify.draw import momentum_sphere
from taylor_verify.draw.caption import NotDrawn, captioned
from taylor_verify.draw.spins import Branch, Wheels, number
from taylor_verify.draw.stage import Look
from taylor_verify.draw.view import Numbers
from taylor_verify.plotting.palette import INK, QUIET
from taylor_verify.plotting.picture import Picture
from taylor_verify.plotting.sheet import Entry, sheet
from taylor_verify.plotting.wording import plain

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.axis import Axis
    from matplotlib.figure import Figure

Document = Mapping[str, Any]

# In inches; the right panel is nearly a square.
_HEIGHT: Final = 2.6
_STABLE: Final[Look] = {"color": "#1C8578", "linewidth": 1.6, "gid": "stable"}
_UNSTABLE: Final[Look] = {
    "color": "#A83C00",
    "linewidth": 1.3,
    "dashes": (4, 1.6),
    "gid": "unstable",
}
_HERE: Final[Look] = {
    "linestyle": "none",
    "marker": "*",
    "markersize": 11,
    "markerfacecolor": "#F2B705",
    "markeredgecolor": INK,
    "markeredgewidth": 0.8,
    "gid": "scene",
}
# Colours by the number of pairs of spins, beyond the two spins that are always there.
_REGIONS: Final = ("#FFFFFF", "#DCE9F2", "#A9C8DF")
_PATCH: Final[Look] = {
    "linestyle": "none",
    "marker": "s",
    "markersize": 8,
    "markeredgecolor": QUIET,
    "markeredgewidth": 0.6,
}
_BORDER: Final[Look] = {"color": "#35607F", "linewidth": 0.9, "gid": "border"}
_EVOLUTE: Final[Look] = {"colors": [_BORDER["color"]], "linewidths": _BORDER["linewidth"]}
# The extent of a panel, in parts of what it has to show.
_ROOM: Final = 1.3
# If the sizes have a larger ratio, their axis is logarithmic.
_UNLIKE: Final = 15.0
# Points on each side of the grid that is drawn, and of the one that finds the extent of the border.
_GRID: Final = 181
_COARSE: Final = 61


@dataclass(frozen=True)
class Series:
    """The body with its wheels, its |H| and H at the start, and the |H| of the cusps, ascending."""

    wheels: Wheels
    size: float
    start: Numbers
    births: tuple[float, ...]

    @property
    def spins(self) -> str:
        """The words for the steady spins of the scene."""
        return self.regions[sum(birth < self.size for birth in self.births)]

    @property
    def regions(self) -> list[str]:
        """The words for each number of steady spins that is possible."""
        if len(self.births) == 1:
            return ["2 steady spins", "4 steady spins, or a circle"]
        return [f"{2 + 2 * pairs} steady spins" for pairs in range(len(self.births) + 1)]

    @property
    def limits(self) -> tuple[float, float]:
        """The least and the largest N that the left panel shows."""
        shown = [self.size, *self.births, float(np.linalg.norm(self.wheels.rotor))]
        return (min(shown) / _ROOM if self.is_long else 0.0), max(shown) * _ROOM

    @property
    def is_long(self) -> bool:
        """True if the sizes are so unlike that their axis is logarithmic."""
        shown = [self.size, *self.births]
        return max(shown) > _UNLIKE * min(shown)


def series(document: Document) -> Series:
    """Return the bifurcations of a free body with wheels. Raises NotDrawn for any other scene."""
    if not document["rotor"]:
        raise NotDrawn(f"expected a body with wheels (rotor), got none @ {document['scene']}")
    sphere = momentum_sphere.series(document)
    return Series(sphere.wheels, sphere.size, sphere.course[:1], tuple(sphere.wheels.births()))


def picture(document: Document) -> Picture:
    """Return the bifurcations of one scene. Raises NotDrawn as `series` does."""
    bifurcations = series(document)
    births = " and ".join(plain(birth) for birth in bifurcations.births) or "no value"
    alt = (
        f"Steady spins of {document['scene']}. With its wheels, more of them appear at |H| = {births}; "
        f"the scene has |H| = {plain(bifurcations.size)} and {bifurcations.spins}. "
        f"Beside it the same for wheels that vary in a plane: {', '.join(bifurcations.regions)}, "
        "with the border between."
    )
    title = "Bifurcations of the steady spins"
    return captioned(document, "bifurcation", title, alt, partial(_figure, bifurcations))


def _figure(bifurcations: Series, caption: str) -> Figure:
    # The branches go beyond the panel, so that no curve ends inside.
    branches = bifurcations.wheels.branches(bifurcations.limits[1] * _ROOM)
    is_mixed = any(not branch.stable for branch in branches)
    entries: list[Entry] = [
        (_STABLE, "stable spin"),
        *([(_UNSTABLE, "unstable spin")] if is_mixed else []),
        (_HERE, "this scene"),
        *(
            ({**_PATCH, "markerfacecolor": colour}, words)
            for colour, words in zip(_REGIONS, bifurcations.regions, strict=False)
        ),
    ]
    figure, (left, right) = sheet(2, entries, caption, _HEIGHT)
    _draw_energies(left, bifurcations, branches)
    _draw_wheels(right, bifurcations)
    return figure


# The wheels of the scene, any momentum.


def _draw_energies(axes: Axes, bifurcations: Series, branches: Sequence[Branch]) -> None:
    low, high = bifurcations.limits
    if bifurcations.is_long:
        axes.set_xscale("log")
    bounds = [low, *bifurcations.births, high]
    for pairs, (left, right) in enumerate(itertools.pairwise(bounds)):
        axes.axvspan(left, right, facecolor=_REGIONS[pairs], linewidth=0, zorder=0)
    for birth in bifurcations.births:
        axes.axvline(birth, zorder=1, **_BORDER)
    for branch in branches:
        look = {"zorder": 3, **_STABLE} if branch.stable else {"zorder": 2, **_UNSTABLE}
        axes.plot(branch.sizes, _parts(bifurcations.wheels, branch.sizes, branch.momenta), **look)
    (part,) = _parts(bifurcations.wheels, np.array([bifurcations.size]), bifurcations.start)
    axes.plot([bifurcations.size], [part], clip_on=False, zorder=5, **_HERE)
    axes.set(xlim=(low, high), ylim=(-0.04, 1.04), xlabel="|H|, the whole momentum")
    axes.set_ylabel("T, from least to greatest", labelpad=2)
    axes.set_title("the wheels of the scene", pad=4)
    if not bifurcations.is_long:
        _number_few(axes.xaxis)


def _parts(wheels: Wheels, sizes: Numbers, momenta: Numbers) -> Numbers:
    """Return the energies between the least and the greatest of momenta of these sizes, from 0 to 1."""
    low, high = wheels.extremes(sizes)
    spread = np.maximum(high - low, np.finfo(float).tiny)
    return np.asarray(np.clip((wheels.energy(momenta) - low) / spread, 0, 1))


def _number_few(axis: Axis) -> None:
    from matplotlib.ticker import MaxNLocator

    axis.set_major_locator(MaxNLocator(4, steps=[1, 2, 5, 10]))


# Any wheels, the momentum of the scene.


def _draw_wheels(axes: Axes, bifurcations: Series) -> None:
    plane, names = _plane(bifurcations.wheels)
    here = plane @ bifurcations.wheels.rotor
    half = _half(bifurcations, plane, here, *axes.get_window_extent().size)
    across, upwards = (np.linspace(-side, side, _GRID) for side in half)
    first, second = _pairs(bifurcations, plane, across, upwards)
    for values, colour in (
        (np.maximum(first, second), _REGIONS[1]),
        (np.minimum(first, second), _REGIONS[2]),
    ):
        if (values > 0).any():
            axes.contourf(across, upwards, values, levels=[0, 1e9], colors=[colour], zorder=0)
    for values in (first, second):
        if (values > 0).any() and (values < 0).any():
            axes.contour(across, upwards, values, levels=[0], zorder=1, **_EVOLUTE)
    axes.plot([0, here[0]], [0, here[1]], color=QUIET, linewidth=0.8, zorder=2)
    axes.plot(*here[:, None], zorder=5, **_HERE)
    axes.set(xlim=(-half[0], half[0]), ylim=(-half[1], half[1]), xlabel=names[0])
    axes.set_ylabel(names[1], labelpad=0)
    _number_few(axes.xaxis)
    _number_few(axes.yaxis)
    axes.set_title(f"any wheels, |H| = {bifurcations.size:.4g}", pad=4)


def _pairs(
    bifurcations: Series, plane: Numbers, across: Numbers, upwards: Numbers
) -> tuple[Numbers, Numbers]:
    """Return two numbers at each point of a grid; each is positive where its pair of spins exists."""
    rotors = np.stack(np.meshgrid(across, upwards), axis=-1) @ plane
    return number(bifurcations.wheels.moments, rotors, bifurcations.size)


def _half(
    bifurcations: Series, plane: Numbers, here: Numbers, width: float, height: float
) -> tuple[float, float]:
    """Return half the sides of the panel, at one scale: it shows the whole border and the scene."""
    moments = bifurcations.wheels.moments
    reach = 1.1 * float(np.abs(1 - np.divide.outer(moments, moments)).max()) * bifurcations.size
    coarse = np.linspace(-reach, reach, _COARSE) if reach > 0 else np.zeros(_COARSE)
    inside = np.maximum(*_pairs(bifurcations, plane, coarse, coarse)) > 0
    sides = [
        max([abs(float(side)), *np.abs(coarse[inside.any(axis=axis)])])
        for axis, side in enumerate(here)
    ]
    unit = _ROOM * max(sides[0] / width, sides[1] / height)
    return unit * width, unit * height


def _plane(wheels: Wheels) -> tuple[Numbers, tuple[str, str]]:
    """Return two unit vectors of the plane through h and the middle axis, as rows, with their names.

    For wheels along the middle axis, the plane is that of the middle and the greatest moment.
    """
    order = np.argsort(wheels.moments)
    middle = np.eye(3)[order[1]]
    rest = wheels.rotor - (wheels.rotor @ middle) * middle
    subscripts = "\N{SUBSCRIPT ONE}\N{SUBSCRIPT TWO}\N{SUBSCRIPT THREE}"
    name = f"h{subscripts[order[1]]}"
    second = f"{name}, along the middle axis" if len(set(wheels.moments)) == 3 else name
    if not rest.any():
        return np.array([np.eye(3)[order[2]], middle]), (f"h{subscripts[order[2]]}", second)
    along = rest / np.linalg.norm(rest)
    axis = int(np.abs(along).argmax())
    if np.count_nonzero(along) == 1:
        return np.array([np.eye(3)[axis], middle]), (f"h{subscripts[axis]}", second)
    return np.array([along, middle]), ("h across the middle axis", second)
