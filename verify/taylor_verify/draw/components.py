"""The components of the motion against time: omega in principal axes, or beside loads in body axes.

A flip is where the middle component of omega is zero: from one to the next a free triaxial body takes the
flip time 2K/lam of its orbit.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import partial
from itertools import cycle
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from taylor_verify.draw.caption import OMEGA, SUBSCRIPTS, Document, NotDrawn, captioned
from taylor_verify.draw.view import Numbers
from taylor_verify.plotting.picture import Picture
from taylor_verify.plotting.sheet import Entry, sheet
from taylor_verify.plotting.style import QUIET

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


# In inches.
_HEIGHT: Final = 2.7
# The components differ in their dashes too, for readers who see no colours.
LINES: Final[tuple[dict[str, Any], ...]] = (
    {"color": "#0B5FA5", "linewidth": 1.5},
    {"color": "#A83C00", "linewidth": 1.5, "dashes": (5, 1.6)},
    {"color": "#1C8578", "linewidth": 1.5, "dashes": (1.4, 1.2)},
)
_LETTERS: Final = {
    "moment": ("M", "moment, body axes"),
    "force": ("X", "force, body axes"),
    "couple": ("L", "couple, body axes"),
}
_FLIP: Final[dict[str, Any]] = {"color": QUIET, "linewidth": 0.8, "gid": "flip"}
# Room beyond the values, in parts of their extent.
_ROOM: Final = 0.06
# Room at the end of the times, for half a number.
_ASIDE: Final = 0.03


@dataclass(frozen=True)
class Panel:
    """The components (n, m) of one vector, with its letter and its name.

    Values that are held stay the same from one instant to the next.
    """

    letter: str
    name: str
    rows: Numbers
    is_held: bool = False


@dataclass(frozen=True)
class Series:
    """The panels at these times; the times of the flips, and the flip time of an orbit that has one."""

    times: Numbers
    panels: tuple[Panel, ...]
    flips: tuple[float, ...]
    flip_time: float | None


def series(document: Document) -> Series:
    """Return the components of omega in principal axes, or of the loads and what they act on in body axes.

    Raises NotDrawn if the start and the end are the same double.
    """
    course, body = document["course"], document["body"]
    times = np.array(course["t"])
    if times[0] == times[-1]:
        raise NotDrawn(
            f"expected a span of time that double precision resolves, got {times[0]!r} as start and as "
            f"end @ {document['scene']}"
        )
    if body is None:
        panels = (
            Panel("x", "linear impulse", np.array(course["linear_impulse"])),
            Panel("y", "angular impulse", np.array(course["angular_impulse"])),
        )
        return Series(times, (*panels, *_acting(document)), (), None)
    # Loads beside it are in body axes.
    has_loads = bool(document["acting"])
    axes, name = (np.eye(3), "body") if has_loads else (np.array(body["axes"]), "principal")
    rows = np.array(course["omega"]) @ axes.T
    panel = Panel(OMEGA, f"angular velocity, {name} axes", rows)
    numbers = {row["name"]: float(row["value"]) for row in document["analytic"]}
    flips: tuple[float, ...] = ()
    # The flips are in the time of the scene. With damping the flip time of the orbit is in another time.
    if document["is_free"] and not document["rotor"] and "saddle_rate" in numbers:
        flips = _zeros(times, rows[:, int(np.argsort(body["principal_moments"])[1])])
    flip_time = None if document["damping"] else numbers.get("flip_time")
    return Series(times, (panel, *_acting(document)), flips, flip_time)


def _acting(document: Document) -> Iterator[Panel]:
    """Yield the panels of loads and own states."""
    for each in document["acting"]:
        letter, name = _LETTERS.get(each["name"], (each["name"], f"state {each['name']}"))
        yield Panel(letter, name, np.array(each["rows"]), each["is_held"])


def _zeros(times: Numbers, values: Numbers) -> tuple[float, ...]:
    """Return the times at which the values change sign, interpolated linearly between two rows."""
    places = np.flatnonzero(values[:-1] * values[1:] < 0)
    first, last = values[places], values[places + 1]
    zeros = times[places] + (times[places + 1] - times[places]) * first / (first - last)
    return tuple(float(t) for t in zeros)


def picture(document: Document) -> Picture:
    """Return the components of one scene against time. Raises NotDrawn as `series` does."""
    components = series(document)
    names = " and ".join(panel.name for panel in components.panels)
    alt = (
        f"{names[0].upper()}{names[1:]} of {document['scene']}, each component against time, from t = "
        f"{components.times[0]:g} to t = {components.times[-1]:g}."
    )
    if components.flips:
        flips = ", ".join(f"{t:.4g}" for t in components.flips)
        alt += f" The middle component is zero, a flip, at t = {flips}."
    if components.flip_time is not None:
        alt += f" The flip time is {components.flip_time:.9g}."
    return captioned(document, "time", "Motion in time", alt, partial(figure, components))


def figure(components: Series, words: str) -> Figure:
    """Return the picture of all panels; ``words`` stand below the legend."""
    entries: list[Entry] = [
        (dict(look), ", ".join(_components_named(components, k))) for k, look in enumerate(LINES)
    ]
    if components.flips:
        pace = "" if components.flip_time is None else f", every {components.flip_time:.5g}"
        entries.append((_FLIP, f"flip: the middle component is 0{pace}"))
    drawn, places = sheet(len(components.panels), entries, words, _HEIGHT)
    for axes, panel in zip(places, components.panels, strict=True):
        _draw(axes, components, panel)
    return drawn


def _components_named(components: Series, k: int) -> Iterator[str]:
    """Yield the names of the components that the line k shows."""
    for panel in components.panels:
        if panel.rows.shape[1] == 1 and not k:
            yield panel.letter
        elif panel.rows.shape[1] > max(k, 1):
            yield f"{panel.letter}{SUBSCRIPTS[k]}"


def _draw(axes: Axes, components: Series, panel: Panel) -> None:
    from matplotlib.ticker import MaxNLocator

    way = "steps-post" if panel.is_held else "default"
    for look, values in zip(cycle(LINES), panel.rows.T, strict=False):
        axes.plot(components.times, values, gid="course", zorder=3, drawstyle=way, **look)
    for flip in components.flips:
        axes.axvline(flip, zorder=1, **_FLIP)
    low, high = float(panel.rows.min()), float(panel.rows.max())
    extent = (high - low) or abs(high) or 1.0
    first, last = sorted((float(components.times[0]), float(components.times[-1])))
    axes.set(xlim=(first, last + _ASIDE * (last - first)), xlabel="time t")
    axes.xaxis.set_major_locator(MaxNLocator(5, steps=[1, 2, 5, 10]))
    axes.set(ylim=(low - _ROOM * extent, high + _ROOM * extent))
    axes.axhline(0, color=QUIET, linewidth=0.5, zorder=0)
    # A power of ten above the axis would push the title off the sheet.
    axes.yaxis.set_major_formatter(lambda value, _: f"{value:.4g}".replace("-", "\N{MINUS SIGN}"))
    axes.set_title(panel.name, pad=4)
