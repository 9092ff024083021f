"""The pictures that stand beside the tables: drawn when something is measured, shown where they are.

A page shows the pictures that lie in ``figures`` already; without matplotlib none are drawn, and the
pages that are made of stored data are the same but for them.
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
    """Return the pictures that are there, as a page in ``place``/tables shows them."""
    return "\n\n".join(
        f"![{prose(one.alt)}](../{FOLDER}/{one.stem}.svg)"
        for one in pictures
        if (place / FOLDER / f"{one.stem}.svg").exists()
    )
