"""The caption of a picture: the scene, and how its numbers were had; and the refusal to draw one."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final

_WAYS: Final = {
    "arb": "exact, by closed form in balls",
    "mpmath": "exact, by closed form",
    "taylor": "exact, by enclosed Taylor series",
}


class NotDrawn(ValueError):  # noqa: N818 (an answer, not a fault of the code)
    """The scene has not what a picture shows; the text says what is missing."""


def caption(document: Mapping[str, Any]) -> str:
    """Return the scene and the exact route; nothing for a document of another maker."""
    way = _WAYS.get(document.get("route", ""))
    return f"{document['scene']}: {way}." if way and "evidence" in document else ""
