"""The verb `explain`: the equations, the orbit and the arithmetic of one run."""

from __future__ import annotations

import argparse
from functools import partial

from taylor_verify.cli.answer import PASS, Answer
from taylor_verify.cli.inputs import known_rungs, read_scenes
from taylor_verify.cli.progress import working
from taylor_verify.cli.scene_text import explanation_text
from taylor_verify.explain.explanation import explanation


def answer(options: argparse.Namespace) -> Answer:
    """Explain one run."""
    (rung,) = known_rungs([options.rung])
    (scene,) = read_scenes([options.scene], warn=False)
    with working(f"explain {options.scene}"):
        found = explanation(scene, rung)
    return Answer(PASS, found, partial(explanation_text, found))
