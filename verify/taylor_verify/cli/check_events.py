"""The option `check --event`: the judgement of a solver's own times of an event."""

from __future__ import annotations

import argparse
from functools import partial

from taylor_verify.cli.answer import FAIL, PASS, UNDECIDED, Answer, WrongCall, wrong_calls
from taylor_verify.cli.console import Page, bold
from taylor_verify.cli.inputs import parse_tolerance, read_scene
from taylor_verify.cli.progress import working
from taylor_verify.exact.printed_events import event_row
from taylor_verify.exact.solution import Unsettled
from taylor_verify.judge.events import EventsJudgement, judge_events
from taylor_verify.judge.tolerances import tolerances
from taylor_verify.numbers.precision import rung
from taylor_verify.solvers.files.events import read_events


def answer(options: argparse.Namespace) -> Answer:
    """Judge the times in one file."""
    if len(options.files) > 1:
        raise WrongCall(f"expected one file with --event, got {len(options.files)}")
    scene = read_scene(options.scene)
    with wrong_calls():
        tolerance = tolerances(parse_tolerance(options.tolerance), [scene]).every
    times = read_events(options.files[0])
    try:
        with working(f"check {options.files[0]}"):
            judged = judge_events(scene, options.event, times, rung(options.rung), tolerance)
    except Unsettled as doubt:
        because = f"undecided: {doubt} @ {scene.name}"
        content = {"scene": scene.name, "event": options.event, "because": because}
        return Answer(UNDECIDED, content, str, [because])
    status = PASS if judged.passed else FAIL if judged.is_wrong else UNDECIDED
    return Answer(status, judged.document(), partial(_text, judged))


def _text(judged: EventsJudgement) -> str:
    page, digits = Page(), judged.true.digits
    count = len(judged.answered)
    page.line(bold(judged.true.text), f": {count} of {len(judged.true)} events of {judged.scene}")
    for each in judged.answered:
        page.line(
            f"t = {float(each.given):.17g}: right to {each.digits} digits (off by {each.error:.1e})"
        )
    for event in judged.missed:
        page.line(f"missed: t = {event_row(event, digits)['t']}")
    for time in judged.invented:
        page.line(f"invented: t = {float(time):.17g}")
    for event in judged.true.undecided:
        row = event_row(event, digits)
        page.line(f"undecided: t = {row['t']}, within {row['radius']}")
    return page.text()
