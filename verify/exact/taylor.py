"""The truth where no closed form is known: our own Taylor recursion in exact integers.

Both equation sets are quadratic, z' = c + sum of products of states and linear forms of them, so
the coefficients of a series follow from convolutions alone. Numbers are integers that count units
of 2^-bits, times are exact dyadic rationals, and the body's coefficients stay rational: nothing is
rounded but the states. Right-hand sides are written here from the texts, not taken from models.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from math import ceil, lcm
from operator import mul
from typing import Any, Final, final

import numpy as np
from mpmath import libmp, mp

from verify.exact.solution import NO_CLOSED_FORM, Quantities, Solution, Unsettled
from verify.scenes import tensors
from verify.scenes.bodies import ImmersedBody, RigidBody
from verify.scenes.motion import Impulse, Motion, Quaternion, Spin, State
from verify.scenes.precision import floor_log2, power_of_two
from verify.scenes.scene import Scene
from verify.scenes.tensors import Matrix, Vector

Triple = tuple[int, int, int]
Polynomial = Mapping[tuple[int, int], Fraction]

_BITS_PER_DIGIT: Final = 3.3219280948873626
# mpmath's integers: those of gmpy2 where it is installed, which are twice as fast, else Python's.
_Integer: Final = libmp.MPZ
# Roundings of one step add up to some hundred units, and a long span has some ten thousand steps.
_GUARD_BITS: Final = 24
# A step of radius/e^2 is the cheapest for the quadratic cost of a convolution: bits * ln 2 / 2
# orders; the linear cost asks for a few more. Two ratios, taken in turn every twenty digits, so
# that two evaluations that are compared differ in order, step and precision.
_ORDERS_PER_BIT: Final = (0.36, 0.40)
_DIGITS_PER_TURN: Final = 20
_MOST_STEPS: Final = 1_000_000
_PILOT_BITS: Final = 64


@final
@dataclass(frozen=True)
class TaylorSolution(Solution):
    """The motion of any scene, free or loaded, by recursion on the equations of motion."""

    scene: Scene

    route = "taylor"
    regime = NO_CLOSED_FORM

    def evaluate(self, elapsed: Sequence[Fraction], digits: int) -> Quantities:
        """The tracked quantities at these times, any order and either sign, to about ``digits``.

        The absolute error of a vector is that many digits below the smallest block of the initial
        state, times what the orbit makes of a rounding. Raises Unsettled when the span would take
        more than a million steps.
        """
        grid = self._grid(digits)
        later = sorted({t for t in elapsed if t >= 0})
        earlier = sorted({t for t in elapsed if t < 0}, reverse=True)
        states: dict[Fraction, list[int]] = {}
        for times in (later, earlier):
            states.update(_march(self._equations, self._start, times, grid))
        return _quantities(self.scene, [states[t] for t in elapsed], grid.bits)

    @cached_property
    def _equations(self) -> Quadratic:
        return _equations(self.scene)

    @cached_property
    def _start(self) -> Vector:
        return _start(self.scene)

    def _grid(self, digits: int) -> Grid:
        smallest = min((floor_log2(size) // 2 for size in self._squared_sizes() if size), default=0)
        bits = ceil(digits * _BITS_PER_DIGIT) + _GUARD_BITS + max(0, -smallest)
        return Grid(bits, _ORDERS_PER_BIT[digits // _DIGITS_PER_TURN % 2])

    def _squared_sizes(self) -> list[Fraction]:
        """|block|^2 of everything whose smallness a fixed point must resolve."""
        z, e = self._start, self._equations
        moving = z[:3] if self.scene.model == "euler" else z[:6]
        variables = moving + tuple(
            sum((n * c for n, c in zip(form.numerators, z, strict=True)), Fraction(0))
            / form.denominator
            for form in e.forms
        )
        return [
            tensors.dot(variables[i : i + 3], variables[i : i + 3])
            for i in range(0, len(variables), 3)
        ]


def arcs(scene: Scene, starts: Sequence[State], spans: Sequence[Fraction], digits: int) -> Motion:
    """Row k: where the scene's equations lead from the exact state starts[k] in the time spans[k].

    Settled to ``digits`` by the agreement of two evaluations, as Solution.motion is, and raises
    Unsettled likewise.
    """
    return _Arcs(scene, tuple(starts)).motion(spans, digits)


@final
@dataclass(frozen=True)
class _Arcs(Solution):
    """Many short motions of one body, each from a state of its own."""

    scene: Scene
    starts: tuple[State, ...]

    route = "taylor"
    regime = NO_CLOSED_FORM

    def evaluate(self, elapsed: Sequence[Fraction], digits: int) -> Quantities:
        ends = [
            TaylorSolution(replace(self.scene, initial=start)).evaluate([span], digits)
            for start, span in zip(self.starts, elapsed, strict=True)
        ]
        return {name: np.concatenate([end[name] for end in ends]) for name in ends[0]}


# The equations.


@dataclass(frozen=True)
class Combination:
    """sum of numerators[i] v_i / denominator: a linear combination with exact coefficients."""

    numerators: tuple[int, ...]
    denominator: int


@dataclass(frozen=True)
class Quadratic:
    """z' = constant + rates(products); a product is of two variables: states, then forms."""

    constant: Vector
    forms: tuple[Combination, ...]
    products: tuple[tuple[int, int], ...]
    rates: tuple[tuple[tuple[int, ...], Combination], ...]


