"""The verb `draw`: pictures of the exact motion of one scene."""

from __future__ import annotations

import argparse
from collections.abc import Mapping
from functools import partial
from pathlib import Path
from typing import Any, Final

from taylor_verify.cli.answer import PASS, Answer, WrongCall, wrong_calls
from taylor_verify.cli.console import Page, bold
from taylor_verify.cli.folders import unwritable, writable_file
from taylor_verify.cli.inputs import read_scenes, require_matplotlib
from taylor_verify.cli.progress import working
from taylor_verify.draw.caption import NotDrawn
from taylor_verify.draw.course import motion
from taylor_verify.draw.pictures import pictures
from taylor_verify.exact.solution import Unsettled
from taylor_verify.publish.pictures.picture import ENDINGS, content
from taylor_verify.records.replacement import replace_files
from taylor_verify.scenes.scene import Scene

_STILL: Final = ENDINGS
_DEFAULT: Final = ".svg"


def answer(options: argparse.Namespace) -> Answer:
    """Draw the motion of a scene, every picture to a file of its own."""
    require_matplotlib("draw")
    (scene,) = read_scenes([options.scene])
    place = _place(options.out, scene)
    names = [name.strip() for name in options.only.split(",")] if options.only else []
    with working(f"draw {scene.name}"):
        document = _document(scene)
        with wrong_calls(" @ --only", NotDrawn):
            found = pictures(document, names)
        if not found:
            raise WrongCall(f"expected a motion to draw, got a body at rest @ {scene.name}")
        files = {}
        for name in found:
            own = place.stem if len(names) == 1 else f"{place.stem}-{name}"
            files[name] = f"{own}{place.suffix}"
        contents = {
            files[name]: content(picture, place.suffix[1:].lower())
            for name, picture in found.items()
        }
        with unwritable("a file that can be written", str(place), "--out"):
            written = replace_files(place.parent, contents)
    shown = {
        "scene": scene.name,
        "regime": document["regime"],
        "route": document["route"],
        "evidence": document["evidence"],
        "files": [
            {"file": str(path), "picture": name, "title": picture.title, "shows": picture.alt}
            for path, (name, picture) in zip(written, found.items(), strict=True)
        ],
    }
    return Answer(PASS, shown, partial(_text, shown))


def _document(scene: Scene) -> dict[str, Any]:
    """Return what is drawn. Raises WrongCall where the exact motion cannot be had."""
    with wrong_calls(f" @ {scene.name}", Unsettled):
        return motion(scene)


def _place(out: str | None, scene: Scene) -> Path:
    """Return the file that --out names, from which each picture has its name. Raises WrongCall."""
    name = out if out is not None else Path(scene.name).with_suffix("").as_posix().replace("/", "-")
    place = writable_file(name, "--out")
    if not place.suffix:
        return place.with_suffix(_DEFAULT)
    if place.suffix.lower() not in _STILL:
        raise WrongCall(f"expected {', '.join(_STILL)}, got {place.suffix!r} @ --out")
    return place


def _text(shown: Mapping[str, Any]) -> str:
    page = Page()
    how = f"(route {shown['route']}, {shown['evidence']})"
    page.line(bold(shown["scene"]), f": {shown['regime']} {how}")
    for file in shown["files"]:
        page.line(f"wrote {file['file']}")
        page.indented("  ", file["shows"])
    return page.text()
