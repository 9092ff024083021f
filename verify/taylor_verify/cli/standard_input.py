"""The trajectories of a call: files, or standard input, named `-`, which is read once like a file."""

from __future__ import annotations

import sys
import tempfile
from argparse import Namespace
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import Any, Final

from taylor_verify.cli.answer import WrongCall
from taylor_verify.cli.inputs import read_scene
from taylor_verify.records.faults import Refused
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.files.columns.assigned import Request, request
from taylor_verify.solvers.files.file import TrajectoryFile, read
from taylor_verify.solvers.files.formats.column import BYTES

NAME: Final = "-"
# The ending of a file by its first bytes; text is recognised below.
_ENDINGS: Final[Mapping[bytes, str]] = {
    b"PAR1": ".parquet",
    b"PK\x03\x04": ".npz",
    b"\x89HDF": ".h5",
    b"\x89MCAP": ".mcap",
    b"{": ".json",
}


def scene_and_files(
    options: Namespace, faults: Sequence[str] = ()
) -> tuple[Scene, list[TrajectoryFile]]:
    """Read the scene and the files of a call, each file once.

    Raises WrongCall with the faults of all, behind the ``faults`` that are known.
    """
    known = list(faults)

    def attempt(reading: Callable[..., Any], *given: Any) -> Any:
        try:
            return reading(*given)
        except (WrongCall, Refused) as error:
            known.extend(error.faults)

    scene = attempt(read_scene, options.scene)
    columns = request(options.columns or ())
    files = [attempt(_read_named, name, columns, scene) for name in dict.fromkeys(options.files)]
    if known:
        raise WrongCall(*known)
    return scene, files


def _read_named(name: str, columns: Request, scene: Scene) -> TrajectoryFile:
    """Return the trajectory in a file, or on standard input for `-`. Raises Refused and WrongCall."""
    if name != NAME:
        return read(name, columns, scene)
    content = b"" if sys.stdin is None else sys.stdin.buffer.read(BYTES.most + 1)
    if not content:
        raise WrongCall("expected a trajectory on standard input, got nothing @ -")
    BYTES.check(len(content), NAME)
    with tempfile.TemporaryDirectory(prefix="taylor-verify-") as folder:
        file = Path(folder) / f"stdin{_ending(content)}"
        file.write_bytes(content)
        return replace(read(file, columns, scene), name=NAME)


def _ending(content: bytes) -> str:
    start = content.lstrip()
    for first, ending in _ENDINGS.items():
        if start.startswith(first):
            return ending
    with suppress(ValueError):
        line = start[: start.index(b"\n")]
        if b"," not in line and b";" not in line:
            return ".txt"
    return ".csv"
