"""The width of an enclosure beside its true error: the stored numbers, and the picture of them."""

from __future__ import annotations

from pathlib import Path
from typing import Final

from taylor_verify.records import store
from taylor_verify.records.json_text import complete, read
from taylor_verify.records.replacement import replace_files
from taylor_verify.studies import figures
from taylor_verify.studies.enclosure import picture as widths
from taylor_verify.studies.enclosure.document import EnclosureStudy

STORED: Final = f"{store.FOLDER}/enclosure.json"

_MADE_BY: Final = {"made_by": "taylor-verify publish --enclosure; do not edit"}


def write(folder: Path, study: EnclosureStudy) -> list[Path]:
    """Store the numbers below ``folder`` and draw them.

    Raises ImportError without matplotlib, and OSError.
    """
    drawn = figures.draw(folder, [widths.picture(study)])
    text = store.laid_out({**_MADE_BY, **complete(study)})
    return [*replace_files(folder, {STORED: text}), *drawn]


def load(folder: Path) -> EnclosureStudy:
    """Return the numbers stored below ``folder``. Raises OSError and ValueError."""
    return read(folder / STORED, EnclosureStudy)
