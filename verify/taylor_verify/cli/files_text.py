"""The text that a person reads about several files of one solver."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from rich.console import Console
from rich.table import Table
from rich.text import Text

from taylor_verify.cli.console import new_console, print_indented, print_line, text_of
from taylor_verify.cli.sentences import status_text
from taylor_verify.cli.terminal import figure
from taylor_verify.records.quantities import STATES
from taylor_verify.records.showing import counts

if TYPE_CHECKING:
    from taylor_verify.judge.files.judgement import FileJudgement
    from taylor_verify.judge.series.files import FilesJudgement


def files_text(judged: FilesJudgement, scene: str, rung: str) -> str:
    """Return the order of each quantity, a line for each file, and what is peculiar to a file."""
    console = new_console()
    head = f"{len(judged.files)} files"
    print_line(console, Text(head, "bold"), f": judged as answers to {scene} in {rung} arithmetic")
    for order in judged.order:
        print_indented(console, "  ", order.sentence)
    common = [
        note for note in judged.files[0].notes if all(note in one.notes for one in judged.files)
    ]
    for note in (*judged.notes, *common):
        print_line(console, Text("note", "yellow"), f"  {note}")
    print_line(console)
    console.print(_files_table(judged))
    for one in judged.files:
        _print_peculiar(console, one, common)
    print_line(console, f"\n{counts(judged.verdicts)}; `check` of one file alone says the reasons")
    return text_of(console)


def _files_table(judged: FilesJudgement) -> Table:
    """The largest error of each state quantity in each file, the largest step first."""
    table = Table(box=None, padding=(0, 2, 0, 0), pad_edge=False)
    states = [
        name
        for name in STATES
        if any(v.quantity == name and v.is_compared for v in judged.verdicts)
    ]
    table.add_column("file", overflow="fold")
    for heading in ("step", "rows", *states):
        table.add_column(heading, justify="right", no_wrap=True)
    table.add_column("verdicts")
    pairs = zip(judged.files, judged.steps, strict=True)
    for one, step in sorted(pairs, key=lambda pair: -pair[1].value if pair[1] else 0.0):
        errors = {v.quantity: v.max for v in one.verdicts if v.is_compared}
        table.add_row(
            one.file.name,
            "" if step is None else f"{step.value:g}",
            str(len(one.file.times)),
            *(figure(errors.get(name)) for name in states),
            counts(one.verdicts),
        )
    return table


def _print_peculiar(console: Console, one: FileJudgement, common: Sequence[str]) -> None:
    lines = [line for line in _peculiar(one) if line not in common]
    if not lines:
        return
    print_line(console)
    print_line(console, Text(one.file.name, "bold"))
    for line in lines:
        print_indented(console, "  ", line)


def _peculiar(one: FileJudgement) -> Iterator[str]:
    """Return the conventions, the causes and the notes of a file, and why something was not compared."""
    for finding in one.conventions:
        yield finding.sentence
    for cause in one.causes:
        yield f"likely cause: {cause.sentence}"
    yield from one.notes
    for verdict in one.verdicts:
        if not verdict.is_compared:
            status = status_text(verdict.verdict.value).plain
            yield f"{status}: {verdict.quantity}: {verdict.because}"
