"""The verb `scene`: a scene written from somebody else's description of a body."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from taylor_verify.cli.answer import PASS, Answer, WrongCall


def add_options(verb: Any) -> None:
    """Add the arguments of `scene from`."""
    verb.add_argument("source", choices=("from",), metavar="from", help="the word `from`")
    verb.add_argument("file", metavar="FILE", help="a URDF, SDF or MJCF file")
    verb.add_argument(
        "--link", metavar="NAME", help="the link or body; without it, the only one with an inertia"
    )
    verb.add_argument(
        "--out", metavar="FILE", help="write the scene there, to a file that is not there yet"
    )


def scene(options: argparse.Namespace) -> Answer:
    """Write a scene from a URDF, SDF or MJCF file, to be read and edited."""
    from taylor_verify.scenes.imported import import_scene
    from taylor_verify.scenes.reading.faults import Refused
    from taylor_verify.scenes.reading.reader import read

    try:
        found = import_scene(Path(options.file), options.link)
        warnings = read(found.text, options.file).warnings
    except Refused as error:
        raise WrongCall(str(error)) from error
    document = {
        "text": found.text,
        "link": found.link,
        "format": found.form,
        "warnings": [*warnings],
    }
    messages = [f"warning: {warning} @ {options.file}" for warning in warnings]
    if options.out is None:
        return Answer(PASS, document, lambda: found.text.rstrip("\n"), messages)
    _write(found.text, options.out)
    return Answer(PASS, {**document, "written": [options.out]}, lambda: options.out, messages)


def _write(text: str, name: str) -> None:
    """Write a new file whole; what somebody has edited is left as it is."""
    from taylor_verify.records.replacement import replace_files

    place = Path(name)
    try:
        if not place.parent.is_dir():
            raise NotADirectoryError(0, f"no folder {place.parent}")
        if place.exists():
            raise FileExistsError(0, "it is there already, and perhaps edited")
        replace_files(place.parent, {place.name: text})
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        expected = "the name of a new file that can be written"
        raise WrongCall(f"expected {expected}, got {name!r} ({reason}) @ --out") from error
