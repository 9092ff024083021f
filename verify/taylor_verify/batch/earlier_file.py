"""The file of an earlier run's verdicts: verdicts.json of `run --out`, or the document of `--json`."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final

from taylor_verify.batch.differences import ERRORS
from taylor_verify.records.json_text import DOCUMENT, parsed
from taylor_verify.records.regular_file import read_bytes
from taylor_verify.records.soundness import check_rows
from taylor_verify.records.status import Status
from taylor_verify.records.store import with_digest
from taylor_verify.records.verdict import Verdict

_NUMBERS: Final = (*ERRORS, "bound", "attainable", "roundoff")


def load(file: Path | str) -> tuple[Verdict, ...]:
    """Return the verdicts of a file.

    Raises records.faults.Refused for a file that cannot be read. Raises ValueError, which names what
    was expected and where, for a file with other content: a half-understood baseline would pass everything.
    """
    content = read_bytes(Path(file), "a file of verdicts", DOCUMENT)
    try:
        placed = dict(_placed(parsed(content, _Rows)))
        for place, verdict in placed.items():
            _check_comparable(verdict, place)
        check_rows(placed)
    except ValueError as fault:
        raise ValueError(f"{fault} @ {file}") from fault
    return tuple(placed.values())


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


def _check_comparable(verdict: Verdict, place: str) -> None:
    """Refuse a row with which nothing can be compared."""
    for name in _NUMBERS if verdict.verdict is Status.PASS else ():
        if getattr(verdict, name) is None:
            raise ValueError(f"expected a number of a row that passed, got null @ {place}.{name}")
    if not isinstance(verdict.provenance.get("scene"), str):
        raise ValueError(
            f"expected the digest of the scene's text, got none @ {place}.provenance.scene"
        )
