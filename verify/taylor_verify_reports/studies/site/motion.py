"""Pictures of one motion in space that can be turned: the polhode, the body's axis, the path.

A portrait has a dense course in floats, and a record the errors at fewer samples. The logarithm of the
error is interpolated linearly and shown as colour.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import log10
from typing import Any, Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from taylor_verify_reports.studies.site.figure import Figure, Trace, column

Portrait = Mapping[str, Any]
Record = Mapping[str, Any]
Numbers = NDArray[np.float64]

_COLOUR_SCALE: Final = [[0, "$low"], [0.5, "$middle"], [1, "$high"]]
_COLOUR_BAR: Final = {
    "title": {"text": "log₁₀ error", "side": "right"},
    "thickness": 10,
    "len": 0.7,
    "outlinewidth": 0,
}
# An ellipsoid is drawn only if its semi-axes have a larger ratio than this, least over greatest.
_FLATTEST: Final = 1e-3
# A deviation of a curve by this part of its extent is a third of a pixel, which nobody sees.
_UNSEEN: Final = 0.0008
# The margin and the shortest side of a box, as parts of its longest side.
_MARGIN: Final = 0.03
_LEAST_SIDE: Final = 0.3
# A curve that spreads by less than this part of its size is a point: a body at rest, or a steady spin.
_A_POINT: Final = 1e-7
# Stored values of a constant quantity differ by less than this part: they have nine digits.
_ALIKE: Final = 1e-6


def motions_of(portrait: Portrait, record: Record | None) -> list[Figure]:
    """Return every picture in space of one scene; errors are those of ``record``, if there is one."""
    if not portrait.get("course"):
        return []
    figures = (make(portrait, record) for make in (polhode, axis_in_space, path))
    return [figure for figure in figures if figure is not None]


def polhode(portrait: Portrait, record: Record | None) -> Figure | None:
    """Return omega in body axes on its energy ellipsoid, or the linear impulse on its sphere.

    If loads change the energy or the length, the motion lies on no such surface, and only the curve is
    shown. The result is None for a motion that is a point.
    """
    is_rigid = portrait["model"] == "euler"
    key, quantity = ("omega", "omega") if is_rigid else ("linear_impulse", "impulse")
    curve = _Curve.of(portrait, portrait["course"].get(key, []), record, quantity)
    if curve is None:
        return None
    surface = _ellipsoid(portrait, curve.rows) if is_rigid else _sphere(curve.rows)
    label, name = ("ω", "angular velocity") if is_rigid else ("x", "linear impulse")
    place = (
        " It runs along the polhode, which lies on the ellipsoid of its kinetic energy."
        if is_rigid
        else " It keeps its length: it runs on a sphere."
    )
    return Figure(
        name="polhode",
        title="Polhode" if is_rigid and surface else name.capitalize(),
        caption=f"The {name} in body axes.{place if surface else ''}{curve.colour}",
        alt=f"{portrait['title']}: the curve of the {name} in body axes.{curve.colour}",
        traces=[*([surface] if surface else []), *curve.traces()],
        axes=[f"{label}₁", f"{label}₂", f"{label}₃"],
        box=_box(curve.rows, surface),
    )


def axis_in_space(portrait: Portrait, record: Record | None) -> Figure | None:
    """Return the third body axis as a curve on the unit sphere, in space axes; None without attitudes."""
    turned = np.array(portrait["course"].get("attitude", [])).reshape(-1, 3, 3)
    curve = _Curve.of(portrait, turned[:, :, 2], record, "attitude")
    if curve is None:
        return None
    return Figure(
        name="axis",
        title="The body's axis in space",
        caption=f"Where body axis 3 points, on the unit sphere of space axes.{curve.colour}",
        alt=f"{portrait['title']}: the curve of body axis 3 on the unit sphere of space.{curve.colour}",
        traces=[_ball((1, 1, 1)), *curve.traces()],
        axes=["X", "Y", "Z"],
        box=_box(curve.rows, _ball((1, 1, 1))),
    )


def path(portrait: Portrait, record: Record | None) -> Figure | None:
    """Return the path of the centre through the fluid, in space axes; None without a path."""
    curve = _Curve.of(portrait, portrait["course"].get("centre", []), record, "centre")
    if curve is None:
        return None
    return Figure(
        name="path",
        title="The centre through the fluid",
        caption=f"The path of the body's origin in space axes, all three at one scale.{curve.colour}",
        alt=f"{portrait['title']}: the path of the centre in space.{curve.colour}",
        traces=curve.traces(),
        axes=["X", "Y", "Z"],
        box=_box(curve.rows, None),
    )


def _box(rows: Numbers, surface: Trace | None) -> list[tuple[float, float]]:
    """Return the sides of a box around a curve and its surface, with room for the line's width.

    Short sides are extended, so that the box does not look like a line.
    """
    points = rows
    if surface:
        semi, axes = np.array(surface["ball"]["semi"]), np.array(surface["ball"]["axes"])
        reach = np.sqrt(np.square(semi[:, None] * axes).sum(axis=0))
        points = np.concatenate([rows, [reach, -reach]])
    low, high = points.min(axis=0), points.max(axis=0)
    half = (high - low) / 2 + _MARGIN * float((high - low).max())
    half = np.maximum(half, _LEAST_SIDE * half.max())
    middle = (low + high) / 2
    return [(float(a), float(b)) for a, b in zip(middle - half, middle + half, strict=True)]


# Curves.


@dataclass(frozen=True)
class _Curve:
    """A curve (n, 3) with its times, and the samples (time, logarithm of the error) for its colour.

    ``colour`` is the sentence that explains the colour; it is empty without errors.
    """

    times: Numbers
    rows: Numbers
    errors: Sequence[tuple[float, float]]
    colour: str

    @classmethod
    def of(
        cls, portrait: Portrait, rows: ArrayLike, record: Record | None, quantity: str
    ) -> _Curve | None:
        """Return the curve of ``rows`` (n, 3); None without rows, and for a curve that is a point."""
        points = np.asarray(rows, dtype=float)
        if not points.size or not _extent(points) > _A_POINT * np.abs(points).max():
            return None
        errors = _errors(record, quantity)
        rung = record["rung"] if record else ""
        words = f" The colour is the logarithm of the error of {quantity} there, on {rung}."
        return cls(np.array(portrait["course"]["t"]), points, errors, words if errors else "")

    def traces(self) -> list[Trace]:
        """Return Plotly's traces of the curve and of a mark at its start."""
        places = thinned(self.rows, _UNSEEN)
        times = self.times[places]
        line: dict[str, Any] = {"width": 5, "color": "$low"}
        if self.errors:
            instants, logarithms = np.array(self.errors).T
            colours = np.interp(times, instants, logarithms)
            line |= {
                "color": column(colours, 3),
                "colorscale": _COLOUR_SCALE,
                "colorbar": _COLOUR_BAR,
            }
        start = {"marker": {"size": 4, "color": "$ink"}, "hovertemplate": "start<extra></extra>"}
        return [
            {
                **_scattered("lines", "motion", self.rows[places]),
                "line": line,
                "showlegend": False,
                "text": column(times, 7),
                "hovertemplate": "t = %{text}<br>%{x:.4g}, %{y:.4g}, %{z:.4g}<extra></extra>",
            },
            {**_scattered("markers", "start", self.rows[:1]), **start, "showlegend": False},
        ]


