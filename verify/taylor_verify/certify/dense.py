"""Dense answers of programs as exact pieces: SciPy's and heyoka's, and pieces in JSON."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from fractions import Fraction
from itertools import pairwise
from typing import Any, Final

import numpy as np
from flint import fmpq, fmpq_poly

from taylor_verify.certify.pieces import Piece, Pieces, finite, merged, polynomial
from taylor_verify.numbers.irrational import fraction, rational
from taylor_verify.records.faults import Faults, Refused, brief, cut, near, refusal
from taylor_verify.records.quantities import COLUMNS, MOMENTA
from taylor_verify.scenes.reading.table import exact_number
from taylor_verify.scenes.scene import Scene

Polynomials = list[fmpq_poly]

_LISTS: Final = (list, tuple, np.ndarray)


def columns_of(scene: Scene, count: int) -> list[str]:
    """Return the columns of a state of so many numbers: the first groups of the scene's order."""
    order = ["quaternion", *(["centre"] if scene.model == "kirchhoff" else [])]
    groups = {group.name: group.columns for group in scene.groups}
    main = [name for name in groups if name not in order and name in COLUMNS]
    own = [name for name in groups if name not in COLUMNS]
    columns: list[str] = []
    sizes = []
    for name in (*main, *order, *own):
        columns += groups.get(name, COLUMNS.get(name, ()))
        sizes.append(len(columns))
        if len(columns) == count:
            return columns
    tracked = [column for group in scene.groups for column in group.columns]
    if len(tracked) == count:
        return tracked
    raise refusal(f"{' or '.join(map(str, sizes))} components", count, "answer")


def is_piecewise(answer: Any) -> bool:
    """Return True for SciPy's polynomials on pieces, and its splines, in one variable."""
    breaks = getattr(answer, "t" if hasattr(answer, "k") else "x", None)
    return hasattr(answer, "c") and isinstance(breaks, np.ndarray)


def named(names: Sequence[str], breaks: Sequence[Any], rows: Iterator[Polynomials]) -> Pieces:
    """Return pieces between breaks, with a row of polynomials for each."""
    times = [finite_number(t, "breaks") for t in breaks]
    pairs = zip(pairwise(times), rows, strict=True)
    return Pieces.of(_piece(names, *ends, row) for ends, row in pairs)


def _piece(names: Sequence[str], begin: Fraction, end: Fraction, row: Polynomials) -> Piece:
    """Return one piece, which a motion backwards in time gives from its later end on."""
    piece = Piece(begin, end, dict(zip(names, row, strict=True)))
    return piece if begin <= end else piece.shifted(end, begin)


def finite_number(value: Any, place: str) -> Fraction:
    """Return the rational that a number in binary is."""
    try:
        number = value if isinstance(value, float | np.floating) else float(value)
        return Fraction(*map(int, number.as_integer_ratio()))
    except (TypeError, ValueError, OverflowError):
        raise refusal("finite numbers", brief(value), place) from None


# SciPy's OdeSolution: polynomials of x = (t - t_old)/h, by the class of the interpolant.


def _runge_kutta(dense: Any) -> Polynomials:
    pairs = zip(dense.y_old.tolist(), dense.Q.tolist(), strict=True)
    t, h = fmpq_poly([0, 1]), Fraction(float(dense.h))
    return [t * polynomial(row, h) + rational(y) for y, row in pairs]


def _radau(dense: Any) -> Polynomials:
    pairs = zip(dense.y_old.tolist(), dense.Q.tolist(), strict=True)
    return [polynomial([y, *row], Fraction(float(dense.h))) for y, row in pairs]


def _dop853(dense: Any) -> Polynomials:
    x = polynomial([0, 1], Fraction(float(dense.h)))
    rows = []
    for place, y in enumerate(dense.y_old.tolist()):
        total = fmpq_poly([])
        for i, f in enumerate(dense.F[::-1, place].tolist()):
            total = (total + rational(Fraction(f))) * (1 - x if i % 2 else x)
        rows.append(total + rational(Fraction(y)))
    return rows


def _backward_differences(dense: Any) -> Polynomials:
    """D_0 + sum of D_k times the product of (t - t_shift)/denom."""
    begin, product, powers = Fraction(float(dense.t_old)), fmpq_poly([1]), []
    for shift, denominator in zip(dense.t_shift.tolist(), dense.denom.tolist(), strict=True):
        factor = [begin - Fraction(shift), 1]
        product = product * polynomial(factor) / rational(Fraction(denominator))
        powers.append(product)
    rows = []
    for first, *rest in dense.D[: len(powers) + 1].T.tolist():
        terms = (rational(Fraction(d)) * p for d, p in zip(rest, powers, strict=True))
        rows.append(sum(terms, polynomial([first])))
    return rows


