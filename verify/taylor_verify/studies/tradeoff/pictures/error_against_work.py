"""The error of every setting against what it computed: evaluations of the equations, or steps.

These counts are the same on every machine. What an evaluation is, a solver says itself: for taylor
it is one order of the series of one step, for the others one call of the equations.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from typing import Any, Final

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

AXES: Final = {
    "evaluations": "evaluations of the equations",
    "steps": "steps",
}
_NOTE: Final = "An evaluation of taylor is one order of a step's series."


def picture(document: Mapping[str, Any], work: str) -> Picture | None:
    """Against ``work``, one of `AXES`; None where no sound setting counted it."""
    series = [one for one in series_of(document) if one.is_seen(work, "error")]
    front = front_of((row for one in series for row in one.rows), work, "error")
    if not front:
        return None
    diagram = Diagram(
        x=work,
        y="error",
        x_name=AXES[work],
        y_name=error_name(document),
        floors=floors_of(document),
        note=_NOTE if work == "evaluations" else "",
    )
    alt = (
        f"Largest error against {work} on {document['scene']}, both logarithmic, for "
        f"{names(series)}. The fewest {work} of a sound setting are {front[0][work]} "
        f"({label_of(front[0])}, error {plain(front[0]['error'])}); the smallest error is "
        f"{plain(front[-1]['error'])} with {front[-1][work]} ({label_of(front[-1])})."
        f"{fallen(series)}"
    )
    title = f"Error against {work}: {document['scene']}"
    return Picture(
        stem_of(document, work), title, alt, partial(figure_of, diagram, panels_of(series))
    )