def _scattered(mode: str, name: str, rows: Numbers) -> Trace:
    x, y, z = map(column, rows.T)
    return {"type": "scatter3d", "mode": mode, "name": name, "x": x, "y": y, "z": z}


def _extent(rows: Numbers) -> float:
    return float(np.ptp(rows, axis=0).max())


def _errors(record: Record | None, quantity: str) -> list[tuple[float, float]]:
    """Return time and logarithm of each error above zero, in the order of time."""
    gates = record["gates"] if record else ()
    errors = next((gate["errors"] for gate in gates if gate["quantity"] == quantity), ())
    # The error at the start is that of the rounded data, and not one of the motion.
    pairs = list(zip(record["times"], errors, strict=True))[1:] if record and errors else []
    return sorted((t, log10(error)) for t, error in pairs if error and error > 0)


def thinned(rows: ArrayLike, tolerance: float) -> list[int]:
    """Return the indices of the points that a curve (n, 3) needs; the others are near the chords of these.

    ``tolerance`` is the largest distance from a chord, relative to the extent of the curve. The method is
    that of Ramer, Douglas and Peucker.
    """
    points = np.asarray(rows, dtype=float)
    farthest = tolerance * _extent(points)
    places, chords = {0, len(points) - 1}, [(0, len(points) - 1)]
    while chords:
        first, last = chords.pop()
        away = _from_chord(points[first : last + 1])
        if away.max() > farthest:
            at = first + int(away.argmax())
            places.add(at)
            chords += [(first, at), (at, last)]
    return sorted(places)


def _from_chord(points: Numbers) -> Numbers:
    """Return the distance of each point from the segment between the first and the last point."""
    chord, offset = points[-1] - points[0], points - points[0]
    foot = np.clip(offset @ chord / (chord @ chord or 1.0), 0, 1)
    return np.asarray(np.linalg.norm(offset - np.outer(foot, chord), axis=1))


# Surfaces.


def _ellipsoid(portrait: Portrait, rows: Numbers) -> Trace | None:
    """Return the ellipsoid omega.I omega = 2T in body axes; None if T changes, or if it is very flat."""
    body = portrait.get("body")
    if not body:
        return None
    moments, axes = np.array(body["principal_moments"]), body["axes"]
    energies = np.square(rows @ np.transpose(axes)) @ moments
    semi = np.sqrt(energies[0] / moments)
    is_drawn = _is_constant(energies) and semi.min() > _FLATTEST * semi.max()
    return _ball(semi, axes) if is_drawn else None


def _sphere(rows: Numbers) -> Trace | None:
    """Return the sphere on which all rows lie; None if their lengths differ, as under loads."""
    lengths = np.linalg.norm(rows, axis=1)
    return _ball([lengths[0]] * 3) if _is_constant(lengths) else None


def _is_constant(values: Numbers) -> bool:
    return bool(np.ptp(values) <= _ALIKE * values.max())


def _ball(
    semi: Sequence[float] | Numbers,
    axes: Sequence[Sequence[float]] = ((1, 0, 0), (0, 1, 0), (0, 0, 1)),
) -> Trace:
    """Return an ellipsoid with semi-axes along the rows of ``axes``; the script makes its mesh."""
    return {
        "type": "surface",
        "ball": {"semi": column(semi), "axes": [column(a) for a in axes]},
        "opacity": 0.35,
        "showscale": False,
        "hoverinfo": "skip",
        "name": "surface",
        "colorscale": [[0, "$surface"], [1, "$surface"]],
        "lighting": {"ambient": 0.8, "diffuse": 0.4, "specular": 0.05, "roughness": 0.9},
        "contours": {name: {"highlight": False} for name in "xyz"},
    }
