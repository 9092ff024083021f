"""The sentences about verdicts on a console, and the line that ends an answer."""

from __future__ import annotations

import sys
import textwrap
from collections.abc import Iterator, Sequence
from math import ceil, log10
from typing import TYPE_CHECKING

from rich.text import Text

from taylor_verify.cli.answer import FAIL, PASS, UNDECIDED, WRONG_CALL
from taylor_verify.cli.console import Page, bold
from taylor_verify.records.error_kind import ErrorKind

if TYPE_CHECKING:
    from taylor_verify.records.answers import LikelyCause
    from taylor_verify.records.verdict import Verdict

_COLOURS = {"pass": "green", "fail": "bold red", "undecided": "yellow", "vacuous": "yellow"}
_MEANINGS = {PASS: "passed", FAIL: "failed", UNDECIDED: "undecided", WRONG_CALL: "not judged"}
_INDENT = "    "
# Errors of these kinds are no matter of accuracy: a wider tolerance would hide them.
_NO_ACCURACY = (
    None,
    ErrorKind.CONVENTION,
    ErrorKind.OFFSET,
    ErrorKind.TIME_SHIFT,
    ErrorKind.NOT_FINITE,
)
# A tolerance beyond this judges nothing.
_LARGEST_TOLERANCE = 0.01


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


def print_cause(page: Page, cause: LikelyCause, place: str = "") -> None:
    """Print a likely cause; ``place`` says which run it is about."""
    about = f"  {place}" if place else ""
    page.line(bold("likely cause", "yellow"), f"{about}: {cause.sentence}")


def print_arithmetic(page: Page, verdicts: Sequence[Verdict]) -> None:
    """Print the arithmetic of every bound that has one."""
    for verdict in verdicts:
        if verdict.is_compared and verdict.reason.allowance:
            place = f"{verdict.bound:.3g} = " if verdict.bound is not None else ""
            text = f"{place}{verdict.reason.allowance}"
            page.indented(f"{verdict.quantity} allowed: ", text)


def print_end(
    page: Page, verdicts: Sequence[Verdict], counts: str, status: int | None, explained: bool
) -> None:
    """Print the counts, the meaning of the exit status, and what to do next.

    ``status`` is None if something other than the rows decides it.
    """
    meaning = f"{_MEANINGS.get(status, '')} (exit status {status})" if status is not None else ""
    page.line(f"{counts}: {meaning or 'by their own bounds'}")
    for step in _next_steps(verdicts, explained):
        page.indented("  ", step)


def _next_steps(verdicts: Sequence[Verdict], explained: bool) -> Iterator[str]:
    tolerance = coarser_tolerance(verdicts)
    if tolerance is not None:
        yield f"--tolerance {tolerance:.0e} judges a method of this accuracy"
    if not explained and any(v.is_compared and v.verdict.value != "pass" for v in verdicts):
        yield "--explain shows the arithmetic of what is allowed"


def coarser_tolerance(verdicts: Sequence[Verdict]) -> float | None:
    """Return the least power of ten above the errors of all failed rows.

    None if no row failed, or if the fault is not one of accuracy.
    """
    failed = [v for v in verdicts if v.verdict.value == "fail"]
    errors = [v.max for v in failed if v.max is not None and v.error_kind not in _NO_ACCURACY]
    has_one = any(v.tolerance is not None for v in verdicts)
    if not failed or has_one or len(errors) < len(failed) or not max(errors) < _LARGEST_TOLERANCE:
        return None
    return float(10.0 ** ceil(log10(max(errors))))