def _equations(scene: Scene) -> Quadratic:
    if isinstance(scene.body, RigidBody):
        return _euler(scene.body, with_attitude=bool(scene.track))
    return _kirchhoff(scene.body, bool(scene.track), "centre" in scene.track)


def _euler(body: RigidBody, with_attitude: bool) -> Quadratic:
    """omega' = K((I omega) x omega + M); each row r of R obeys r' = r x omega."""
    omega: Triple = (0, 1, 2)
    inertia, inverse = body.inertia, body.inverse_inertia
    torque: list[Polynomial] = []
    for j, k in ((1, 2), (2, 0), (0, 1)):
        forward = {(i, k): inertia[j][i] for i in omega}
        backward = {(i, j): -inertia[k][i] for i in omega}
        torque.append(_sum(forward, backward))
    right = [_sum(*(_times(c, p) for c, p in zip(row, torque, strict=True))) for row in inverse]
    if with_attitude:
        right += [p for row in _rows_from(3) for p in _cross(row, omega)]
    return _quadratic(tensors.apply(inverse, body.moment), (), right)


def _kirchhoff(body: ImmersedBody, with_attitude: bool, with_centre: bool) -> Quadratic:
    """Hydromechanics 48 (3), (4), (5); R' = R [Omega]x row by row, centre' = R U."""
    x: Triple = (0, 1, 2)
    y: Triple = (3, 4, 5)
    size = 6 + 9 * with_attitude + 3 * with_centre
    velocity: Triple = (size, size + 1, size + 2)
    omega: Triple = (size + 3, size + 4, size + 5)
    right = _cross(x, omega)
    right += [_sum(p, q) for p, q in zip(_cross(y, omega), _cross(x, velocity), strict=True)]
    if with_attitude:
        right += [p for row in _rows_from(6) for p in _cross(row, omega)]
    if with_centre:
        right += [_dot(row, velocity) for row in _rows_from(6)]
    return _quadratic(body.force + body.couple, body.energy_matrix, right)


def _rows_from(first: int) -> tuple[Triple, Triple, Triple]:
    """The variables of the three rows of R."""
    a, b, c = ((i, i + 1, i + 2) for i in range(first, first + 9, 3))
    return a, b, c


def _cross(a: Triple, b: Triple) -> list[Polynomial]:
    one = Fraction(1)
    return [_sum({(a[j], b[k]): one}, {(a[k], b[j]): -one}) for j, k in ((1, 2), (2, 0), (0, 1))]


def _dot(a: Triple, b: Triple) -> Polynomial:
    return {pair: Fraction(1) for pair in zip(a, b, strict=True)}


def _times(factor: Fraction, polynomial: Polynomial) -> Polynomial:
    return {pair: factor * coefficient for pair, coefficient in polynomial.items()}


