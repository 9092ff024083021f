"""Replacement of generated files as a whole: a reader of the folder sees old files or new ones."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from tempfile import TemporaryDirectory


def replace_files(
    folder: Path, contents: Mapping[str, str | bytes | Iterator[str]], stale: Iterable[Path] = ()
) -> tuple[Path, ...]:
    """Put the contents, by their paths below ``folder``, in place of what is there; remove ``stale``.

    A long text may come in pieces. All are first written apart, so that what fails in writing leaves
    the old files as they were, and none is ever half written. Raises OSError; returns the paths in the
    order given.
    """
    folder.mkdir(parents=True, exist_ok=True)
    places = {name: folder / name for name in contents}
    # A directory inside the folder is on the same file system, where a move is one step.
    with TemporaryDirectory(dir=folder, prefix=".unfinished-") as staging:
        for name, content in contents.items():
            place = Path(staging, name)
            place.parent.mkdir(parents=True, exist_ok=True)
            if isinstance(content, bytes):
                place.write_bytes(content)
            else:
                pieces = [content] if isinstance(content, str) else content
                with place.open("w", encoding="utf-8", newline="") as staged:
                    staged.writelines(pieces)
        for name, place in places.items():
            place.parent.mkdir(parents=True, exist_ok=True)
            os.replace(Path(staging, name), place)
    for file in set(stale) - set(places.values()):
        file.unlink(missing_ok=True)
    return tuple(places.values())


def first_line(file: Path) -> str:
    """Return the line in which a generated file names its maker."""
    with file.open(encoding="utf-8", errors="replace") as lines:
        return lines.readline().rstrip("\n")
