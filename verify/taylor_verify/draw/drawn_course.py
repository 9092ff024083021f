"""Course of a motion: rows of the exact solution as floats, dense enough to be drawn.

    document["course"]["omega"]      the motion at dense times
    document["body"]                 principal moments and axes, and the momentum of wheels
    document["acting"]               loads and own states at the same times, of a scene that writes them
    document["analytic"]             the numbers of the orbit: period, flip time

Each number is the exact one, by closed form or enclosure, rounded to the figures of a picture.
"""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import replace
from fractions import Fraction
from functools import partial
from math import ceil
from typing import Final

import numpy as np
from mpmath import mp, mpf

from taylor_verify.draw.acting_loads import Document, acting_on
from taylor_verify.draw.view import Numbers
from taylor_verify.exact.elements import Elements, elements
from taylor_verify.exact.printed import shortest_text
from taylor_verify.exact.route import solution
from taylor_verify.exact.solution import Solution, Unsettled
from taylor_verify.numbers import tensors
from taylor_verify.numbers.patience import Patience
from taylor_verify.numbers.tensors import Matrix
from taylor_verify.records.quantities import TRACKED
from taylor_verify.scenes.bodies import ImmersedBody
from taylor_verify.scenes.scene import Scene

# Digits of the numbers of the orbit.
DIGITS: Final = 30
# Intervals of the dense course.
INTERVALS: Final = 360
# A curve over more periods would cover itself.
PERIODS: Final = 3
# Radians that a body may turn between two rows.
_TURN: Final = 0.1
# A motion with fewer turns is drawn over a longer span where it moves, at most so many times as long.
_TURNS: Final = 2.0
LONGEST: Final = 16
# Seconds of processor time that the longer spans may take together.
_SECONDS: Final = 8.0
# The most parts of an interval.
_MOST: Final = 8
# Digits of a number in the course. The motion is computed to one digit more: a component that is smaller
# than this digit of its vector counts as zero, although it is not proven to be zero.
FIGURES: Final = 9


def motion(scene: Scene, intervals: int = INTERVALS) -> Document:
    """Return the document that every picture of a motion is drawn from, attitude and centre included.

    ``intervals`` is the number of intervals of time; a body that turns fast gets more. Raises Unsettled if
    the motion cannot be computed to the digits of a picture.
    """
    own = frozenset(state.name for state in scene.own_states)
    whole = replace(scene, track=frozenset(TRACKED[scene.model]), states=own)
    exact, orbit = solution(whole), _orbit_of(scene)
    body = scene.body
    shape, rotor = getattr(body, "ellipsoid", None), body.parts().get("rotor")
    # The route and the evidence below are those of the last call of `exact`.
    extent = _length(scene, orbit)
    course = _course_of(scene, exact, extent, intervals)
    # Rows show angles below half a turn only, however fast the body is: more parts than these do not help.
    more = min(ceil(float(_angles(_attitudes(course)).max()) / _TURN), _MOST)
    if more > 1:
        course = _course_of(scene, exact, extent, more * intervals)
    return {
        "scene": scene.name,
        "title": scene.title,
        "model": scene.model,
        "regime": orbit.regime or exact.regime,
        "route": exact.route,
        "evidence": exact.evidence,
        "analytic": _analytic(orbit),
        "course": course,
        "acting": acting_on(whole, course),
        "body": _inertia_ellipsoid(scene),
        "axis": body.axis_of_symmetry if isinstance(body, ImmersedBody) else None,
        "semi_axes": None if shape is None else [float(a) for a in shape.semi_axes],
        "hung": _hung(scene),
        "mass_matrix": _mass_matrix(scene),
        "rotor": [float(v) for v in rotor] if rotor else None,
        "is_free": body.is_free,
        "damping": float(body.damping),
    }


def lengthened(scene: Scene, document: Document) -> Document:
    """Return the motion over a longer span, if loads turn the body less than twice in that of the scene.

    It is at most ``LONGEST`` times as long, and ends where the motion cannot be computed soon.
    """
    factor, patience = 1 if scene.body.loads else LONGEST, Patience(_SECONDS)
    while factor < LONGEST and turns(_attitudes(document["course"])) < _TURNS:
        factor *= 2
        longer = replace(scene.clock, instants=(scene.clock.start + factor * span(scene),))
        after = patience.made(partial(_motion_if_known, replace(scene, clock=longer)), None)
        if after is None:
            break
        document = after
    return document


def _motion_if_known(scene: Scene) -> Document | None:
    with suppress(Unsettled):
        return motion(scene)
    return None


def turns(attitudes: Numbers) -> float:
    """Return the sum of the angles between neighbours of attitudes (n, 3, 3), in turns."""
    return float(_angles(attitudes).sum()) / (2 * np.pi)


