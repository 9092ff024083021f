"""The verb `check`: the judgement of a trajectory in a file, or of several of one solver."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from functools import partial
from typing import TYPE_CHECKING

from taylor_verify.cli.answer import Answer, WrongCall
from taylor_verify.cli.verbs import known_rungs, read_number, read_scenes

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from taylor_verify.judge.files.judgement import FileJudgement
    from taylor_verify.judge.series.files import FilesJudgement
    from taylor_verify.scenes.scene import Scene
    from taylor_verify.solvers.files.file import TrajectoryFile


def add_options(verb: argparse.ArgumentParser) -> None:
    """Add the options that are about several files."""
    verb.add_argument(
        "--steps",
        metavar="H,H,...",
        help="the step of each of several files, for the order of convergence; default: what the files or "
        "their names say (run_h0.05.csv)",
    )
    verb.add_argument(
        "--picture",
        metavar="FILE",
        help="draw the errors of several files against their steps (svg, pdf, png; matplotlib)",
    )


def check(options: argparse.Namespace) -> Answer:
    """Judge somebody's trajectory; of several files also find the order of convergence."""
    from taylor_verify.cli.answers_text import check_text, files_text
    from taylor_verify.cli.ci import outputs, tell
    from taylor_verify.cli.progress import working
    from taylor_verify.judge.series.files import files_judgement, judge_each
    from taylor_verify.records.verdict import exit_status
    from taylor_verify.scenes.reading.faults import Refused

    (options.rung,) = known_rungs([options.rung])
    with working(f"check {', '.join(options.files)}"):
        scene, files, steps = _asked(options)
    picture = _picture(options, files, steps)
    asked = outputs(options)
    if len(files) == 1:
        judged = _judged(options, files[0], scene)
        to_ci = tell(asked, judged, exit_status(judged.verdicts))
        text = partial(
            check_text, judged, scene.name, options.rung, to_ci.stated_status, options.explain
        )
        document = {**judged.document(), **to_ci.document}
        return Answer(to_ci.status, document, to_ci.closing(text), to_ci.messages)
    try:
        each = judge_each(files, lambda file: _judged(options, file, scene))
    except Refused as error:
        raise WrongCall(str(error)) from error
    several = files_judgement(each, steps)
    to_ci = tell(asked, several, exit_status(several.verdicts))
    document = {**several.document(), **to_ci.document}
    messages = [*to_ci.messages, *_drawn(several, picture)]
    text = partial(files_text, several, scene.name, options.rung)
    return Answer(to_ci.status, document, to_ci.closing(text), messages)


def _judged(options: argparse.Namespace, file: TrajectoryFile, scene: Scene) -> FileJudgement:
    """Judge one file as the options say."""
    from taylor_verify.cli.progress import working
    from taylor_verify.cli.tolerance import read_tolerances
    from taylor_verify.judge.files.judgement import judge_file
    from taylor_verify.scenes.precision import rung

    tolerances = read_tolerances(options.tolerance, [scene])
    with working(f"check {file.name}"):
        return judge_file(
            file,
            scene,
            rung(options.rung),
            options.accept_conventions,
            options.partial,
            tolerances,
        )


def _asked(
    options: argparse.Namespace,
) -> tuple[Scene, list[TrajectoryFile], Sequence[float] | None]:
    """Read scene, files and steps; the faults of all are reported at once."""
    from taylor_verify.judge.series.files import repeated
    from taylor_verify.scenes.reading.faults import Refused
    from taylor_verify.solvers.files.columns.request import request
    from taylor_verify.solvers.files.file import read

    faults = repeated(options.files)
    steps: list[float] | None = None
    try:
        steps = _steps(options)
    except WrongCall as error:
        faults.append(str(error))
    try:
        scenes = read_scenes([options.scene])
    except WrongCall as error:
        faults.append(str(error))
    files = []
    for file in dict.fromkeys(options.files):
        try:
            files.append(read(file, request(options.columns or ())))
        except Refused as error:
            faults.append(str(error))
    if faults:
        raise WrongCall("\n".join(faults))
    return scenes[0], files, steps


def _steps(options: argparse.Namespace) -> list[float] | None:
    from taylor_verify.judge.series.files import checked_steps

    if options.steps is None:
        return None
    if len(options.files) == 1:
        raise WrongCall("expected several files with --steps, got one @ --steps")
    steps = []
    for text in options.steps.split(","):
        steps.append(read_number(text, "--steps"))
        if not steps[-1] > 0:
            raise WrongCall(f"expected a positive step, got {text!r} @ --steps")
    try:
        return checked_steps(steps, len(options.files))
    except ValueError as error:
        raise WrongCall(f"{error} (--steps)") from error


# The picture.


def _picture(
    options: argparse.Namespace,
    files: Sequence[TrajectoryFile],
    steps: Sequence[float] | None,
) -> Path | None:
    """Return the file of --picture, known to be possible before the work begins."""
    from importlib.util import find_spec

    from taylor_verify.cli.ci import writable_file
    from taylor_verify.judge.series.files import steps_of
    from taylor_verify.publish.pictures.picture import ENDINGS

    if options.picture is None:
        return None
    path = writable_file(options.picture, "--picture")
    if path.suffix.lower() not in ENDINGS:
        expected = f"a file that ends in {', '.join(ENDINGS)}"
        raise WrongCall(f"expected {expected}, got {options.picture!r} @ --picture")
    if sum(step is not None for step in steps_of(files, steps)) < 2:
        raise WrongCall(
            "expected several files whose steps are known (--steps 0.1,0.05,...), got fewer than two "
            "@ --picture"
        )
    if find_spec("matplotlib") is None:
        raise WrongCall(
            "expected matplotlib (pip install 'taylor-verify[plots]'), got none @ --picture"
        )
    return path


def _drawn(judged: FilesJudgement, path: Path | None) -> list[str]:
    """Draw the errors against the steps, and say where."""
    if path is None:
        return []
    from taylor_verify.publish.pictures import order
    from taylor_verify.publish.pictures.picture import save_as

    if not any(order.has_points(one) for one in judged.order):
        return [f"no picture: no error above zero at a known step @ {path}"]
    verdict = judged.verdicts[0]
    save_as(order.picture(f"{verdict.scene} on {verdict.rung}", judged.order), path)
    return [f"wrote {path}"]
