"""The portrait of a shipped scene: all that a page shows of it, as one plain document.

    document["course"]["omega"]      the motion at dense times, in plain floats, to be drawn
    document["values"]["rows"]       the motion at ten times, in 30 digits, to be compared with
    document["potential"]            the quartic X3 of Clebsch's body, x3'^2 = r^2 X3(x3)

All but ``explain``, a run on f64, belongs to the scene's own rational numbers. Nothing here depends on
the machine or the hour: two portraits of one scene are the same.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from math import lcm
from typing import Any, Final

from flint import acb, ctx, fmpz_poly
from mpmath import mp, mpf

from taylor_verify.exact.elements import Elements, elements
from taylor_verify.exact.ellipsoid import formed_to
from taylor_verify.exact.kirchhoff.closed import revolution
from taylor_verify.exact.kirchhoff.quartic import Nutation
from taylor_verify.exact.kirchhoff.reduced import Reduced
from taylor_verify.exact.printed import document, shortest_text
from taylor_verify.exact.route import solution
from taylor_verify.exact.solution import Solution, Unsettled
from taylor_verify.explain.explanation import explanation
from taylor_verify.records.quantities import MAIN, TRACKED
from taylor_verify.scenes import tensors
from taylor_verify.scenes.bodies import ImmersedBody
from taylor_verify.scenes.library import find
from taylor_verify.scenes.scene import Scene
from taylor_verify.scenes.tensors import Matrix
from taylor_verify.studies.portraits.equations import equations

DIGITS: Final = 30
# Times at which the values are given: these parts of the span.
TIMES: Final = 10
# Intervals of the dense course; over more periods than these a curve covers itself.
INTERVALS: Final = 360
PERIODS: Final = 3
# Of a number in the course; the motion behind it is known to one digit more, and what is smaller
# beside its vector than that is a zero which was not found to be one.
FIGURES: Final = 9
_RUNG: Final = "f64"
_ROOT_BITS: Final = 160

Document = dict[str, Any]


def portrait(scene: Scene) -> Document:
    """Return the whole document of one shipped scene. Raises Unsettled where a number does not settle."""
    text = find(scene.name).read_text(encoding="utf-8")
    formed = formed_to(scene, DIGITS)
    exact, orbit = solution(formed), _orbit(scene)
    values = document(formed, exact, _times(scene), DIGITS)
    explained = explanation(scene, _RUNG)
    return {
        "scene": scene.name,
        "title": scene.title,
        "model": scene.model,
        "source": scene.source or None,
        "why": _comment(text),
        "toml": text,
        "track": _tracked(scene),
        "regime": values["regime"],
        "route": values["route"],
        "warnings": list(scene.warnings),
        "tex": equations(scene),
        "analytic": _analytic(orbit),
        # A run takes another time each time.
        "explain": {**explained, "cost": {**explained["cost"], "seconds": None}},
        "values": values,
        "course": _course(scene, exact, _length(scene, orbit)),
        "body": _ellipsoid_of_inertia(scene),
        "potential": _potential(scene, orbit),
        "sha256": scene.digest,
    }


def _comment(text: str) -> list[str]:
    """Return the comments of the file without their marks: they say why the scene exists."""
    return [line.lstrip("# ").rstrip() for line in text.splitlines() if line.startswith("#")]


def _tracked(scene: Scene) -> list[str]:
    return [MAIN[scene.model], *(name for name in TRACKED[scene.model] if name in scene.track)]


# The numbers of the orbit.


def _orbit(scene: Scene) -> Elements:
    """Return the orbit's own numbers; none where the digits cannot be had."""
    try:
        return elements(scene, DIGITS)
    except Unsettled as doubt:
        return Elements("", (), (str(doubt),))


def _analytic(orbit: Elements) -> list[Document]:
    names = ("name", "value", "meaning", "unit", "source")
    with mp.workdps(DIGITS):
        texts = [str(mp.nstr(element.value, DIGITS)) for element in orbit.numbers]
    return [
        {name: getattr(element, name) for name in names} | {"value": text}
        for element, text in zip(orbit.numbers, texts, strict=True)
    ]


# The motion.


def _span(scene: Scene) -> Fraction:
    """Return the time from the start to the farthest instant; below zero where time runs backward."""
    start = scene.clock.start
    return max((instant - start for instant in scene.clock.instants), key=abs)


def _length(scene: Scene, orbit: Elements) -> Fraction:
    """Return the span, or a few periods if it is longer."""
    span = _span(scene)
    if "period" not in orbit:
        return span
    few = PERIODS * Fraction(mp.nstr(orbit["period"].value, FIGURES))
    return span if abs(span) <= few else (few if span > 0 else -few)


def _times(scene: Scene) -> list[tuple[str, Fraction]]:
    """Return parts of the span with their texts, which are decimals and exact."""
    spread = [scene.clock.start + _span(scene) * k / TIMES for k in range(1, TIMES + 1)]
    texts = [shortest_text(t, DIGITS) for t in spread]
    return [(text, Fraction(text)) for text in texts]


