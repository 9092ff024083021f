"""Limits and numbers of logarithmic axes: powers of ten, and their multiples by 2 and 5 on short axes."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from math import ceil, floor, log10
from typing import TYPE_CHECKING, Final

from taylor_verify.plotting.wording import power_of_ten

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Limits = tuple[float, float]

# An axis shows at least a decade, even for close points.
_LEAST_DECADES: Final = 1.0
# Plain digits are shorter between these numbers.
_LEAST_PLAIN: Final = 1e-3
_MOST_PLAIN: Final = 1e5


def number_axes(axes: Axes) -> None:
    """Give numbers and a grid to axes whose limits are set."""
    from matplotlib.ticker import LogLocator, NullFormatter

    axes.grid(visible=True, which="major")
    axes.tick_params(which="minor", length=1.5)
    for axis, limits in ((axes.xaxis, axes.get_xlim()), (axes.yaxis, axes.get_ylim())):
        is_long = powers_within(*limits) >= 2
        axis.set_major_locator(LogLocator(subs=(1.0,) if is_long else (1.0, 2.0, 5.0)))
        axis.set_major_formatter(partial(number, is_long=is_long))
        axis.set_minor_formatter(NullFormatter())


def powers_within(low: float, high: float) -> int:
    """Return the number of powers of ten on an axis."""
    return floor(log10(high)) - ceil(log10(low)) + 1


def number(value: float, _place: int | None = None, *, is_long: bool) -> str:
    """Return the text of a number: a power of ten on a long axis, one digit on a short one."""
    if is_long:
        return power_of_ten(value)
    if _LEAST_PLAIN <= value < _MOST_PLAIN:
        return f"{value:.1g}" if value < 1 else f"{value:.0f}"
    power = floor(log10(value) + 1e-9)
    digit = round(value / 10.0**power)
    return power_of_ten(10.0**power) if digit == 1 else f"{digit}·{power_of_ten(10.0**power)}"


def widened(values: Sequence[float], before: float, after: float) -> Limits:
    """Return limits of a logarithmic axis for these values, with margins as parts of its length."""
    least, most = (log10(end(values)) if values else 0.0 for end in (min, max))
    lacking = max(_LEAST_DECADES - (most - least), 0.0) / 2
    least, most = least - lacking, most + lacking
    length = (most - least) / (1 - before - after)
    return 10 ** (least - before * length), 10 ** (most + after * length)
