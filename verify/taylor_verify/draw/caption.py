"""Pictures of one motion by name and caption, and the refusal of a picture."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from typing import TYPE_CHECKING, Any, Final

from taylor_verify.plotting.picture import Picture
from taylor_verify.plotting.wording import stem_of

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Document = Mapping[str, Any]

OMEGA: Final = "\N{GREEK SMALL LETTER OMEGA}"
SUBSCRIPTS: Final = "\N{SUBSCRIPT ONE}\N{SUBSCRIPT TWO}\N{SUBSCRIPT THREE}"
WAYS: Final = {
    "arb": "exact, by closed form with proven bounds",
    "mpmath": "exact, by closed form",
    "taylor": "exact, by enclosed Taylor series",
}


class NotDrawn(ValueError):  # noqa: N818 (an answer, not a fault of the code)
    """Refusal of a picture that the scene cannot have; the text says what is missing."""


def caption(document: Document) -> str:
    """Return the scene and the exact route of its motion."""
    return f"{document['scene']}: {WAYS[document['route']]}."


def captioned(
    document: Document, kind: str, title: str, alt: str, draw: Callable[[str], Figure]
) -> Picture:
    """Return a picture of the motion ``document``; ``draw`` makes the figure with its caption.

    ``kind`` is the end of the file's name, and ``title`` stands before the name of the scene.
    """
    heading = f"{title}: {document['scene']}"
    return Picture(stem_of(document, kind), heading, alt, partial(draw, caption(document)))
