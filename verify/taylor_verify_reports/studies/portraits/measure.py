"""Portrait of a shipped scene: everything that its page shows, as one plain document.

    document["course"]["omega"]      the motion at dense times (draw.course.motion), for pictures
    document["values"]["rows"]       the motion at ten times, in 30 digits, for comparisons
    document["potential"]            the quartic X3 of Clebsch's body, x3'^2 = r^2 X3(x3)

Every number is that of the scene's own rational values, except in ``explain``, which describes a run on
f64. Nothing depends on the machine or the time of day: two portraits of one scene are equal.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction
from math import lcm
from typing import Any, Final

from flint import acb, ctx, fmpz_poly
from mpmath import mp

from taylor_verify.draw.course import DIGITS, FIGURES, motion, plain, span
from taylor_verify.exact.kirchhoff.closed import revolution
from taylor_verify.exact.kirchhoff.quartic import Nutation
from taylor_verify.exact.kirchhoff.reduced import Reduced
from taylor_verify.exact.printed import document, shortest_text
from taylor_verify.exact.route import solution
from taylor_verify.explain.explanation import explanation
from taylor_verify.records.quantities import MAIN, TRACKED
from taylor_verify.scenes.bodies import ImmersedBody
from taylor_verify.scenes.library import find
from taylor_verify.scenes.scene import Scene
from taylor_verify_reports.studies.portraits.equations import equations

# The number of times at which the values are given.
TIMES: Final = 10
_RUNG: Final = "f64"
_ROOT_BITS: Final = 160

Document = dict[str, Any]


def portrait(scene: Scene) -> Document:
    """Return the document of one shipped scene. Raises Unsettled if a number does not reach its digits."""
    text = find(scene.name).read_text(encoding="utf-8")
    values = document(scene, solution(scene), _times(scene), DIGITS)
    explained, moved = explanation(scene, _RUNG), motion(scene)
    orbit = {row["name"]: row["value"] for row in moved["analytic"]}
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
        "potential": _potential(scene, orbit),
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


# The potential.


def _potential(scene: Scene, orbit: Mapping[str, str]) -> Document | None:
    """Return X3 of Hydromechanics 49 with its roots, and the interval of the axial impulse.

    The result is None unless the body is free, symmetric about one of its axes, and has a linear impulse,
    without which x3 is constant. ``variable`` names the component along the axis: x1, x2 or x3.
    """
    body = scene.body
    if not isinstance(body, ImmersedBody) or not body.is_free:
        return None
    closed = revolution(Reduced(scene))
    if closed is None or not isinstance(closed.subject, Nutation):
        return None
    nutation = closed.subject
    X3 = [coefficient / nutation.body.r**2 for coefficient in nutation.f]  # noqa: N806 (as in 49)
    if nutation.F2 == 0 or len(X3) < 2 or nutation.axes.number is None:
        return None
    variable = f"x{nutation.axes.number}"
    ends = [orbit[name] for name in (f"{variable}_low", f"{variable}_high") if name in orbit]
    with mp.workdps(DIGITS):
        interval = [mp.mpf(end) for end in ends] or [mp.convert(nutation.z)] * 2
        return {
            "variable": variable,
            "coefficients": plain([mp.convert(coefficient) for coefficient in X3]),
            "roots": roots(X3),
            "interval": plain(interval),
        }


def roots(polynomial: Sequence[Fraction]) -> list[list[float]]:
    """Return [real, imaginary] of every root with its multiplicity: real roots first, in rising order.

    The polynomial has its highest power first. Its roots are isolated from exact integers, so that
    multiplicities are exact, and a real root has no imaginary part.
    """
    scale = lcm(*(coefficient.denominator for coefficient in polynomial))
    integers = [int(coefficient * scale) for coefficient in reversed(polynomial)]
    with ctx.workprec(_ROOT_BITS):
        # flint's type stubs leave out the multiplicities.
        isolated: list[Any] = list(fmpz_poly(integers).complex_roots())
        parts = [_parts(acb(root)) for root, multiplicity in isolated for _ in range(multiplicity)]
    return sorted(parts, key=lambda root: (root[1] != 0, root))


def _parts(root: acb) -> list[float]:
    """Return the rounded real and imaginary part; adding 0.0 makes 0.0 of -0.0."""
    return [float(f"{float(part.mid()):.{FIGURES}g}") + 0.0 for part in (root.real, root.imag)]
