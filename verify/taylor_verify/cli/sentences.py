"""Verdicts printed on a console in the words of `words`, and the line that ends an answer."""

from __future__ import annotations

import sys
import textwrap
from collections.abc import Sequence

from rich.text import Text

from taylor_verify.cli.answer import FAIL, PASS, UNDECIDED, WRONG_CALL
from taylor_verify.cli.console import Page, bold
from taylor_verify.records.verdict import Verdict
from taylor_verify.words.account import allowance
from taylor_verify.words.next_steps import next_steps

_COLOURS = {"pass": "green", "fail": "bold red", "undecided": "yellow", "vacuous": "yellow"}
_MEANINGS = {PASS: "passed", FAIL: "failed", UNDECIDED: "undecided", WRONG_CALL: "not judged"}
_INDENT = "    "


def status_text(status: str) -> Text:
    return Text(status, _COLOURS.get(status, "magenta"))


def print_sentence(page: Page, verdict: Verdict, place: str = "", why: str = "") -> None:
    """Print the sentence of a verdict, its quantity in the colour of the status.

    ``place`` says behind the status which run it is. A verdict that came as expected has ``why`` in place
    of its sentence.
    """
    status = verdict.verdict.value
    sentence = f"{verdict.quantity}: as expected: {why}" if why else verdict.sentence
    text = f"{status}  {place} {sentence}" if place else sentence
    width = max(page.console.width, 20) if sys.stdout.isatty() else sys.maxsize
    first, *others = textwrap.wrap(text, width, subsequent_indent=_INDENT, break_on_hyphens=False)
    head = Text(first)
    head.stylize(status_text(status).style, 0, len(status if place else verdict.quantity))
    page.line(head)
    for line in others:
        page.line(line)


def figure(value: float | None) -> str:
    return "not finite" if value is None or value != value else f"{value:.3g}"


def print_line(page: Page, line: str) -> None:
    """Print a line whose first words, up to a colon, say what it is, such as a likely cause or a note."""
    what, _, rest = line.partition(":")
    page.line(bold(what, "yellow"), f":{rest}")


def print_arithmetic(page: Page, verdicts: Sequence[Verdict]) -> None:
    """Print the arithmetic of every bound that has one."""
    for verdict in verdicts:
        if verdict.is_compared and verdict.reason.allowance:
            page.indented(f"{verdict.quantity} allowed: ", allowance(verdict))


def print_end(
    page: Page, verdicts: Sequence[Verdict], counts: str, status: int | None, explained: bool
) -> None:
    """Print the counts, the meaning of the exit status, and what to do next.

    ``status`` is None if something other than the rows decides it.
    """
    meaning = f"{_MEANINGS.get(status, '')} (exit status {status})" if status is not None else ""
    page.line(f"{counts}: {meaning or 'by their own bounds'}")
    for step in next_steps(verdicts, explained):
        page.indented("  ", step)
