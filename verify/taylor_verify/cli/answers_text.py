"""The texts that a person reads about verdicts: of a run, of a file, of several files of one solver."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import groupby
from typing import TYPE_CHECKING, Final

from rich.console import Console
from rich.text import Text

from taylor_verify.cli.console import (
    PIPED_WIDTH,
    new_console,
    print_indented,
    print_line,
    text_of,
)
from taylor_verify.cli.sentences import (
    figure,
    print_arithmetic,
    print_cause,
    print_end,
    print_sentence,
    status_text,
)
from taylor_verify.cli.table import Cell, Heading, print_table
from taylor_verify.records.quantities import GATE_FACTOR, STATES
from taylor_verify.records.showing import counts
from taylor_verify.records.status import gravest

if TYPE_CHECKING:
    from taylor_verify.batch.expectations import Agreement
    from taylor_verify.judge.files.judgement import FileJudgement
    from taylor_verify.judge.series.files import FilesJudgement
    from taylor_verify.records.answers import LikelyCause
    from taylor_verify.records.verdict import Verdict

# The sentences of so many runs come before the lines of the overview.
_FEW: Final = 2
_OVERVIEW: Final = (
    *(Heading("scene"), Heading("rung"), Heading("verdict")),
    *(Heading("state"), Heading("error/u", to_right=True), Heading("at t", to_right=True)),
    *(Heading("drift"), Heading("error/u", to_right=True)),
    *(Heading(name, to_right=True) for name in ("/floor", "steps", "seconds")),
)
_NUMBERS: Final = (
    *(Heading("quantity"), Heading("verdict")),
    *(Heading(name, to_right=True) for name in ("error", "at t", "allowed", "/floor", "since t")),
    Heading("unit"),
)


# A run.


def verdicts_text(
    verdicts: Sequence[Verdict],
    held: Agreement,
    status: int | None,
    causes: Sequence[LikelyCause] = (),
    explained: bool = False,
) -> str:
    """Return the sentences of a run or two and then a line for each; of many runs the lines come first.

    Of many runs only rows that are no pass have a sentence. Where no row was judged, and all for one
    reason, the counts and the reason are enough. With ``explained`` the arithmetic of the bounds is there.
    """
    # A path of any length keeps its row in one line of a pipe; on a terminal it is folded.
    console = new_console(PIPED_WIDTH + max((len(v.scene) for v in verdicts), default=0))
    why = held.unjudged(verdicts)
    if not why or len({verdict.because for verdict in verdicts}) > 1:
        _print_rows(console, verdicts, held, causes, explained)
    total = f"{counts(verdicts)}{_as_expected(verdicts, held)}"
    unexpected = [verdict for verdict in verdicts if held.met(verdict) is None]
    print_end(console, unexpected, total, status, explained)
    if why:
        print_line(console, f"nothing was judged: {why}")
    return text_of(console)


def _print_rows(
    console: Console,
    verdicts: Sequence[Verdict],
    held: Agreement,
    causes: Sequence[LikelyCause],
    explained: bool,
) -> None:
    runs = [(run, list(rows)) for run, rows in groupby(verdicts, key=lambda v: (v.scene, v.rung))]
    is_few = len(runs) <= _FEW
    if is_few:
        for (scene, rung), rows in runs:
            print_line(console, Text(scene, "bold"), f" in {rung} arithmetic")
            for verdict in rows:
                print_sentence(console, verdict, why=_expected(verdict, held))
            for cause in causes:
                if (cause.scene, cause.rung) == (scene, rung):
                    print_cause(console, cause)
            print_line(console)
    _print_overview(console, runs)
    print_line(console)
    if any(verdict.tolerance is not None for verdict in verdicts):
        print_line(console, "Judged by the tolerance that was asked for.")
    others = [verdict for verdict in verdicts if verdict.verdict.value != "pass"]
    for verdict in () if is_few else others:
        place = f"{verdict.scene} {verdict.rung}"
        print_sentence(console, verdict, place, _expected(verdict, held))
    for cause in () if is_few else causes:
        print_cause(console, cause, f"{cause.scene} {cause.rung}")
    for mismatch in held.mismatches:
        print_line(console, Text("not as expected", "bold red"), f"  {mismatch}")
    if explained:
        for (scene, rung), rows in runs:
            print_line(console, Text(scene, "bold"), f" in {rung} arithmetic")
            print_arithmetic(console, rows)
    if explained or held.mismatches or (others and not is_few):
        print_line(console)


def _expected(verdict: Verdict, held: Agreement) -> str:
    expected = held.met(verdict)
    return "" if expected is None else expected.why


def _as_expected(verdicts: Sequence[Verdict], held: Agreement) -> str:
    """How many of the rows that are no pass are what the extremes are expected to answer."""
    met = sum(held.met(verdict) is not None for verdict in verdicts)
    wrong = len(held.mismatches)
    return (f"; {met} of them as expected" if met else "") + (
        f"; {wrong} not as expected" if wrong else ""
    )


def _print_overview(
    console: Console, runs: Sequence[tuple[tuple[str, str], list[Verdict]]]
) -> None:
    """Print a line for each run: its worst state, its worst drift, what it cost."""
    rows = [[scene, rung, *_run_cells(group)] for (scene, rung), group in runs]
    print_table(console, _OVERVIEW, rows, keys=2)
    print_line(console)
    print_indented(
        console,
        "",
        "Errors and drifts are the largest of all samples, in units of roundoff u = 2^-bits; "
        "/floor is the largest error over what perfect rounding would leave, of all gates.",
    )


def _run_cells(group: list[Verdict]) -> tuple[Cell, ...]:
    status = status_text(gravest(v.verdict for v in group))
    compared = [v for v in group if v.at is not None]
    if not compared:
        return (status, *[""] * 8)
    state = max((v for v in compared if v.quantity in STATES), key=_ratio)
    drift = max((v for v in compared if v.is_conserved), key=_units, default=None)
    return (
        status,
        state.quantity,
        f"{_units(state):.3g}",
        f"{state.at:.6g}",
        drift.quantity if drift else "",
        f"{_units(drift):.3g}" if drift else "",
        f"{max(map(_ratio, compared)):.2g}",
        str(state.steps or ""),
        f"{state.seconds:.3f}" if state.seconds is not None else "",
    )


def _units(verdict: Verdict) -> float:
    """The largest error in units of roundoff; one that is no number counts as larger than any."""
    if verdict.max is None or not verdict.roundoff or verdict.max != verdict.max:
        return float("inf")
    return verdict.max / verdict.roundoff


def _ratio(verdict: Verdict) -> float:
    """The largest error over attainable; one that is no number counts as larger than any."""
    ratio = verdict.ratio
    return ratio if ratio is not None and ratio == ratio else float("inf")


# A file.


def check_text(
    judged: FileJudgement, scene: str, rung: str, status: int | None, explained: bool = False
) -> str:
    """Return the sentence for each quantity, the likely causes, the numbers, and the counts.

    The conventions of the file come first. With ``explained`` the arithmetic of the bounds is there too.
    """
    console = new_console()
    print_line(console, Text(judged.file.name, "bold"), f": {_extent(judged)}")
    print_line(console, f"judged as an answer to {scene} in {rung} arithmetic")
    _print_conventions(console, judged)
    print_line(console)
    for verdict in judged.verdicts:
        print_sentence(console, verdict)
    for cause in judged.causes:
        print_cause(console, cause)
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
    print_table(console, _NUMBERS, [_cells(verdict) for verdict in verdicts], keys=1)
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


# Several files.


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
    _print_files(console, judged)
    for one in judged.files:
        _print_peculiar(console, one, common)
    print_line(console, f"\n{counts(judged.verdicts)}; `check` of one file alone says the reasons")
    return text_of(console)


def _print_files(console: Console, judged: FilesJudgement) -> None:
    """Print the largest error of each state quantity in each file, the largest step first."""
    compared = {v.quantity for v in judged.verdicts if v.is_compared}
    states = [name for name in STATES if name in compared]
    numbers = (Heading(name, to_right=True) for name in ("step", "rows", *states))
    pairs = zip(judged.files, judged.steps, strict=True)
    rows = []
    for one, step in sorted(pairs, key=lambda pair: -pair[1].value if pair[1] else 0.0):
        errors = {v.quantity: v.max for v in one.verdicts if v.is_compared}
        rows.append(
            [
                *(one.file.name, "" if step is None else f"{step.value:g}"),
                str(len(one.file.times)),
                *(figure(errors.get(name)) for name in states),
                counts(one.verdicts),
            ]
        )
    print_table(console, [Heading("file"), *numbers, Heading("verdicts")], rows, keys=1)


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
        yield cause.line
    yield from one.notes
    for verdict in one.verdicts:
        if not verdict.is_compared:
            status = status_text(verdict.verdict.value).plain
            yield f"{status}: {verdict.quantity}: {verdict.because}"
