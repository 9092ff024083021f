"""The work-precision diagram: the error of every setting against the time of a solve."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from typing import Any

from taylor_verify.publish.pictures.picture import Picture
from taylor_verify.publish.pictures.wording import plain, stem_of
from taylor_verify.studies.tradeoff.pictures.diagram import Diagram, figure_of
from taylor_verify.studies.tradeoff.pictures.series import front_of, panels_of, series_of
from taylor_verify.studies.tradeoff.pictures.wording import (
    error_name,
    fallen,
    floors_of,
    label_of,
    names,
)


def picture(document: Mapping[str, Any]) -> Picture | None:
    """None where no sound setting was timed."""
    series = [one for one in series_of(document) if one.is_seen("seconds", "error")]
    front = front_of((row for one in series for row in one.rows), "seconds", "error")
    if not front:
        return None
    # A published time is a median of many, of which the page beside the picture tells.
    timing = document.get("timing")
    which = f", best of {timing['repeats']}" if timing else ""
    diagram = Diagram(
        x="seconds",
        y="error",
        x_name=f"time of a solve{which} (s)",
        y_name=error_name(document),
        floors=floors_of(document),
        bars=True,
    )
    best = front[-1]
    alt = (
        f"Largest error against time of a solve on {document['scene']}, both logarithmic, for "
        f"{names(series)}. The fastest sound setting is {label_of(front[0])} with an error of "
        f"{plain(front[0]['error'])}, the most accurate {label_of(best)} with "
        f"{plain(best['error'])} in {best['seconds'] / front[0]['seconds']:.2g} times its time; "
        f"{len(front)} settings are beaten by none.{fallen(series)}"
    )
    title = f"Error against time: {document['scene']}"
    return Picture(
        stem_of(document, "time"), title, alt, partial(figure_of, diagram, panels_of(series))
    )
