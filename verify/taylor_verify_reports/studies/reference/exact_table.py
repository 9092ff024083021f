"""Exact trajectory of a shipped scene as a plain document, for users without Python.

The motion is that of the scene's own rational values, not of values rounded to a rung.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction
from typing import Any, Final

import numpy as np

from taylor_verify.exact.printed import document, shortest_text
from taylor_verify.exact.route import solution
from taylor_verify.records.quantities import COLUMNS
from taylor_verify.scenes.library import find
from taylor_verify.scenes.scene import Scene

DIGITS: Final = 32


def reference(scene: Scene) -> dict[str, Any]:
    """Return the scene in exact text, and its motion at all its instants, column by column.

    A row is the motion at exactly the time printed in its column ``t``, even if the instant of the scene is
    no finite decimal. The column ``radius`` is the error bound of the row, as in the command `exact`; it
    includes the rounding of the digits. Raises Unsettled if the exact motion does not reach its digits.
    """
    texts = [shortest_text(instant, DIGITS) for instant in scene.clock.instants]
    times = [(text, Fraction(text)) for text in texts]
    printed = document(scene, solution(scene), times, DIGITS)
    own = {group.name: group.columns for group in scene.groups}
    return {
        "scene": scene.name,
        "title": scene.title,
        "source": scene.source,
        "model": scene.model,
        "sha256": scene.digest,
        "regime": printed["regime"],
        "route": printed["route"],
        "digits": DIGITS,
        "body": _exact_parts(scene.body.parts()),
        **_written(scene),
        "initial": _initial(scene),
        "columns": {
            **columns(printed["rows"], {**COLUMNS, **own}),
            "radius": [row["radius"] for row in printed["rows"]],
        },
    }


def columns(
    rows: Sequence[Mapping[str, Any]], names: Mapping[str, Sequence[str]]
) -> dict[str, list[str]]:
    """Return the columns of printed rows by name: the time, and each component, named by its quantity."""
    listed = {"t": [str(row["t"]) for row in rows]}
    for quantity in (quantity for quantity in names if quantity in rows[0]):
        entries = np.array([row[quantity] for row in rows]).reshape(len(rows), -1).T
        listed |= zip(names[quantity], entries.tolist(), strict=True)
    return listed


# The scene, in exact text.


def _written(scene: Scene) -> dict[str, str]:
    """Return the text of a scene that writes loads down; it has more than ``body`` can say."""
    return {"toml": find(scene.name).read_text(encoding="utf-8")} if scene.body.loads else {}


def _initial(scene: Scene) -> dict[str, Any]:
    """Return the state at the time ``t``, with attitude and centre if the scene tracks them."""
    state = scene.initial
    names = {*state.MOVING, *scene.track}
    parts = {name: value for name, value in state.parts().items() if name in names}
    return {"t": _exact(scene.clock.start), **_exact_parts(parts)}


def _exact_parts(parts: Mapping[str, Any]) -> dict[str, Any]:
    return {name: _exact(value) for name, value in parts.items()}


def _exact(value: Any) -> Any:
    """Return a rational, or nested lists of rationals, as exact text: a decimal of 32 digits, else a/b."""
    if not isinstance(value, Fraction):
        return [_exact(entry) for entry in value]
    text = shortest_text(value, DIGITS)
    return text if Fraction(text) == value else str(value)
