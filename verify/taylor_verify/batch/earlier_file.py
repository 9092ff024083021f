"""The file of an earlier run's verdicts: verdicts.json of `run --out`, or the document of `--json`."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from taylor_verify.records import store, sums
from taylor_verify.records.json_text import DOCUMENT, parsed
from taylor_verify.records.regular_file import read_bytes
from taylor_verify.records.soundness import check_rows
from taylor_verify.records.store import with_digest
from taylor_verify.records.verdict import Verdict


def load(file: Path | str) -> tuple[tuple[Verdict, ...], bool | None]:
    """Return the verdicts of a file, and whether they were edited; None where no sum says it.

    The sum is that of the document, or stands in a file beside verdicts.json. Raises
    records.faults.Refused for a file that cannot be read. Raises ValueError, which names what was expected
    and where, for a file with other content: a half-understood baseline would pass everything.
    """
    content = read_bytes(Path(file), "a file of verdicts", DOCUMENT)
    try:
        placed = dict(_placed(parsed(content, _Rows)))
        check_rows(placed)
    except ValueError as fault:
        raise ValueError(f"{fault} @ {file}") from fault
    return tuple(placed.values()), _is_edited(content, Path(file))


def _is_edited(content: bytes, file: Path) -> bool | None:
    beside = file.with_name(store.SUM)
    if file.name != store.VERDICTS or not beside.exists():
        return sums.is_edited(content)
    return read_bytes(beside, "a sum", DOCUMENT) != sums.line(content, file.name).encode()


@dataclass(frozen=True)
class _Rows:
    """The part of a document that a baseline needs; a document of several files has one for each file."""

    verdicts: tuple[Verdict, ...] | None = None
    scenes: Mapping[str, str] = field(default_factory=dict)
    files: tuple[_Rows, ...] = ()


def _placed(document: _Rows, place: str = "") -> Iterator[tuple[str, Verdict]]:
    """Yield every row of a document with its place in it. Raises ValueError where there is no list."""
    if document.verdicts is None and not document.files:
        raise ValueError(f"expected a key verdicts, got none @ {place or 'the document'}")
    for i, verdict in enumerate(document.verdicts or ()):
        yield f"{place}verdicts[{i}]", with_digest(verdict, document.scenes)
    for k, file in enumerate(document.files):
        yield from _placed(file, f"{place}files[{k}].")
