"""The verb `check`: the judgement of a trajectory in a file."""

from __future__ import annotations

import argparse
from functools import partial
from typing import TYPE_CHECKING

from taylor_verify.cli.answer import Answer, WrongCall
from taylor_verify.cli.verbs import known_rungs, read_scenes

if TYPE_CHECKING:
    from taylor_verify.scenes.scene import Scene
    from taylor_verify.solvers.file import TrajectoryFile


def check(options: argparse.Namespace) -> Answer:
    """The judgement of somebody's trajectory."""
    from taylor_verify.cli.check_text import check_text
    from taylor_verify.cli.ci import outputs, tell
    from taylor_verify.cli.progress import working
    from taylor_verify.judge.answer import judge_file
    from taylor_verify.records.verdict import exit_status
    from taylor_verify.scenes.precision import rung

    (name,) = known_rungs([options.rung])
    scene, file = _scene_and_file(options.scene, options.file)
    asked = outputs(options)
    with working(f"check {options.file}"):
        judged = judge_file(file, scene, rung(name), options.accept_conventions, options.partial)
    to_ci = tell(asked, judged, exit_status(judged.verdicts))
    text = partial(check_text, judged, scene.name, name, to_ci.status, options.explain)
    document = {**judged.document(), **to_ci.document}
    return Answer(to_ci.status, document, text, to_ci.messages)


def _scene_and_file(scene: str, file: str) -> tuple[Scene, TrajectoryFile]:
    """Both read; the faults of both are reported at once."""
    from taylor_verify.scenes.faults import Refused
    from taylor_verify.solvers.file import read

    faults: list[str] = []
    try:
        scenes = read_scenes([scene])
    except WrongCall as error:
        faults.append(str(error))
    try:
        found = read(file)
    except Refused as error:
        faults.append(str(error))
    if faults:
        raise WrongCall("\n".join(faults))
    return scenes[0], found
