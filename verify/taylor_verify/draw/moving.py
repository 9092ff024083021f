"""A motion to be animated: the body in space, a curve in the body, and components against time.

Space is turned so that weight points downwards, or else a constant H upwards. The course is the exact one
of the other pictures: between two rows the body turns by a tenth of a radian, or by more if it turns often.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from html import escape
from pathlib import Path
from typing import Any, Final

import numpy as np

from taylor_verify.draw import components, mesh, polhode, spheres
from taylor_verify.draw.axis_path import fixed_direction, momentum_of, upright
from taylor_verify.draw.caption import Document, NotDrawn, caption
from taylor_verify.draw.drawn_course import turns
from taylor_verify.draw.mesh import Face, Mesh
from taylor_verify.draw.surface import Surface
from taylor_verify.draw.view import Numbers
from taylor_verify.exact.row_arithmetic import quaternions

# Seconds for a turn, so that the eye can follow.
_TURN: Final = 2.4
# Limits of the whole animation, in seconds.
_SHORTEST, _LONGEST = 6.0, 40.0
# The least length of a body without a shape, in parts of its path.
_LEAST: Final = 0.06
# The length of the largest weight, in parts of the body's reach.
_ARROW: Final = 0.6
_MOMENTUM_UP: Final = ", H upwards"
# An attitude that changes by less than this is constant.
_STILL: Final = 1e-6
# Digits of a number on the page: no eye sees the next one.
_DIGITS: Final = 4
_TEMPLATE: Final = Path(__file__).with_name("assets") / "turning.html"


def moving(document: Document) -> dict[str, Any]:
    """Return all that the script of a moving page reads; ``document`` is that of draw.drawn_course.motion.

    Attitudes are quaternions, scalar first. Raises NotDrawn for a body that does not move.
    """
    course = document["course"]
    attitudes = np.array(course["attitude"]).reshape(-1, 3, 3)
    centres = np.array(course.get("centre", [[0.0] * 3]))
    if not max(np.ptp(attitudes, axis=0).max() - _STILL, np.ptp(centres, axis=0).max()) > 0:
        raise NotDrawn(f"expected a motion to animate, got a body at rest @ {document['scene']}")
    up, words = _up(document, attitudes)
    attitudes, centres = up @ attitudes, centres @ up.T
    parts = components.series(document)
    times = course["t"]
    body = _body(document, centres)
    middle = (centres.min(axis=0) + centres.max(axis=0)) / 2
    away = float(np.linalg.norm(centres - middle, axis=1).max())
    return {
        "title": document["title"],
        "caption": f"{caption(document)} Drag to turn.",
        "alt": f"{document['scene']} from t = {times[0]:g} to t = {times[-1]:g}, moving: {body.name}.",
        "name": f"{body.name}{words}",
        "times": _rounded(times, 7),
        "quaternions": _rounded(quaternions(attitudes), 5),
        "centres": _rounded(centres, 5) if "centre" in course else None,
        "faces": [_face(face) for face in body.faces],
        "arrow": words == _MOMENTUM_UP,
        "hung": list(_hung(document, up, body.reach)),
        "middle": _rounded(middle, 6),
        # The largest distance of anything from the middle, at any time.
        "reach": away + body.reach if "centre" in course else max(body.reach, 1.0),
        "inset": _inset(document),
        "panels": [_panel(panel) for panel in _shown(document, parts)],
        "flips": _rounded(parts.flips, 7),
        # So long that the eye can follow each turn.
        "seconds": min(max(_TURN * turns(attitudes), _SHORTEST), _LONGEST),
    }


def _up(document: Document, attitudes: Numbers) -> tuple[Numbers, str]:
    """Return the rotation of space that makes weight point down, or else H up, and its words."""
    for force, _ in document["hung"][:1]:
        return upright(-np.array(force)), ", weight downwards"
    if document["body"] is None:
        return np.eye(3), ""
    momentum, _ = momentum_of(document)
    up = fixed_direction(np.einsum("nij,nj->ni", attitudes, momentum))
    return (np.eye(3), "") if up is None else (upright(up), _MOMENTUM_UP)


def _hung(document: Document, up: Numbers, reach: float) -> Iterator[dict[str, Any]]:
    """Yield weight and buoyancy: the point of the body, and an arrow in space of its size."""
    largest = max((float(np.linalg.norm(force)) for force, _ in document["hung"]), default=1.0)
    for force, at in document["hung"]:
        arrow = _ARROW * reach / largest * (up @ np.array(force))
        place = _at_tip(at) if document["body"] is not None else np.array(at)
        yield {"at": _rounded(place), "arrow": _rounded(arrow)}


def _at_tip(at: Sequence[float]) -> Numbers:
    """Return the middle of the lid of a top, which shows the direction of the centre of mass alone."""
    return np.array(at) / (float(np.linalg.norm(at)) or 1.0) * mesh.LID


def _body(document: Document, centres: Numbers) -> Mesh:
    body, shape = document["body"], document["semi_axes"]
    if body is not None:
        places = [np.array(at) for _, at in document["hung"] if any(at)]
        if places:
            return mesh.top(places[0])
        return mesh.rigid(np.array(body["principal_moments"]), np.array(body["axes"]))
    if shape is not None:
        return mesh.ellipsoid(shape)
    least = _LEAST * float(np.ptp(centres, axis=0).max())
    return mesh.block(np.array(document["mass_matrix"]), least)


def _shown(document: Document, parts: components.Series) -> Iterator[components.Panel]:
    """Yield the first panel of the motion, and those of loads and own states that are not all zero."""
    acting = parts.panels[len(parts.panels) - len(document["acting"]) :]
    yield parts.panels[0]
    yield from (panel for panel in acting if panel.rows.any())


def _panel(panel: components.Panel) -> dict[str, Any]:
    rows = {"rows": _rounded(panel.rows), "isHeld": panel.is_held}
    return {**rows, "letter": panel.letter, "heading": panel.name}


def _face(face: Face) -> dict[str, Any]:
    line = {"p": _rounded(face.corners), "c": face.colour}
    return line if face.is_line else {**line, "n": _rounded(face.normal)}


def _inset(document: Document) -> dict[str, Any] | None:
    """Return the curve in the body: the polhode, or the direction of H or of the linear impulse."""
    for surface_of in (polhode.surface, spheres.surface):
        with suppress(NotDrawn):
            return _on_surface(surface_of(document))
    return None


def _on_surface(drawn: Surface) -> dict[str, Any]:
    borders = [curve for curve in drawn.curves if curve.look["gid"] == "separatrix"]
    return {
        "semi": _rounded(drawn.semi_axes, 6),
        "course": _rounded(drawn.course),
        "curves": [_rounded(curve.points) for curve in borders],
        "letter": drawn.letter,
        "name": drawn.name,
        "view": {"azimuth": drawn.side.azimuth, "elevation": drawn.side.elevation},
        "sinks": drawn.sinks,
    }


def _rounded(values: Numbers | Iterable[float], digits: int = _DIGITS) -> Any:
    """Return numbers for JSON, rounded to this many digits of the largest."""
    numbers = np.asarray(values, dtype=float)
    if not numbers.size:
        return []
    largest = float(np.abs(numbers).max())
    decimals = digits - int(np.floor(np.log10(largest))) - 1 if largest > 0 else 0
    return np.round(numbers, decimals).tolist()


def page(motion: Mapping[str, Any]) -> str:
    """Return the page on which a motion turns, one HTML file without network; ``motion`` is of `moving`."""
    text = json.dumps(motion, allow_nan=False, ensure_ascii=False, separators=(",", ":"))
    # The data stand in a script element, which no text of theirs may end.
    template = _TEMPLATE.read_text(encoding="utf-8").replace("TITLE", escape(motion["title"]), 1)
    return template.replace("DATA", text.replace("<", "\\u003c"), 1)