def _nordsieck(dense: Any) -> Polynomials:
    shift = fmpq_poly([rational(Fraction(float(dense.t_old)) - Fraction(float(dense.t))), 1])
    return [polynomial(row, Fraction(float(dense.h)))(shift) for row in dense.yh.tolist()]


_INTERPOLANTS: Final[Mapping[str, Callable[[Any], Polynomials]]] = {
    "RkDenseOutput": _runge_kutta,
    "Dop853DenseOutput": _dop853,
    "RadauDenseOutput": _radau,
    "BdfDenseOutput": _backward_differences,
    "LsodaDenseOutput": _nordsieck,
    "ConstantDenseOutput": lambda dense: [polynomial([y]) for y in dense.value.tolist()],
}


def of_ode_solution(answer: Any, scene: Scene) -> Pieces:
    """Return the pieces of SciPy's OdeSolution."""
    kinds = {type(dense).__name__ for dense in answer.interpolants}
    if unknown := sorted(kinds - set(_INTERPOLANTS)):
        raise refusal(f"interpolants ({', '.join(_INTERPOLANTS)})", unknown[0], "answer")
    rows = [_INTERPOLANTS[type(dense).__name__](dense) for dense in answer.interpolants]
    return named(columns_of(scene, len(rows[0])), answer.ts.tolist(), iter(rows))


def of_taylor(answer: Any, scene: Scene) -> Pieces:
    """Return the pieces of heyoka's continuous output: powers of the time since each step began."""
    steps = np.asarray(answer.tcs)
    if not issubclass(steps.dtype.type, np.floating):
        raise refusal("coefficients in float64 or long double", f"{steps.dtype}", "answer")
    rows = ([polynomial(c) for c in step.tolist()] for step in steps)
    return named(columns_of(scene, answer.tcs.shape[1]), list(answer.times), rows)


def of_scipy(answer: Any, names: Sequence[str]) -> Pieces:
    """Return the pieces of a PPoly, a BPoly or a spline, with a column for each component."""
    if hasattr(answer, "k"):
        return _of_spline(answer, names)
    c = np.asarray(answer.c, dtype=float)
    columns = c.reshape(*c.shape[:2], -1).transpose(1, 2, 0).tolist()
    breaks = np.asarray(answer.x).tolist()
    if hasattr(answer, "from_power_basis"):
        lengths = [Fraction(b) - Fraction(a) for a, b in pairwise(breaks)]
        pairs = zip(columns, lengths, strict=True)
        return named(names, breaks, ([_bernstein(p, h) for p in row] for row, h in pairs))
    return named(names, breaks, ([polynomial(p[::-1]) for p in row] for row in columns))


def _bernstein(coefficients: Sequence[float], length: Fraction) -> fmpq_poly:
    """The polynomial of Bernstein's coefficients on a piece, by de Casteljau's recursion."""
    x = polynomial([0, 1], length)
    rows = [polynomial([c]) for c in coefficients]
    while len(rows) > 1:
        rows = [p + x * (q - p) for p, q in pairwise(rows)]
    return rows[0]


def _of_spline(answer: Any, names: Sequence[str]) -> Pieces:
    k, t = int(answer.k), [finite(x) for x in np.asarray(answer.t).tolist()]
    c = np.asarray(answer.c, dtype=float)
    columns = [[finite(x) for x in row] for row in c.reshape(len(c), -1).T.tolist()]
    places = [j for j in range(k, len(t) - k - 1) if t[j] < t[j + 1]]
    return Pieces.of(
        Piece(fraction(t[j]), fraction(t[j + 1]), dict(zip(names, row, strict=True)))
        for j in places
        for row in [_de_boor(t, columns, k, j)]
    )


def _de_boor(t: Sequence[fmpq], columns: Sequence[Sequence[fmpq]], k: int, j: int) -> Polynomials:
    """The polynomials of a spline between two knots, by de Boor's recursion."""
    rows = [[fmpq_poly([c]) for c in column[j - k : j + 1]] for column in columns]
    for r in range(1, k + 1):
        for i in range(k, r - 1, -1):
            low, high = t[i + j - k], t[i + 1 + j - r]
            share = fmpq_poly([t[j] - low, 1]) / (high - low)
            for d in rows:
                d[i] = d[i - 1] + share * (d[i] - d[i - 1])
    return [d[k] for d in rows]


