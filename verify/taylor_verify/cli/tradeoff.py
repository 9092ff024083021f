"""The verb `tradeoff`: speed against accuracy of every setting of every solver."""

from __future__ import annotations

import argparse
import json
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from functools import partial
from pathlib import Path
from typing import Any, Final

from rich.text import Text

from taylor_verify.cli.answer import (
    PASS,
    UNDECIDED,
    WRONG_CALL,
    Answer,
    CallParts,
    WrongCall,
    wrong_calls,
)
from taylor_verify.cli.console import Page, bold, print_table
from taylor_verify.cli.folders import alone_in, not_written, writable
from taylor_verify.cli.inputs import (
    known_count,
    known_rungs,
    read_number,
    read_scenes,
    require_matplotlib,
)
from taylor_verify.cli.progress import working
from taylor_verify.cli.streams import say
from taylor_verify.records.replacement import replace_files
from taylor_verify.scenes.reading.positive import positive
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.engines.engine import prepare
from taylor_verify.solvers.engines.launcher import NotMade
from taylor_verify.tradeoff.document import label_of
from taylor_verify.tradeoff.recommendation import OutOfReach, recommended
from taylor_verify.tradeoff.setting import RUNGS, Setting, chosen, outside, settings, toleranced
from taylor_verify.tradeoff.trade_off import trade_off

_NOT_RUN: Final = "not run"
_NUMBERS: Final = (">drift", ">steps", ">evals", ">seconds", ">spread", ">first", ">compile")
_TIMES: Final = ("seconds", "spread", "first_seconds", "compile_seconds")


def answer(options: argparse.Namespace) -> Answer:
    """Measure each scene, and with a target find the cheapest setting that reaches it."""
    parts = CallParts()
    if not options.scenes:
        parts.faults.append("expected a scene, such as euler/generic, got none @ tradeoff")
    parts.read(known_count, options.repeats, "--repeats")
    target, place = parts.read(_target, options.target), None
    if options.out is not None:
        parts.read(require_matplotlib, "--out")
        place = parts.read(writable, options.out)
    rungs = parts.read(known_rungs, options.rung or RUNGS)
    asked = parts.read(_asked, options, rungs or RUNGS)
    scenes = parts.read(read_scenes, options.scenes)
    parts.end()
    if options.outside:
        # Before anything is timed: a download is no part of a solve, which says so where there is none.
        for name in toleranced():
            with suppress(NotMade):
                prepare(name, say)
    documents: list[dict[str, Any]] = []
    missed: list[str] = []
    with alone_in(place):
        for scene in scenes:
            with working(f"tradeoff {scene.name}"):
                trade = trade_off(scene, asked(scene), options.repeats, options.seed)
                document = trade.document()
                if target is not None:
                    document["recommendation"] = None
                    try:
                        document["recommendation"] = recommended(trade, target).document()
                    except OutOfReach as reason:
                        missed.append(str(reason))
                documents.append(document)
        status = UNDECIDED if missed else PASS
        try:
            drawn = [] if place is None else [f"wrote {path}" for path in _draw(documents, place)]
        except OSError as error:
            # What was measured for minutes is shown in any case.
            drawn, status = [not_written(error, "--out")], WRONG_CALL
    text = partial(tradeoff_text, documents)
    return Answer(status, {"scenes": documents}, text, [*missed, *drawn])


def _draw(documents: Sequence[Mapping[str, Any]], place: Path) -> list[Path]:
    """Write the pictures of each scene and the document itself, whole or not at all."""
    from taylor_verify.plotting.picture import save
    from taylor_verify.tradeoff.work_precision import pictures

    drawn = save([picture for one in documents for picture in pictures(one)], place)
    text = json.dumps({"scenes": documents}, indent=1, allow_nan=False) + "\n"
    return [*replace_files(place, {"tradeoff.json": text}), *drawn]


