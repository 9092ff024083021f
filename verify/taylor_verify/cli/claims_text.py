"""The text of the ledger: a line for each entry, and in words what is not plainly true."""

from __future__ import annotations

from collections.abc import Sequence
from math import isfinite

from rich.table import Table
from rich.text import Text

from taylor_verify.claims.document import ClaimRow, Verdict
from taylor_verify.cli.console import new_console, print_indented, print_line, text_of

_COLOURS = {
    Verdict.HOLDS: "green",
    Verdict.RESTORED: "green",
    Verdict.ONLY_IF: "yellow",
    Verdict.FALSE: "bold red",
}
# What is told of an entry below the table, in this order, with its label.
_TOLD = (
    ("correction", "correct    "),
    ("condition", "only if    "),
    ("open", "open       "),
    ("void", "vacuous    "),
    ("counterexample", "fails for  "),
)
_IN_FULL = (
    ("statement", "statement  "),
    ("domain", "domain     "),
    ("lost", "lost       "),
    *_TOLD,
    ("method", "checked by "),
    ("because", "bound      "),
    ("remark", "remark     "),
)


def claims_text(rows: Sequence[ClaimRow], in_full: bool) -> str:
    """A line for each entry, then what is not plainly true with its reason, then the counts.

    Entries that were asked for are told in full.
    """
    console = new_console()
    table = Table(box=None, padding=(0, 2, 0, 0), pad_edge=False)
    table.add_column("claim", overflow="fold")
    table.add_column("verdict", no_wrap=True)
    for heading in ("residual", "bound", "as transcribed"):
        table.add_column(heading, justify="right", no_wrap=True)
    for row in rows:
        table.add_row(Text(row.id), _verdict(row.verdict), *_numbers(row))
    console.print(table)
    print_line(console)
    print_line(
        console,
        "A bound of 0 is that of an identity, expanded in exact rationals. The last column is the "
        "residual of the form as transcribed, or without its condition.",
    )
    for row in rows:
        told = [
            (key, label) for key, label in (_IN_FULL if in_full else _TOLD) if getattr(row, key)
        ]
        if told:
            print_line(console)
            print_line(console, Text(row.id, "bold"), "  ", _verdict(row.verdict))
        for key, label in told:
            print_indented(console, f"  {label}", getattr(row, key))
    verdicts = [row.verdict.value for row in rows]
    counts = (f"{verdicts.count(verdict)} {verdict}" for verdict in dict.fromkeys(verdicts))
    print_line(console, f"\n{', '.join(counts)}")
    return text_of(console)


def _verdict(verdict: Verdict) -> Text:
    return Text(verdict.value, _COLOURS.get(verdict, "magenta"))


def _numbers(row: ClaimRow) -> tuple[str, str, str]:
    residual = row.residual
    transcribed = "" if residual.transcribed is None else _short(residual.transcribed)
    return _short(residual.statement), _short(row.bound), transcribed


def _short(size: float | None) -> str:
    return "not finite" if size is None or not isfinite(size) else f"{size:.2g}"
