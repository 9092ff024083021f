"""The rows of a sweep on disk: a Parquet dataset of one file a chunk, and what they are the answer to.

A part is written whole or not at all, and carries the numbers of its bodies and the sum of its rows.
Whatever ends a sweep, the parts that are there are finished, and those that are not, or that were damaged
since, are judged again: nothing is lost, and nothing is done twice.
"""

from __future__ import annotations

import hashlib
import json
import logging
import os
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path
from typing import Any, Final

from taylor_verify.batch.sweeps.chunk import COLUMNS, Columns
from taylor_verify.records.faults import Refused
from taylor_verify.records.json_text import complete, read
from taylor_verify.records.limit import Limit
from taylor_verify.records.regular_file import regular_file
from taylor_verify.records.replacement import replace_files

_log = logging.getLogger(__name__)
_PART: Final = Limit(2**28, "bytes", "a thousand bodies take a megabyte")

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
        """Return the numbers of the parts that are there, each as it was written."""
        return {number for number in range(self.parts) if self._is_sound(number)}

    def write(self, number: int, columns: Columns) -> None:
        """Write a part in one step. Raises OSError."""
        from pyarrow import parquet

        content = BytesIO()
        parquet.write_table(
            self._signed(number, table(columns)),
            content,
            compression="zstd",
            use_dictionary=[name for name in _REPEATED if name in columns],
        )
        replace_files(self.rows, {self._name(number): content.getvalue()})

    def tables(self, columns: Sequence[str]) -> Iterator[Any]:
        """Yield the parts in their order, each a table of pyarrow with these columns."""
        for number in range(self.parts):
            yield self._read(number, columns)

    def _read(self, number: int, columns: Sequence[str] | None = None) -> Any:
        from pyarrow import parquet

        with regular_file(self._file(number), "a part of a sweep", _PART) as file:
            # Threads would save nothing on parts of this size.
            return parquet.ParquetFile(file).read(columns, use_threads=False)

    def _is_sound(self, number: int) -> bool:
        """Return True for a part that holds its bodies as they were judged; a damaged one is told."""
        from pyarrow import ArrowException

        if not os.path.lexists(self._file(number)):
            return False
        try:
            rows = self._read(number)
            if self._signed(number, rows).schema.metadata == rows.schema.metadata:
                return True
        except (ArrowException, OSError, ValueError, Refused):
            pass
        _log.warning("taylor-verify: warning: damaged, and run again: %s", self._name(number))
        return False

    def _signed(self, number: int, rows: Any) -> Any:
        """Return the rows of a part with the numbers of its bodies and their sum beside them."""
        first = number * self.manifest.chunk
        bodies = f"{first} to {min(first + self.manifest.chunk, self.manifest.total) - 1}"
        return rows.replace_schema_metadata({"bodies": bodies, "sha256": _sum(rows)})

    def _file(self, number: int) -> Path:
        return self.rows / self._name(number)

    @staticmethod
    def _name(number: int) -> str:
        return f"part-{number:06d}.parquet"


def _sum(rows: Any) -> str:
    """Return the SHA-256 of the rows, column by column, each number to the last bit."""
    digest = hashlib.sha256()
    for name in rows.column_names:
        digest.update(repr((name, rows.column(name).to_pylist())).encode())
    return digest.hexdigest()


def table(columns: Columns) -> Any:
    """Return the rows as a table of pyarrow."""
    import pyarrow

    kinds = {name: getattr(pyarrow, COLUMNS.get(name, "float64"))() for name in columns}
    return pyarrow.table(columns, pyarrow.schema(kinds))


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
