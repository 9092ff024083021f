"""The verb `draw`: pictures of the exact motion of one scene, and of the errors of files beside it."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any, Final

from taylor_verify.cli.answer import PASS, Answer, CallParts, WrongCall, wrong_calls
from taylor_verify.cli.console import Page, bold
from taylor_verify.cli.folders import unwritable, writable_file
from taylor_verify.cli.inputs import known_rungs, require_matplotlib
from taylor_verify.cli.progress import working
from taylor_verify.cli.standard_input import scene_and_files
from taylor_verify.draw import file_errors, missing_load
from taylor_verify.draw.caption import NotDrawn
from taylor_verify.draw.drawn_course import lengthened, motion
from taylor_verify.draw.moving import moving, page
from taylor_verify.draw.pictures import pictures
from taylor_verify.exact.solution import Unsettled
from taylor_verify.judge.files.judgement import FileJudgement, judge_file
from taylor_verify.numbers.precision import rung
from taylor_verify.plotting.picture import ENDINGS as STILLS
from taylor_verify.plotting.picture import Picture, content
from taylor_verify.records.replacement import replace_files
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.files.file import TrajectoryFile

ERRORS: Final = "errors"
LOAD: Final = "load"
OF_FILES: Final = (ERRORS, LOAD)
_STILL: Final = ".svg"
_PAGE: Final = ".html"


def answer(options: argparse.Namespace) -> Answer:
    """Draw the motion of a scene, and the errors of files, every picture to a file of its own."""
    parts = CallParts()
    parts.read(require_matplotlib, "draw")
    rungs = parts.read(known_rungs, [options.rung])
    scene, files = scene_and_files(options, parts)
    place = parts.read(_place, options, options.scene if scene is None else scene.name)
    names = [name.strip() for name in options.only.split(",")] if options.only else []
    if options.animate and (names or files):
        fault = "expected a scene alone with --animate, got --only or files @ --animate"
        parts.faults.append(fault)
    parts.end()
    (options.rung,) = rungs
    with working(f"draw {scene.name}"), wrong_calls(kinds=NotDrawn):
        with wrong_calls(f" @ {scene.name}", Unsettled):
            document = motion(scene)
            # A short motion is animated over a longer time.
            document = lengthened(scene, document) if options.animate else document
        if options.animate:
            shown = [_animate(moving(document), place)]
        else:
            drawings = _pictures(document, names, files, partial(_judged, options, scene))
            shown = _write(drawings, place, is_alone=len(names) == 1)
    facts = {name: document[name] for name in ("scene", "regime", "route", "evidence")}
    content = {**facts, "files": shown}
    return Answer(PASS, content, partial(_text, content))


def _animate(motion: Mapping[str, Any], place: Path) -> dict[str, str]:
    """Write the motion as a page."""
    with unwritable("a file that can be written", str(place), "--out"):
        (path,) = replace_files(place.parent, {place.name: page(motion)})
    named = {"title": motion["title"], "shows": motion["alt"]}
    return {"file": str(path), "picture": "animation", **named}


def _pictures(
    document: Mapping[str, Any],
    names: Sequence[str],
    files: Sequence[TrajectoryFile],
    judge: Callable[[TrajectoryFile], FileJudgement],
) -> dict[str, Picture]:
    """Return the pictures of the motion, and those of the files if there are any, by their names."""
    others = [name for name in names if name not in OF_FILES]
    drawings = pictures(document, others) if others or not names else {}
    if not files and (asked := [name for name in names if name in OF_FILES]):
        raise WrongCall(
            "expected trajectory files behind the scene (draw SCENE mine.csv), got none @ --only "
            f"{','.join(asked)}"
        )
    judged = {file.name: judge(file) for file in files}
    if judged and (not names or ERRORS in names):
        records = {name: each.record.document() for name, each in judged.items() if each.record}
        drawings[ERRORS] = file_errors.picture(document, records)
    return {**drawings, **dict(_loads(document, names, judged))}


def _loads(
    document: Mapping[str, Any], names: Sequence[str], judged: Mapping[str, FileJudgement]
) -> Iterator[tuple[str, Picture]]:
    """Yield the load that each file asks for, where no cause is proven, or where --only names it."""
    for number, (name, each) in enumerate(judged.items(), start=1):
        if LOAD in names or (not names and each.missing_load):
            suffix = f"-{number}" if len(judged) > 1 else ""
            causes = [cause.name for cause in each.causes]
            drawn = missing_load.picture(document, name, each.missing_load, causes)
            yield f"{LOAD}{suffix}", drawn


def _judged(options: argparse.Namespace, scene: Scene, file: TrajectoryFile) -> FileJudgement:
    """Return the judgement of a file. Raises WrongCall if it cannot be compared."""
    judged = judge_file(file, scene, rung(options.rung), options.accept_conventions, partial=True)
    if judged.record is None:
        raise WrongCall(f"{judged.verdicts[0].because} @ {file.name}")
    return judged


def _write(drawings: Mapping[str, Picture], place: Path, is_alone: bool) -> list[dict[str, str]]:
    """Draw all pictures, then write them; a single picture has the name of --out itself."""
    ending = place.suffix
    contents = {
        f"{place.stem if is_alone else f'{place.stem}-{name}'}{ending}": content(
            picture, ending[1:].lower()
        )
        for name, picture in drawings.items()
    }
    with unwritable("a file that can be written", str(place), "--out"):
        written = replace_files(place.parent, contents)
    return [
        {"file": str(path), "picture": name, "title": picture.title, "shows": picture.alt}
        for path, (name, picture) in zip(written, drawings.items(), strict=True)
    ]


def _place(options: argparse.Namespace, scene: str) -> Path:
    """Return the file that --out names, from which each picture has its name. Raises WrongCall."""
    stem = Path(scene).with_suffix("").as_posix().replace("/", "-").strip("-.")
    place = writable_file(stem if options.out is None else options.out, "--out")
    endings, others = ((_PAGE,), STILLS) if options.animate else (STILLS, (_PAGE,))
    if options.out is None or not place.suffix:
        return place.with_name(place.name + (_PAGE if options.animate else _STILL))
    if place.suffix.lower() not in endings:
        how = "out" if options.animate else ""
        mend = f" (with{how} --animate: {', '.join(others)})"
        raise WrongCall(f"expected {', '.join(endings)}{mend}, got {place.suffix!r} @ --out")
    return place


def _text(shown: Mapping[str, Any]) -> str:
    page = Page()
    how = f"(route {shown['route']}, {shown['evidence']})"
    page.line(bold(shown["scene"]), f": {shown['regime']} {how}")
    for file in shown["files"]:
        page.line(f"wrote {file['file']}")
        page.indented("  ", file["shows"])
    return page.text()