def _sum(*polynomials: Polynomial) -> Polynomial:
    """The sum; a b and b a are one product, and what cancels is gone."""
    total: dict[tuple[int, int], Fraction] = {}
    for polynomial in polynomials:
        for (a, b), coefficient in polynomial.items():
            pair = (min(a, b), max(a, b))
            total[pair] = total.get(pair, Fraction(0)) + coefficient
    return {pair: coefficient for pair, coefficient in total.items() if coefficient}


def _quadratic(constant: Vector, forms: Matrix, right: Sequence[Polynomial]) -> Quadratic:
    """The equations with common denominators; a missing constant is zero, as is a form's tail."""
    size = len(right)
    products = tuple(sorted({pair for polynomial in right for pair in polynomial}))
    place = {pair: index for index, pair in enumerate(products)}
    return Quadratic(
        constant=constant + (Fraction(0),) * (size - len(constant)),
        forms=tuple(_combination(row + (Fraction(0),) * (size - len(row))) for row in forms),
        products=products,
        rates=tuple(
            (tuple(place[pair] for pair in polynomial), _combination(tuple(polynomial.values())))
            for polynomial in right
        ),
    )


def _combination(coefficients: Vector) -> Combination:
    denominator = lcm(*(c.denominator for c in coefficients))
    return Combination(tuple(int(c * denominator) for c in coefficients), denominator)


def _start(scene: Scene) -> Vector:
    """The initial state in the order of the equations, exactly."""
    initial = scene.initial
    if isinstance(initial, Spin):
        moving: Vector = initial.omega
    else:
        moving = initial.linear + initial.angular
    if scene.track:
        moving += tuple(entry for row in _rotation(initial.attitude) for entry in row)
    if "centre" in scene.track and isinstance(initial, Impulse):
        moving += initial.centre
    return moving


def _rotation(quaternion: Quaternion) -> Matrix:
    """The matrix R of a quaternion of any norm: rational, because R is of degree 2 in q/|q|."""
    s, a, b, c = quaternion
    norm = s * s + a * a + b * b + c * c
    rows = (
        (s * s + a * a - b * b - c * c, 2 * (a * b - s * c), 2 * (a * c + s * b)),
        (2 * (a * b + s * c), s * s - a * a + b * b - c * c, 2 * (b * c - s * a)),
        (2 * (a * c - s * b), 2 * (b * c + s * a), s * s - a * a - b * b + c * c),
    )
    return tuple(tensors.scaled(1 / norm, row) for row in rows)


# The recursion.


@dataclass(frozen=True)
class Grid:
    """The fixed point: integers count 2^-bits, and a series has ``orders_per_bit`` bits orders."""

    bits: int
    orders_per_bit: float

    @property
    def order(self) -> int:
        return ceil(self.bits * self.orders_per_bit)

    def integers(self, values: Iterable[Fraction]) -> list[int]:
        return [_Integer(round(value * 2**self.bits)) for value in values]


def _march(
    equations: Quadratic, start: Vector, times: Sequence[Fraction], grid: Grid
) -> dict[Fraction, list[int]]:
    """The states at these times, which lie on one side of 0 and go away from it."""
    if not times:
        return {}
    state, now, last = grid.integers(start), Fraction(0), times[-1]
    width = _first_width(equations, start, last, grid)
    reached: dict[Fraction, list[int]] = {}
    steps, pending = 0, list(times[::-1])
    while pending:
        series = _series(equations, state, width, grid)
        growth = _log2_reach(series, grid)
        step = _dyadic(width, min(growth, 0.0))
        while pending and abs(pending[-1] - now) <= abs(step):
            time = pending.pop()
            reached[time] = _value(series, (time - now) / width, grid)
        steps += 1
        _refuse_endless(steps + abs(last - now) / abs(step), last)
        state, now = _value(series, step / width, grid), now + step
        # A little wider than this step, because the next one may be longer.
        width = _dyadic(width, min(growth + 0.06, 1.0))
    return reached


