"""The verb `claims`: the ledger of the source texts, or some of its entries."""

from __future__ import annotations

import argparse
from collections import Counter
from collections.abc import Sequence
from functools import partial

from rich.table import Table
from rich.text import Text

from taylor_verify.cli.answer import FAIL, PASS, Answer, wrong_calls
from taylor_verify.cli.console import Page, bold
from taylor_verify.cli.progress import working
from taylor_verify_reports.claims.claim_row import ClaimRow, Verdict
from taylor_verify_reports.claims.ledger import UnknownClaim, examined, find, missed
from taylor_verify_reports.studies.claims_page import short

_COLOURS = {
    Verdict.HOLDS: "green",
    Verdict.RESTORED: "green",
    Verdict.ONLY_IF: "yellow",
    Verdict.FALSE: "bold red",
}
# Parts of an entry that always stand below the table; an entry in full has more.
_BRIEF = {
    "correction": "correct",
    "condition": "only if",
    "open": "open",
    "void": "vacuous",
    "counterexample": "fails for",
}
_FULL = {
    **{"statement": "statement", "domain": "domain", "lost": "lost"},
    **_BRIEF,
    **{"method": "checked by", "because": "bound", "remark": "remark"},
}


help = "check every numbered equation and every claim of the two source texts"
example = 'claims "hydromechanics 49 (17)"'


def add(verb: argparse.ArgumentParser) -> None:
    """Add the argument of the verb."""
    verb.add_argument(
        "ids",
        nargs="*",
        metavar="ID",
        help='"heinbockel (2.2.70)", the number "(2.2.70)" alone, or a whole text, "hydromechanics 48"; '
        "default: all statements",
    )


def run(options: argparse.Namespace) -> Answer:
    """Examine the claims asked for."""
    with wrong_calls("", UnknownClaim):
        asked = find(options.ids)
    with working(f"claims, {len(asked)} entries"):
        rows = [finding.row() for finding in examined(asked)]
    faults = missed(rows)
    text = partial(_text, rows, in_full=bool(options.ids))
    return Answer(FAIL if faults else PASS, [row.document() for row in rows], text, faults)


def _text(rows: Sequence[ClaimRow], in_full: bool) -> str:
    """Return a line for each entry, then the reason of each that is not plainly true, then the counts.

    Entries that were asked for by id are shown in full.
    """
    page = Page()
    table = Table(box=None, padding=(0, 2, 0, 0), pad_edge=False)
    table.add_column("claim", overflow="fold")
    table.add_column("verdict", no_wrap=True)
    for heading in ("residual", "bound", "as transcribed"):
        table.add_column(heading, justify="right", no_wrap=True)
    for row in rows:
        residual = row.residual
        transcribed = "" if residual.transcribed is None else short(residual.transcribed)
        numbers = (short(residual.statement), short(row.bound), transcribed)
        table.add_row(Text(row.id), _verdict(row.verdict), *numbers)
    page.console.print(table)
    page.line()
    page.line(
        "A bound of 0 is that of an identity, expanded in exact rationals. The last column is the "
        "residual of the form as transcribed, or without its condition.",
    )
    for row in rows:
        labels = _FULL if in_full else _BRIEF
        parts = {label: getattr(row, key) for key, label in labels.items() if getattr(row, key)}
        if parts:
            page.line()
            page.line(bold(row.id), "  ", _verdict(row.verdict))
        for label, text in parts.items():
            page.indented(f"  {label:11}", text)
    counts = Counter(row.verdict.value for row in rows)
    page.line()
    page.line(f"{', '.join(f'{count} {verdict}' for verdict, count in counts.items())}")
    return page.text()


def _verdict(verdict: Verdict) -> Text:
    return Text(verdict.value, _COLOURS.get(verdict, "magenta"))
