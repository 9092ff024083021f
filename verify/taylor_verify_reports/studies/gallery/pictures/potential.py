"""Picture of the quartic X3 of the axial impulse of Clebsch's body, its roots and the orbit's interval.

x3'^2 = r^2 X3(x3) (Hydromechanics 49): the motion is where X3 >= 0. It turns back at a simple root, and
needs an infinite time to reach a repeated root. -X3 is a potential, in which x3 moves like a particle
whose energy is zero.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from taylor_verify.draw.view import Numbers
from taylor_verify.plotting.palette import INK, PAPER, QUIET
from taylor_verify.plotting.picture import Picture
from taylor_verify.plotting.sheet import Entry, sheet
from taylor_verify.plotting.style import SMALL
from taylor_verify.plotting.wording import stem_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Document = Mapping[str, Any]

_CURVE: Final = "#0072B2"
_ORBIT: Final = "#A83C00"
_POINTS: Final = 101
# Margin beyond the shown roots, relative to the interval's length.
_BESIDE: Final = 0.45
# The least length of the interval, relative to the largest root.
_LEAST: Final = 0.25
# Margins above the hump of the orbit and below the axis, relative to that hump.
_ABOVE: Final = 1.35
_BELOW: Final = 0.75
_HEIGHT: Final = 1.75
# Marks of roots by multiplicity; higher ones have that of three.
_ROOT: Final = {
    "linestyle": "none",
    "markersize": 5.5,
    "markeredgecolor": INK,
    "markeredgewidth": 0.9,
    "gid": "root",
}
_ROOTS: Final[Mapping[int, Entry]] = {
    1: ({**_ROOT, "marker": "o", "markerfacecolor": PAPER}, "simple root"),
    2: ({**_ROOT, "marker": "D", "markerfacecolor": INK}, "double root"),
    3: ({**_ROOT, "marker": "^", "markerfacecolor": INK}, "triple root"),
}
_MULTIPLE: Final = {2: " (double)", 3: " (triple)", 4: " (fourfold)"}
_SUBSCRIPTS: Final = str.maketrans("123", "\N{SUBSCRIPT ONE}\N{SUBSCRIPT TWO}\N{SUBSCRIPT THREE}")


@dataclass(frozen=True)
class Series:
    """The curve X3 as points (n, 2), the interval of the motion, and the roots.

    ``roots`` has the real roots with their multiplicities, ``pair`` real and imaginary part of a complex
    one.
    """

    scene: str
    variable: str
    regime: str
    curve: Numbers
    interval: tuple[float, float]
    roots: tuple[tuple[float, int], ...]
    pair: tuple[float, float] | None


def series(portrait: Document) -> Series:
    """Return the curve and the roots of a scene. Raises ValueError for a scene without a quartic."""
    potential = portrait["potential"]
    if potential is None:
        raise ValueError(f"expected a quartic of the axial impulse, got none @ {portrait['scene']}")
    real = [float(re) for re, im in potential["roots"] if im == 0]
    pair = next(((float(re), float(im)) for re, im in potential["roots"] if im > 0), None)
    roots = tuple((root, real.count(root)) for root in dict.fromkeys(real))
    low, high = map(float, potential["interval"])
    left, right = _shown(low, high, [root for root, _ in roots])
    # Half of the points lie in the interval, where the curve matters most.
    z = np.union1d(np.linspace(left, right, _POINTS), np.linspace(low, high, _POINTS))
    curve = np.stack([z, np.polyval(potential["coefficients"], z)], axis=1)
    return Series(
        scene=portrait["scene"],
        variable=potential["variable"],
        regime=portrait["regime"],
        curve=curve,
        interval=(low, high),
        roots=roots,
        pair=pair,
    )


def _shown(low: float, high: float, roots: Sequence[float]) -> tuple[float, float]:
    """Return the shown range: the interval, extended to roots that are no farther than its own length."""
    length = max(high - low, _LEAST * max(abs(low), abs(high), *map(abs, roots)))
    near = [root for root in roots if low - length <= root <= high + length]
    ends = [low, high, *near]
    return min(ends) - _BESIDE * length / 2, max(ends) + _BESIDE * length / 2


def picture(portraits: Sequence[Document], name: str) -> Picture:
    """Return the picture with a panel for each scene. Raises ValueError for a scene without a quartic."""
    drawn = [series(portrait) for portrait in portraits]
    sentences = " ".join(map(_sentence, drawn))
    title = "The quartic of the axial impulse"
    alt = (
        f"The polynomial X3 against the axial impulse, with the interval of the motion. {sentences}"
    )
    return Picture(stem_of({"scene": name}, "potential"), title, alt, partial(_figure, drawn))


def _sentence(drawn: Series) -> str:
    low, high = drawn.interval
    roots = ", ".join(f"{root:.3g}{_MULTIPLE.get(count, '')}" for root, count in drawn.roots)
    complex_pair = " and a complex pair" if drawn.pair else ""
    return (
        f"{drawn.scene}: real roots {roots}{complex_pair}; {drawn.variable} moves from {low:.3g} to "
        f"{high:.3g}."
    )


def _figure(drawn: Sequence[Series]) -> Figure:
    counts = {min(count, 3) for panel in drawn for _, count in panel.roots}
    entries: list[Entry] = [
        ({"color": _CURVE, "linewidth": 1.3}, "X\N{SUBSCRIPT THREE}"),
        ({"color": _ORBIT, "linewidth": 3}, "the orbit's interval"),
        *(entry for count, entry in _ROOTS.items() if count in counts),
    ]
    figure, places = sheet(len(drawn), entries, height=_HEIGHT)
    for axes, panel in zip(places, drawn, strict=True):
        _draw(axes, panel)
    return figure


def _draw(axes: Axes, drawn: Series) -> None:
    from matplotlib.ticker import MaxNLocator

    z, X = drawn.curve.T  # noqa: N806 (as in 49)
    low, high = drawn.interval
    inside = (z >= low) & (z <= high)
    top = float(X[inside].max())
    # A steady motion has no hump: the curve beside it gives the scale.
    scale = top if high > low and top > 0 else float(np.abs(X).max()) / 3 or 1.0
    axes.set(xlim=(z[0], z[-1]), ylim=(-_BELOW * scale, _ABOVE * scale))
    # There is room for a few short numbers only.
    axes.yaxis.set_major_locator(MaxNLocator(5, steps=[1, 2, 5, 10]))
    axes.axhline(0, color=QUIET, linewidth=0.6, zorder=1)
    axes.plot(z, X, color=_CURVE, linewidth=1.3, zorder=3, gid="curve")
    if high > low:
        axes.fill_between(z[inside], 0, X[inside], color=_CURVE, alpha=0.14, linewidth=0, zorder=2)
    axes.plot([low, high], [0, 0], color=_ORBIT, linewidth=3, zorder=4, gid="interval")
    for root, count in drawn.roots:
        if z[0] <= root <= z[-1]:
            axes.plot([root], [0], zorder=5, **_ROOTS[min(count, 3)][0])
    subscript = drawn.variable.translate(_SUBSCRIPTS)
    square = f"({subscript}\N{PRIME}/r)\N{SUPERSCRIPT TWO}"
    axes.set_xlabel(f"{subscript} (impulse)", labelpad=2)
    axes.set_ylabel(f"X\N{SUBSCRIPT THREE} = {square}", labelpad=2)
    name = drawn.scene.partition("/")[2]
    heading = name if name == drawn.regime else f"{name} ({drawn.regime})"
    axes.set_title(heading, pad=4, fontsize=SMALL + 0.5)
