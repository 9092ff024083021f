"""The verb `draw`: pictures of the exact motion of one scene, and of the errors of files beside it."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any, Final

from taylor_verify.cli.answer import PASS, Answer, WrongCall, wrong_calls
from taylor_verify.cli.console import Page, bold
from taylor_verify.cli.folders import unwritable, writable_file
from taylor_verify.cli.inputs import known_rungs, read_scenes, require_matplotlib
from taylor_verify.cli.progress import working
from taylor_verify.draw import file_errors
from taylor_verify.draw.caption import NotDrawn
from taylor_verify.draw.course import motion
from taylor_verify.draw.pictures import pictures
from taylor_verify.exact.solution import Unsettled
from taylor_verify.judge.files.judgement import judge_file
from taylor_verify.publish.pictures.picture import ENDINGS, Picture, content
from taylor_verify.records.record import Record
from taylor_verify.records.replacement import replace_files
from taylor_verify.scenes.precision import rung
from taylor_verify.scenes.reading.faults import Refused
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.files.columns.request import request
from taylor_verify.solvers.files.file import TrajectoryFile, read

ERRORS: Final = "errors"
_STILL: Final = ENDINGS
_DEFAULT: Final = ".svg"


def answer(options: argparse.Namespace) -> Answer:
    """Draw the motion of a scene, and the errors of files, every picture to a file of its own."""
    require_matplotlib("draw")
    (options.rung,) = known_rungs([options.rung])
    scene, files = _asked(options)
    place = _place(options.out, scene)
    names = [name.strip() for name in options.only.split(",")] if options.only else []
    with working(f"draw {scene.name}"), wrong_calls(kinds=NotDrawn):
        document = _document(scene)
        found = _pictures(document, names, files, partial(_record, options, scene))
        written = _write(found, place, is_alone=len(names) == 1)
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


def _asked(options: argparse.Namespace) -> tuple[Scene, list[TrajectoryFile]]:
    """Read the scene and the files; the faults of all are reported at once."""
    faults: list[str] = []

    def attempt(reading: Callable[[], Any]) -> Any:
        try:
            return reading()
        except (WrongCall, Refused) as error:
            faults.append(str(error))

    scenes = attempt(lambda: read_scenes([options.scene]))
    columns = options.columns or ()
    names = dict.fromkeys(options.files)
    files = [attempt(partial(lambda name: read(name, request(columns)), name)) for name in names]
    if faults:
        raise WrongCall("\n".join(faults))
    return scenes[0], files


def _document(scene: Scene) -> dict[str, Any]:
    """Return what is drawn. Raises WrongCall where the exact motion cannot be had."""
    with wrong_calls(f" @ {scene.name}", Unsettled):
        return motion(scene)


def _pictures(
    document: Mapping[str, Any],
    names: Sequence[str],
    files: Sequence[TrajectoryFile],
    record: Callable[[TrajectoryFile], Record],
) -> dict[str, Picture]:
    """Return the pictures of the motion, and that of the errors if files are given, by their names."""
    others = [name for name in names if name != ERRORS]
    found = pictures(document, others) if others or not names else {}
    if files and (not names or ERRORS in names):
        found[ERRORS] = file_errors.picture(document, {file.name: record(file) for file in files})
    elif ERRORS in names:
        raise WrongCall(f"expected trajectory files behind the scene, got none @ --only {ERRORS}")
    return found


def _record(options: argparse.Namespace, scene: Scene, file: TrajectoryFile) -> Record:
    """Return the errors of a file. Raises WrongCall where it could not be compared."""
    judged = judge_file(file, scene, rung(options.rung), options.accept_conventions, True)
    if judged.record is None:
        raise WrongCall(f"{judged.verdicts[0].because} @ {file.name}")
    return judged.record


def _write(found: Mapping[str, Picture], place: Path, is_alone: bool) -> Sequence[Path]:
    """Draw all, then write all; a picture that was asked for alone has the name of --out itself."""
    ending = place.suffix
    contents = {
        f"{place.stem if is_alone else f'{place.stem}-{name}'}{ending}": content(
            picture, ending[1:].lower()
        )
        for name, picture in found.items()
    }
    with unwritable("a file that can be written", str(place), "--out"):
        return replace_files(place.parent, contents)


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
