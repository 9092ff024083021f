"""Samples and callables as pieces, by the interpolation or the degree that their program states."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from fractions import Fraction
from itertools import pairwise
from math import isfinite
from typing import Any, Final

import numpy as np
from flint import fmpq_poly

from taylor_verify.certify.dense import columns_of, finite_number, named, of_scipy
from taylor_verify.certify.pieces import MOST_DEGREE, Pieces, nearest, polynomial
from taylor_verify.certify.slopes import slopes_of
from taylor_verify.numbers.irrational import rational
from taylor_verify.records.faults import brief, refusal
from taylor_verify.records.quantities import COLUMNS
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.files.file import TrajectoryFile
from taylor_verify.solvers.values import exact

INTERPOLATIONS: Final = ("linear", "cubic", "hermite")
# Values between the nodes of interpolation may differ from a polynomial by this much, of their size.
_ROUNDING: Final = 2.0**-40
# Where in a piece it is looked at again, off the nodes.
_CHECKED: Final = (Fraction(1, 97), Fraction(52, 97), Fraction(95, 97))


def of_samples(file: TrajectoryFile, scene: Scene, interpolation: str | None) -> Pieces:
    """Return the pieces between the rows of a file."""
    if interpolation not in INTERPOLATIONS:
        got = "none" if interpolation is None else brief(interpolation)
        expected = f"what its program makes of the rows ({', '.join(INTERPOLATIONS)})"
        raise refusal(expected, got, "interpolation")
    values = {
        column: [exact(row[k]) for row in rows]
        for group, rows in file.groups.items()
        for k, column in enumerate(file.columns[group])
    }
    pairs = sorted(zip(file.times, *values.values(), strict=True))
    for time, *row in pairs:
        if not all(map(isfinite, row)):
            raise refusal("finite numbers", brief(list(map(float, row))), f"t = {float(time):g}")
    times, names = [Fraction(row[0]) for row in pairs], list(values)
    rows = _with_steady_signs(names, [row[1:] for row in pairs])
    if len(times) < 2:
        raise refusal("two rows at least", len(times), file.name)
    if interpolation == "cubic":
        from scipy.interpolate import CubicSpline

        spline = CubicSpline([float(t) for t in times], np.array(rows, dtype=float))
        return of_scipy(spline, names)
    if interpolation == "linear":
        lines = (
            [polynomial([v, w - v], b - a) for v, w in zip(p, q, strict=True)]
            for (a, p), (b, q) in pairwise(zip(times, rows, strict=True))
        )
        return named(names, times, lines)
    slopes = slopes_of(scene, names, times, rows)
    ends = pairwise(zip(times, rows, slopes, strict=True))
    cubics = (
        [_hermite(*each, b - a) for each in zip(p, q, f, g, strict=True)]
        for (a, p, f), (b, q, g) in ends
    )
    return named(names, times, cubics)


def _with_steady_signs(
    names: Sequence[str], rows: Sequence[Sequence[Fraction]]
) -> list[list[Fraction]]:
    """Return the rows with each quaternion near to the one before: its sign is free in answers."""
    places = {k for k, name in enumerate(names) if name in COLUMNS["quaternion"]}
    steady: list[list[Fraction]] = []
    for row in rows:
        turned = steady and sum(row[k] * steady[-1][k] for k in places) < 0
        steady.append([-v if turned and k in places else v for k, v in enumerate(row)])
    return steady


def _hermite(p: Fraction, q: Fraction, f: Fraction, g: Fraction, h: Fraction) -> fmpq_poly:
    """The cubic with the values p, q and the slopes f, g at its ends."""
    rise = q - p
    return polynomial([p, h * f, 3 * rise - h * (2 * f + g), h * (f + g) - 2 * rise], h)


def of_callable(answer: Callable[..., Any], scene: Scene, degree: Any, nodes: Any) -> Pieces:
    """Return the polynomials of a stated degree that a callable is between stated nodes."""
    if degree is None or nodes is None:
        raise refusal("degree and nodes with a callable", "none", "answer")
    if not isinstance(degree, int) or not 0 <= degree <= MOST_DEGREE:
        raise refusal(f"a degree from 0 to {MOST_DEGREE}", brief(degree), "degree")
    times = sorted(finite_number(t, "nodes") for t in np.ravel(nodes).tolist())
    if len(times) < 2:
        raise refusal("two nodes at least", len(times), "nodes")
    names: list[str] = []
    rows: list[list[fmpq_poly]] = []
    for k, (begin, end) in enumerate(pairwise(times)):
        asked = _points(begin, end, degree)
        values = [_called(answer, t, k) for t in asked]
        names = names or columns_of(scene, len(values[0]))
        row = [_through(begin, asked, column) for column in zip(*values, strict=True)]
        _check(answer, row, begin, end, degree, k)
        rows.append(row)
    return named(names, times, iter(rows))


def _points(begin: Fraction, end: Fraction, degree: int) -> list[Fraction]:
    """Chebyshev's nodes of a piece, rounded to doubles inside it."""
    angles = np.pi * (np.arange(degree + 1) + 0.5) / (degree + 1)
    shares = ((1 - np.cos(angles)) / 2).tolist()
    return [Fraction(float(begin + (end - begin) * Fraction(share))) for share in shares]


def _called(answer: Callable[..., Any], time: Fraction, piece: int) -> list[float]:
    values = np.asarray(answer(float(time)), dtype=float).reshape(-1)
    if not np.isfinite(values).all():
        raise refusal("finite numbers", brief(values.tolist()), f"piece {piece}")
    return list(map(float, values))


def _through(begin: Fraction, times: Sequence[Fraction], values: Sequence[float]) -> fmpq_poly:
    """The polynomial through values, by Newton's divided differences."""
    differences = [Fraction(value) for value in values]
    for k in range(1, len(times)):
        for i in range(len(times) - 1, k - 1, -1):
            differences[i] = (differences[i] - differences[i - 1]) / (times[i] - times[i - k])
    total = fmpq_poly([])
    for difference, time in zip(reversed(differences), reversed(times), strict=True):
        total = total * fmpq_poly([rational(begin - time), 1]) + rational(difference)
    return total


def _check(
    answer: Callable[..., Any],
    row: Sequence[fmpq_poly],
    begin: Fraction,
    end: Fraction,
    degree: int,
    piece: int,
) -> None:
    """Refuse a callable that is no polynomial of the degree on a piece."""
    for share in _CHECKED:
        time = Fraction(float(begin + (end - begin) * share))
        for value, p in zip(_called(answer, time, piece), row, strict=True):
            ours = nearest(p(rational(time - begin)))
            if not abs(value - ours) <= _ROUNDING * max(abs(value), abs(nearest(p[0]))):
                expected = f"a polynomial of degree {degree} in t on piece {piece}"
                got = (
                    f"values that differ from one by {abs(value - ours):.1e} at t = {float(time):g}"
                )
                mend = "between each two nodes; an abscissa in float32 makes stairs of it"
                raise refusal(expected, got, "answer", mend)
