"""The verdicts of an earlier run: verdicts.json of `run --out`, its folder, or the document of `--json`."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from os import PathLike, fspath
from pathlib import Path
from typing import Any, Final

from taylor_verify.batch.comparison import Earlier
from taylor_verify.records import store, sums
from taylor_verify.records.faults import brief
from taylor_verify.records.json_text import DOCUMENT, parsed
from taylor_verify.records.regular_file import read_bytes
from taylor_verify.records.soundness import check_rows
from taylor_verify.records.store import with_digest
from taylor_verify.records.verdict import Verdict

_GATES: Final = ("bound", "baseline")


def read_baseline(file: str | PathLike[str]) -> Earlier:
    """Read ``verdicts.json`` of `run --out`, or the document of `run --json` and `check --json`.

    Its sum is that of the document, or stands in a file beside verdicts.json. Raises
    records.faults.Refused for a file that cannot be read, and ValueError for one that holds something else.
    """
    place = Path(file)
    content = read_bytes(place, "a file of verdicts", DOCUMENT)
    verdicts, edited = _of_document(content, place)
    beside = place.with_name(store.SUM)
    if place.name == store.VERDICTS and beside.exists():
        line = read_bytes(beside, "a sum", DOCUMENT)
        edited = line != sums.line(content, store.VERDICTS).encode()
    return Earlier(fspath(file), verdicts, edited)


def earlier(baseline: str | PathLike[str] | Mapping[str, Any] | None, gate: str) -> Earlier | None:
    """Return the rows of a baseline. Raises as `read_baseline` does, ValueError for a wrong gate."""
    if gate not in _GATES:
        raise ValueError(f"expected bound or baseline, got {brief(gate)} @ gate")
    if baseline is None:
        if gate == "baseline":
            raise ValueError("expected a baseline with the gate baseline, got none @ baseline")
        return None
    if isinstance(baseline, str | PathLike):
        return read_baseline(baseline)
    if not isinstance(baseline, Mapping):
        got = brief(baseline)
        raise ValueError(f"expected the path of a baseline or its document, got {got} @ baseline")
    try:
        content = json.dumps(baseline).encode()
    except (TypeError, ValueError) as error:
        raise ValueError(f"expected a JSON document, got {error} @ baseline") from None
    return Earlier("the baseline", *_of_document(content, "baseline"))


def read_report(folder: str | PathLike[str]) -> Earlier:
    """Read the verdicts of a report folder.

    Raises FileNotFoundError where there are none, and ValueError for a file that holds something else.
    """
    place = Path(folder)
    return Earlier(fspath(folder), store.load(place), store.are_edited(place))


def _of_document(content: bytes, place: object) -> tuple[tuple[Verdict, ...], bool | None]:
    """Return the verdicts of a document, and whether they were edited; None where no sum says it.

    Raises ValueError, which names what was expected and where, for other content: a half-understood
    baseline would pass everything.
    """
    try:
        placed = dict(_placed(parsed(content, _Rows)))
        check_rows(placed)
    except ValueError as fault:
        raise ValueError(f"{fault} @ {place}") from fault
    return tuple(placed.values()), sums.is_edited(content)


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