def components(answer: Any) -> int:
    """Return the number of components of a piecewise polynomial or a spline."""
    shape = np.asarray(answer.c).shape
    return int(np.prod(shape[1:] if hasattr(answer, "k") else shape[2:], dtype=int))


def of_mapping(answer: Mapping[str, Any], scene: Scene) -> Pieces:
    """Return the pieces of piecewise polynomials by the names of groups or columns."""
    parts = []
    for name, each in answer.items():
        if not is_piecewise(each):
            raise refusal("a piecewise polynomial or a spline", brief(each), name)
        columns = _columns(scene, name, components(each))
        parts.append(of_scipy(each, columns))
    return merged(parts)


def _columns(scene: Scene, name: str, count: int) -> Sequence[str]:
    """Return the columns of a quantity or a group, or of a single column."""
    if name == "attitude" and count == len(COLUMNS["quaternion"]):
        name = "quaternion"
    known = {n: group.columns for n, group in scene.known_groups.items()}
    if name != "impulse" and name not in {*known, *(c for group in known.values() for c in group)}:
        raise refusal("a quantity or a column of the scene", name, "answer", near(name, known))
    columns = known.get(name, (name,))
    if name == "impulse":
        columns = tuple(column for group in MOMENTA["kirchhoff"] for column in COLUMNS[group])
    if len(columns) != count:
        many = "1 component" if len(columns) == 1 else f"{len(columns)} components"
        raise refusal(f"{many} in each piece", count, name)
    return columns


def of_document(document: Mapping[str, Any], scene: Scene) -> Pieces:
    """Return the pieces of ``{"breaks": [..], "quantities": {"omega": [[[c0, c1, ..], ..], ..]}}``.

    Raises Refused with every fault and its place.
    """
    faults = Faults()
    breaks = _numbers(document["breaks"], "breaks", faults)
    columns: dict[str, Polynomials] = {}
    if isinstance(document["breaks"], _LISTS) and len(document["breaks"]) < 2:
        faults.add("two breaks at least", str(len(document["breaks"])), "breaks")
    quantities = document["quantities"]
    if not isinstance(quantities, Mapping) or not quantities:
        expected = "an object with a list of pieces for each quantity"
        raise refusal(expected, brief(quantities), "quantities")
    for name, pieces in quantities.items():
        count = _length(document["breaks"]) - 1
        columns |= _of_quantity(scene, name, pieces, count, faults)
    if faults.lines:
        raise Refused(faults.lines)
    rows = zip(*columns.values(), strict=True)
    return Pieces.of(
        Piece(a, b, dict(zip(columns, row, strict=True)))
        for (a, b), row in zip(pairwise(breaks), rows, strict=True)
    )


def _of_quantity(
    scene: Scene, name: str, pieces: Any, count: int, faults: Faults
) -> dict[str, Polynomials]:
    """Return the polynomials of each column of a quantity, one for each of so many pieces."""
    place, many = f"quantities.{name}", f"{count} pieces, one between two breaks"
    each = _list(pieces, many, place, faults, count if count > 0 else _length(pieces))
    names = _columns(scene, name, _length(each[0])) if each else ()
    components = f"{len(names)} lists of coefficients, one for each component"
    rows = []
    for k, piece in enumerate(each):
        parts = _list(piece, components, f"{place}[{k}]", faults, len(names))
        places = (f"{place}[{k}][{i}]" for i in range(len(parts)))
        rows.append(
            [polynomial(_numbers(p, at, faults)) for p, at in zip(parts, places, strict=True)]
        )
    is_whole = all(len(row) == len(names) for row in rows)
    return dict(zip(names, map(list, zip(*rows, strict=True)), strict=True)) if is_whole else {}


def _length(value: Any) -> int:
    return len(value) if isinstance(value, _LISTS) else 0


def _list(value: Any, expected: str, place: str, faults: Faults, count: int) -> Any:
    """Return a list of so many entries; an empty one, and a fault, for anything else."""
    if isinstance(value, _LISTS) and len(value) == count:
        return value
    got = f"a list of {len(value)}" if isinstance(value, _LISTS) else brief(value)
    faults.add(expected, got, place)
    return ()


def _numbers(values: Any, place: str, faults: Faults) -> list[Fraction]:
    """Return the numbers of a list, those of each fault left out."""
    numbers = []
    many = _length(values) or 1
    for k, value in enumerate(_list(values, "a list of numbers", place, faults, many)):
        try:
            numbers.append(_exact(value))
        except (ValueError, OverflowError):
            faults.add("a finite number", cut(str(value)), f"{place}[{k}]")
    return numbers


def _exact(value: Any) -> Fraction:
    return Fraction(value) if isinstance(value, float) else exact_number(value)
