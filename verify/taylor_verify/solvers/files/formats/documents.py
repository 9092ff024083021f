"""Columns in JSON: an object of arrays, or one that has such an object under ``columns``."""

from __future__ import annotations

import json
import re
from itertools import islice
from pathlib import Path
from typing import Any, Final

from taylor_verify.records.faults import Faults, Refused, refusal
from taylor_verify.solvers.files.columns.names import KNOWN
from taylor_verify.solvers.files.formats.column import (
    BYTES,
    COLUMNS,
    KEYS,
    ROWS,
    VALUES,
    Column,
    Table,
    refuse_part,
    shown,
)
from taylor_verify.solvers.files.formats.content import Content
from taylor_verify.solvers.values import named_once

_BETWEEN_BRACKETS: Final = re.compile(r"[^\[\]{}]+")
_KEY_OR_BRACKET: Final = re.compile(r"[\[{]|\"\s*:")


def read(file: Content, path: Path, part: str) -> Table:
    """Return the arrays; commas, keys and brackets are counted before anything is made of the text."""
    refuse_part(part, path)
    text = file.text(BYTES)
    # No array has more entries than commas and one.
    longest = max((text.count(",", *m.span()) for m in _BETWEEN_BRACKETS.finditer(text)), default=0)
    for limit, commas in ((ROWS, longest), (VALUES, text.count(","))):
        if commas > limit.most:
            raise limit.refusal("more", path)
    if sum(1 for _ in islice(_KEY_OR_BRACKET.finditer(text), KEYS.most + 1)) > KEYS.most:
        raise KEYS.refusal("more", path)
    document = _parsed(text, path)
    if isinstance(document, dict) and isinstance(document.get("columns"), dict):
        document = document["columns"]
    if not isinstance(document, dict):
        expected = 'an object of column arrays {"t": [...], "w1": [...]}'
        raise refusal(expected, shown(document), path)
    faults, columns = Faults(), []
    for name, values in document.items():
        if isinstance(values, list):
            columns.append(Column(name, values))
        elif name in KNOWN:
            faults.add("an array of numbers", shown(values), f"{path}, column {name}")
    if faults.lines:
        raise Refused(faults.lines)
    COLUMNS.check(len(columns), path)
    return Table(columns)


def _parsed(text: str, path: Path) -> Any:
    try:
        return json.loads(
            text,
            parse_float=str,
            parse_int=str,
            parse_constant=float,
            object_pairs_hook=named_once,
        )
    except (ValueError, RecursionError) as error:
        reason = "brackets nested too deeply" if isinstance(error, RecursionError) else error
        raise refusal("a JSON document", f"a fault in it: {reason}", path) from None
