"""How surfaces, and lines on them, are drawn: what faces the reader in full, what does not faintly."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import isfinite
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from taylor_verify.publish.pictures.palette import INK, PAPER, QUIET
from taylor_verify.publish.pictures.sheet import Frame, add_axes
from taylor_verify.publish.pictures.style import SMALL
from taylor_verify.studies.gallery.pictures.view import Ellipsoid, Numbers, View, pieces

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.colors import Colormap, Normalize
    from matplotlib.figure import Figure

SURFACE: Final = "#F3F5F7"
WIRE: Final = "#BFC6CC"
# Of what is behind.
FAINT_ALPHA: Final = 0.28

# Room for a name, in inches.
_ASIDE: Final = 0.62
_ABOVE: Final = 0.12
# Beyond the surface, in parts of the semi-axis.
_STUB: Final = 0.24
_NAME: Final = 0.36

# Light to dark, told apart in grey and with any colour vision; the light end keeps off the paper.
_SCALE: Final = "cividis_r"
_FROM: Final = 0.06
# Largest over median, beyond which colours go by decades, and how many of these are told apart.
_UNLIKE: Final = 30.0
_DECADES: Final = 4


def stage(figure: Figure, frame: Frame, spots: Numbers, above: float = _ABOVE) -> Axes:
    """Axes without lines that show all the spots, one unit as long upwards as to the right.

    There is room for a name beside the outermost spot on every side, ``above`` and below in inches.
    """
    axes = add_axes(figure, frame)
    axes.axis("off")
    low, high = spots.min(axis=0), spots.max(axis=0)
    room = np.array([frame.width - 2 * _ASIDE, frame.height - 2 * above])
    unit = float(((high - low) / room).max())
    half = unit * np.array([frame.width, frame.height]) / 2
    middle = (low + high) / 2
    axes.set_xlim(middle[0] - half[0], middle[0] + half[0])
    axes.set_ylim(middle[1] - half[1], middle[1] + half[1])
    return axes


def reach(surface: Ellipsoid, view: View) -> Numbers:
    """The spots that a surface and the names of its axes need."""
    names = np.diag(surface.semi_axes) * (1 + _NAME)
    return np.concatenate([view.seen(surface.outline(view)), view.seen(names)])


def draw_surface(axes: Axes, surface: Ellipsoid, view: View) -> None:
    """The rim, filled, and the three sections across the axes."""
    rim = view.seen(surface.outline(view))
    axes.fill(rim[:, 0], rim[:, 1], facecolor=SURFACE, edgecolor=QUIET, linewidth=0.7, zorder=0)
    for pole in np.eye(3):
        draw_on(
            axes, surface, view, surface.circle(pole), {"color": WIRE, "linewidth": 0.5}, zorder=1
        )


def draw_on(
    axes: Axes,
    surface: Ellipsoid,
    view: View,
    points: Numbers,
    drawn: Mapping[str, Any],
    zorder: float,
) -> None:
    """A line on the surface: in full where it faces the reader, faintly behind."""
    spots = view.seen(points)
    for is_seen, piece in pieces(spots, surface.faces(points, view)):
        look = {} if is_seen else {"alpha": FAINT_ALPHA}
        axes.plot(
            piece[:, 0],
            piece[:, 1],
            # Round ends of what is faint would lie on each other and show as dots.
            solid_capstyle="round" if is_seen else "butt",
            **{**drawn, **look},
            zorder=zorder if is_seen else 0.5,
        )


def draw_axes(axes: Axes, surface: Ellipsoid, view: View, names: Sequence[str]) -> None:
    """The axes where they leave the surface, each with its name; those that point away, faintly."""
    for i, name in enumerate(names):
        direction = np.eye(3)[i] * surface.semi_axes[i]
        ends = view.seen(np.array([direction, direction * (1 + _STUB)]))
        is_seen = bool(surface.faces(direction, view)[0])
        axes.annotate(
            "",
            ends[1],
            ends[0],
            arrowprops={
                **{"arrowstyle": "-|>", "color": QUIET, "linewidth": 0.8, "mutation_scale": 6},
                **{"shrinkA": 0, "shrinkB": 0},
            },
            zorder=3 if is_seen else 0.2,
        )
        spot = view.seen(direction * (1 + _NAME))[0]
        outward = ends[1] - ends[0]
        axes.text(
            float(spot[0]),
            float(spot[1]),
            name,
            size=SMALL,
            color=INK,
            ha=_side(outward[0], float(np.hypot(*outward))),
            va="center_baseline" if abs(outward[1]) < abs(outward[0]) else "center",
            zorder=6,
            gid="name",
            bbox={"facecolor": PAPER, "alpha": 0.7, "linewidth": 0, "pad": 0.3},
        )


def _side(right: float, length: float) -> str:
    if abs(right) < 0.4 * length:
        return "center"
    return "left" if right > 0 else "right"


def scale() -> Colormap:
    """The colours of a quantity, from little (light) to much (dark)."""
    import matplotlib
    from matplotlib.colors import ListedColormap

    return ListedColormap(matplotlib.colormaps[_SCALE](np.linspace(_FROM, 1.0, 256)))


def norm_of(values: Sequence[float]) -> Normalize:
    """From a size to its place on the scale: in proportion, or by decades where sizes are so unlike.

    What is zero, or below the last decade, has the lightest colour.
    """
    from matplotlib.colors import LogNorm, Normalize

    above = sorted(value for value in values if isfinite(value) and value > 0)
    most = above[-1] if above else 1.0
    if not above or most <= _UNLIKE * above[len(above) // 2]:
        return Normalize(0.0, most, clip=True)
    return LogNorm(max(above[0], most / 10**_DECADES), most, clip=True)


def draw_bar(
    figure: Figure, frame: Frame, norm: Normalize, name: str, is_reversed: bool = False
) -> None:
    """What the colours mean, on a line of its own; reversed where the dark end is the least value."""
    from matplotlib.cm import ScalarMappable

    axes = add_axes(figure, frame)
    colours = scale().reversed() if is_reversed else scale()
    bar = figure.colorbar(ScalarMappable(norm, colours), cax=axes, orientation="horizontal")
    bar.outline.set_linewidth(0.5)
    bar.outline.set_edgecolor(QUIET)
    axes.set_xlabel(name, size=SMALL)
    axes.tick_params(labelsize=SMALL)
