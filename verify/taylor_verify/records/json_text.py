"""JSON text of typed documents, and documents read from it: every reader and writer is one of these.

A float that is not finite is null, because JSON has no word for it. Floats are written so that they read
back to the last bit.
"""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Mapping
from dataclasses import Field, fields, is_dataclass
from decimal import Decimal
from enum import Enum
from math import isfinite
from pathlib import Path
from typing import Annotated, Any, Final, TypeVar

import msgspec

from taylor_verify.records.faults import Refused, refusal
from taylor_verify.records.limit import Limit
from taylor_verify.records.regular_file import bounded_bytes, read_bytes

Document = TypeVar("Document")

DOCUMENT: Final = Limit(2**28, "bytes", "a hundred thousand verdicts")

# A number that is not negative. The schema says so; a value in memory may be NaN, which no bound admits.
Size = Annotated[float, msgspec.Meta(extra_json_schema={"minimum": 0})]
Count = Annotated[int, msgspec.Meta(ge=0)]


def about(description: str) -> msgspec.Meta:
    """Return the annotation that describes a field in the JSON schema."""
    return msgspec.Meta(description=description)


# What msgspec says of a value that does not fit: the words, and the place behind them.
_PLACE: Final = re.compile(r" - at `\$\.?(.*)`$")
_MISSING: Final = re.compile(r"Object missing required field `(.*)`")
_TYPE: Final = re.compile(r"`([^`]*)`")
_WORDS: Final = {
    **{"object": "an object", "array": "a list", "str": "a text", "bool": "true or false"},
    **{"float": "a number", "int": "a whole number"},
}
_OUT_OF_RANGE: Final = re.compile("(Number|Integer value) out of range")
_MOST_DIGITS: Final = 4000
_STEP: Final = re.compile(r"\[(\d+)\]|(\.\.\.|[^.\[\]]+)")


def plain(document: Any) -> Any:
    """Return a typed document as dicts, lists and values, without fields that are at their default."""
    return _builtins(document, lambda field, value: value != field.default)


def complete(document: Any) -> Any:
    """Return a typed document as dicts, lists and values, with all of its fields."""
    return _builtins(document, lambda field, value: True)


def _builtins(document: Any, is_included: Callable[[Field[Any], Any], bool]) -> Any:
    if is_dataclass(document) and not isinstance(document, type):
        members = ((field, getattr(document, field.name)) for field in fields(document))
        return {
            f.name: _builtins(value, is_included) for f, value in members if is_included(f, value)
        }
    if isinstance(document, (tuple, list)):
        return [_builtins(item, is_included) for item in document]
    if isinstance(document, Mapping):
        return {key: _builtins(value, is_included) for key, value in document.items()}
    return document.value if isinstance(document, Enum) else finite(document)


def finite(value: Any) -> Any:
    """Return the value; None for a float that is not finite."""
    return None if isinstance(value, float) and not isfinite(value) else value


def parsed(content: bytes, kind: type[Document]) -> Document:
    """Read JSON text as a document of a type; keys that the type does not have are left out.

    Raises ValueError with what was expected, what came, and the place in the document.
    """
    try:
        try:
            return msgspec.json.decode(content, type=kind)
        except msgspec.ValidationError as error:
            raise ValueError(_fault(error, json.loads(content, parse_int=_whole))) from error
    except RecursionError:
        raise ValueError("expected a JSON document, got brackets nested too deeply") from None
    except (msgspec.DecodeError, UnicodeDecodeError) as error:
        raise ValueError(f"expected a JSON document, got a fault: {error}") from error


def converted(value: Any, kind: type[Document]) -> Document:
    """Make a document of a type from dicts and lists. Raises ValueError as ``parsed`` does."""
    try:
        return msgspec.convert(value, kind)
    except msgspec.ValidationError as error:
        raise ValueError(_fault(error, value)) from error


def read(file: Path, kind: type[Document]) -> Document:
    """Read a file as a document of a type. Raises OSError, and ValueError that names the file."""
    try:
        return parsed(bounded_bytes(file, "a stored document", DOCUMENT), kind)
    except Refused:
        raise
    except ValueError as error:
        raise ValueError(f"{error} @ {file}") from error


def exact_document(file: Path) -> Any:
    """Return the JSON document in a file, its decimals as Decimal. Raises Refused."""
    content = read_bytes(file, "a JSON document", DOCUMENT)
    return loaded(content, file, parse_float=Decimal, parse_int=_whole)


def loaded(content: str | bytes, place: object, **parts: Any) -> Any:
    """Return a JSON document whose ``parts`` are made as json.loads takes them. Raises Refused."""
    try:
        return json.loads(content, **parts)
    except (ValueError, RecursionError) as error:
        reason = "brackets nested too deeply" if isinstance(error, RecursionError) else error
        raise refusal("a JSON document", f"a fault in it: {reason}", place) from None


def _whole(text: str) -> int | str:
    """Return a whole number, which Python makes of no more than 4300 digits."""
    return int(text) if len(text) <= _MOST_DIGITS else f"a number of {len(text)} digits"


def _fault(error: msgspec.ValidationError, document: Any) -> str:
    """Return the fault in the form of this project: expected ..., got ... @ place."""
    text = _OUT_OF_RANGE.sub("Expected a finite number", str(error))
    text = re.sub("Invalid enum value '.*?'", "Expected a word that is known here", text)
    match = _PLACE.search(text)
    expectation = (text[: match.start()] if match else text).partition(", got ")[0]
    place = match[1] if match else ""
    if missing := _MISSING.fullmatch(expectation):
        return f"expected a key {missing[1]}, got none @ {place or 'the document'}"
    expectation = _TYPE.sub(_in_words, expectation)
    where = f" @ {place}" if place else ""
    return f"{expectation[:1].lower()}{expectation[1:]}, got {_at(document, place)}{where}"


def _in_words(match: re.Match[str]) -> str:
    return " or ".join(_WORDS.get(word, word) for word in match[1].split(" | "))


def _at(document: Any, place: str) -> str:
    """Return the value at a place of a document; msgspec does not name the key of a dictionary."""
    for index, name in _STEP.findall(place):
        if name == "...":
            return "another value"
        if name and name not in document:
            return "none"
        document = document[int(index)] if index else document[name]
    if isinstance(document, (dict, list)):
        return "an object" if isinstance(document, dict) else "a list"
    return f"{document!r:.60}"
