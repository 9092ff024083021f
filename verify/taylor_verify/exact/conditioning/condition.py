"""The condition of an orbit: how far a small error, made at one instant, is carried to another.

The transition matrix comes from differences of the exact solution at high precision, so it shares
nothing with the equations the solver was given.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import inf
from typing import Any, Final

import numpy as np
from flint import fmpz_mat
from mpmath import libmp, mp, mpf

from taylor_verify.exact.conditioning.inputs import momentum
from taylor_verify.exact.conditioning.sensitivity import difference, real
from taylor_verify.exact.conditioning.variation import transition_table
from taylor_verify.exact.route import solution
from taylor_verify.exact.solution import Quantities, Unsettled
from taylor_verify.scenes.bodies import RigidBody
from taylor_verify.scenes.motion import Spin
from taylor_verify.scenes.precision import floor_log2
from taylor_verify.scenes.scene import Scene
from taylor_verify.scenes.tensors import Vector

Array = np.ndarray[Any, Any]
FloatArray = np.ndarray[Any, np.dtype[np.float64]]

# (e, digits): momenta are changed by 10^-e of their size. The first attempt is for regular orbits. A
# perturbed orbit may lie 10^-e beside a degenerate one, where a closed form can lose 3e digits; the
# Taylor route loses none.
_CLOSED_FORM_DIGITS: Final = ((12, 36), (25, 110), (50, 220), (100, 440), (250, 1100))
_TAYLOR_DIGITS: Final = ((12, 32), (30, 70), (60, 130))
# Norms are wanted to a digit or two; a single number, the determinant, stands for a whole matrix.
_VOLUME_ERROR: Final = mpf("1e-6")


@dataclass(frozen=True)
class Transition:
    """How errors travel along one orbit between the instants ``elapsed`` (times since the start).

    The state is the momentum z (H, or the impulses x and y), in body axes; the attitude, as a
    rotation vector in space axes (R becomes exp([theta]x) R); and the centre, in space axes.
    ``table`` holds what ``norms`` returns.
    """

    elapsed: tuple[Fraction, ...]
    table: Mapping[tuple[str, str], FloatArray]

    def norms(self, out: str, into: str) -> FloatArray:
        """Entry [i, k]: the spectral norm of d out(t_i) / d into(t_k) for k <= i; zero for k > i.

        Shape (n, n). ``into`` is ``momentum`` or ``attitude`` (euler), ``linear_impulse``,
        ``angular_impulse``, ``attitude`` or ``centre`` (kirchhoff); ``out`` is one of the same, or
        ``omega`` = K momentum. What the scene does not track raises KeyError. A norm outside
        the range of float64 is inf.
        """
        return self.table[out, into]


def transition(scene: Scene, elapsed: Sequence[Fraction]) -> Transition:
    """The transition norms between these times, ``elapsed`` since the start and sorted away from it.

    With D, A, C the derivatives of momentum, attitude and centre by the initial momentum, and c the
    centre, the derivatives by the initial state are

        momentum <- momentum  D
        attitude <- momentum  A     attitude <- attitude  1
        centre   <- momentum  C     centre   <- attitude  -[c - c(0)]x     centre <- centre  1

    since a rotation of the start turns the whole path about its start, and a shift moves it. This
    matrix at t_i, times the inverse of the one at t_k, is

        momentum <- momentum  D_i D_k^-1
        attitude <- momentum  (A_i - A_k) D_k^-1
        centre   <- momentum  (C_i - C_k + [c_i - c_k]x A_k) D_k^-1
        centre   <- attitude  -[c_i - c_k]x, of norm |c_i - c_k|

    and 1 or 0 elsewhere. Both flows conserve volume, det D = 1, loads or not; a false digit in D
    shows in det D as it does in D_i D_k^-1, so precision rises until det D = 1 to six digits.
    Raises Unsettled if it never is.
    """
    if differs_dearly(scene):
        table = transition_table(scene, solution(scene), _units(scene), elapsed)
        if table is not None:
            return Transition(tuple(elapsed), table)
    return Transition(tuple(elapsed), dict(_norms(next(settled(scene, elapsed)))))


def differs_dearly(scene: Scene) -> bool:
    """Return True if each difference of the motion would cost a Taylor integration or quadratures.

    One integration along it costs less. A start beside it may leave the closed form: a motion in a plane
    leaves the plane, Weber's loses FG = 0, and a manufactured one has its closed form from one start only.
    """
    if scene.body.manufactured is not None or solution(scene).by_quadrature:
        return True
    start = momentum(scene)
    beside = (start.moved(j, unit) for j, unit in enumerate(start.units))
    return any(solution(each).route == "taylor" for each in (scene, *beside))


def settled(scene: Scene, elapsed: Sequence[Fraction], least: int = 0) -> Iterator[Derivatives]:
    """Differences that conserve volume, of 10^-``least`` units or less, at one precision after the other.

    Raises Unsettled if there is none.
    """
    exact = solution(scene)
    is_by_series = exact.route == "taylor" or exact.by_quadrature
    ladder = _TAYLOR_DIGITS if is_by_series else _CLOSED_FORM_DIGITS
    is_settled = False
    for exponent, digits in ladder:
        if exponent < least:
            continue
        found = derivatives(scene, elapsed, exponent, digits)
        if found.volume_error() <= _VOLUME_ERROR:
            is_settled = True
            yield found
    if not is_settled:
        raise Unsettled(
            f"differences of the exact solution at {digits} digits do not conserve volume along the "
            f"orbit of {scene.name}: its transition matrix is not known"
        )


@dataclass(frozen=True)
class Derivatives:
    """The orbit's derivatives by its initial momentum, as object arrays of mpf.

    They are differences of 10^-``exponent`` units, formed with ``digits`` digits.
    ``momentum`` (n, d, d), d = 3 or 6, ``others`` (n, 3, d) by name (omega, attitude, centre as
    tracked), the momenta themselves in ``state`` (n, d) and the ``centre`` (n, 3), empty where
    untracked. Momenta are measured in ``units``, one power of two near the size of each component's
    block, in ``momentum`` and ``state``; everything else is in the scene's units. The centre counts
    from its place at the start.
    """

    exponent: int
    digits: int
    units: Vector
    momentum: Array
    others: Mapping[str, Array]
    state: Array
    centre: Array

    def volume_error(self) -> mpf:
        """The largest |det D - 1|: exact for D as counted in last bits."""
        d = self.momentum.shape[1]
        with mp.workdps(self.digits):
            bits = mp.prec
            volumes = [_volume(counts) for counts in as_integers(self.momentum, bits)]
            return max(abs(mp.ldexp(mp.mpf(v), -d * bits) - 1) for v in volumes)


def derivatives(
    scene: Scene, elapsed: Sequence[Fraction], exponent: int, digits: int
) -> Derivatives:
    """One-sided differences at ``digits`` digits, each momentum changed by 10^-exponent units."""
    start = momentum(scene)
    step = Fraction(1, 10**exponent)
    with mp.workdps(digits):
        here = solution(scene).evaluate(elapsed, digits)
        columns: list[dict[str, Array]] = []
        for j, unit in enumerate(start.units):
            there = solution(start.moved(j, step * unit)).evaluate(elapsed, digits)
            columns.append(_momentum_first(scene, difference(here, there, mp.convert(step))))
        stacked = {
            name: np.stack([column[name] for column in columns], axis=2) for name in columns[0]
        }
        return Derivatives(
            exponent=exponent,
            digits=digits,
            units=start.units,
            momentum=stacked.pop("momentum") / real((start.units,)).T,
            others=stacked,
            state=_momenta(scene, here) / real((start.units,)),
            centre=_path(scene, here),
        )


def _momentum_first(scene: Scene, change: dict[str, Array]) -> dict[str, Array]:
    """The same change with the momenta under one name: H beside omega, or x and y as one vector."""
    if isinstance(scene.body, RigidBody):
        return {"momentum": change["omega"] @ real(scene.body.inertia).T, **change}
    both = [change.pop("linear_impulse"), change.pop("angular_impulse")]
    return {"momentum": np.concatenate(both, axis=1), **change}


def _momenta(scene: Scene, here: Quantities) -> Array:
    """H, or x and y as one vector, at every time."""
    if isinstance(scene.body, RigidBody):
        momenta: Array = here["omega"] @ real(scene.body.inertia).T
        return momenta
    return np.concatenate([here["linear_impulse"], here["angular_impulse"]], axis=1)


def _path(scene: Scene, here: Quantities) -> Array:
    """The centre from its place at the start; no rows where it is not tracked."""
    if "centre" not in here or isinstance(scene.initial, Spin):
        return np.empty((0, 3), dtype=object)
    return here["centre"] - real((scene.initial.centre,))


def _units(scene: Scene) -> Vector:
    """For each component of the momentum a power of two near the size of its block."""
    return momentum(scene).units


# Norms. The products are of Python's integers, which NumPy multiplies as objects: they count
# 2^-bits of each quantity's size, a power of two.


def _norms(found: Derivatives) -> Iterator[tuple[tuple[str, str], FloatArray]]:
    """Every entry of the table."""
    blocks = ("momentum",) if len(found.units) == 3 else ("linear_impulse", "angular_impulse")
    sizes = {block: floor_log2(found.units[3 * j]) for j, block in enumerate(blocks)}
    sizes.update({name: log2_size(rows) for name, rows in found.others.items()})
    if "attitude" in found.others:
        sizes["attitude"] = 0
    if "centre" in found.others:
        sizes["centre"] = log2_size(found.others["centre"], found.centre)
    if "attitude" in found.others:
        yield from _from_place(found, blocks, sizes)
    table = _from_momentum(found, sizes)
    for row, out in enumerate((*blocks, *found.others)):
        for column, into in enumerate(blocks):
            part = table[:, :, 3 * row : 3 * row + 3, 3 * column : 3 * column + 3]
            yield (out, into), _ldexp(_spectral_norms(part), sizes[out] - sizes[into])


def _from_momentum(found: Derivatives, sizes: Mapping[str, int]) -> FloatArray:
    """d (momentum, others)(t_i) / d momentum(t_k), shape (n, n, rows, d), zero for k > i."""
    count, d, _ = found.momentum.shape
    with mp.workdps(found.digits):
        bits = mp.prec
        others = [rows * mp.ldexp(1, -sizes[name]) for name, rows in found.others.items()]
        rows = as_integers(np.concatenate([found.momentum, *others], axis=1), bits)
        inverses = [inverse(counts, bits) for counts in rows[:, :d]]
        arms = as_integers(found.centre * mp.ldexp(1, -sizes.get("centre", 0)), bits)
    # omega depends on the momentum of the moment; attitude and centre add up from the start.
    place = d + 3 * ("omega" in found.others)
    table = np.zeros((count, count, rows.shape[1], d))
    for k in range(count):
        product = (rows[k:].reshape(-1, d) @ inverses[k]).reshape(count - k, -1, d)
        turn = product[0, place : place + 3].copy()
        product[:, place:] -= product[0, place:].copy()
        if len(arms):
            product[:, place + 3 :] += _cross(arms[k:] - arms[k], turn) >> bits
        table[k:, k] = _floats(product, 2 * bits)
    return table


def _from_place(
    found: Derivatives, blocks: Sequence[str], sizes: Mapping[str, int]
) -> Iterator[tuple[tuple[str, str], FloatArray]]:
    """What a turn or a shift of the body does: it moves the later path as a whole."""
    count = len(found.momentum)
    alone, nothing = np.tril(np.ones((count, count))), np.zeros((count, count))
    places = [name for name in found.others if name != "omega"]
    for into in places:
        for out in (*blocks, *found.others):
            yield (out, into), alone if out == into else nothing
    if "centre" in places:
        with mp.workdps(found.digits):
            bits = mp.prec
            path = as_integers(found.centre * mp.ldexp(1, -sizes["centre"]), bits)
        arms = _floats(path[:, None] - path[None, :], bits)
        lengths = np.tril(np.linalg.norm(arms, axis=2))
        yield ("centre", "attitude"), _ldexp(lengths, sizes["centre"])


def _volume(counts: Array) -> int:
    """The determinant of a matrix of integers."""
    return int(fmpz_mat(counts.tolist()).det())


def inverse(counts: Array, bits: int) -> Array:
    """The inverse, in integers that count 2^-bits as those of the matrix do; each rounded once."""
    found = fmpz_mat(counts.tolist()).inv()
    scale = 1 << 2 * bits + 1
    halves = [int(scale * entry.p // entry.q) for entry in found.entries()]
    return np.array([half + 1 >> 1 for half in halves], dtype=object).reshape(counts.shape)


def _cross(arms: Array, turn: Array) -> Array:
    """a x (each column of turn), for every row a of arms: (n, 3, d)."""
    j, k = [1, 2, 0], [2, 0, 1]
    across: Array = arms[:, j, None] * turn[None, k] - arms[:, k, None] * turn[None, j]
    return across


def log2_size(*arrays: Array) -> int:
    """The binary exponent of the largest entry, 0 if all are zero."""
    largest = max((abs(value) for array in arrays for value in array.flat), default=0)
    return int(mp.mag(largest)) if largest else 0


def as_integers(values: Array, bits: int) -> Array:
    """Python integers that count 2^-bits."""
    fixed = [int(libmp.to_fixed(value._mpf_, bits)) for value in values.flat]
    return np.array(fixed, dtype=object).reshape(values.shape)


def _floats(counts: Array, bits: int) -> FloatArray:
    unit = 1 << bits
    return np.array([quotient(count, unit) for count in counts.flat]).reshape(counts.shape)


def quotient(count: int, unit: int) -> float:
    """count / unit rounded once; inf, of either sign, beyond float64."""
    try:
        return count / unit
    except OverflowError:
        return inf if count > 0 else -inf


def _spectral_norms(matrices: FloatArray) -> FloatArray:
    """The largest singular value over the last two axes; inf where an entry is."""
    size: FloatArray = np.abs(matrices).max(axis=(-2, -1), keepdims=True)
    # Divided by their size, because entries up to 1e308 would overflow when squared.
    moderate = np.where(np.isfinite(size), matrices, 0.0) / np.where(size > 0, size, 1.0)
    norms = np.linalg.norm(moderate, 2, axis=(-2, -1))
    return np.where(np.isfinite(size[..., 0, 0]), norms * size[..., 0, 0], inf)


def _ldexp(values: FloatArray, exponent: int) -> FloatArray:
    """values * 2^exponent; beyond float64 that is inf, and no warning."""
    with np.errstate(over="ignore", under="ignore"):
        return np.ldexp(values, exponent)
