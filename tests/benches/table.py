"""The table of `make bench`: each ratio beside the last one and its target, then what to look at."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from typing import Final

from rich import box
from rich.table import Table

from benches.history import Row, has_moved
from benches.ratio import Ratio
from benches.suite import Measured


def table(measured: Sequence[Measured], last: Mapping[str, Row]) -> Table:
    """Return a row for each ratio."""
    made = Table(box=box.SIMPLE_HEAD, pad_edge=False)
    made.add_column("ratio", no_wrap=True)
    for heading in ("last", "now", "±", "target", "cost", "target", "a second"):
        made.add_column(heading, justify="right", no_wrap=True)
    made.add_column("", no_wrap=True)
    for one in measured:
        before = last.get(one.ratio.name)
        words = [*(["missed"] if one.misses else []), *_change(one, before)]
        made.add_row(*_cells(one, before), ", ".join(words))
    return made


def _cells(one: Measured, before: Row | None) -> Iterator[str]:
    ratio = one.ratio
    yield ratio.name
    yield format_ratio(before.ratio) if before else ""
    yield format_ratio(one.value)
    yield format_ratio(one.spread)
    yield format_ratio(ratio.target.most) if ratio.target else ""
    yield f"{format_cost(ratio, one.cost)} a {ratio.unit}"
    yield format_cost(ratio, ratio.limit.most) if ratio.limit else ""
    yield f"{1 / one.cost:,.0f}" if ratio.measure == "second" and one.cost < 1 else ""


def _change(one: Measured, before: Row | None) -> Iterator[str]:
    if before is not None and has_moved(one, before):
        yield "better" if one.value < before.ratio else "worse"


def remarks(measured: Sequence[Measured], last: Mapping[str, Row]) -> Iterator[str]:
    """Yield a line for each target that is missed, then for each ratio that is not what it was."""
    for because, names in _missed(measured).items():
        yield f"missed ({because}): {', '.join(names)}"
    for one in measured:
        before = last.get(one.ratio.name)
        for word in _change(one, before):
            now = f"{format_ratio(one.value)} ±{format_ratio(one.spread)}"
            was = f"{format_ratio(before.ratio)} ±{format_ratio(before.spread)}"
            yield f"{word}: {one.ratio.name} is {now}, was {was} at {before.commit} on {before.date}"


def _missed(measured: Sequence[Measured]) -> dict[str, list[str]]:
    """Return the names of the ratios that miss each target, by the reason for it."""
    names: dict[str, list[str]] = defaultdict(list)
    for one in measured:
        ratio = one.ratio
        wanted = ((ratio.target, one.misses_target), (ratio.limit, one.misses_limit))
        for target, is_missed in wanted:
            if target is not None and is_missed:
                names[target.because].append(ratio.name)
    return names


def format_ratio(value: float) -> str:
    """Return a ratio with three digits."""
    return f"{value:.3g}" if value < 1000 else f"{value:,.0f}"


_SECONDS: Final = {"s": 1.0, "ms": 1e-3, "µs": 1e-6, "ns": 1e-9}


def format_cost(ratio: Ratio, value: float) -> str:
    """Return the cost of one unit with three digits."""
    if ratio.measure == "byte":
        return f"{value / 2**20:.1f} MiB"
    unit = next((unit for unit, size in _SECONDS.items() if value >= size), "ns")
    return f"{value / _SECONDS[unit]:.3g} {unit}"
