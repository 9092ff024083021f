"""A TOML document as text, in which the caller writes the numbers.

The standard library reads TOML and does not write it. Here every number has to keep its digits, too.
"""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Mapping
from typing import Any, Final

_BARE: Final = re.compile(r"[A-Za-z0-9_-]+")
# A longer array of arrays has one of them a line.
_WIDTH: Final = 100


def toml(document: Mapping[str, Any], number: Callable[[Any], str]) -> str:
    """Return the text of a document; ``number`` writes each value that is no text, bool, array or table."""
    lines = [f"{_key(k)} = {_value(v, number)}" for k, v in document.items() if not _is_table(v)]
    for name, table in document.items():
        if _is_table(table):
            lines += ["", f"[{_key(name)}]"]
            lines += [f"{_key(k)} = {_value(v, number)}" for k, v in table.items()]
    return "\n".join(lines) + "\n"


def _is_table(value: object) -> bool:
    return isinstance(value, Mapping)


def _key(name: str) -> str:
    return name if _BARE.fullmatch(name) else _text(name)


def _text(value: str) -> str:
    """Return a TOML string: JSON's escapes, and one for the character that JSON leaves."""
    return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")


def _value(value: Any, number: Callable[[Any], str]) -> str:
    match value:
        case str():
            return _text(value)
        case bool():
            return str(value).lower()
        case list():
            entries = [_value(entry, number) for entry in value]
            line = f"[{', '.join(entries)}]"
            if len(line) <= _WIDTH or not any(isinstance(entry, list) for entry in value):
                return line
            return "[\n" + "".join(f"  {entry},\n" for entry in entries) + "]"
        case Mapping():
            inner = ", ".join(f"{_key(k)} = {_value(v, number)}" for k, v in value.items())
            return f"{{ {inner} }}" if inner else "{}"
    return number(value)
