"""Pictures of a trade-off: error against time, and against evaluations of the equations."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from functools import partial
from math import isfinite
from pathlib import Path
from typing import Any, Final

from taylor_verify.plotting.picture import Picture, save
from taylor_verify.plotting.wording import plain, stem_of
from taylor_verify.records.standing import Standing
from taylor_verify.tradeoff.pictures.diagram import work_precision
from taylor_verify.tradeoff.pictures.series import (
    AT_THE_BORDER,
    Series,
    Spot,
    front_of,
    panels_of,
    series_of,
)

# Kinds of work: the key of a row, and the word in titles and names of files. Evaluations are the same on
# every machine.
WORKS: Final = {"seconds": "time", "evaluations": "evaluations"}
_NOTE: Final = "An evaluation of taylor is one order of a step's series."


def draw(document: Mapping[str, Any], folder: Path | str) -> list[Path]:
    """Write the pictures of one scene's trade-off, as `TradeOff.document` gives it, to a folder.

    Raises ImportError without matplotlib, ValueError for a document without a sound point, OSError
    for a folder that cannot be written.
    """
    return save(pictures(document), folder)


def pictures(document: Mapping[str, Any]) -> list[Picture]:
    """Return every picture that has points. Raises ValueError for a document without a sound point."""
    if not any(row["standing"] == "sound" for row in document["points"]):
        raise ValueError(f"expected a sound point, got none @ {document['scene']}.points")
    drawn = (_work_precision(document, key) for key in WORKS)
    return [picture for picture in drawn if picture is not None]


def _work_precision(document: Mapping[str, Any], key: str) -> Picture | None:
    """Return the picture of error against work; None if no sound setting has both numbers."""
    series = [line for line in series_of(document, key) if line.sound or line.border]
    front = front_of(series)
    if not front:
        return None
    is_time, work, scene = key == "seconds", WORKS[key], document["scene"]
    # A published time is a median of many, which the page explains.
    best = f", best of {document['timing']['repeats']}" if "timing" in document else ""
    axes = {"seconds": f"time of a solve{best} (s)", "evaluations": "evaluations of the equations"}
    unit = "relative; attitude in rad" if "attitude" in document["track"] else "relative"
    figure = partial(
        work_precision,
        panels_of(series),
        x_name=axes[key],
        y_name=f"largest error ({unit})",
        floors=floors_of(document),
        bars=is_time,
        note=_NOTE if key == "evaluations" else "",
    )
    alt = (
        f"Largest error against {'time of a solve' if is_time else work} on {scene}, both "
        f"logarithmic, for {_names(series)}. "
        f"{_ends(front, work)}{_at_the_border(series)}"
    )
    return Picture(stem_of(document, work), f"Error against {work}: {scene}", alt, figure)


def _names(series: Sequence[Series]) -> str:
    """Return the names of the families as a list in a sentence."""
    *others, last = (line.family for line in series)
    return f"{', '.join(others)} and {last}" if others else last


def floors_of(document: Mapping[str, Any]) -> dict[str, float]:
    """Return the attainable error of each rung that has one."""
    floors = document.get("attainable") or {}
    return {rung: float(e) for rung, e in floors.items() if e and isfinite(e) and e > 0}


def _ends(front: Sequence[Spot], work: str) -> str:
    """Return the two ends of the front in words: the cheapest and the most accurate setting."""
    first, best = front[0], front[-1]
    if work == "time":
        return (
            f"The fastest sound setting is {first.label} with an error of {plain(first.y)}, "
            f"the most accurate {best.label} with {plain(best.y)} in {best.x / first.x:.2g} times "
            f"its time; {len(front)} settings are beaten by none."
        )
    return (
        f"The fewest {work} of a sound setting are {first.x} ({first.label}, error "
        f"{plain(first.y)}); the smallest error is {plain(best.y)} with {best.x} ({best.label})."
    )


def _at_the_border(series: Sequence[Series]) -> str:
    """Return the number of settings at the border in words; empty if all are sound."""
    standings = Counter(spot.row["standing"] for line in series for spot in line.spots)
    plural = {Standing.FALSE: "false successes"}
    names = [
        f"{standings[name]} {plural.get(name, name) if standings[name] > 1 else name}"
        for name in AT_THE_BORDER
        if standings[name]
    ]
    return f" Marked at the border: {', '.join(names)}." if names else ""
