"""The texts that a person reads about verdicts: of a run, of a file, of several files of one solver."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import groupby
from math import inf, isnan
from typing import TYPE_CHECKING, Final

from rich.text import Text

from taylor_verify.cli.console import PIPED_WIDTH, Page, bold
from taylor_verify.cli.sentences import (
    figure,
    print_arithmetic,
    print_cause,
    print_end,
    print_sentence,
    status_text,
)
from taylor_verify.cli.table import Cell, print_table
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
    *("scene", "rung", "verdict", "state", ">error/u", ">at t", "drift", ">error/u"),
    *(">/floor", ">steps", ">seconds"),
)
_NUMBERS: Final = (
    *("quantity", "verdict", ">error", ">at t", ">allowed", ">/floor", ">since t", "unit"),
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
    page = Page(PIPED_WIDTH + max((len(v.scene) for v in verdicts), default=0))
    why = held.unjudged(verdicts)
    if not why or len({verdict.because for verdict in verdicts}) > 1:
        _print_rows(page, verdicts, held, causes, explained)
    total = f"{counts(verdicts)}{_as_expected(verdicts, held)}"
    unexpected = [verdict for verdict in verdicts if held.met(verdict) is None]
    print_end(page, unexpected, total, status, explained)
    if why:
        page.line(f"nothing was judged: {why}")
    return page.text()


def _print_rows(
    page: Page,
    verdicts: Sequence[Verdict],
    held: Agreement,
    causes: Sequence[LikelyCause],
    explained: bool,
) -> None:
    runs = [(run, list(rows)) for run, rows in groupby(verdicts, key=lambda v: (v.scene, v.rung))]
    is_few = len(runs) <= _FEW
    for (scene, rung), rows in runs if is_few else ():
        page.line(bold(scene), f" in {rung} arithmetic")
        for verdict in rows:
            print_sentence(page, verdict, why=_expected(verdict, held))
        for cause in causes:
            if (cause.scene, cause.rung) == (scene, rung):
                print_cause(page, cause)
        page.line()
    # A line for each run: its worst state, its worst drift, its cost.
    lines = [[scene, rung, *_run_cells(group)] for (scene, rung), group in runs]
    print_table(page.console, _OVERVIEW, lines, keys=2)
    page.line()
    page.indented(
        "",
        "Errors and drifts are the largest of all samples, in units of roundoff u = 2^-bits; "
        "/floor is the largest error over what perfect rounding would leave, of all gates.",
    )
    page.line()
    if any(verdict.tolerance is not None for verdict in verdicts):
        page.line("Judged by the tolerance that was asked for.")
    others = [verdict for verdict in verdicts if verdict.verdict.value != "pass"]
    for verdict in () if is_few else others:
        place = f"{verdict.scene} {verdict.rung}"
        print_sentence(page, verdict, place, _expected(verdict, held))
    for cause in () if is_few else causes:
        print_cause(page, cause, f"{cause.scene} {cause.rung}")
    for mismatch in held.mismatches:
        page.line(bold("not as expected", "red"), f"  {mismatch}")
    if explained:
        for (scene, rung), rows in runs:
            page.line(bold(scene), f" in {rung} arithmetic")
            print_arithmetic(page, rows)
    if explained or held.mismatches or (others and not is_few):
        page.line()


def _expected(verdict: Verdict, held: Agreement) -> str:
    expected = held.met(verdict)
    return "" if expected is None else expected.why


def _as_expected(verdicts: Sequence[Verdict], held: Agreement) -> str:
    """Return how many of the rows that are no pass are what the extremes are expected to answer."""
    met = sum(held.met(verdict) is not None for verdict in verdicts)
    said = {
        f"{met} of them as expected": met,
        f"{len(held.mismatches)} not as expected": held.mismatches,
    }
    return "".join(f"; {words}" for words, count in said.items() if count)


def _run_cells(group: list[Verdict]) -> tuple[Cell, ...]:
    status = status_text(gravest(v.verdict for v in group))
    compared = [v for v in group if v.at is not None]
    if not compared:
        return (status, *[""] * 8)
    state = max((v for v in compared if v.quantity in STATES), key=_ratio)
    drift = max((v for v in compared if v.is_conserved), key=_units, default=None)
    return (
        status,
        *(state.quantity, f"{_units(state):.3g}", f"{state.at:.6g}"),
        *((drift.quantity, f"{_units(drift):.3g}") if drift else ("", "")),
        f"{max(map(_ratio, compared)):.2g}",
        str(state.steps or ""),
        f"{state.seconds:.3f}" if state.seconds is not None else "",
    )


def _units(verdict: Verdict) -> float:
    """Return the largest error in units of roundoff; NaN counts as larger than any."""
    return _finite(verdict.max) / verdict.roundoff if verdict.roundoff else inf


def _ratio(verdict: Verdict) -> float:
    """Return the largest error over attainable; NaN counts as larger than any."""
    return _finite(verdict.ratio)


def _finite(number: float | None) -> float:
    return inf if number is None or isnan(number) else number


# A file.


def check_text(
    judged: FileJudgement, scene: str, rung: str, status: int | None, explained: bool = False
) -> str:
    """Return the sentence for each quantity, the likely causes, the numbers, and the counts.

    The conventions of the file come first. With ``explained`` the arithmetic of the bounds is there too.
    """
    page = Page()
    times = judged.file.times
    extent = f"{len(times)} row{'s' * (len(times) > 1)}"
    span = f"from t = {float(times[0]):g} to t = {float(times[-1]):g}"
    page.line(bold(judged.file.name), f": {extent} {span}")
    page.line(f"judged as an answer to {scene} in {rung} arithmetic")
    _print_conventions(page, judged)
    page.line()
    for verdict in judged.verdicts:
        print_sentence(page, verdict)
    for cause in judged.causes:
        print_cause(page, cause)
    for note in judged.notes:
        page.line(Text("note", "yellow"), f": {note}")
    page.line()
    if any(verdict.is_compared for verdict in judged.verdicts):
        _print_numbers(page, judged.verdicts)
        page.line()
        if explained:
            print_arithmetic(page, judged.verdicts)
            page.line()
    print_end(page, judged.verdicts, counts(judged.verdicts), status, explained)
    return page.text()


def _print_conventions(page: Page, judged: FileJudgement) -> None:
    if not judged.conventions:
        return
    is_certain = any(finding.is_certain for finding in judged.conventions)
    if not is_certain:
        how = " in a way that this motion cannot tell"
    else:
        how = ", and was corrected" if judged.accepted else ", and was judged as it stands"
    page.line()
    page.line(bold(f"the file departs from the scene's conventions{how}", "yellow"))
    page.indented("  ", *(finding.sentence for finding in judged.conventions))
    if is_certain and not judged.accepted:
        page.line("  (--accept-conventions corrects this and judges the rest)")


def _print_numbers(page: Page, verdicts: Sequence[Verdict]) -> None:
    """Print the numbers of all quantities, and what stands in the columns."""
    print_table(page.console, _NUMBERS, [_cells(verdict) for verdict in verdicts], keys=1)
    page.line()
    by_tolerance = any(verdict.tolerance is not None for verdict in verdicts)
    asked = "the tolerance that was asked for, where there is one; else " if by_tolerance else ""
    allowed = f"{asked}{GATE_FACTOR} times the roundoff floor, which perfect rounding would leave"
    page.indented("", f"allowed: {allowed}; /floor: the largest error over that floor")


def _cells(v: Verdict) -> list[str | Text]:
    since = "" if v.since is None else figure(v.since)
    numbers = (v.max, v.at, v.bound, v.ratio)
    figures = [figure(number) if v.is_compared else "" for number in numbers]
    return [v.quantity, status_text(v.verdict.value), *figures, since, v.unit]


# Several files.


def files_text(judged: FilesJudgement, scene: str, rung: str) -> str:
    """Return the order of each quantity, a line for each file, and what is peculiar to a file."""
    page = Page()
    page.line(
        bold(f"{len(judged.files)} files"), f": judged as answers to {scene} in {rung} arithmetic"
    )
    page.indented("  ", *(order.sentence for order in judged.order))
    first, *others = judged.files
    common = [note for note in first.notes if all(note in one.notes for one in others)]
    for note in (*judged.notes, *common):
        page.line(Text("note", "yellow"), f"  {note}")
    page.line()
    _print_files(page, judged)
    for one in judged.files:
        _print_peculiar(page, one, common)
    page.line(f"\n{counts(judged.verdicts)}; `check` of one file alone says the reasons")
    return page.text()


def _print_files(page: Page, judged: FilesJudgement) -> None:
    """Print the largest error of each state quantity in each file, the largest step first."""
    compared = {v.quantity for v in judged.verdicts if v.is_compared}
    states = [name for name in STATES if name in compared]
    headings = ["file", ">step", ">rows", *(f">{name}" for name in states), "verdicts"]
    pairs = zip(judged.files, judged.steps, strict=True)
    rows = []
    for one, step in sorted(pairs, key=lambda pair: -pair[1].value if pair[1] else 0.0):
        errors = {v.quantity: v.max for v in one.verdicts if v.is_compared}
        begin = [one.file.name, f"{step.value:g}" if step else "", str(len(one.file.times))]
        rows.append([*begin, *(figure(errors.get(name)) for name in states), counts(one.verdicts)])
    print_table(page.console, headings, rows, keys=1)


def _print_peculiar(page: Page, one: FileJudgement, common: Sequence[str]) -> None:
    lines = [line for line in _peculiar(one) if line not in common]
    if lines:
        page.line()
        page.line(bold(one.file.name))
        page.indented("  ", *lines)


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
