"""The rows of a sweep on disk: a Parquet dataset of one file a chunk, and what they are the answer to.

A part is written whole or not at all. Whatever ends a sweep, the parts that are there are finished, and
those that are not are judged again: nothing is lost, and nothing is done twice.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path
from typing import Any, Final

from taylor_verify.batch.sweeps.chunk import COLUMNS, Columns
from taylor_verify.records.faults import Refused
from taylor_verify.records.json_text import complete, read
from taylor_verify.records.replacement import replace_files

MANIFEST: Final = "sweep.json"
TEMPLATE: Final = "template.toml"
_ROWS: Final = "verdicts"
OWN_NAMES: Final = (MANIFEST, TEMPLATE, _ROWS)
"""The names in a sweep's folder of what was asked and of the rows."""
_MADE_BY: Final = "taylor-verify sweep"
# What cannot be shown in a line.
_UNSEEN: Final = {
    "digest": "the text of the template, or of the scenes,",
    "package": "the code of taylor-verify",
    "programs": "the program of the solver",
    "versions": "the versions of libraries",
}
_WORDS: Final = {"name": "the template or family", "points": "the kind of points"}
# Made of the others.
_DERIVED: Final = ("total", "chunk", "made_by")
_MEND: Final = "(repeat the first call with --resume, or name another folder)"
# Texts that a column repeats.
_REPEATED: Final = ("scene", "quantity", "verdict", "outcome", "unit", "because")


@dataclass(frozen=True)
class Manifest:
    """The question of a sweep: scenes, solver, rung, tolerance, and digests of the code that answers."""

    name: str
    digest: str
    count: int
    seed: int | None
    points: str | None
    total: int
    chunk: int
    solver: str
    rung: str
    tolerance: str | None
    programs: tuple[str, ...]
    package: str
    versions: dict[str, str]
    made_by: str = _MADE_BY

    def differences(self, other: Manifest) -> list[str]:
        """Return a sentence for each option in which another sweep differs."""
        mine, theirs = vars(self), vars(other)
        names = [name for name in mine if name not in _DERIVED and mine[name] != theirs[name]]
        return [_difference(name, mine[name], theirs[name]) for name in names]


def _difference(name: str, mine: object, theirs: object) -> str:
    if name in _UNSEEN:
        expected, got = f"{_UNSEEN[name]} as in the sweep that is there", "another one"
    else:
        expected = f"{_WORDS.get(name, name)} {_word(mine)} as in the sweep that is there"
        got = _word(theirs)
    return f"expected {expected}, got {got} @ resume {_MEND}"


def _word(value: object) -> str:
    return "none" if value is None else str(value)


@dataclass(frozen=True)
class Dataset:
    """The dataset of one sweep in a folder."""

    folder: Path
    manifest: Manifest

    @property
    def rows(self) -> Path:
        """The folder of the parts, which pandas and pyarrow read as one table."""
        return self.folder / _ROWS

    @property
    def parts(self) -> int:
        """The number of parts when all are finished."""
        return -(-self.manifest.total // self.manifest.chunk)

    def begin(self, texts: Mapping[str, str]) -> None:
        """Write what is asked, with the text of a template beside it. Raises OSError."""
        document = json.dumps(complete(self.manifest), indent=1) + "\n"
        replace_files(self.folder, {**texts, MANIFEST: document})

    def finished(self) -> set[int]:
        """Return the numbers of the parts that are there, each whole."""
        return {number for number in range(self.parts) if self._is_whole(number)}

    def write(self, number: int, columns: Columns) -> None:
        """Write a part in one step. Raises OSError."""
        from pyarrow import parquet

        content = BytesIO()
        parquet.write_table(
            table(columns),
            content,
            compression="zstd",
            use_dictionary=[name for name in _REPEATED if name in columns],
        )
        replace_files(self.rows, {self._name(number): content.getvalue()})

    def tables(self, columns: Sequence[str]) -> Iterator[Any]:
        """Yield the parts in their order, each a table of pyarrow with these columns."""
        from pyarrow import parquet

        for number in range(self.parts):
            # Threads would save nothing on parts of this size.
            yield parquet.read_table(self._file(number), columns=list(columns), use_threads=False)

    def _is_whole(self, number: int) -> bool:
        from pyarrow import ArrowException, parquet

        try:
            return bool(parquet.read_metadata(self._file(number)).num_rows)
        except (ArrowException, OSError):
            return False

    def _file(self, number: int) -> Path:
        return self.rows / self._name(number)

    @staticmethod
    def _name(number: int) -> str:
        return f"part-{number:06d}.parquet"


def table(columns: Columns) -> Any:
    """Return the rows as a table of pyarrow."""
    import pyarrow

    types = {name: getattr(pyarrow, kind)() for name, kind in COLUMNS.items()}
    return pyarrow.table(
        {
            name: pyarrow.array(values, types.get(name, pyarrow.float64()))
            for name, values in columns.items()
        }
    )


def read_manifest(folder: Path) -> Manifest | None:
    """Return what the sweep in a folder asked; None where there is none.

    Raises Refused for a file that is something else.
    """
    file = folder / MANIFEST
    if not file.exists():
        return None
    try:
        return read(file, Manifest)
    except ValueError as error:
        raise Refused([str(error)]) from None
