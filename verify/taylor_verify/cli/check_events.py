"""The option `check --event`: the judgement of a solver's own times of an event."""

from __future__ import annotations

import argparse
from functools import partial

from taylor_verify.check import check
from taylor_verify.cli.answer import FAIL, PASS, UNDECIDED, Answer, WrongCall, wrong_calls
from taylor_verify.cli.console import titled
from taylor_verify.cli.inputs import parse_tolerance, read_scene
from taylor_verify.cli.progress import working
from taylor_verify.exact.solution import Unsettled
from taylor_verify.words.account import event_lines


def answer(options: argparse.Namespace) -> Answer:
    """Judge the times in one file."""
    if len(options.files) > 1:
        raise WrongCall(f"expected one file with --event, got {len(options.files)}")
    scene, (file,) = read_scene(options.scene), options.files
    try:
        with working(f"check {file}"), wrong_calls():
            tolerance = parse_tolerance(options.tolerance)
            judged = check(scene, file, options.rung, tolerance=tolerance, event=options.event)
    except Unsettled as doubt:
        because = f"undecided: {doubt} @ {scene.name}"
        content = {"scene": scene.name, "event": options.event, "because": because}
        return Answer(UNDECIDED, content, str, [because])
    status = PASS if judged.passed else FAIL if judged.is_wrong else UNDECIDED
    content, event = judged.document(), judged.true.text
    text = partial(titled, event, judged.heading.removeprefix(event), event_lines(content))
    return Answer(status, content, text)
