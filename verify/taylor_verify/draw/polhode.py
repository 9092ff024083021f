"""The polhode: the angular velocity on the ellipsoid of inertia, coloured by the error of a run.

T is conserved, so omega stays on the surface omega.I omega = 2T, whose semi-axes along the principal axes
are sqrt(2T/J_i). The thin line is the exact course, the marks are the samples of a run: their place is the
exact one (an error of a few u is far below the width of a line), their colour the size of the error.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from math import isfinite, sqrt
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from taylor_verify.draw.stage import Look, Stage, norm_of, scale
from taylor_verify.draw.view import Ellipsoid, Numbers, View
from taylor_verify.publish.pictures.palette import INK, PAPER, QUIET
from taylor_verify.publish.pictures.picture import Picture
from taylor_verify.publish.pictures.sheet import Entry
from taylor_verify.publish.pictures.wording import plain, stem_of

if TYPE_CHECKING:
    from matplotlib.colors import Normalize
    from matplotlib.figure import Figure

Document = Mapping[str, Any]

# In inches.
_HEIGHT: Final = 3.5
_STAGE: Final = 4.2
_COURSE: Final[Look] = {"color": INK, "linewidth": 0.8, "gid": "course"}
_BORDER: Final[Look] = {
    **{"color": "#8A5A00", "linewidth": 0.8, "dashes": (4, 2)},
    "gid": "separatrix",
}
_SAMPLE: Final[Look] = {
    **{"linestyle": "none", "marker": "o", "markersize": 4.5},
    **{"markerfacecolor": QUIET, "markeredgecolor": INK, "markeredgewidth": 0.4},
}
_OMEGA: Final = "\N{GREEK SMALL LETTER OMEGA}"
# The width of a mark, in points.
_NEAR, _FAR = 4.2, 3.0
# The encircled axis faces the reader, and the two others are seen from the side.
_FACING: Final = (1.0, 0.55, 0.45)


@dataclass(frozen=True)
class Series:
    """The curve in principal axes, one row a time, and the samples with their errors in u.

    ``separatrices`` are the curves through the middle axis; none where two moments are equal.
    """

    semi_axes: tuple[float, float, float]
    course: Numbers
    samples: Numbers
    errors: tuple[float, ...]
    separatrices: tuple[Numbers, ...]


def series(portrait: Document, samples: Sequence[Sequence[float]], record: Document) -> Series:
    """Return the curve and the samples, whose exact omega at the record's times is ``samples``.

    Raises ValueError for a scene without such a surface: a fluid, a moment of force, a body at rest.
    """
    body, course = portrait["body"], portrait["course"]
    is_free = any(row["name"] == "T" for row in portrait["analytic"])
    if body is None or "omega" not in course or not is_free:
        raise ValueError(f"expected a free rigid body, got another scene @ {portrait['scene']}")
    gate = next(gate for gate in record["gates"] if gate["quantity"] == "omega")
    axes, moments = np.array(body["axes"]), np.array(body["principal_moments"])
    own = np.array(course["omega"]) @ axes.T
    twice = float(moments @ np.square(own[0]))
    if not twice > 0:
        raise ValueError(f"expected a body that turns, got one at rest @ {portrait['scene']}")
    a, b, c = (sqrt(twice / moment) for moment in moments)
    return Series(
        (a, b, c),
        own,
        np.array(samples) @ axes.T,
        tuple(error / record["unit_roundoff"] for error in gate["errors"]),
        tuple(_separatrices(Ellipsoid((a, b, c)), moments)),
    )


def picture(portrait: Document, samples: Sequence[Sequence[float]], record: Document) -> Picture:
    """The polhode of one scene, with the errors of one run. Raises ValueError as `series` does."""
    found = series(portrait, samples, record)
    rung = record["rung"]
    most, at = max(
        (e, t) for e, t in zip(found.errors, record["times"], strict=True) if isfinite(e)
    )
    alt = (
        f"The angular velocity of {portrait['scene']} on its ellipsoid of inertia, whose semi-axes are "
        f"{', '.join(plain(a) for a in found.semi_axes)}: a closed curve or part of one, with the "
        f"{len(found.errors)} samples of the run on {rung} marked. Their errors are at most "
        f"{plain(most)} u, at t = {at:g}."
    )
    title = f"Polhode: {portrait['scene']}"
    return Picture(stem_of(portrait, "polhode"), title, alt, partial(_figure, found, rung))


def _separatrices(surface: Ellipsoid, moments: Numbers) -> list[Numbers]:
    """Return the two plane sections through the middle axis on which H^2 = 2T J2.

    J1 > J2 > J3 the moments: J1 (J1 - J2) omega_1^2 = J3 (J2 - J3) omega_3^2, so in units of the semi-axes
    (J1 - J2) q_1^2 = (J2 - J3) q_3^2.
    """
    low, middle, high = np.argsort(moments)
    lower, upper = moments[middle] - moments[low], moments[high] - moments[middle]
    if not min(lower, upper) > 1e-9 * moments[high]:
        return []
    poles = np.zeros((2, 3))
    poles[:, high], poles[:, low] = sqrt(upper), [sqrt(lower), -sqrt(lower)]
    return [surface.circle(pole) for pole in poles]


def _view(found: Series) -> View:
    """The side to which the curve turns; of the axes, the one that it goes round faces the reader."""
    q = found.course / np.array(found.semi_axes)
    mean = q.mean(axis=0)
    order = np.argsort(-np.abs(mean))
    direction = np.zeros(3)
    for weight, i in zip(_FACING, order, strict=True):
        direction[i] = weight if mean[i] >= 0 else -weight
    # From above rather than from below where the curve does not say which.
    if order[0] != 2:
        direction[2] = abs(direction[2])
    return View.facing([float(v) for v in direction])


def _figure(found: Series, rung: str) -> Figure:
    stage = Stage.around(Ellipsoid(found.semi_axes), _view(found), _STAGE, _HEIGHT)
    for curve in found.separatrices:
        stage.line(curve, 2, _BORDER)
    stage.line(found.course, 3, _COURSE)
    norm = norm_of(found.errors)
    _draw_samples(stage, found, norm)
    axes = zip(
        "\N{SUBSCRIPT ONE}\N{SUBSCRIPT TWO}\N{SUBSCRIPT THREE}", found.semi_axes, strict=True
    )
    names = [f"{_OMEGA}{subscript} = {semi_axis:.3g}" for subscript, semi_axis in axes]
    stage.name_axes(found.semi_axes, names)
    entries: list[Entry] = [(_COURSE, "exact course"), (_SAMPLE, f"samples of taylor {rung}")]
    entries += [(_BORDER, "separatrices")] if found.separatrices else []
    stage.legend(entries, "Faint: on the far side.", 2.8)
    stage.bar(norm, f"error on {rung}, in u of max|{_OMEGA}|", 1.0)
    return stage.figure


def _draw_samples(stage: Stage, found: Series, norm: Normalize) -> None:
    """Draw later samples above earlier ones, and those behind the body smaller, hollow and faint."""
    errors = np.array(found.errors)
    known, faces = np.isfinite(errors), stage.faces(found.samples)
    x, y = stage.view.seen(found.samples).T
    colours = scale()(norm(np.where(known, errors, 0.0)))
    near, far = known & faces, known & ~faces
    hollow = {"facecolor": PAPER, "edgecolors": colours[far], "linewidths": 0.7, "alpha": 0.5}
    stage.axes.scatter(x[far], y[far], s=_FAR**2, zorder=0.6, gid="hidden samples", **hollow)
    full = {"c": colours[near], "edgecolors": INK, "linewidths": 0.35}
    stage.axes.scatter(x[near], y[near], s=_NEAR**2, zorder=5, gid="samples", **full)
