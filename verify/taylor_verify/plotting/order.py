"""Picture of the errors of several files against their steps: lines of quantities, and their floors."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import TYPE_CHECKING, Any, Final

from taylor_verify.plotting.log_axes import number_axes, widened
from taylor_verify.plotting.palette import QUIET
from taylor_verify.plotting.picture import Picture
from taylor_verify.plotting.sheet import name_lines, sheet
from taylor_verify.plotting.style import look_of_line
from taylor_verify.plotting.wording import stem_of
from taylor_verify.records.answers import Order
from taylor_verify.records.quantities import is_state

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Points = list[tuple[float, float]]

# In inches.
_HEIGHT: Final = 3.525
_DOTTED: Final[dict[str, Any]] = {"linestyle": (0, (1, 2)), "linewidth": 0.7}


def has_points(order: Order) -> bool:
    """Return True if a logarithmic axis can show an error of the quantity."""
    return bool(_errors(order))


def picture(title: str, orders: Sequence[Order]) -> Picture:
    """Return the picture of all quantities: state on the left, conserved quantities on the right.

    Raises ValueError if no error is above zero.
    """
    drawn = [order for order in orders if has_points(order)]
    if not drawn:
        raise ValueError("expected an error above zero, got none @ order")
    sentences = ". ".join(order.sentence for order in drawn)
    return Picture(
        stem_of({"scene": title.partition(" ")[0]}, "order"),
        f"Error against step: {title}",
        f"Largest error against the step h on {title}, both logarithmic. {sentences}.",
        partial(_figure, drawn),
    )


def _figure(orders: Sequence[Order]) -> Figure:
    groups = {
        "state": [order for order in orders if is_state(order.quantity)],
        "conserved quantities": [order for order in orders if not is_state(order.quantity)],
    }
    panels = [(heading, group) for heading, group in groups.items() if group]
    entries = [
        ({"color": QUIET, "linewidth": 1.8}, "order read here"),
        ({"color": QUIET, **_DOTTED}, "roundoff floor"),
    ]
    figure, places = sheet(len(panels), entries, height=_HEIGHT)
    for axes, (heading, group) in zip(places, panels, strict=True):
        axes.set_title(heading, pad=4)
        _draw(axes, group)
    return figure


def _draw(axes: Axes, orders: Sequence[Order]) -> None:
    errors = [_errors(order) for order in orders]
    floors = [[(p.step, p.attainable) for p in o.points if p.attainable] for o in orders]
    everything = [point for points in (*errors, *floors) for point in points]
    axes.set(xscale="log", yscale="log", xlabel="step h", ylabel="largest error")
    axes.set(xlim=widened([h for h, _ in everything], 0.08, 0.08))
    axes.set(ylim=widened([error for _, error in everything], 0.06, 0.06))
    number_axes(axes)
    for i, order in enumerate(orders):
        look = look_of_line(i).line
        (line,) = axes.plot(*zip(*errors[i], strict=True), gid=order.quantity, zorder=3, **look)
        line.set_label(_name(order))
        least, most = order.smallest or 0.0, order.largest or 0.0
        read = [p for p in errors[i] if order.order is not None and least <= p[0] <= most]
        if read:
            heavy = {**look, "linewidth": 1.8 * look["linewidth"]}
            axes.plot(*zip(*read, strict=True), zorder=3, gid="order", **heavy)
        if floors[i]:
            axes.plot(*zip(*floors[i], strict=True), color=look["color"], gid="floor", **_DOTTED)
    name_lines(axes)


def _name(order: Order) -> str:
    unit = " (rad)" if order.unit == "rad" else ""
    return order.quantity + unit + ("" if order.order is None else f", order {order.order:.1f}")


def _errors(order: Order) -> Points:
    return [(p.step, p.error) for p in order.points if p.error]
