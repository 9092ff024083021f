"""The words of a trade-off's pictures: names of axes, and the sentences of an alt text."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import isfinite
from typing import Any

from taylor_verify.studies.tradeoff.pictures.series import AT_THE_BORDER, Row, Series


def error_name(document: Mapping[str, Any]) -> str:
    """The error's axis; where an attitude is tracked its angle counts too."""
    unit = "relative; attitude in rad" if "attitude" in document["track"] else "relative"
    return f"largest error ({unit})"


def floors_of(document: Mapping[str, Any]) -> dict[str, float]:
    """What perfect rounding would leave, by rung: the document's ``attainable``, where it has one."""
    floors = document.get("attainable") or {}
    return {rung: float(e) for rung, e in floors.items() if e and isfinite(e) and e > 0}


def label_of(row: Row) -> str:
    """A setting as `tradeoff` prints it."""
    return " ".join(word for word in (row["solver"], row["setting"], row["rung"]) if word)


def names(series: Sequence[Series]) -> str:
    found = [one.family for one in series]
    return found[0] if len(found) == 1 else f"{', '.join(found[:-1])} and {found[-1]}"


def fallen(series: Sequence[Series]) -> str:
    """How many are no answer, by what they are, with a space before; empty where all are sound."""
    standings = [row["standing"] for one in series for row in one.rows]
    counts = [(standings.count(name), name) for name in AT_THE_BORDER]
    said = [f"{count} {name}{_plural(count, name)}" for count, name in counts if count]
    return f" Marked at the border: {', '.join(said)}." if said else ""


def _plural(count: int, name: str) -> str:
    return "es" if count > 1 and name.endswith("success") else ""
