"""The text of a trade-off: a line for each setting, the front in words, what was asked and achieved."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from rich.console import Console
from rich.table import Table
from rich.text import Text

from taylor_verify.cli.console import new_console, print_indented, print_line, text_of
from taylor_verify.studies.tradeoff.document import label

_NOT_RUN = "not run"
_HEADINGS = {
    "The front": "sentences",
    "The front of integrators": "integrators",
    "Asked for and achieved": "requests",
}


def tradeoff_text(found: Sequence[Mapping[str, Any]]) -> str:
    """For each scene a line for each setting, the front in words, and what was asked and achieved."""
    console = new_console()
    for trade in found:
        _print_trade(console, trade)
    return text_of(console)


def _print_trade(console: Console, trade: Mapping[str, Any]) -> None:
    timing, machine = trade["timing"], trade["provenance"]
    print_line(console, Text(trade["scene"], "bold"), f" on {machine['processor']}")
    console.print(_points_table(trade))
    for reason, names in _not_run(trade["points"]).items():
        print_line(console, f"not run: {', '.join(names)} ({reason})")
    for row in trade["points"]:
        if row["standing"] not in ("sound", _NOT_RUN):
            told = f"  {_label(row)}: {row['because']}"
            print_line(console, Text(row["standing"], "bold red"), told)
    print_line(
        console,
        f"Best of up to {timing['repeats']} solves, {timing['order']} (seed {timing['seed']}); "
        "* is on the front. first: the whole first solve, with compiling and start-up.",
    )
    print_line(console, f"seconds: {timing['of']}.")
    floors = [f"{rung} {least:.2g}" for rung, least in trade.get("attainable", {}).items() if least]
    if floors:
        told = (
            f"Attainable, one rounding of the state a sample and nothing else: {', '.join(floors)}."
        )
        print_line(console, told)
    if any("cold" in row for row in trade["points"]):
        print_line(console)
        print_line(console, Text("In a process of its own, nothing compiled", "bold"))
        console.print(_cold_table(trade["points"]))
    for heading, key in _HEADINGS.items():
        if not trade.get(key):
            continue
        print_line(console)
        print_line(console, Text(heading, "bold"))
        for sentence in trade[key]:
            print_indented(console, "  ", sentence)
    if trade.get("recommendation"):
        print_line(console)
        print_line(console, Text(trade["recommendation"]["sentence"], "green"))
        print_line(console, f"  {trade['recommendation']['command']}")
    print_line(console)


def _points_table(trade: Mapping[str, Any]) -> Table:
    rows = [row for row in trade["points"] if row["standing"] != _NOT_RUN]
    table = Table(box=None, padding=(0, 1, 0, 0), pad_edge=False)
    quantities = list(dict.fromkeys(name for row in rows for name in row["max"]))
    errors = [heading for name in quantities for heading in (name, "final")]
    numbers = ("drift", "steps", "evals", "seconds", "spread", "first", "compile")
    for heading in ("", "setting", "rung"):
        table.add_column(heading, no_wrap=True)
    for heading in (*errors, *numbers):
        table.add_column(heading, justify="right", no_wrap=True)
    for row in rows:
        mark = "*" if _label(row) in trade["front"] else "" if row["standing"] == "sound" else "!"
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
    """Seconds of the first solve of all, part by part, and the solve that needs no more of that."""
    table = Table(box=None, padding=(0, 1, 0, 0), pad_edge=False)
    table.add_column("setting", no_wrap=True)
    parts = ("process", "importing", "compiling", "solving", "rest", "whole")
    for heading in (*parts, "later solves"):
        table.add_column(heading, justify="right", no_wrap=True)
    for row in points:
        if row.get("cold"):
            cells = [*(row["cold"][part] for part in parts), row["seconds"]]
            table.add_row(Text(_label(row)), *(_short(value) for value in cells))
    return table


def _label(row: Mapping[str, Any]) -> str:
    return label(row["solver"], row["setting"], row["rung"])


def _not_run(points: Sequence[Mapping[str, Any]]) -> dict[str, list[str]]:
    """What was not run, by the reason: a whole family by its name, else each setting."""
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
