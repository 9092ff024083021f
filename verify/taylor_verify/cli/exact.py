"""The verb `exact`: the exact motion of one scene."""

from __future__ import annotations

import argparse
from collections.abc import Mapping, Sequence
from fractions import Fraction
from functools import partial
from typing import Any, Final

from taylor_verify.cli.answer import PASS, UNDECIDED, Answer, CallParts, WrongCall
from taylor_verify.cli.console import Page, bold, titled
from taylor_verify.cli.inputs import read_number, read_scene
from taylor_verify.cli.progress import working
from taylor_verify.exact.event_times import Incomplete, events_of
from taylor_verify.exact.printed import document
from taylor_verify.exact.printed_events import (
    event_lines,
    events_document,
    incomplete_document,
)
from taylor_verify.exact.request import MOST_DIGITS
from taylor_verify.exact.route import solution
from taylor_verify.exact.solution import NO_CLOSED_FORM, NoClosedForm, Unsettled
from taylor_verify.scenes.scene import Scene

# Characters of a line of 80 beside the name of a quantity. Entries of a wider matrix get a line each.
_ROOM: Final = 62
# Ten seconds for a body in closed form.
_MOST_IN_ALL: Final = 10_000_000


def answer(options: argparse.Namespace) -> Answer:
    """Print the exact motion at the times asked for, or the times of an event."""
    parts = CallParts()
    if not 1 <= options.digits <= MOST_DIGITS:
        got = f"got {options.digits} @ --digits"
        parts.faults.append(f"expected a number from 1 to {MOST_DIGITS}, {got}")
    if (options.event is None) is (options.at is None):
        got = "none" if options.event is None else "both"
        fault = f"expected one of --at T,T,... and --event TEXT --until T, got {got}"
        parts.faults.append(fault)
    if (options.event is None) is not (options.until is None):
        parts.faults.append("expected --event TEXT and --until T together")
    scene = parts.read(read_scene, options.scene)
    until = None if options.until is None else parts.read(read_number, options.until, "--until")
    texts = [text for times in options.at or () for text in times.split(",")]
    times = [(text.strip(), parts.read(read_number, text, "--at")) for text in texts]
    parts.end()
    return _of_times(options, scene, times) if until is None else _of_events(options, scene, until)


def _of_events(options: argparse.Namespace, scene: Scene, until: Fraction) -> Answer:
    content: dict[str, Any] = {"events": [], "undecided": []}
    try:
        with working(f"exact {scene.name}"):
            content = events_document(events_of(scene, options.event, until, options.digits))
    except Unsettled as doubt:
        if isinstance(doubt, Incomplete):
            content = incomplete_document(doubt.events, scene.clock.start)
        content["because"] = f"undecided: {doubt} @ {scene.name}"
    doubts = [content["because"]] if "because" in content else []
    status = UNDECIDED if doubts or content["undecided"] else PASS
    document = {"scene": scene.name, "event": options.event, "until": options.until, **content}
    if "reached" not in document and doubts:
        return Answer(status, document, str, doubts)
    first, *rest = event_lines(document)
    return Answer(status, document, partial(titled, scene.name, f": {first}", rest), doubts)


def _of_times(
    options: argparse.Namespace, scene: Scene, times: Sequence[tuple[str, Fraction]]
) -> Answer:
    if len(times) * options.digits > _MOST_IN_ALL:
        asked = f"{len(times)} times of {options.digits} digits"
        raise WrongCall(
            f"expected at most {_MOST_IN_ALL} digits in all times, got {asked} @ --digits"
        )
    try:
        with working(f"exact {scene.name}"):
            motion = solution(scene, options.route)
            content = document(scene, motion, times, options.digits, options.attitude)
    except NoClosedForm as reason:
        content = {
            "scene": scene.name,
            "route": options.route,
            "digits": options.digits,
            "regime": NO_CLOSED_FORM,
            "rows": [],
            "because": f"no closed form: {reason}; leave out --route, or use --route taylor "
            f"@ {scene.name}",
        }
    doubts = [content["because"]] if "because" in content else []
    # Without rows the message says all.
    text = partial(_text, content) if content["rows"] else str
    return Answer(UNDECIDED if doubts else PASS, content, text, doubts)


def _text(content: Mapping[str, Any]) -> str:
    page = Page()
    how = f"(route {content['route']}, {content['evidence']})"
    page.line(bold(content["scene"]), f": {content['regime']} {how}")
    for row in content["rows"]:
        page.line()
        page.line(f"t = {row['t']}   (relative radius {row['radius']})")
        for name, value in row.items():
            if name not in ("t", "radius", "absolute"):
                _print_quantity(page, name, value)
        for name, size in row.get("absolute", {}).items():
            page.line(f"  {name}: no digit of a 0 is proven; its size is at most {size}")
    return page.text()


def _print_quantity(page: Page, name: str, value: Sequence[Any] | str) -> None:
    entries = [value] if isinstance(value, str) else value
    rows = [row if isinstance(row, list) else [row] for row in entries]
    # A column for the sign, so that digits stand below digits.
    signed = [[text if text.startswith("-") else f" {text}" for text in row] for row in rows]
    width = max(len(text) for row in signed for text in row)
    lines = [("", " ".join(text.ljust(width) for text in row).rstrip()) for row in signed]
    if len(signed[0]) > 1 and max(len(line) for _, line in lines) > _ROOM:
        lines = [(f"r{i}{k}", x) for i, row in enumerate(signed, 1) for k, x in enumerate(row, 1)]
    for label, line in lines:
        page.line(f"  {name.ljust(12 if label else 15)}{label} {line}")
        name = ""
