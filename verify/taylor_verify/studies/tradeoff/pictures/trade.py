"""The pictures of a trade-off: error against time, evaluations and steps; digits asked for and got."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from taylor_verify.publish.pictures.picture import Picture, save
from taylor_verify.studies.tradeoff.pictures import (
    digits_achieved,
    error_against_time,
    error_against_work,
)


def draw(document: Mapping[str, Any], folder: Path | str) -> list[Path]:
    """Write the pictures of one scene's trade-off, as `TradeOff.document` gives it, to a folder.

    Raises ImportError without matplotlib, ValueError for a document without a sound point, OSError
    for a folder that cannot be written.
    """
    return save(pictures(document), folder)


def pictures(document: Mapping[str, Any]) -> list[Picture]:
    """Every picture with its alt text; one that would be empty is left out."""
    if not any(row["standing"] == "sound" for row in document["points"]):
        raise ValueError(f"expected a sound point, got none @ {document['scene']}.points")
    found = (
        error_against_time.picture(document),
        *(error_against_work.picture(document, work) for work in error_against_work.AXES),
        digits_achieved.picture(document),
    )
    return [one for one in found if one is not None]
