"""The sentences about verdicts on a console, and the line that ends an answer."""

from __future__ import annotations

import sys
import textwrap
from collections.abc import Iterator, Sequence
from math import ceil, log10
from typing import TYPE_CHECKING

from rich.console import Console
from rich.text import Text

from taylor_verify.cli.answer import FAIL, PASS, UNDECIDED, WRONG_CALL
from taylor_verify.cli.console import print_indented, print_line
from taylor_verify.records.error_kind import ErrorKind

if TYPE_CHECKING:
    from taylor_verify.records.answers import LikelyCause
    from taylor_verify.records.verdict import Verdict

_COLOURS = {"pass": "green", "fail": "bold red", "undecided": "yellow", "vacuous": "yellow"}
_MEANINGS = {PASS: "passed", FAIL: "failed", UNDECIDED: "undecided", WRONG_CALL: "not judged"}
_INDENT = "    "
# Errors of these kinds are no matter of accuracy: a wider tolerance would hide them.
_NO_ACCURACY = (
    *(None, ErrorKind.CONVENTION, ErrorKind.OFFSET, ErrorKind.TIME_SHIFT),
    ErrorKind.NOT_FINITE,
)
# A tolerance beyond this judges nothing.
_LARGEST_TOLERANCE = 0.01


def status_text(status: str) -> Text:
    return Text(status, _COLOURS.get(status, "magenta"))


def print_sentence(console: Console, verdict: Verdict, place: str = "", why: str = "") -> None:
    """Print the sentence of a verdict, its quantity in the colour of the status.

    ``place`` says behind the status which run it is. A verdict that came as expected has ``why`` in place
    of its sentence.
    """
    said = f"{verdict.quantity}: as expected: {why}" if why else verdict.sentence
    head = Text.assemble(status_text(verdict.verdict.value), f"  {place} ") if place else Text()
    width = max(console.width, 20) if sys.stdout.isatty() else sys.maxsize
    lines = textwrap.wrap(
        head.plain + said, width, subsequent_indent=_INDENT, break_on_hyphens=False
    )
    first = Text(lines[0])
    begin = 0 if place else len(verdict.quantity)
    first.stylize(
        _COLOURS.get(verdict.verdict.value, "magenta"), 0, begin or len(verdict.verdict.value)
    )
    print_line(console, first)
    for line in lines[1:]:
        print_line(console, line)


def figure(value: float | None) -> str:
    return "not finite" if value is None or value != value else f"{value:.3g}"


def print_cause(console: Console, cause: LikelyCause, place: str = "") -> None:
    """Print a likely cause; ``place`` says which run it is about."""
    about = f"  {place}" if place else ""
    print_line(console, Text("likely cause", "bold yellow"), f"{about}: {cause.sentence}")


def print_arithmetic(console: Console, verdicts: Sequence[Verdict]) -> None:
    """Print the arithmetic of every bound that has one."""
    for verdict in verdicts:
        if verdict.is_compared and verdict.reason.allowance:
            place = f"{verdict.bound:.3g} = " if verdict.bound is not None else ""
            text = f"{place}{verdict.reason.allowance}"
            print_indented(console, f"{verdict.quantity} allowed: ", text)


def print_end(
    console: Console, verdicts: Sequence[Verdict], counts: str, status: int | None, explained: bool
) -> None:
    """Print the counts, the meaning of the exit status, and what to do next.

    ``status`` is None where something else than the rows decides it.
    """
    meaning = f"{_MEANINGS.get(status, '')} (exit status {status})" if status is not None else ""
    print_line(console, f"{counts}: {meaning or 'by their own bounds'}")
    for step in _next_steps(verdicts, explained):
        print_indented(console, "  ", step)


def _next_steps(verdicts: Sequence[Verdict], explained: bool) -> Iterator[str]:
    tolerance = coarser_tolerance(verdicts)
    if tolerance is not None:
        yield f"--tolerance {tolerance:.0e} judges a method of this accuracy"
    if not explained and any(v.is_compared and v.verdict.value != "pass" for v in verdicts):
        yield "--explain shows the arithmetic of what is allowed"


def coarser_tolerance(verdicts: Sequence[Verdict]) -> float | None:
    """Return the power of ten that all failed rows are within; None where accuracy is not the fault."""
    failed = [v for v in verdicts if v.verdict.value == "fail"]
    errors = [v.max for v in failed if v.max is not None and v.error_kind not in _NO_ACCURACY]
    has_one = any(v.tolerance is not None for v in verdicts)
    if not failed or has_one or len(errors) < len(failed) or not max(errors) < _LARGEST_TOLERANCE:
        return None
    return float(10.0 ** ceil(log10(max(errors))))
