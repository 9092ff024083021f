"""Columns in JSON: an object of arrays, a list of objects, or an object in each line.

An object of arrays may have groups in it, or its columns under ``columns``.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from itertools import islice
from pathlib import Path
from typing import Any, Final

from taylor_verify.records.faults import Faults, Refused, refusal
from taylor_verify.records.json_text import loaded
from taylor_verify.solvers.files.columns.names import KNOWN
from taylor_verify.solvers.files.formats.column import (
    BYTES,
    COLUMNS,
    KEYS,
    ROWS,
    VALUES,
    Column,
    Table,
    shown,
)
from taylor_verify.solvers.files.formats.content import Content
from taylor_verify.solvers.files.formats.entries import Entries, table
from taylor_verify.solvers.values import named_once

_LINES: Final = (".jsonl", ".ndjson")
_BETWEEN_BRACKETS: Final = re.compile(r"[^\[\]{}]+")
_KEY_OR_BRACKET: Final = re.compile(r"[\[{]|\"\s*:")
_EXPECTED: Final = 'an object of column arrays {"t": [...], "w1": [...]}'


def read(file: Content, path: Path) -> Table:
    """Return the columns of a document, or of an object in each line."""
    if path.suffix.lower() in _LINES or _is_of_lines(file):
        return table(_objects(file, path), path)
    document = _document(file, path)
    if isinstance(document, dict):
        lists = [each for each in document.values() if isinstance(each, list)]
        document = lists[0] if len(lists) == 1 and _are_objects(lists[0]) else document
    if _are_objects(document):
        counted = enumerate(document, start=1)
        return table((_object(each, f"{path}, row {k}") for k, each in counted), path)
    if isinstance(document, dict) and isinstance(document.get("columns"), dict):
        document = document["columns"]
    while isinstance(document, dict) and len(document) == 1:
        (inner,) = document.values()
        if not isinstance(inner, dict):
            break
        document = inner
    if not isinstance(document, dict):
        raise refusal(_EXPECTED, shown(document), path)
    faults, columns = Faults(), list(_columns(document, path))
    for name, values in document.items():
        if name in KNOWN and not _has_parts(values):
            faults.add("an array of numbers", shown(values), f"{path}, column {name}")
    if faults.lines:
        raise Refused(faults.lines)
    COLUMNS.check(len(columns), path)
    return Table(columns)


def _columns(document: Mapping[str, Any], path: Path, group: str = "") -> Iterator[Column]:
    """Yield the arrays of an object and of the objects in it, an array of vectors by its components."""
    for name, values in document.items():
        if isinstance(values, dict) and values and not any(map(_has_parts, values.values())):
            # pandas writes the numbers of a column by the labels of the rows.
            yield Column(f"{group}{name}", list(values.values()))
        elif isinstance(values, dict) and not group:
            yield from _columns(values, path, f"{name}.")
        elif isinstance(values, list) and values and isinstance(values[0], list | dict):
            entries = (Entries.of(each, f"{group}{name}") for each in values)
            yield from table(entries, path).columns
        elif isinstance(values, list):
            yield Column(f"{group}{name}", values)


def _are_objects(value: Any) -> bool:
    return isinstance(value, list) and bool(value) and isinstance(value[0], dict)


def _has_parts(value: Any) -> bool:
    return isinstance(value, list | dict)


def _document(file: Content, path: Path) -> Any:
    """Return the document; commas, keys and brackets are counted before anything is made of the text."""
    text = file.text(BYTES)
    # No array has more entries than commas and one.
    longest = max((text.count(",", *m.span()) for m in _BETWEEN_BRACKETS.finditer(text)), default=0)
    for limit, commas in ((ROWS, longest), (VALUES, text.count(","))):
        if commas > limit.most:
            raise limit.refusal("more", path)
    if sum(1 for _ in islice(_KEY_OR_BRACKET.finditer(text), KEYS.most + 1)) > KEYS.most:
        raise KEYS.refusal("more", path)
    return _parsed(text, path)


def _parsed(text: str, place: object) -> Any:
    numbers = {"parse_float": str, "parse_int": str, "parse_constant": float}
    return loaded(text, place, **numbers, object_pairs_hook=named_once)


# An object in each line.


def _is_of_lines(file: Content) -> bool:
    """Return True if the first line is an object by itself, and another line follows."""
    lines = (line for line in file.lines(BYTES) if line.strip())
    first, second = next(lines, ""), next(lines, "")
    return bool(second) and first.strip()[:1] == "{" and first.strip()[-1:] == "}"


def _objects(file: Content, path: Path) -> Iterator[Entries]:
    for number, line in enumerate(file.lines(), start=1):
        if line.strip():
            place = f"{path}, line {number}"
            yield _object(_parsed(line, place), place)


def _object(value: Any, place: str) -> Entries:
    if not isinstance(value, dict):
        raise refusal('an object {"t": ..., "w1": ...}', shown(value), place)
    return Entries.of(value)
