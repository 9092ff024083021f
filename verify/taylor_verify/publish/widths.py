"""The width of an enclosure beside its true error: the stored numbers, and the picture of them."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final

from taylor_verify.publish import data, figures
from taylor_verify.publish.pictures import widths
from taylor_verify.publish.replacement import replace_files

STORED: Final = f"{data.FOLDER}/enclosure.json"

_MADE_BY: Final = {"made_by": "taylor-verify publish --enclosure; do not edit"}


def write(folder: Path, document: Mapping[str, Any]) -> list[Path]:
    """Store the numbers below ``folder`` and draw them.

    Raises ImportError without matplotlib, and OSError.
    """
    drawn = figures.draw(folder, [widths.picture(document)])
    return [*replace_files(folder, {STORED: data.laid_out({**_MADE_BY, **document})}), *drawn]
