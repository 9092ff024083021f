"""A page on which a motion turns: one HTML file with its script and its numbers, and no network."""

from __future__ import annotations

import json
from collections.abc import Iterable
from html import escape
from pathlib import Path
from typing import Any, Final

import numpy as np

from taylor_verify.draw.mesh import Face
from taylor_verify.draw.moving import Inset, Moving
from taylor_verify.draw.polhode import facing
from taylor_verify.draw.view import Numbers

_TEMPLATE: Final = Path(__file__).with_name("assets") / "turning.html"
# Digits of a number on the page: no eye sees the next one.
_DIGITS: Final = 4


def page(motion: Moving) -> str:
    """Return the page of a motion: one HTML file, which plays and turns and needs no network."""
    text = json.dumps(document(motion), allow_nan=False, ensure_ascii=False, separators=(",", ":"))
    # The data stand in a script element, which no text of theirs may end.
    template = _TEMPLATE.read_text(encoding="utf-8").replace("TITLE", escape(motion.title), 1)
    return template.replace("DATA", text.replace("<", "\\u003c"), 1)


def document(motion: Moving) -> dict[str, Any]:
    """Return all that the script of the page reads."""
    return {
        "title": motion.title,
        "caption": f"{motion.caption} Drag to turn.".strip(),
        "alt": motion.alt,
        "name": motion.body.name + (", H upwards" if motion.arrow else ""),
        "times": _rounded(motion.times, 7),
        "quaternions": _rounded(quaternions(motion.attitudes), 5),
        "centres": None if motion.centres is None else _rounded(motion.centres, 5),
        "faces": [_face(face) for face in motion.body.faces],
        "arrow": motion.arrow,
        "middle": _rounded(motion.middle, 6),
        "reach": motion.reach,
        "inset": None if motion.inset is None else _inset(motion.inset),
        "rows": _rounded(motion.rows),
        "letter": motion.letter,
        "heading": motion.heading,
        "flips": _rounded(np.array(motion.flips), 7),
        "seconds": motion.seconds,
    }


def _face(face: Face) -> dict[str, Any]:
    line = {"p": _rounded(face.corners), "c": face.colour}
    return line if face.is_line else {**line, "n": _rounded(face.normal)}


def _inset(inset: Inset) -> dict[str, Any]:
    view = facing(inset.course, inset.semi_axes)
    return {
        "semi": _rounded(np.array(inset.semi_axes), 6),
        "course": _rounded(inset.course),
        "curves": [_rounded(curve) for curve in inset.curves],
        "letter": inset.letter,
        "name": inset.name,
        "view": {"azimuth": view.azimuth, "elevation": view.elevation},
        "sinks": inset.sinks,
    }


def quaternions(attitudes: Numbers) -> Numbers:
    """Return unit quaternions (n, 4), scalar first; the sign of each is that of its neighbour."""
    traces = np.einsum("nii->ni", attitudes)
    total = traces.sum(axis=1)
    # The largest of the four squares is at least a quarter: its root loses no digits.
    squares = np.stack([1 + total, *(1 + 2 * traces[:, i] - total for i in range(3))], axis=1)
    skew = np.stack(
        [
            attitudes[:, (i + 2) % 3, (i + 1) % 3] - attitudes[:, (i + 1) % 3, (i + 2) % 3]
            for i in range(3)
        ],
        axis=1,
    )
    products = attitudes + np.swapaxes(attitudes, 1, 2)
    rows = np.empty((len(attitudes), 4))
    for k, largest in enumerate(squares.argmax(axis=1)):
        if largest == 0:
            rows[k] = [squares[k, 0], *skew[k]]
        else:
            i = largest - 1
            rows[k] = [skew[k, i], *products[k, i]]
            rows[k, 1 + i] = squares[k, largest]
    rows /= np.linalg.norm(rows, axis=1, keepdims=True)
    signs = np.where((rows[1:] * rows[:-1]).sum(axis=1) < 0, -1.0, 1.0)
    rows[1:] *= np.cumprod(signs)[:, None]
    return rows


def _rounded(values: Numbers | Iterable[float], digits: int = _DIGITS) -> Any:
    """Return numbers for JSON, rounded to this many digits of the largest."""
    numbers = np.asarray(values, dtype=float)
    if not numbers.size:
        return []
    largest = float(np.abs(numbers).max())
    decimals = digits - int(np.floor(np.log10(largest))) - 1 if largest > 0 else 0
    return np.round(numbers, decimals).tolist()
