"""Portrait of a shipped scene: everything that its page shows, as one plain document.

    document["course"]["omega"]      the motion at dense times (by draw.drawn_course), for pictures
    document["values"]["rows"]       the motion at ten times, in 30 digits, for comparisons

Every number is that of the scene's own rational values, except in ``explain``, which describes a run on
f64. Nothing depends on the machine or the time of day: two portraits of one scene are equal.
"""

from __future__ import annotations

from fractions import Fraction
from typing import Any, Final

from taylor_verify.draw.drawn_course import DIGITS, motion, span
from taylor_verify.exact.printed import document, shortest_text
from taylor_verify.exact.route import solution
from taylor_verify.explain.explanation import explanation
from taylor_verify.records.quantities import MAIN, TRACKED
from taylor_verify.scenes.library import find
from taylor_verify.scenes.scene import Scene
from taylor_verify_reports.studies.portraits.latex_equations import equations

# The number of times at which the values are given.
TIMES: Final = 10
_RUNG: Final = "f64"

Document = dict[str, Any]


def portrait(scene: Scene) -> Document:
    """Return the document of one shipped scene. Raises Unsettled if a number does not reach its digits."""
    text = find(scene.name).read_text(encoding="utf-8")
    values = document(scene, solution(scene), _times(scene), DIGITS)
    explained, moved = explanation(scene, _RUNG), motion(scene)
    return {
        **moved,
        "source": scene.source or None,
        "why": _comment(text),
        "toml": text,
        "track": _tracked(scene),
        "regime": values["regime"],
        "warnings": list(scene.warnings),
        "tex": equations(scene),
        # The seconds of a run differ from run to run.
        "explain": {**explained, "cost": {**explained["cost"], "seconds": None}},
        "values": values,
        "sha256": scene.digest,
    }


def _comment(text: str) -> list[str]:
    """Return the comment lines of the file without their marks; they say why the scene exists."""
    return [line.lstrip("# ").rstrip() for line in text.splitlines() if line.startswith("#")]


def _tracked(scene: Scene) -> list[str]:
    return [MAIN[scene.model], *(name for name in TRACKED[scene.model] if name in scene.track)]


# The motion.


def _times(scene: Scene) -> list[tuple[str, Fraction]]:
    """Return equidistant times of the span, each after its text, which is an exact decimal."""
    spread = [scene.clock.start + span(scene) * k / TIMES for k in range(1, TIMES + 1)]
    texts = [shortest_text(t, DIGITS) for t in spread]
    return [(text, Fraction(text)) for text in texts]
