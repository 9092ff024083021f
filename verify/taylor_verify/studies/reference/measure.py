"""The exact trajectory of a shipped scene as a plain document, for those who have no Python.

The numbers are those of the scene's own rational values, not of values rounded to a rung.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction
from typing import Any, Final

from taylor_verify.batch.documents import documents
from taylor_verify.exact.printed import decimal_text, document
from taylor_verify.exact.route import solution
from taylor_verify.records.quantities import COLUMNS
from taylor_verify.scenes.manufactured import Manufactured
from taylor_verify.scenes.reading.reader import load
from taylor_verify.scenes.scene import Scene

DIGITS: Final = 32


def reference(scene: Scene) -> dict[str, Any]:
    """What the scene is, in exact text, and its motion at all its instants, column by column.

    A row is the motion at exactly the time printed in its column ``t``, also where the instant
    itself has no finite decimal. ``radius`` is that of `exact`, the rounding of the digits included.
    Raises Unsettled where the exact solution does not settle.
    """
    texts = [_instant(instant) for instant in scene.clock.instants]
    times = [(text, Fraction(text)) for text in texts]
    printed = document(scene, solution(scene), times, DIGITS)
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
        **_manufactured(scene.body.manufactured),
        "initial": _initial(scene),
        "columns": _columns(printed["rows"]),
    }


def references(names: Sequence[str], finished: Callable[[str], None]) -> list[dict[str, Any]]:
    """The documents of many scenes on all cores, in the order given.

    ``finished`` is told the name of each scene as it ends. Raises Failed for one that came to
    nothing.
    """
    return documents(reference, names, _expense, finished)


def _expense(name: str) -> tuple[int, int]:
    """The longest first, so that no core is left with one at the end: what is tracked tells."""
    scene = load(name)
    return -len(scene.track), -len(scene.initial.moving)


def _columns(rows: Sequence[dict[str, Any]]) -> dict[str, list[str]]:
    tracked = [quantity for quantity in COLUMNS if quantity in rows[0]]
    columns = {"t": [row["t"] for row in rows]}
    for quantity in tracked:
        entries = zip(*(_entries(row[quantity]) for row in rows), strict=True)
        for name, column in zip(COLUMNS[quantity], entries, strict=True):
            columns[name] = list(column)
    return columns | {"radius": [row["radius"] for row in rows]}


def _entries(value: Sequence[Any]) -> list[str]:
    """A vector as it is, a matrix row by row."""
    return [
        entry for part in value for entry in ([part] if isinstance(part, str) else _entries(part))
    ]


# The question, in exact text.


def _manufactured(motion: Manufactured | None) -> dict[str, Any]:
    """The motion of omega, or of x and y as one vector, with the time since the start; if there is one."""
    if motion is None:
        return {}
    waves = [{name: _exact(value) for name, value in vars(wave).items()} for wave in motion.waves]
    return {"manufactured": {"constant": _exact(motion.constant), "waves": waves}}


def _initial(scene: Scene) -> dict[str, Any]:
    """The state at the time ``t``; of attitude and centre, what the scene tracks."""
    state = scene.initial
    asked = {*state.MOVING, *scene.track}
    parts = {name: value for name, value in state.parts().items() if name in asked}
    return {"t": _exact(scene.clock.start), **_exact_parts(parts)}


def _exact_parts(parts: Mapping[str, Any]) -> dict[str, Any]:
    return {name: _exact(value) for name, value in parts.items()}


def _exact(value: Any) -> Any:
    """Rationals as text that loses nothing: a decimal where 32 digits suffice, else a/b."""
    if not isinstance(value, Fraction):
        return [_exact(entry) for entry in value]
    text = _instant(value)
    return text if Fraction(text) == value else str(value)


def _instant(value: Fraction) -> str:
    """The number to 32 digits without its last zeros."""
    mantissa, e, exponent = decimal_text(value, DIGITS).partition("e")
    if "." in mantissa:
        mantissa = mantissa.rstrip("0").rstrip(".")
    return f"{mantissa}{e}{exponent}"
