"""The verb `scene`: a scene written from somebody else's description of a body."""

from __future__ import annotations

import argparse
from pathlib import Path

from taylor_verify.cli.answer import PASS, Answer, WrongCall
from taylor_verify.cli.folders import unwritable
from taylor_verify.records.replacement import replace_files
from taylor_verify.scenes.imported import import_scene
from taylor_verify.scenes.reading.reader import read


def answer(options: argparse.Namespace) -> Answer:
    """Write a scene from a URDF, SDF or MJCF file, to be read and edited."""
    if options.source != "from":
        raise WrongCall(
            f"expected the word `from` (scene from robot.urdf), got {options.source!r} @ scene"
        )
    imported = import_scene(Path(options.file), options.link)
    warnings = (*imported.warnings, *read(imported.text, options.file).warnings)
    document = {
        "text": imported.text,
        "link": imported.link,
        "format": imported.form,
        "warnings": [*warnings],
    }
    messages = [f"warning: {warning} @ {options.file}" for warning in warnings]
    if options.out is None:
        return Answer(PASS, document, lambda: imported.text.rstrip("\n"), messages)
    _write(imported.text, options.out)
    return Answer(PASS, {**document, "written": [options.out]}, lambda: options.out, messages)


def _write(text: str, name: str) -> None:
    """Write a new file whole; what somebody has edited is left as it is."""
    place = Path(name)
    with unwritable("the name of a new file that can be written", name, "--out"):
        if not place.parent.is_dir():
            raise NotADirectoryError(0, f"no folder {place.parent}")
        if place.exists():
            raise FileExistsError(0, "it is there already, and perhaps edited")
        replace_files(place.parent, {place.name: text})
