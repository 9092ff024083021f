"""The verb `run`: the whole chain for some scenes, or for the standard set."""

from __future__ import annotations

import argparse
from functools import partial
from itertools import groupby
from math import inf, isnan
from typing import Final

from taylor_verify.batch.chosen_scenes import select
from taylor_verify.batch.comparison import Earlier
from taylor_verify.batch.earlier_file import read_report
from taylor_verify.batch.expectations import Agreement
from taylor_verify.batch.judgements import Judgements
from taylor_verify.batch.lock import Occupied
from taylor_verify.batch.report import ReportNotWritten
from taylor_verify.cli.answer import (
    PASS,
    WRONG_CALL,
    Answer,
    CallParts,
    WrongCall,
    graver,
    wrong_calls,
)
from taylor_verify.cli.ci import Outputs, concluded, outputs
from taylor_verify.cli.console import PIPED_WIDTH, Cell, Page, bold, print_table
from taylor_verify.cli.folders import IN_A_CHECKOUT, writable
from taylor_verify.cli.inputs import known_count, known_rungs, read_tolerances
from taylor_verify.cli.progress import advancing
from taylor_verify.cli.sentences import (
    print_arithmetic,
    print_end,
    print_line,
    print_sentence,
    status_text,
)
from taylor_verify.cli.streams import say
from taylor_verify.records.answers import Against
from taylor_verify.records.json_text import complete
from taylor_verify.records.quantities import is_state
from taylor_verify.records.showing import counts
from taylor_verify.records.status import gravest
from taylor_verify.records.verdict import Verdict
from taylor_verify.run_many import run_many
from taylor_verify.solvers.registry import solver_named
from taylor_verify.words.account import cause_line, note_line
from taylor_verify.words.cells import in_roundoffs, over_attainable
from taylor_verify.words.opening import opening

# Up to so many runs, their sentences come before the lines of the overview.
_FEW: Final = 2
_OVERVIEW: Final = (
    "scene",
    "rung",
    "verdict",
    "state",
    ">error/u",
    ">at t",
    "drift",
    ">error/u",
    ">/floor",
    ">steps",
    ">seconds",
)


def answer(options: argparse.Namespace) -> Answer:
    """Solve, compare and judge."""
    parts = CallParts()
    rungs = parts.read(known_rungs, options.rung) if options.rung else None
    parts.read(_check_solver, options.solver)
    selection = parts.read(select, options.scenes or None, rungs)
    for warning in selection.warnings if selection else ():
        say(f"warning: {warning}")
    parts.read(known_count, options.jobs, "--jobs")
    names = [scene.name for scene in selection.scenes] if selection else []
    folder = parts.read(writable, options.out, "--out", names) if options.out is not None else None
    published = parts.read(_published, options.against) if options.against is not None else None
    asked = parts.read(outputs, options)
    scenes = selection.scenes if selection else None
    tolerances = parts.read(read_tolerances, options.tolerance, scenes)
    parts.end()
    written = [f"wrote {folder / 'tables'} and {folder / 'data'}"] if folder is not None else []
    status = PASS
    try:
        with wrong_calls(" (--out)", Occupied), advancing() as progress:
            results = run_many(
                selection,
                options.solver,
                jobs=options.jobs,
                resume=options.resume,
                out=folder,
                progress=progress,
                tolerance=tolerances,
            )
    except ReportNotWritten as error:
        # A run that took hours is shown in any case.
        results, status, written = error.results, WRONG_CALL, [f"{error} (--out)"]
    return _answer(results, asked, published, written, status, options.explain)


def _check_solver(name: str) -> None:
    """Raise WrongCall for a name that is no solver."""
    with wrong_calls(" @ --solver"):
        solver_named(name)


def _published(folder: str) -> Earlier:
    """Return the verdicts of the folder of --against."""
    try:
        with wrong_calls(" (--against)"):
            return read_report(folder)
    except (FileNotFoundError, NotADirectoryError) as error:
        raise WrongCall(
            f"expected a folder of `run --out`, got no such file @ --against {error.filename}; "
            f"{IN_A_CHECKOUT}"
        ) from error


