"""Pictures beside the tables: drawn after a measurement, shown if their files exist.

A page shows the pictures of ``figures`` that exist. Without matplotlib no pictures are drawn; the pages
are otherwise the same.
"""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Final

from taylor_verify.publish.markdown import prose
from taylor_verify.publish.pictures.picture import Picture, save

FOLDER: Final = "figures"


def draw(place: Path, pictures: Iterable[Picture]) -> list[Path]:
    """Write pictures to ``place``/figures. Raises ImportError without matplotlib, and OSError."""
    drawn = [*pictures]
    return save(drawn, place / FOLDER) if drawn else []


def shown(place: Path, pictures: Iterable[Picture]) -> str:
    """Return Markdown that shows the existing pictures on a page in ``place``/tables."""
    return "\n\n".join(
        f"![{prose(one.alt)}](../{FOLDER}/{one.stem}.svg)"
        for one in pictures
        if (place / FOLDER / f"{one.stem}.svg").exists()
    )
