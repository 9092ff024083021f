"""The verb `list`: everything that has a name."""

from __future__ import annotations

import argparse
from functools import partial

from taylor_verify.cli.answer import PASS, Answer
from taylor_verify.cli.scene_text import names_text
from taylor_verify.records.precisions import LADDER
from taylor_verify.scenes.library import EXTREMES, GUIDE, WORST, names
from taylor_verify.scenes.reading.reader import load
from taylor_verify.solvers.files.formats.reading import FORMATS
from taylor_verify.solvers.registry import remarks, solver_names


def answer(options: argparse.Namespace) -> Answer:
    """Name the scenes, solvers, rungs and formats of files, each with a sentence."""
    del options
    scenes = {"scenes": list(names()), "extremes": list(names(EXTREMES, WORST))}
    titles = {name: load(name).title for group in scenes.values() for name in group}
    formats = {suffix: form.sentence for suffix, form in FORMATS.items()}
    found = {
        **scenes,
        "solvers": list(solver_names()),
        "rungs": list(LADDER),
        "formats": list(formats),
    }
    text = partial(names_text, found, {**titles, **remarks(), **formats}, GUIDE)
    return Answer(PASS, {**found, "guide": dict(GUIDE)}, text)
