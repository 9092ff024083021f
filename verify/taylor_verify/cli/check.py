"""The verb `check`: the judgement of a trajectory in a file, or of several of one solver."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import Any

from taylor_verify.cli.answer import Answer, WrongCall, wrong_calls
from taylor_verify.cli.answers_text import check_text, files_text
from taylor_verify.cli.ci import outputs, tell
from taylor_verify.cli.folders import writable_file
from taylor_verify.cli.inputs import (
    known_rungs,
    read_number,
    read_scenes,
    read_tolerances,
    require_matplotlib,
)
from taylor_verify.cli.progress import working
from taylor_verify.judge.files.judgement import FileJudgement, judge_file
from taylor_verify.judge.series.files import (
    FilesJudgement,
    checked_steps,
    files_judgement,
    judge_each,
    repeated,
    steps_of,
)
from taylor_verify.records.verdict import exit_status
from taylor_verify.scenes.precision import rung
from taylor_verify.scenes.reading.faults import Refused
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.files.columns.request import request
from taylor_verify.solvers.files.file import TrajectoryFile, read


def answer(options: argparse.Namespace) -> Answer:
    """Judge somebody's trajectory; of several files also find the order of convergence."""
    (options.rung,) = known_rungs([options.rung])
    with working(f"check {', '.join(options.files)}"):
        scene, files, steps = _asked(options)
    picture = _picture(options, files, steps)
    asked = outputs(options)
    judged: FileJudgement | FilesJudgement
    if len(files) == 1:
        judged = _judged(options, scene, files[0])
    else:
        judged = files_judgement(judge_each(files, partial(_judged, options, scene)), steps)
    to_ci = tell(asked, judged, exit_status(judged.verdicts))
    document = {**judged.document(), **to_ci.document}
    messages = [*to_ci.messages]
    text: Callable[[], str]
    if isinstance(judged, FileJudgement):
        said = (scene.name, options.rung, to_ci.stated_status, options.explain)
        text = partial(check_text, judged, *said)
    else:
        messages += _drawn(judged, picture)
        text = partial(files_text, judged, scene.name, options.rung)
    return Answer(to_ci.status, document, to_ci.closing(text), messages)


def _judged(options: argparse.Namespace, scene: Scene, file: TrajectoryFile) -> FileJudgement:
    """Judge one file as the options say."""
    tolerances = read_tolerances(options.tolerance, [scene])
    as_asked = (options.accept_conventions, options.partial, tolerances)
    with working(f"check {file.name}"):
        return judge_file(file, scene, rung(options.rung), *as_asked)


def _asked(
    options: argparse.Namespace,
) -> tuple[Scene, list[TrajectoryFile], Sequence[float] | None]:
    """Read scene, files and steps; the faults of all are reported at once."""
    faults = repeated(options.files)

    def attempt(reading: Callable[..., Any], *given: Any) -> Any:
        try:
            return reading(*given)
        except (WrongCall, Refused) as error:
            faults.append(str(error))

    steps = attempt(_steps, options)
    scenes = attempt(read_scenes, [options.scene])
    files = [attempt(_read, file, options.columns or ()) for file in dict.fromkeys(options.files)]
    if faults:
        raise WrongCall("\n".join(faults))
    return scenes[0], files, steps


def _read(file: str, columns: Sequence[str]) -> TrajectoryFile:
    return read(file, request(columns))


def _steps(options: argparse.Namespace) -> list[float] | None:
    if options.steps is None:
        return None
    if len(options.files) == 1:
        raise WrongCall("expected several files with --steps, got one @ --steps")
    steps = []
    for text in options.steps.split(","):
        steps.append(read_number(text, "--steps"))
        if not steps[-1] > 0:
            raise WrongCall(f"expected a positive step, got {text!r} @ --steps")
    with wrong_calls(" (--steps)"):
        return checked_steps(steps, len(options.files))


# The picture.


def _picture(
    options: argparse.Namespace,
    files: Sequence[TrajectoryFile],
    steps: Sequence[float] | None,
) -> Path | None:
    """Return the file of --picture, known to be possible before the work begins."""
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
    require_matplotlib("--picture")
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
