"""The portraits of the scenes as JSON files: written after they are made, read by pages and pictures.

data/portraits/euler-generic.json    one file a scene, as `measure` describes it
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any, Final

from taylor_verify.records import store
from taylor_verify.records.file_names import of_scene
from taylor_verify.records.replacement import first_line, replace_files

FOLDER: Final = f"{store.FOLDER}/portraits"

_MADE_BY: Final = {"made_by": "taylor-verify publish; do not edit"}

Portrait = Mapping[str, Any]


def write(folder: Path | str, documents: Iterable[Portrait]) -> list[Path]:
    """Write ``folder``/data/portraits, in place of earlier ones, and return the files written.

    Those of scenes that are no longer there are removed, other people's files are left alone. Raises
    OSError; what the folder held then stays as it was.
    """
    target = Path(folder) / FOLDER
    return list(replace_files(target, _texts(documents), stale=_own_files(target)))


def add(folder: Path | str, documents: Iterable[Portrait]) -> list[Path]:
    """Write portraits beside those that are there, and return the files written. Raises OSError."""
    return list(replace_files(Path(folder) / FOLDER, _texts(documents)))


def _texts(documents: Iterable[Portrait]) -> dict[str, str]:
    return {f"{of_scene(found['scene'])}.json": _laid_out(found) for found in documents}


def load(folder: Path | str, scene: str) -> dict[str, Any] | None:
    """The portrait of a scene; None where there is none.

    Raises OSError for a file that cannot be read and ValueError for one that holds something else.
    """
    file = Path(folder) / FOLDER / f"{of_scene(scene)}.json"
    return store.read_document(file) if file.exists() else None


def _laid_out(document: Portrait) -> str:
    """JSON with a line for every key, and no blanks within it: most of it is rows of numbers."""
    lines = (
        f"{json.dumps(key)}: "
        + json.dumps(value, ensure_ascii=False, allow_nan=False, separators=(",", ":"))
        for key, value in {**_MADE_BY, **document}.items()
    )
    return "{" + ",\n ".join(lines) + "}\n"


def _own_files(target: Path) -> list[Path]:
    """The JSON files that name us as their maker."""
    maker = "{" + json.dumps(_MADE_BY)[1:-1] + ","
    return [file for file in target.glob("*.json") if first_line(file) == maker]
