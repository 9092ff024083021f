"""Pictures of the pages: drawn after a measurement into the folder ``figures`` of the report.

A page shows those of its pictures whose files exist. Without matplotlib nothing is drawn, and the pages
are the same except for new pictures.
"""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Final

from taylor_verify.plotting.picture import Picture, save
from taylor_verify.words.markdown import prose

FOLDER: Final = "figures"


def draw(place: Path, pictures: Iterable[Picture]) -> list[Path]:
    """Write pictures to ``place``/figures and return their files.

    Raises ImportError without matplotlib, and OSError for a folder that cannot be written.
    """
    drawn = [*pictures]
    return save(drawn, place / FOLDER) if drawn else []


def shown(place: Path, pictures: Iterable[Picture]) -> str:
    """Return Markdown for a page in ``place``/tables that shows those pictures whose files exist."""
    return "\n\n".join(
        f"![{prose(picture.alt)}](../{FOLDER}/{picture.stem}.svg)"
        for picture in pictures
        if (place / FOLDER / f"{picture.stem}.svg").exists()
    )
