"""Loads whose limits, each a clip of a text, are others: none, or one limit for a whole vector."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import replace
from typing import Final

from taylor_verify.judge.causes.changed_texts import rewritten
from taylor_verify.judge.causes.texts import Place, places
from taylor_verify.scenes.loads.loads import Loads
from taylor_verify.scenes.loads.vocabulary import Entry

_CLIP: Final = "clip("
_CALL: Final = re.compile(r"\b(abs|clip|max|min)\(")


def other_limits(loads: Loads) -> Iterator[tuple[str, Loads]]:
    """Yield loads with other limits, with what is other in words."""
    free = rewritten(loads, _without_limits)
    if free != loads:
        yield "no limits: each clip gives what stands first in it", free
        by_length = _by_length(loads)
        if by_length != loads:
            yield "the length of the vector is limited, where the scene limits each axis", by_length


def bounds(loads: Loads | None) -> list[tuple[str, str]]:
    """Return the lower and the upper end of each clip in the texts."""
    texts = () if loads is None else (str(place.entry) for place in places(loads))
    every = (call for text in texts for call in calls(text))
    return [(inside[1], inside[2]) for name, inside in every if name == "clip"]


def _without_limits(text: str) -> str:
    """Return a text with the first argument of each clip in its place."""
    while (at := text.find(_CLIP)) >= 0:
        (first, *_), end = arguments(text, at)
        text = f"{text[:at]}({first}){text[end:]}"
    return text


def _by_length(loads: Loads) -> Loads:
    """Return the loads with one limit of the length for each vector of three limited texts."""
    by_vector: dict[tuple[object, ...], list[tuple[Place, str, str]]] = {}
    for place in places(loads):
        if limited := _limited(place.entry):
            by_vector.setdefault(place.path[:-1], []).append((place, *limited))
    for vector in by_vector.values():
        limits = {limit for _, _, limit in vector}
        if len(vector) == 3 and len(limits) == 1:
            (limit,) = limits
            length = f"max(norm({', '.join(text for _, text, _ in vector)}), {limit})"
            for place, text, _ in vector:
                loads = replace(place, loads=loads).put(f"({text})*({limit})/{length}")
    return loads


def _limited(entry: Entry) -> tuple[str, str] | None:
    """Return what an entry limits, and the limit, if it is a clip from minus the limit to the limit."""
    text = str(entry).strip()
    if not text.startswith(_CLIP):
        return None
    parts, end = arguments(text, 0)
    if end < len(text) or len(parts) != 3:
        return None
    inside, low, high = (each.strip() for each in parts)
    return (inside, high) if low.replace(" ", "") == f"-{high.replace(' ', '')}" else None


def calls(text: str) -> Iterator[tuple[str, list[str]]]:
    """Yield the calls with a kink in a text: the name of the function and its arguments."""
    for call in _CALL.finditer(text):
        yield call.group(1), arguments(text, call.start())[0]


def arguments(text: str, at: int) -> tuple[list[str], int]:
    """Return the arguments of the call that begins at a place of a text, and the place behind it."""
    begin = text.index("(", at) + 1
    depth, parts = 0, list[str]()
    for k in range(begin - 1, len(text)):
        depth += (text[k] == "(") - (text[k] == ")")
        if (text[k] == "," and depth == 1) or not depth:
            parts.append(text[begin:k])
            begin = k + 1
        if not depth:
            break
    return parts, begin