def _asked(
    options: argparse.Namespace, rungs: Sequence[str]
) -> Callable[[Scene], Sequence[Setting]]:
    """Return the settings to measure by scene: all there are, or those of --solver and --outside."""
    with wrong_calls(" @ --solver"):
        named = chosen(options.solver, rungs) if options.solver else ()
        others = outside(rungs) if options.outside else ()
    return lambda scene: (*(named or settings(scene, rungs)), *others)


def _target(text: str | None) -> float | None:
    if text is None:
        return None
    try:
        return positive(float(read_number(text, "--target")), "--target")
    except (WrongCall, OverflowError, ValueError) as error:
        raise WrongCall(
            f"expected a positive error, such as 1e-9, got {text!r} @ --target"
        ) from error


# The text.


def tradeoff_text(documents: Sequence[Mapping[str, Any]]) -> str:
    """Return for each scene a line for each setting, the front in words, the errors asked and achieved."""
    page = Page()
    for trade in documents:
        _print_trade(page, trade)
    return page.text()


def _print_trade(page: Page, trade: Mapping[str, Any]) -> None:
    timing, machine = trade["timing"], trade["provenance"]
    page.line(bold(trade["scene"]), f" on {machine['processor']}")
    _print_points(page, trade)
    for reason, names in _not_run(trade["points"]).items():
        page.line(f"not run: {', '.join(names)} ({reason})")
    for row in trade["points"]:
        if row["standing"] not in ("sound", _NOT_RUN):
            words = f"  {label_of(row)}: {row['because']}"
            page.line(bold(row["standing"], "red"), words)
    page.line(
        f"Best of up to {timing['repeats']} solves, {timing['order']} (seed {timing['seed']}); "
        "* is on the front. first: the whole first solve, with compiling and start-up.",
    )
    page.line(f"seconds: {timing['of']}.")
    floors = [f"{rung} {least:.2g}" for rung, least in trade.get("attainable", {}).items() if least]
    if floors:
        words = (
            f"Attainable, one rounding of the state a sample and nothing else: {', '.join(floors)}."
        )
        page.line(words)
    page.line()
    page.line(bold("The front"))
    page.indented("  ", *trade["sentences"])
    if trade.get("recommendation"):
        page.line()
        page.line(Text(trade["recommendation"]["sentence"], "green"))
        page.line(f"  {trade['recommendation']['command']}")
    page.line()


def _print_points(page: Page, trade: Mapping[str, Any]) -> None:
    rows = [row for row in trade["points"] if row["standing"] != _NOT_RUN]
    quantities = list(dict.fromkeys(name for row in rows for name in row["max"]))
    errors = [heading for name in quantities for heading in (f">{name}", ">final")]
    cells = []
    for row in rows:
        mark = "*" if label_of(row) in trade["front"] else "" if row["standing"] == "sound" else "!"
        sizes = [row[part].get(name) for name in quantities for part in ("max", "final")]
        sizes = [_short(value) for value in (*sizes, row["drift"])]
        times = [_short(row[key]) for key in _TIMES]
        begin = [f"{row['solver']} {row['setting']}".rstrip(), row["rung"], mark]
        # A solver that counts nothing has 0.
        counts = (str(row[key] or "") for key in ("steps", "evaluations"))
        cells.append([*begin, *sizes, *counts, *times])
    print_table(page.console, ("setting", "rung", "", *errors, *_NUMBERS), cells, keys=2)


def _not_run(points: Sequence[Mapping[str, Any]]) -> dict[str, list[str]]:
    """Return the settings that were not run, by the reason; a whole family by its name."""
    ran = {row["family"] for row in points if row["standing"] != _NOT_RUN}
    names_by_reason: dict[str, dict[str, None]] = {}
    for row in points:
        if row["standing"] == _NOT_RUN:
            name = f"{row['solver']} {row['setting']}".rstrip()
            name = f"{name} {row['rung']}" if row["family"] in ran else row["family"]
            names_by_reason.setdefault(row["because"], {})[name] = None
    return {reason: list(names) for reason, names in names_by_reason.items()}


def _short(value: float | None) -> str:
    return "" if value is None else f"{value:.2g}"