def _answer(
    results: Judgements,
    asked: Outputs,
    published: Earlier | None,
    written: list[str],
    status: int,
    explained: bool,
) -> Answer:
    """Return the answer of a run, with what comparisons and files add to it."""
    status = graver(status, results.exit_status)
    messages = [f"nothing was judged: {results.unjudged}"] * (results.exit_status == WRONG_CALL)
    messages += written
    document = results.document()
    if published is not None:
        comparison = published.compare_as_published(results)
        departures = tuple(map(str, comparison.failures))
        rows = f"{comparison.compared} rows compared with {published.source}"
        messages += [
            *departures,
            *comparison.notes,
            f"{rows}: {len(departures)} departures from their rounding class",
        ]
        against = Against(published.source, comparison.compared, departures)
        document["against"] = complete(against)
        status = graver(status, comparison.exit_status)
    left = [f"not run: {o.scene} on {o.rung}: {o.why}" for o in results.left_out]
    text = partial(_text, results, explained)
    answered = concluded(asked, results, status, document, text)
    return answered._replace(messages=[*messages, *answered.messages, *left])


# The text.


def _text(results: Judgements, explained: bool, status: int | None) -> str:
    """Return the sentences of a run or two and then a line for each; of many runs the lines come first.

    Of many runs only rows that are no pass have a sentence. If no row was judged, and all for one reason,
    the text is the counts and the reason. With ``explained`` the arithmetic of the bounds is shown too.
    """
    verdicts, agreement = results.verdicts, results.agreement
    # A path of any length keeps its row in one line of a pipe; on a terminal it is folded.
    page = Page(PIPED_WIDTH + max((len(v.scene) for v in verdicts), default=0))
    why = agreement.unjudged
    if not why or len({verdict.because for verdict in verdicts}) > 1:
        _print_rows(page, results, explained)
    met, mismatches = agreement.document().met, len(agreement.mismatches)
    total = counts(verdicts)
    total += f"; {met} of them as expected" if met else ""
    total += f"; {mismatches} not as expected" if mismatches else ""
    print_end(page, agreement.unexpected, total, status, explained)
    if why:
        page.line(f"nothing was judged: {why}")
    return page.text()


def _print_rows(page: Page, results: Judgements, explained: bool) -> None:
    verdicts, agreement, causes = results.verdicts, results.agreement, results.causes
    runs = [(run, list(rows)) for run, rows in groupby(verdicts, key=lambda v: (v.scene, v.rung))]
    is_few = len(runs) <= _FEW
    for (scene, rung), rows in runs if is_few else ():
        own = [cause for cause in causes if (cause.scene, cause.rung) == (scene, rung)]
        page.line(bold(scene), f" in {rung} arithmetic")
        page.indented("", opening(rows, own))
        page.line()
        for verdict in rows:
            print_sentence(page, verdict, why=_expected(verdict, agreement))
        for cause in own:
            print_line(page, cause_line(cause.sentence))
        page.line()
    if not is_few:
        page.indented("", opening(results.unexpected or verdicts, causes))
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
        print_sentence(page, verdict, place, _expected(verdict, agreement))
    for cause in () if is_few else causes:
        print_line(page, cause_line(cause.sentence, f"{cause.scene} {cause.rung}"))
    for note in results.notes:
        print_line(page, note_line(note))
    for mismatch in agreement.mismatches:
        page.line(bold("not as expected", "red"), f"  {mismatch}")
    if explained:
        for (scene, rung), rows in runs:
            page.line(bold(scene), f" in {rung} arithmetic")
            print_arithmetic(page, rows)
    if explained or agreement.mismatches or results.notes or (others and not is_few):
        page.line()


def _expected(verdict: Verdict, agreement: Agreement) -> str:
    expected = agreement.met(verdict)
    return "" if expected is None else expected.why


def _run_cells(group: list[Verdict]) -> tuple[Cell, ...]:
    status = status_text(gravest(v.verdict for v in group))
    compared = [v for v in group if v.at is not None]
    if not compared:
        return (status, *[""] * 8)
    state = max((v for v in compared if is_state(v.quantity)), key=over_attainable)
    drift = max((v for v in compared if v.is_conserved), key=_units, default=None)
    return (
        status,
        state.quantity,
        f"{_units(state):.3g}",
        f"{state.at:.6g}",
        *((drift.quantity, f"{_units(drift):.3g}") if drift else ("", "")),
        f"{max(map(over_attainable, compared)):.2g}",
        str(state.steps or ""),
        f"{state.seconds:.3f}" if state.seconds is not None else "",
    )


def _units(verdict: Verdict) -> float:
    """Return the largest error in units of roundoff; NaN counts as larger than any."""
    units = in_roundoffs(verdict, verdict.max)
    return inf if units is None or isnan(units) else units
