"""The verb `run`: the whole chain for some scenes, or for the standard set."""

from __future__ import annotations

import argparse
from functools import partial

from taylor_verify.batch.comparison import Earlier
from taylor_verify.batch.judgements import Judgements
from taylor_verify.batch.lock import Occupied
from taylor_verify.batch.report import ReportNotWritten, read_report
from taylor_verify.batch.selection import select
from taylor_verify.cli.answer import PASS, WRONG_CALL, Answer, WrongCall, graver, wrong_calls
from taylor_verify.cli.answers_text import verdicts_text
from taylor_verify.cli.ci import Outputs, outputs, tell
from taylor_verify.cli.folders import IN_A_CHECKOUT, writable
from taylor_verify.cli.inputs import known_rungs, read_tolerances
from taylor_verify.cli.progress import advancing
from taylor_verify.cli.streams import say
from taylor_verify.judge.costs import sentence
from taylor_verify.records.answers import Against
from taylor_verify.records.json_text import complete
from taylor_verify.run_many import run_many
from taylor_verify.solvers.registry import solver_named


def answer(options: argparse.Namespace) -> Answer:
    """Solve, compare and judge."""
    rungs = known_rungs(options.rung) if options.rung else None
    with wrong_calls(" @ --solver"):
        solver_named(options.solver)
    selection = select(options.scenes or None, rungs)
    for warning in selection.warnings:
        say(f"warning: {warning}")
    if options.jobs is not None and not options.jobs >= 1:
        raise WrongCall(f"expected a number of at least 1, got {options.jobs} @ --jobs")
    folder = writable(options.out) if options.out is not None else None
    published = _published(options.against) if options.against is not None else None
    asked = outputs(options)
    tolerances = read_tolerances(options.tolerance, selection.scenes)
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


def _published(folder: str) -> Earlier:
    """Return the verdicts of the folder of --against."""
    try:
        with wrong_calls(" (--against)"):
            return read_report(folder)
    except FileNotFoundError as error:
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
        messages += [*departures, f"{rows}: {len(departures)} departures from their rounding class"]
        against = Against(published.source, comparison.compared, departures)
        document["against"] = complete(against)
        status = graver(status, comparison.exit_status)
    to_ci = tell(asked, results, status)
    messages += to_ci.messages
    messages += [f"not run: {o.scene} on {o.rung}: {o.why}" for o in results.left_out]
    if len(results.selection.scenes) > 1 and results.costs:
        messages.append(sentence(results.costs))
    rows_and_agreement = results.verdicts, results.agreement
    text = partial(
        verdicts_text, *rows_and_agreement, to_ci.stated_status, results.causes, explained
    )
    return Answer(to_ci.status, {**document, **to_ci.document}, to_ci.closing(text), messages)
