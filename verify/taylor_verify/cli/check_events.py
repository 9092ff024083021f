"""The option `check --event`: the judgement of a solver's own times of an event."""

from __future__ import annotations

import argparse
from functools import partial

from taylor_verify.cli.answer import FAIL, PASS, UNDECIDED, Answer, WrongCall, wrong_calls
from taylor_verify.cli.console import Page, bold
from taylor_verify.cli.inputs import parse_tolerance, read_scene
from taylor_verify.cli.progress import working
from taylor_verify.exact.solution import Unsettled
from taylor_verify.judge.events import EventsJudgement, judge_events
from taylor_verify.judge.tolerances import tolerances
from taylor_verify.numbers.precision import rung
from taylor_verify.solvers.files.events import read_events
from taylor_verify.words.account import event_lines


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
    page = Page()
    page.line(bold(judged.true.text), judged.heading.removeprefix(judged.true.text))
    for line in event_lines(judged.document()):
        page.line(line)
    return page.text()
