"""Loads whose limits, each a clip of a text, are others: none, or one limit for a whole vector."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Final

from taylor_verify.judge.causes.changed_texts import rewritten
from taylor_verify.judge.causes.texts import places
from taylor_verify.scenes.loads.loads import Loads
from taylor_verify.scenes.loads.vocabulary import Entry

_CLIP: Final = "clip("


def other_limits(loads: Loads) -> Iterator[tuple[str, Loads]]:
    """Yield loads with other limits, with what is other in words."""
    free = rewritten(loads, _without_limits)
    if free != loads:
        yield "no limits: each clip gives what stands first in it", free
        by_length = _by_length(loads)
        if by_length != loads:
            yield "the length of the vector is limited, where the scene limits each axis", by_length


def _without_limits(text: str) -> str:
    """Return a text with the first argument of each clip in its place."""
    while (at := text.find(_CLIP)) >= 0:
        (first, *_), end = arguments(text, at)
        text = f"{text[:at]}({first}){text[end:]}"
    return text


def _by_length(loads: Loads) -> Loads:
    """Return the loads with one limit of the length for each vector of three limited texts."""
    by_vector: dict[tuple[object, ...], list[tuple[str, ...]]] = {}
    for place in places(loads):
        limited = _limited(place.entry)
        if limited is not None:
            by_vector.setdefault(place.path[:-1], []).append((*limited, place.key))
    for vector in by_vector.values():
        texts, limits, keys = zip(*vector, strict=True)
        if len(texts) == 3 and len({*limits}) == 1:
            loads = _with_length(loads, texts, limits[0], keys)
    return loads


def _with_length(loads: Loads, texts: Sequence[str], limit: str, keys: Sequence[str]) -> Loads:
    length = f"max(norm({', '.join(texts)}), {limit})"
    for text, key in zip(texts, keys, strict=True):
        place = next(each for each in places(loads) if each.key == key)
        loads = place.put(f"({text})*({limit})/{length}")
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
