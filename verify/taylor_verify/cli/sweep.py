"""The verb `sweep`: many bodies and starts, solved and judged."""

from __future__ import annotations

import argparse
from dataclasses import astuple
from functools import partial
from time import monotonic
from typing import Final

from taylor_verify.batch.cluster import Unreachable, executor_named
from taylor_verify.batch.lock import Occupied
from taylor_verify.batch.sweeps.sweep import sweep
from taylor_verify.cli.answer import Answer, CallParts, wrong_calls
from taylor_verify.cli.console import Page, bold, print_table
from taylor_verify.cli.folders import writable
from taylor_verify.cli.inputs import known_rungs, parse_tolerance, read_tolerances
from taylor_verify.cli.progress import working
from taylor_verify.cli.sentences import figure, print_end, status_text
from taylor_verify.cli.streams import say
from taylor_verify.records.json_text import complete
from taylor_verify.records.quantities import INITIAL
from taylor_verify.records.status import Status
from taylor_verify.records.sweep import Spread, SweepSummary, WorstCase
from taylor_verify.words.account import cause_line

_HEADINGS: Final = (
    "quantity",
    ">judged",
    ">median",
    ">90 %",
    ">99 %",
    ">99.9 %",
    ">largest",
    ">fail",
)
# The most worst cases in the text; the folder has all.
_SHOWN: Final = 5


def answer(options: argparse.Namespace) -> Answer:
    """Judge all bodies of a sweep, and show how the errors are spread."""
    parts = CallParts()
    rungs = parts.read(known_rungs, [options.rung])
    folder = parts.read(writable, options.out) if options.out is not None else None
    if options.jobs is not None and options.executor != "local":
        fault = "expected --jobs or --executor, which has its own number, got both @ --jobs"
        parts.faults.append(fault)
    parts.read(read_tolerances, options.tolerance, None)
    parts.end()
    (rung,), tolerance, began = rungs, parse_tolerance(options.tolerance), monotonic()
    with (
        wrong_calls(" @ --executor", Unreachable),
        wrong_calls(" (--out)", Occupied),
        wrong_calls(),
        working(f"sweep {options.what}"),
        executor_named(options.executor) as placed,
    ):
        if placed.workers == 0:
            # A cluster that grows on demand begins so.
            say("warning: the dask scheduler has no worker yet, and the sweep waits for one")
        summary = sweep(
            options.what,
            count=options.count,
            seed=options.seed,
            points=options.points,
            solver=options.solver,
            rung=rung,
            tolerance=tolerance,
            executor=placed.executor,
            jobs=options.jobs,
            out=folder,
            resume=options.resume,
            worst=options.worst,
            ahead=placed.ahead,
        )
    messages = [f"{summary.total} bodies in {monotonic() - began:.1f} s"]
    messages += [f"nothing was judged: {lack}" for lack in summary.lacks]
    messages += [f"refused, for example: {refusal}" for refusal in summary.refusals]
    if folder is not None:
        messages.append(f"wrote {folder}, with {len(summary.worst)} of the worst cases as scenes")
    failing = [
        line
        for case in summary.worst
        if case.verdict in (Status.FAIL, Status.UNDECIDED)
        for line in (f"{case.verdict}  {_worst(case)}", *map(cause_line, case.causes))
    ]
    return Answer(
        summary.exit_status, complete(summary), partial(_text, summary), messages, failing
    )


# The text.


def _text(summary: SweepSummary) -> str:
    page = Page()
    page.line(bold(summary.name), f": {summary.total} bodies by {summary.solver} on {summary.rung}")
    page.line()
    print_table(page.console, _HEADINGS, [_cells(each) for each in summary.quantities], keys=1)
    page.line()
    floor = "the roundoff floor, which perfect rounding would leave"
    page.line(f"Errors over {floor}; a body fails above {summary.bound}.")
    page.line()
    if summary.worst:
        page.line(bold("the worst cases"), ", each with the numbers that `run` finds for its scene")
    for case in summary.worst[:_SHOWN]:
        page.line(status_text(case.verdict.value), f"  {_worst(case)}  {case.file}".rstrip())
        for cause in case.causes:
            page.line(cause_line(cause))
    page.line()
    print_end(page, [], f"bodies: {summary.counts}", summary.exit_status, explained=True)
    return page.text()


def _worst(case: WorstCase) -> str:
    # The arithmetic of a bound is long; `run --explain` on the scene shows it.
    size = case.because if case.ratio is None else figure(case.ratio)
    return f"{case.scene}  {case.quantity} {size}"


def _cells(spread: Spread) -> list[str]:
    ratio = spread.ratio
    sizes = astuple(ratio) if ratio is not None and spread.quantity != INITIAL else ()
    shown = [figure(size) for size in sizes] or [""] * 5
    return [spread.quantity, str(spread.judged), *shown, str(spread.counts["fail"])]