def _series(equations: Quadratic, state: list[int], width: Fraction, grid: Grid) -> list[list[int]]:
    """Taylor coefficients of every state, those of order k held multiplied by width^k."""
    bits = grid.bits
    forms = equations.forms
    forward = [[z] for z in state]
    forward += [[_combined(form, state)] for form in forms]
    # The second factor of a convolution is kept in reverse, so that the two lists just pair up.
    backward = {b: forward[b][:] for _, b in equations.products}
    for k in range(grid.order):
        sums = [sum(map(mul, forward[a], backward[b])) for a, b in equations.products]
        scale = (width.denominator * (k + 1)) << bits
        fresh = [
            sum(map(mul, rate.numerators, [sums[place] for place in places]))
            * width.numerator
            // (scale * rate.denominator)
            for places, rate in equations.rates
        ]
        if k == 0:
            drift = grid.integers(width * c for c in equations.constant)
            fresh = [z + c for z, c in zip(fresh, drift, strict=True)]
        fresh += [_combined(form, fresh) for form in forms]
        for coefficients, z in zip(forward, fresh, strict=True):
            coefficients.append(z)
        for b, coefficients in backward.items():
            coefficients.insert(0, fresh[b])
    return forward[: len(state)]


def _combined(form: Combination, state: list[int]) -> int:
    total: int = sum(map(mul, form.numerators, state))
    return total // form.denominator


def _value(series: list[list[int]], fraction: Fraction, grid: Grid) -> list[int]:
    """The states at this fraction of the series' width."""
    bits = grid.bits
    argument = _Integer(round(fraction * 2**bits))
    powers = [_Integer(1) << bits]
    for _ in range(grid.order):
        powers.append(powers[-1] * argument >> bits)
    return [sum(map(mul, coefficients, powers)) >> bits for coefficients in series]


def _log2_reach(series: list[list[int]], grid: Grid) -> float:
    """log2 of the fraction of the width at which the last coefficients fall to the last bit.

    A root test over the last eighth of the orders, so that a series with gaps does not deceive it.
    1 where those coefficients are all zero: the width can then be doubled without harm.
    """
    order, bits_per_order = grid.order, 1 / grid.orders_per_bit
    reach = 1.0
    for k in range(order - max(order // 8, 3), order + 1):
        size = max(abs(coefficients[k]) for coefficients in series).bit_length()
        if size:
            reach = min(reach, ((order - k) * bits_per_order - size) / k)
    return reach


def _first_width(equations: Quadratic, start: Vector, span: Fraction, grid: Grid) -> Fraction:
    """A first guess of the step, from short series: no longer than the span, which has a sign."""
    extra = max(0, grid.bits - _PILOT_BITS) // 4
    pilot = Grid(_PILOT_BITS + extra, grid.orders_per_bit)
    width = span if span else Fraction(1)
    width = _dyadic(width, 0.0)
    for _ in range(3):
        width = _dyadic(
            width,
            min(_log2_reach(_series(equations, pilot.integers(start), width, pilot), pilot), 0.0),
        )
    return width


def _dyadic(width: Fraction, log2_factor: float) -> Fraction:
    """The width times 2^log2_factor, cut to six bits: exact, and cheap to multiply by."""
    whole = int(log2_factor // 1)
    wide = width * power_of_two(whole) * Fraction(2.0 ** (log2_factor - whole))
    unit = power_of_two(floor_log2(wide) - 5)
    return int(wide / unit) * unit


def _refuse_endless(steps: Fraction, span: Fraction) -> None:
    if steps > _MOST_STEPS:
        raise Unsettled(
            f"the Taylor recursion would take about {float(steps):.1e} steps to reach "
            f"{float(span):g}; expected at most {_MOST_STEPS}: ask for a shorter time"
        )


# The answer.


def _quantities(scene: Scene, states: Sequence[Sequence[int]], bits: int) -> Quantities:
    z = np.array([[_real(n, bits) for n in state] for state in states], dtype=object)
    if scene.model == "euler":
        parts, used = {"omega": z[:, :3]}, 3
    else:
        parts, used = {"linear_impulse": z[:, :3], "angular_impulse": z[:, 3:6]}, 6
    if scene.track:
        parts["attitude"] = z[:, used : used + 9].reshape(len(z), 3, 3)
    if "centre" in scene.track:
        parts["centre"] = z[:, used + 9 :]
    return parts


def _real(count: int, bits: int) -> Any:
    """count * 2^-bits, exactly, whatever the ambient precision."""
    return mp.make_mpf(libmp.from_man_exp(count, -bits))
