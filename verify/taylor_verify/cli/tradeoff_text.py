"""The text of a trade-off: a line for each setting, the front in words, what was asked and achieved."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from rich.table import Table
from rich.text import Text

from taylor_verify.cli.console import Page, bold
from taylor_verify.studies.tradeoff.pictures.wording import label_of

_NOT_RUN = "not run"
_HEADINGS = {
    "The front": "sentences",
    "The front of integrators": "integrators",
    "Asked for and achieved": "requests",
}


def tradeoff_text(found: Sequence[Mapping[str, Any]]) -> str:
    """Return for each scene a line for each setting, the front in words, the errors asked and achieved."""
    page = Page()
    for trade in found:
        _print_trade(page, trade)
    return page.text()


def _print_trade(page: Page, trade: Mapping[str, Any]) -> None:
    timing, machine = trade["timing"], trade["provenance"]
    page.line(bold(trade["scene"]), f" on {machine['processor']}")
    page.console.print(_points_table(trade))
    for reason, names in _not_run(trade["points"]).items():
        page.line(f"not run: {', '.join(names)} ({reason})")
    for row in trade["points"]:
        if row["standing"] not in ("sound", _NOT_RUN):
            told = f"  {label_of(row)}: {row['because']}"
            page.line(bold(row["standing"], "red"), told)
    page.line(
        f"Best of up to {timing['repeats']} solves, {timing['order']} (seed {timing['seed']}); "
        "* is on the front. first: the whole first solve, with compiling and start-up.",
    )
    page.line(f"seconds: {timing['of']}.")
    floors = [f"{rung} {least:.2g}" for rung, least in trade.get("attainable", {}).items() if least]
    if floors:
        told = (
            f"Attainable, one rounding of the state a sample and nothing else: {', '.join(floors)}."
        )
        page.line(told)
    if any("cold" in row for row in trade["points"]):
        page.line()
        page.line(bold("In a process of its own, nothing compiled"))
        page.console.print(_cold_table(trade["points"]))
    for heading, key in _HEADINGS.items():
        if trade.get(key):
            page.line()
            page.line(bold(heading))
            page.indented("  ", *trade[key])
    if trade.get("recommendation"):
        page.line()
        page.line(Text(trade["recommendation"]["sentence"], "green"))
        page.line(f"  {trade['recommendation']['command']}")
    page.line()


def _table(words: Sequence[str], numbers: Sequence[str]) -> Table:
    """Return a table with columns of words to the left and of numbers to the right."""
    table = Table(box=None, padding=(0, 1, 0, 0), pad_edge=False)
    for heading in words:
        table.add_column(heading, no_wrap=True)
    for heading in numbers:
        table.add_column(heading, justify="right", no_wrap=True)
    return table


def _points_table(trade: Mapping[str, Any]) -> Table:
    rows = [row for row in trade["points"] if row["standing"] != _NOT_RUN]
    quantities = list(dict.fromkeys(name for row in rows for name in row["max"]))
    errors = [heading for name in quantities for heading in (name, "final")]
    numbers = ("drift", "steps", "evals", "seconds", "spread", "first", "compile")
    table = _table(("", "setting", "rung"), (*errors, *numbers))
    for row in rows:
        mark = "*" if label_of(row) in trade["front"] else "" if row["standing"] == "sound" else "!"
        cells = [row[part].get(name) for name in quantities for part in ("max", "final")]
        table.add_row(
            *(mark, Text(f"{row['solver']} {row['setting']}".rstrip()), row["rung"]),
            *(_short(value) for value in (*cells, row["drift"])),
            *(str(row["steps"]), str(row["evaluations"])),
            *(_short(row[key]) for key in ("seconds", "spread", "first_seconds")),
            _short(row["compile_seconds"]),
        )
    return table


def _cold_table(points: Sequence[Mapping[str, Any]]) -> Table:
    """Return the seconds of the first solve, part by part, and of a solve after it."""
    parts = ("process", "importing", "compiling", "solving", "rest", "whole")
    table = _table(("setting",), (*parts, "later solves"))
    for row in points:
        if row.get("cold"):
            cells = [*(row["cold"][part] for part in parts), row["seconds"]]
            table.add_row(Text(label_of(row)), *(_short(value) for value in cells))
    return table


def _not_run(points: Sequence[Mapping[str, Any]]) -> dict[str, list[str]]:
    """Return the settings that were not run, by the reason; a whole family by its name."""
    ran = {row["family"] for row in points if row["standing"] != _NOT_RUN}
    found: dict[str, dict[str, None]] = {}
    for row in points:
        if row["standing"] == _NOT_RUN:
            name = f"{row['solver']} {row['setting']}".rstrip()
            name = f"{name} {row['rung']}" if row["family"] in ran else row["family"]
            found.setdefault(row["because"], {})[name] = None
    return {reason: list(names) for reason, names in found.items()}


def _short(value: float | None) -> str:
    return "" if value is None else f"{value:.2g}"
