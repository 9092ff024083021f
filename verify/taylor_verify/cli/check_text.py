"""The text that a person reads about a file that was judged."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Final

from rich.console import Console
from rich.text import Text

from taylor_verify.cli.console import new_console, print_indented, print_line, text_of
from taylor_verify.cli.sentences import (
    print_arithmetic,
    print_end,
    print_sentence,
    status_text,
)
from taylor_verify.cli.table import Heading, print_table
from taylor_verify.cli.terminal import figure
from taylor_verify.records.quantities import GATE_FACTOR

if TYPE_CHECKING:
    from taylor_verify.judge.files.judgement import FileJudgement
    from taylor_verify.records.verdict import Verdict

_HEADINGS: Final = (
    *(Heading("quantity"), Heading("verdict")),
    *(Heading(name, to_right=True) for name in ("error", "at t", "allowed", "/floor", "since t")),
    Heading("unit"),
)


def check_text(
    judged: FileJudgement, scene: str, rung: str, status: int | None, explained: bool = False
) -> str:
    """Return the sentence for each quantity, the likely causes, the numbers, and the counts.

    The conventions of the file come first. With ``explained`` the arithmetic of the bounds is there too.
    """
    from taylor_verify.records.showing import counts

    console = new_console()
    print_line(console, Text(judged.file.name, "bold"), f": {_extent(judged)}")
    print_line(console, f"judged as an answer to {scene} in {rung} arithmetic")
    _print_conventions(console, judged)
    print_line(console)
    for verdict in judged.verdicts:
        print_sentence(console, verdict)
    for cause in judged.causes:
        print_line(console, Text("likely cause", "bold yellow"), f": {cause.sentence}")
    for note in judged.notes:
        print_line(console, Text("note", "yellow"), f": {note}")
    print_line(console)
    if any(verdict.is_compared for verdict in judged.verdicts):
        print_numbers(console, judged.verdicts)
        print_line(console)
        if explained:
            print_arithmetic(console, judged.verdicts)
            print_line(console)
    print_end(console, judged.verdicts, counts(judged.verdicts), status, explained)
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


def print_numbers(console: Console, verdicts: Sequence[Verdict]) -> None:
    """Print the numbers of all quantities, and what stands in the columns."""
    print_table(console, _HEADINGS, [_cells(verdict) for verdict in verdicts], keys=1)
    print_line(console)
    by_tolerance = any(verdict.tolerance is not None for verdict in verdicts)
    asked = "the tolerance that was asked for, where there is one; else " if by_tolerance else ""
    allowed = f"{asked}{GATE_FACTOR} times the roundoff floor, which perfect rounding would leave"
    print_indented(console, "", f"allowed: {allowed}; /floor: the largest error over that floor")


def _cells(v: Verdict) -> list[str | Text]:
    since = "" if v.since is None else figure(v.since)
    numbers = (v.max, v.at, v.bound, v.ratio)
    figures = [figure(number) if v.is_compared else "" for number in numbers]
    return [v.quantity, status_text(v.verdict.value), *figures, since, v.unit]
