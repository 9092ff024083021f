"""Pictures of one motion in space, to be turned: the polhode, the body's axis, the path.

A portrait has a dense course in floats, a record the errors at fewer samples: between these the
logarithm of the error is drawn as a straight line, for the colour alone.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import pairwise
from math import dist, log10, sqrt
from typing import Any, Final

from taylor_verify.studies.site.figure import Figure, Trace, column, components

Portrait = Mapping[str, Any]
Record = Mapping[str, Any]

_WARM: Final = [[0, "$low"], [0.5, "$middle"], [1, "$high"]]
# An ellipsoid that differs more from a sphere than that is no picture any more.
_FLATTEST: Final = 1e-3
# Of a curve's extent, a third of a pixel on the screen.
_UNSEEN: Final = 0.0008


def polhode(portrait: Portrait, record: Record | None) -> Figure | None:
    """omega in body axes on the ellipsoid of its energy; the linear impulse on its sphere.

    Where loads change energy or length, no surface holds the motion, and the curve stands alone.
    """
    euler = portrait["model"] == "euler"
    key, quantity = ("omega", "omega") if euler else ("linear_impulse", "impulse")
    course = portrait["course"]
    rows = course.get(key)
    if not rows or _is_a_point(rows):
        return None
    surface = _ellipsoid(portrait, rows) if euler else _sphere(rows)
    label = "ω" if euler else "x"
    named = "angular velocity" if euler else "linear impulse"
    on_it = (
        " It runs along the polhode, which lies on the ellipsoid of its kinetic energy."
        if euler
        else " It keeps its length: it runs on a sphere."
    )
    what = f"The {named} in body axes.{on_it if surface else ''}"
    return Figure(
        name="polhode",
        title="Polhode" if euler and surface else named.capitalize(),
        caption=f"{what}{_of_colour(record, quantity)}",
        alt=f"{portrait['title']}: the curve of the {named} in body axes.{_of_colour(record, quantity)}",
        traces=[
            *([surface] if surface else []),
            _curve(rows, record, quantity, course["t"]),
            _start(rows[0]),
        ],
        axes=[f"{label}₁", f"{label}₂", f"{label}₃"],
    )


def axis_in_space(portrait: Portrait, record: Record | None) -> Figure | None:
    """The three body axes as curves on the unit sphere of space, the third one in colours."""
    turned = portrait["course"].get("attitude")
    if not turned:
        return None
    # Column 3 of R is body axis 3 in space axes; R is stored row by row.
    third = [[row[2], row[5], row[8]] for row in turned]
    if _is_a_point(third):
        return None
    curve = _curve(third, record, "attitude", portrait["course"]["t"])
    return Figure(
        name="axis",
        title="The body's axis in space",
        caption="Where body axis 3 points, on the unit sphere of space axes."
        f"{_of_colour(record, 'attitude')}",
        alt=f"{portrait['title']}: the curve of body axis 3 on the unit sphere of space."
        f"{_of_colour(record, 'attitude')}",
        traces=[_ball((1, 1, 1)), curve, _start(third[0])],
        axes=["X", "Y", "Z"],
    )


def path(portrait: Portrait, record: Record | None) -> Figure | None:
    """The centre on its way through the fluid, in space axes."""
    rows = portrait["course"].get("centre")
    if not rows or _is_a_point(rows):
        return None
    traces = [_curve(rows, record, "centre", portrait["course"]["t"]), _start(rows[0])]
    return Figure(
        name="path",
        title="The centre through the fluid",
        caption="The path of the body's origin in space axes, all three at one scale."
        f"{_of_colour(record, 'centre')}",
        alt=f"{portrait['title']}: the path of the centre in space.{_of_colour(record, 'centre')}",
        traces=traces,
        axes=["X", "Y", "Z"],
    )


# Curves and surfaces.


def motions_of(portrait: Portrait, record: Record | None) -> list[Figure]:
    """Every picture in space of one scene."""
    if not portrait.get("course"):
        return []
    figures = (make(portrait, record) for make in (polhode, axis_in_space, path))
    return [figure for figure in figures if figure is not None]


def _curve(
    rows: Sequence[Sequence[float]],
    record: Record | None,
    quantity: str,
    times: Sequence[float],
) -> Trace:
    kept = thinned(rows, _UNSEEN)
    instants = [times[i] for i in kept]
    x, y, z = components([rows[i] for i in kept])
    colours = _error_at(instants, record, quantity)
    line: dict[str, Any] = {"width": 5, "color": "$low"}
    if colours is not None:
        line |= {"color": column(colours, 3), "colorscale": _WARM, "colorbar": _COLOUR_BAR}
    return {
        **{"type": "scatter3d", "mode": "lines", "name": "motion", "x": x, "y": y, "z": z},
        **{"line": line, "showlegend": False, "text": column(instants, 7)},
        "hovertemplate": "t = %{text}<br>%{x:.4g}, %{y:.4g}, %{z:.4g}<extra></extra>",
    }


_COLOUR_BAR: Final = {
    "title": {"text": "log₁₀ error", "side": "right"},
    "thickness": 10,
    "len": 0.7,
    "outlinewidth": 0,
}


def thinned(rows: Sequence[Sequence[float]], tolerance: float) -> list[int]:
    """The points that a curve needs: no other is farther from its chord than ``tolerance``.

    The tolerance is in parts of the curve's own extent (Ramer, Douglas and Peucker).
    """
    extent = max(max(row[i] for row in rows) - min(row[i] for row in rows) for i in range(3))
    kept, open_ = {0, len(rows) - 1}, [(0, len(rows) - 1)]
    while open_:
        first, last = open_.pop()
        far, at = max(
            ((_from_chord(rows[k], rows[first], rows[last]), k) for k in range(first + 1, last)),
            default=(0.0, first),
        )
        if far > tolerance * extent:
            kept.add(at)
            open_ += [(first, at), (at, last)]
    return sorted(kept)


def _from_chord(point: Sequence[float], one: Sequence[float], other: Sequence[float]) -> float:
    """The distance of a point from the segment between two others."""
    chord = [b - a for a, b in zip(one, other, strict=True)]
    offset = [p - a for a, p in zip(one, point, strict=True)]
    square = sum(c * c for c in chord)
    along = sum(c * o for c, o in zip(chord, offset, strict=True)) / square if square else 0.0
    foot = min(1.0, max(0.0, along))
    return dist(offset, [foot * c for c in chord])


def _start(row: Sequence[float]) -> Trace:
    x, y, z = components([row])
    return {
        **{"type": "scatter3d", "mode": "markers", "name": "start", "x": x, "y": y, "z": z},
        **{"marker": {"size": 4, "color": "$ink"}, "hovertemplate": "start<extra></extra>"},
        "showlegend": False,
    }


def _error_at(times: Sequence[float], record: Record | None, quantity: str) -> list[float] | None:
    """The logarithm of the error at each time, straight between the samples; None without errors."""
    gates = record["gates"] if record else ()
    gate = next((one for one in gates if one["quantity"] == quantity), None)
    if record is None or gate is None:
        return None
    # At the start there is the rounding of the data, or nothing at all: no error of the motion.
    pairs = sorted(list(zip(record["times"], gate["errors"], strict=True))[1:])
    known = [(t, log10(error)) for t, error in pairs if error and error > 0]
    return [_straight(known, t) for t in times] if known else None


def _of_colour(record: Record | None, quantity: str) -> str:
    """What the colour of a curve means; nothing where there is no error to show."""
    if record is None or _error_at([], record, quantity) is None:
        return ""
    return f" The colour is the logarithm of the error of {quantity} there, on {record['rung']}."


def _straight(known: Sequence[tuple[float, float]], at: float) -> float:
    """Between two neighbours in proportion; beyond the ends as the end."""
    if at <= known[0][0]:
        return known[0][1]
    for (before, one), (after, other) in pairwise(known):
        if at <= after:
            return one + (other - one) * (at - before) / (after - before)
    return known[-1][1]


def _ellipsoid(portrait: Portrait, rows: Sequence[Sequence[float]]) -> Trace | None:
    """omega.I omega = 2T in body axes; None where T is not kept, and where no eye could see it."""
    body = portrait.get("body")
    if not body:
        return None
    moments, axes = body["principal_moments"], body["axes"]
    energies = [_twice_energy(moments, axes, omega) for omega in rows]
    semi = [sqrt(energies[0] / moment) for moment in moments]
    seen = _alike(energies) and min(semi) > _FLATTEST * max(semi)
    return _ball(semi, axes) if seen else None


def _twice_energy(
    moments: Sequence[float], axes: Sequence[Sequence[float]], omega: Sequence[float]
) -> float:
    """2T of a body whose principal axes are the rows of ``axes``."""
    along = (sum(a * w for a, w in zip(one, omega, strict=True)) for one in axes)
    return sum(moment * w * w for moment, w in zip(moments, along, strict=True))


def _sphere(rows: Sequence[Sequence[float]]) -> Trace | None:
    """The sphere that all rows lie on; None where their lengths differ, as they do under loads."""
    lengths = [sqrt(sum(value * value for value in row)) for row in rows]
    return _ball([lengths[0]] * 3) if _alike(lengths) else None


def _alike(values: Sequence[float]) -> bool:
    """Equal but for the last of the nine digits that are stored."""
    return max(values) - min(values) <= 1e-6 * max(values)


def _ball(
    semi: Sequence[float], axes: Sequence[Sequence[float]] = ((1, 0, 0), (0, 1, 0), (0, 0, 1))
) -> Trace:
    """An ellipsoid whose semi-axes lie along the rows of ``axes``; the script lays its net."""
    return {
        **{"type": "surface", "ball": {"semi": column(semi), "axes": [column(a) for a in axes]}},
        **{"opacity": 0.35, "showscale": False, "hoverinfo": "skip", "name": "surface"},
        "colorscale": [[0, "$surface"], [1, "$surface"]],
        "lighting": {"ambient": 0.8, "diffuse": 0.4, "specular": 0.05, "roughness": 0.9},
        "contours": {name: {"highlight": False} for name in "xyz"},
    }


def _is_a_point(rows: Sequence[Sequence[float]]) -> bool:
    """A body that is at rest, or spins steadily, draws no curve."""
    size = max(abs(value) for row in rows for value in row)
    spread = max(max(row[i] for row in rows) - min(row[i] for row in rows) for i in range(3))
    return not spread > 1e-7 * size
