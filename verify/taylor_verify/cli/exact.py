"""The verb `exact`: the exact motion of one scene."""

from __future__ import annotations

import argparse
from functools import partial

from taylor_verify.cli.answer import PASS, UNDECIDED, Answer, WrongCall
from taylor_verify.cli.inputs import read_number, read_scenes
from taylor_verify.cli.progress import working
from taylor_verify.cli.scene_text import exact_text
from taylor_verify.exact.ellipsoid import formed_to
from taylor_verify.exact.printed import document
from taylor_verify.exact.request import MOST_DIGITS
from taylor_verify.exact.route import solution
from taylor_verify.exact.solution import NO_CLOSED_FORM, NoClosedForm


def answer(options: argparse.Namespace) -> Answer:
    """Print the exact motion at the times asked for."""
    if not 1 <= options.digits <= MOST_DIGITS:
        raise WrongCall(f"expected --digits from 1 to {MOST_DIGITS}, got {options.digits}")
    times = [(text.strip(), read_number(text, "--at")) for text in options.at.split(",")]
    (scene,) = read_scenes([options.scene])
    try:
        with working(f"exact {scene.name}"):
            scene = formed_to(scene, options.digits)
            found = document(scene, solution(scene, options.route), times, options.digits)
    except NoClosedForm as reason:
        found = {
            "scene": scene.name,
            "route": options.route,
            "digits": options.digits,
            "regime": NO_CLOSED_FORM,
            "rows": [],
            "because": f"no closed form: {reason}; leave out --route, or use --route taylor "
            f"@ {scene.name}",
        }
    doubts = [found["because"]] if "because" in found else []
    # Without rows the message has said it.
    text = partial(exact_text, found) if found["rows"] else str
    return Answer(UNDECIDED if doubts else PASS, found, text, doubts)
