"""The trajectories of a call: files, or standard input, named `-`, which is read once like a file."""

from __future__ import annotations

import sys
import tempfile
from argparse import Namespace
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import Any, Final

from taylor_verify.cli.answer import CallParts, WrongCall
from taylor_verify.cli.inputs import read_scene
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


def scene_and_files(options: Namespace, parts: CallParts) -> tuple[Any, list[TrajectoryFile]]:
    """Read the scene and the files of a call, each file once; their faults are noted.

    The scene is None after a fault.
    """
    scene, columns = (
        parts.read(read_scene, options.scene),
        parts.read(request, options.columns or ()),
    )
    names = dict.fromkeys(options.files)
    return scene, [parts.read(_read_named, name, columns or (), scene) for name in names]


def _read_named(name: str, columns: Request, scene: Scene | None) -> TrajectoryFile:
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
