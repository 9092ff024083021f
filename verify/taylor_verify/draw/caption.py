"""The caption of a picture, with the scene and the route of its numbers, and the refusal of a picture."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final

_WAYS: Final = {
    "arb": "exact, by closed form with proven bounds",
    "mpmath": "exact, by closed form",
    "taylor": "exact, by enclosed Taylor series",
}


class NotDrawn(ValueError):  # noqa: N818 (an answer, not a fault of the code)
    """Refusal of a picture that the scene cannot have; the text says what is missing."""


def caption(document: Mapping[str, Any]) -> str:
    """Return the scene and the exact route of its motion."""
    return f"{document['scene']}: {_WAYS[document['route']]}."