def _attitudes(course: Document) -> Numbers:
    return np.array(course["attitude"]).reshape(-1, 3, 3)


def _angles(attitudes: Numbers) -> Numbers:
    cosines = (np.einsum("nij,nij->n", attitudes[1:], attitudes[:-1]) - 1) / 2
    return np.asarray(np.arccos(np.clip(cosines, -1, 1)))


def _hung(scene: Scene) -> list[tuple[list[float], list[float]]]:
    """Return weight and buoyancy: a force in space, and its point of the body."""
    hung = scene.body.loads.hung if scene.body.loads else ()
    return [([float(v) for v in force], [float(v) for v in at]) for force, at in hung]


def _mass_matrix(scene: Scene) -> list[list[float]] | None:
    """Return M of (x, y) = M (U, Omega); None for a rigid body."""
    body = scene.body
    if not isinstance(body, ImmersedBody):
        return None
    return [[float(v) for v in row] for row in body.mass_matrix]


def _orbit_of(scene: Scene) -> Elements:
    """Return the numbers of the orbit; none if their digits cannot be computed."""
    try:
        return elements(scene, DIGITS)
    except Unsettled as doubt:
        return Elements("", (), (str(doubt),))


def _analytic(orbit: Elements) -> list[Document]:
    """Return the numbers of the orbit with their meaning, each to all its digits."""
    names = ("name", "value", "meaning", "unit", "source")
    with mp.workdps(DIGITS):
        texts = [str(mp.nstr(element.value, DIGITS)) for element in orbit.numbers]
    return [
        {name: getattr(element, name) for name in names} | {"value": text}
        for element, text in zip(orbit.numbers, texts, strict=True)
    ]


def span(scene: Scene) -> Fraction:
    """Return the time from the start to the farthest instant; below zero where time runs backward."""
    return max(scene.clock.elapsed, key=abs)


def _length(scene: Scene, orbit: Elements) -> Fraction:
    """Return the span, or a few periods if it is longer."""
    whole = span(scene)
    if "period" not in orbit:
        return whole
    few = PERIODS * Fraction(mp.nstr(orbit["period"].value, FIGURES))
    return whole if abs(whole) <= few else (few if whole > 0 else -few)


def _course_of(scene: Scene, exact: Solution, extent: Fraction, intervals: int) -> Document:
    """Return times and the motion at them, each number rounded to the figures of a picture.

    A row is the motion at exactly the time printed. A vector is a list; an attitude has nine numbers,
    row by row.
    """
    start = scene.clock.start
    texts = [shortest_text(start + extent * k / intervals, FIGURES) for k in range(intervals + 1)]
    exactly = exact.motion([Fraction(text) - start for text in texts], FIGURES + 1)
    course: Document = {"t": [float(text) for text in texts]}
    for name, rows in exactly.quantities.items():
        course[name] = [_rounded(list(row.flat)) for row in rows]
    return course


def _rounded(entries: Sequence[mpf]) -> list[float]:
    """Return the entries to ``FIGURES`` digits; 0 for an entry below the last digit of the largest."""
    least = max(map(abs, entries)) / mpf(10) ** (FIGURES + 1)
    return [float(mp.nstr(v, FIGURES)) if abs(v) > least else 0.0 for v in entries]


def _inertia_ellipsoid(scene: Scene) -> Document | None:
    """Return the principal moments, each with its axis in body axes; None for a body in a fluid."""
    inertia = scene.body.parts().get("inertia")
    if inertia is None:
        return None
    moments, axes = _principal_frame(inertia)
    return {"principal_moments": plain(moments), "axes": [_rounded(axis) for axis in axes]}


def _principal_frame(inertia: Matrix) -> tuple[list[mpf], list[list[mpf]]]:
    """Return the principal moments, and to each a unit vector; the three vectors are right-handed.

    A body whose axes are its principal axes keeps their order and signs. Any other body has its moments in
    ascending order, and the largest component of its first two axes is positive.
    """
    with mp.workdps(DIGITS):
        if tensors.is_diagonal(inertia):
            unit = [[mpf(int(i == k)) for k in range(3)] for i in range(3)]
            return [mp.convert(inertia[i][i]) for i in range(3)], unit
        moments, vectors = mp.eigsy(mp.matrix([[mp.convert(v) for v in row] for row in inertia]))
        first, second = (_upward([vectors[i, k] for i in range(3)]) for k in (0, 1))
        third = [first[i] * second[k] - first[k] * second[i] for i, k in ((1, 2), (2, 0), (0, 1))]
        return list(moments), [first, second, third]


def _upward(axis: list[mpf]) -> list[mpf]:
    return axis if max(axis, key=abs) > 0 else [-component for component in axis]


def plain(numbers: Sequence[mpf]) -> list[float]:
    """Return numbers to the figures of a picture."""
    return [float(mp.nstr(number, FIGURES)) for number in numbers]