def _course(scene: Scene, exact: Solution, length: Fraction) -> Document:
    """Return times and the motion at them, each number rounded to the figures of a picture.

    A row is the motion at exactly the time printed. A vector is a list; an attitude has nine numbers,
    row by row.
    """
    start = scene.clock.start
    texts = [shortest_text(start + length * k / INTERVALS, FIGURES) for k in range(INTERVALS + 1)]
    motion = exact.motion([Fraction(text) - start for text in texts], FIGURES + 1)
    course: Document = {"t": [float(text) for text in texts]}
    for name, rows in motion.quantities.items():
        course[name] = [_rounded(list(row.flat)) for row in rows]
    return course


def _rounded(entries: Sequence[mpf]) -> list[float]:
    """Return the entries to ``FIGURES`` digits; 0 for what is below the last of the largest one's."""
    least = max(map(abs, entries)) / mpf(10) ** (FIGURES + 1)
    return [float(mp.nstr(v, FIGURES)) if abs(v) > least else 0.0 for v in entries]


# What is drawn besides the motion.


def _ellipsoid_of_inertia(scene: Scene) -> Document | None:
    """Return principal moments, each with its axis in body components; None for a body in a fluid."""
    inertia = scene.body.parts().get("inertia")
    if inertia is None:
        return None
    moments, axes = principal_frame(inertia)
    return {"principal_moments": _plain(moments), "axes": [_rounded(axis) for axis in axes]}


def principal_frame(inertia: Matrix) -> tuple[list[mpf], list[list[mpf]]]:
    """Return the principal moments, and to each a unit vector; the three vectors are right-handed.

    A body whose axes are its principal axes keeps their order and signs, any other has its moments
    in ascending order and the largest component of its first two axes positive.
    """
    with mp.workdps(DIGITS):
        if tensors.is_diagonal(inertia):
            unit = [[mpf(int(i == k)) for k in range(3)] for i in range(3)]
            return [mp.convert(inertia[i][i]) for i in range(3)], unit
        found, vectors = mp.eigsy(mp.matrix([[mp.convert(v) for v in row] for row in inertia]))
        first, second = (_upward([vectors[i, k] for i in range(3)]) for k in (0, 1))
        third = [first[i] * second[k] - first[k] * second[i] for i, k in ((1, 2), (2, 0), (0, 1))]
        return list(found), [first, second, third]


def _upward(axis: list[mpf]) -> list[mpf]:
    return axis if max(axis, key=abs) > 0 else [-component for component in axis]


def _plain(numbers: Sequence[mpf]) -> list[float]:
    return [float(mp.nstr(number, FIGURES)) for number in numbers]


def _potential(scene: Scene, orbit: Elements) -> Document | None:
    """Return X3 of Hydromechanics 49 with its roots, and the interval of the axial impulse.

    None unless the body is free, of revolution about a body axis, and has a linear impulse: x3 is
    constant without one. ``variable`` names the component along the axis of symmetry: x1, x2 or x3.
    """
    body = scene.body
    if not isinstance(body, ImmersedBody) or not body.is_free:
        return None
    found = revolution(Reduced(scene))
    if found is None or not isinstance(found.subject, Nutation):
        return None
    nutation = found.subject
    X3 = [coefficient / nutation.body.r**2 for coefficient in nutation.f]  # noqa: N806 (as in 49)
    if nutation.F2 == 0 or len(X3) < 2 or nutation.axes.number is None:
        return None
    variable = f"x{nutation.axes.number}"
    ends = [orbit[name].value for name in (f"{variable}_low", f"{variable}_high") if name in orbit]
    with mp.workdps(DIGITS):
        interval = ends or [mp.convert(nutation.z)] * 2
        return {
            "variable": variable,
            "coefficients": _plain([mp.convert(coefficient) for coefficient in X3]),
            "roots": roots(X3),
            "interval": _plain(interval),
        }


def roots(polynomial: Sequence[Fraction]) -> list[list[float]]:
    """Return [real, imaginary] of every root as often as it is one: the real ones first, upwards.

    The polynomial has its highest power first. Its roots are isolated from exact integers, so that
    repeated ones are known as such, and a real one has no imaginary part.
    """
    scale = lcm(*(coefficient.denominator for coefficient in polynomial))
    integers = [int(coefficient * scale) for coefficient in reversed(polynomial)]
    with ctx.workprec(_ROOT_BITS):
        # With multiplicities, which flint's type stubs leave out.
        isolated: list[Any] = list(fmpz_poly(integers).complex_roots())
        found = [_parts(acb(root)) for root, times in isolated for _ in range(times)]
    return sorted(found, key=lambda root: (root[1] != 0, root))


def _parts(root: acb) -> list[float]:
    return [float(f"{float(part.mid()):.{FIGURES}g}") + 0.0 for part in (root.real, root.imag)]
