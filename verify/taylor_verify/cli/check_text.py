"""The text that a person reads about a file that was judged."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from rich.console import Console
from rich.table import Table
from rich.text import Text

from taylor_verify.cli.console import new_console, print_indented, print_line, text_of
from taylor_verify.cli.terminal import error_sentences, figure, status_text
from taylor_verify.records.quantities import GATE_FACTOR

if TYPE_CHECKING:
    from taylor_verify.judge.answer import FileJudgement
    from taylor_verify.records.verdict import Verdict


def check_text(judged: FileJudgement, scene: str, rung: str) -> str:
    """What the file is, what its conventions are, a line for each quantity, and every reason."""
    from taylor_verify.records.verdict import summary

    console = new_console()
    print_line(console, Text(judged.file.name, "bold"), f": {_extent(judged)}")
    print_line(console, f"judged as an answer to {scene} in {rung} arithmetic")
    _print_conventions(console, judged)
    print_line(console)
    if any(verdict.at is not None for verdict in judged.verdicts):
        console.print(_quantities_table([v for v in judged.verdicts if v.at is not None]))
        print_line(console)
        has_tolerance = any(verdict.tolerance is not None for verdict in judged.verdicts)
        first = (
            "the tolerance that was asked for, where there is one; else " if has_tolerance else ""
        )
        print_line(
            console,
            f"allowed: {first}{GATE_FACTOR} times what rounding the input and every step would leave;",
        )
        print_line(console, "/floor: the largest error over what it would leave, of all rows.")
    for cause in judged.causes:
        print_line(console, Text("likely cause", "bold yellow"), f"  {cause.sentence}")
    for note in judged.notes:
        print_line(console, Text("note", "yellow"), f"  {note}")
    others = [verdict for verdict in judged.verdicts if verdict.verdict.value != "pass"]
    if others:
        print_line(console)
    for verdict in others:
        print_line(console, status_text(verdict.verdict.value), f"  {verdict.quantity}")
        _print_reason(console, verdict)
    counts = ", ".join(f"{n} {status}" for status, n in summary(judged.verdicts).items() if n)
    print_line(console, f"\n{counts}")
    return text_of(console)


def _extent(judged: FileJudgement) -> str:
    times = judged.file.times
    rows = f"{len(times)} row{'s' if len(times) > 1 else ''}"
    return f"{rows} from t = {float(times[0]):g} to t = {float(times[-1]):g}"


def _print_conventions(console: Console, judged: FileJudgement) -> None:
    found = judged.conventions
    if not found:
        return
    print_line(console)
    certain = any(finding.is_certain for finding in found)
    if not certain:
        heading = (
            "the file departs from the scene's conventions in a way that this motion cannot tell"
        )
    elif judged.accepted:
        heading = "the file departs from the scene's conventions, and was corrected"
    else:
        heading = "the file departs from the scene's conventions, and was judged as it stands"
    print_line(console, Text(heading, "bold yellow"))
    for finding in found:
        print_indented(console, "  ", finding.sentence)
    if certain and not judged.accepted:
        print_line(console, "  (--accept-conventions corrects this and judges the rest)")


def _print_reason(console: Console, verdict: Verdict) -> None:
    """Print the conclusion, the error and its place, its shift of time, and the arithmetic of the bound."""
    reason = verdict.reason
    if reason.conclusion:
        print_indented(console, "    ", reason.conclusion)
    if verdict.at is None:
        return
    print_indented(console, "    ", "; ".join(error_sentences(verdict.row())))
    if reason.meaning:
        print_indented(console, "    ", reason.meaning)
    sign = ": " if reason.tolerance else " = "
    print_indented(console, "    allowed: ", f"{figure(verdict.bound)}{sign}{reason.allowance}")


def _quantities_table(verdicts: Sequence[Verdict]) -> Table:
    table = Table(box=None, padding=(0, 2, 0, 0), pad_edge=False)
    numbers = ("largest error", "at t", "allowed", "/floor", "late by", "error left")
    for heading in ("quantity", "verdict", *numbers, "unit"):
        table.add_column(heading, justify="right" if heading in numbers else "left", no_wrap=True)
    for v in verdicts:
        figures = (v.max, v.at, v.bound, v.ratio)
        cells = [*(figure(f) for f in figures), *_shift_cells(v)]
        table.add_row(v.quantity, status_text(v.verdict.value), *cells, v.unit)
    return table


def _shift_cells(verdict: Verdict) -> tuple[str, str]:
    """The shift of time that explains the error, and what it leaves: the fit of the reason."""
    if verdict.remains is None:
        return "", ""
    left = figure(verdict.remains)
    if verdict.trend is not None:
        return f"{figure(verdict.trend)} t, {verdict.shift}", left
    if verdict.shift == "constant":
        return f"{figure(verdict.time_shift)}, constant", left
    return str(verdict.shift), left
