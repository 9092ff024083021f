"""The verb `sweep`: many bodies and starts, solved and judged."""

from __future__ import annotations

import argparse
from functools import partial
from time import monotonic
from typing import Final

from taylor_verify.batch.cluster import Unreachable, executor_named
from taylor_verify.batch.lock import Occupied
from taylor_verify.batch.sweeps.report import counts, document
from taylor_verify.batch.sweeps.sweep import sweep
from taylor_verify.cli.answer import Answer, WrongCall, wrong_calls
from taylor_verify.cli.console import Page, bold, print_table
from taylor_verify.cli.folders import writable
from taylor_verify.cli.inputs import known_rungs
from taylor_verify.cli.progress import working
from taylor_verify.cli.sentences import figure, print_end, status_text
from taylor_verify.records.quantities import INITIAL
from taylor_verify.records.sweep import Spread, SweepSummary

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
# Of the worst cases the text has as many; the folder has all.
_SHOWN: Final = 5


def answer(options: argparse.Namespace) -> Answer:
    """Sweep, and show how the errors are spread."""
    (rung,) = known_rungs([options.rung])
    folder = writable(options.out) if options.out is not None else None
    if options.jobs is not None and options.executor != "local":
        raise WrongCall(
            "expected --jobs or --executor, which has its own number, got both @ --jobs"
        )
    began = monotonic()
    with (
        wrong_calls(" @ --executor", Unreachable),
        wrong_calls(" (--out)", Occupied),
        wrong_calls(),
        working(f"sweep {options.what}"),
        executor_named(options.executor) as placed,
    ):
        found = sweep(
            options.what,
            count=options.count,
            seed=options.seed,
            points=options.points,
            solver=options.solver,
            rung=rung,
            executor=placed.executor,
            jobs=options.jobs,
            out=folder,
            resume=options.resume,
            worst=options.worst,
            ahead=placed.ahead,
        )
    messages = [f"{found.total} bodies in {monotonic() - began:.1f} s"]
    messages += [f"nothing was judged: {lack}" for lack in found.lacks]
    messages += [f"refused, for one: {refusal}" for refusal in found.refusals]
    messages += [f"wrote {folder}"] if folder is not None else []
    return Answer(found.exit_status, document(found), partial(_text, found), messages)


# The text.


def _text(found: SweepSummary) -> str:
    page = Page()
    page.line(bold(found.name), f": {found.total} bodies by {found.solver} on {found.rung}")
    page.line()
    print_table(page.console, _HEADINGS, [_cells(each) for each in found.quantities], keys=1)
    page.line()
    page.line(f"Error over attainable; a gate stands at {found.factor}.")
    page.line()
    if found.worst:
        page.line(bold("the worst cases"))
    for case in found.worst[:_SHOWN]:
        # The arithmetic of a bound is long; `run --explain` on the scene shows it.
        size = case.because if case.ratio is None else f"{case.ratio:.3g}"
        said = f"  {case.scene}  {case.quantity} {size}"
        page.line(status_text(case.verdict.value), f"{said}  {case.file}".rstrip())
    page.line()
    print_end(page, [], f"bodies: {counts(found)}", found.exit_status, explained=True)
    return page.text()


def _cells(spread: Spread) -> list[str]:
    ratio = spread.ratio
    sizes = (
        (ratio.median, ratio.ninety, ratio.ninety_nine, ratio.thousandth, ratio.largest)
        if ratio is not None and spread.quantity != INITIAL
        else ()
    )
    shown = [figure(size) for size in sizes] or [""] * 5
    return [spread.quantity, str(spread.judged), *shown, str(spread.counts["fail"])]
