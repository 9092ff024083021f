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
# Roundings of one step add up to some hundred last bits, and a long span has some ten thousand
# steps; half of these bits is what the truncation of a series may leave, so that it stays visible
# above the roundings of its own coefficients.
_GUARD_BITS: Final = 26
_SLACK_BITS: Final = 12
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
        problem = self._problem
        grid = problem.grid(digits)
        later = sorted({t for t in elapsed if t >= 0})
        earlier = sorted({t for t in elapsed if t < 0}, reverse=True)
        states: dict[Fraction, list[int]] = {}
        for times in (later, earlier):
            states.update(_march(problem, times, grid))
        return _quantities(self.scene, [problem.reals(states[t], grid) for t in elapsed])

    @cached_property
    def _problem(self) -> Problem:
        return _problem(self.scene)


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
class Equations:
    """z' = constant + right: quadratic in variables, which are the states and then the forms."""

    constant: Vector
    forms: Matrix
    right: tuple[Polynomial, ...]


@dataclass(frozen=True)
class Units:
    """Powers of two, one for every variable and one for time, in which the motion is of size 1."""

    variables: tuple[int, ...]
    time: int


def _euler(body: RigidBody, with_attitude: bool) -> Equations:
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
    return Equations(tensors.apply(inverse, body.moment), (), tuple(right))


def _kirchhoff(body: ImmersedBody, with_attitude: bool, with_centre: bool) -> Equations:
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
    return Equations(body.force + body.couple, body.energy_matrix, tuple(right))


def _euler_units(body: RigidBody, start: Vector) -> Units:
    """omega by its size, or what the moment makes of it; time by omega."""
    spun = tensors.apply(body.inverse_inertia, body.moment)
    omega = _largest(_exponent(start[:3]), _halved(_exponent(spun)), default=0)
    return Units((omega,) * 3 + (0,) * (len(start) - 3), -omega)


def _kirchhoff_units(body: ImmersedBody, start: Vector) -> Units:
    """Each block by its size, or by what the loads, and x x U, make of it in the unit of time."""
    x, y, force, couple = start[:3], start[3:6], body.force, body.couple
    a, b, c = body.linear, body.coupling, body.angular
    spun = tensors.plus(tensors.apply(tensors.transpose(b), force), tensors.apply(c, couple))
    pushed = tensors.plus(tensors.apply(a, force), tensors.apply(b, couple))
    omega = _largest(
        _exponent(tensors.apply(tensors.transpose(b), x)),
        _exponent(tensors.apply(c, y)),
        _halved(_exponent(spun)),
        default=0,
    )
    time = -omega
    velocity = _largest(
        _exponent(tensors.apply(a, x)),
        _exponent(tensors.apply(b, y)),
        _later(_exponent(pushed), time),
        default=omega,
    )
    linear = _largest(_exponent(x), _later(_exponent(force), time), default=0)
    angular = _largest(
        _exponent(y), _later(_exponent(couple), time), default=linear + velocity + time
    )
    angular = max(angular, linear + velocity + time)
    sizes = (linear,) * 3 + (angular,) * 3 + (0,) * 9 + (velocity + time,) * 3
    return Units(sizes[: len(start)] + (velocity,) * 3 + (omega,) * 3, time)


def _exponent(vector: Vector) -> int | None:
    """log2 of the length, rounded; None for zero."""
    square = tensors.dot(vector, vector)
    return floor_log2(square) // 2 if square else None


def _halved(exponent: int | None) -> int | None:
    return None if exponent is None else exponent // 2


def _later(exponent: int | None, time: int) -> int | None:
    """The size of what grows at this rate, after one unit of time."""
    return None if exponent is None else exponent + time


def _largest(*exponents: int | None, default: int) -> int:
    return max((e for e in exponents if e is not None), default=default)


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


# The same, in integers.


@dataclass(frozen=True)
class Combination:
    """sum of numerators[i] v_i / denominator: a linear combination with exact coefficients."""

    numerators: tuple[int, ...]
    denominator: int


@dataclass(frozen=True)
class Grid:
    """The fixed point: integers count 2^-bits of a unit.

    A series has ``order`` terms, the last of which is to fall below 2^slack last bits.
    """

    bits: int
    slack: int
    orders_per_bit: float

    @property
    def order(self) -> int:
        return ceil((self.bits - self.slack) * self.orders_per_bit)

    def integers(self, values: Iterable[Fraction]) -> list[int]:
        return [_Integer(round(value * 2**self.bits)) for value in values]


@dataclass(frozen=True)
class Problem:
    """Equations and initial state in units: z' = constant + rates(products of two variables).

    ``moving`` counts the states that enter the equations of the others.
    """

    units: Units
    start: Vector
    moving: int
    constant: Vector
    forms: tuple[Combination, ...]
    products: tuple[tuple[int, int], ...]
    rates: tuple[tuple[tuple[int, ...], Combination], ...]

    def grid(self, digits: int) -> Grid:
        """Bits for these digits of the smallest block, and for what coefficients make of a bit."""
        blocks = [_exponent(self.start[i : i + 3]) for i in range(0, self.moving, 3)]
        small = max(0, *(-exponent for exponent in blocks if exponent is not None), 0)
        rows = [*self.forms, *(rate for _, rate in self.rates)]
        strong = max(
            (sum(map(abs, row.numerators)) // row.denominator).bit_length() for row in rows
        )
        slack = _SLACK_BITS + strong
        bits = ceil(digits * _BITS_PER_DIGIT) + _GUARD_BITS + strong + small
        return Grid(bits, slack, _ORDERS_PER_BIT[digits // _DIGITS_PER_TURN % 2])

    def reals(self, state: Sequence[int], grid: Grid) -> list[Any]:
        """The state in the scene's own units, exactly, whatever the ambient precision."""
        units = self.units.variables[: len(state)]
        return [
            mp.make_mpf(libmp.from_man_exp(count, unit - grid.bits))
            for count, unit in zip(state, units, strict=True)
        ]


def _problem(scene: Scene) -> Problem:
    """The scene's equations, its numbers exact and in units of their size."""
    start = _start(scene)
    if isinstance(scene.body, RigidBody):
        equations, moving = _euler(scene.body, bool(scene.track)), 3
        units = _euler_units(scene.body, start)
    else:
        equations = _kirchhoff(scene.body, bool(scene.track), "centre" in scene.track)
        units, moving = _kirchhoff_units(scene.body, start), 6
    size, products = len(start), sorted({pair for p in equations.right for pair in p})
    unit = [power_of_two(exponent) for exponent in units.variables]
    per_time = [power_of_two(units.time) / one for one in unit]
    places = {pair: place for place, pair in enumerate(products)}
    return Problem(
        units=units,
        start=tuple(z / one for z, one in zip(start, unit[:size], strict=True)),
        moving=moving,
        constant=tuple(c * one for c, one in zip(equations.constant, per_time, strict=False)),
        forms=tuple(
            _combination([c * one / own for c, one in zip(form, unit, strict=False)])
            for form, own in zip(equations.forms, unit[size:], strict=True)
        ),
        products=tuple(products),
        rates=tuple(
            (
                tuple(places[pair] for pair in p),
                _combination([c * unit[a] * unit[b] * one for (a, b), c in p.items()]),
            )
            for p, one in zip(equations.right, per_time, strict=False)
        ),
    )


def _combination(coefficients: Sequence[Fraction]) -> Combination:
    denominator = lcm(*(c.denominator for c in coefficients))
    return Combination(tuple(int(c * denominator) for c in coefficients), denominator)


# The recursion.


def _march(problem: Problem, times: Sequence[Fraction], grid: Grid) -> dict[Fraction, list[int]]:
    """The states at these times, which lie on one side of 0 and go away from it."""
    if not times:
        return {}
    unit = power_of_two(problem.units.time)
    state, now, last = grid.integers(problem.start), Fraction(0), times[-1] / unit
    width = _first_width(problem, last, grid)
    reached: dict[Fraction, list[int]] = {}
    steps, pending = 0, list(times[::-1])
    while pending:
        series = _series(problem, state, width, grid)
        growth = _log2_reach(series, problem.moving, grid)
        step = _dyadic(width, min(growth, 0.0))
        while pending and abs(pending[-1] / unit - now) <= abs(step):
            time = pending.pop()
            reached[time] = _value(series, (time / unit - now) / width, grid)
        steps += 1
        _refuse_endless(steps + abs(last - now) / abs(step), times[-1])
        state, now = _value(series, step / width, grid), now + step
        # A little wider than this step, because the next one may be longer.
        width = _dyadic(width, min(growth + 0.06, 1.0))
    return reached


def _series(problem: Problem, state: list[int], width: Fraction, grid: Grid) -> list[list[int]]:
    """Taylor coefficients of every state, those of order k held multiplied by width^k."""
    bits, forms, products = grid.bits, problem.forms, problem.products
    forward = [[z] for z in state]
    forward += [[_combined(form, state)] for form in forms]
    # The second factor of a convolution is kept in reverse, so that the two lists just pair up.
    backward = {b: forward[b][:] for _, b in products}
    for k in range(grid.order):
        sums = [sum(map(mul, forward[a], backward[b])) for a, b in products]
        scale = (width.denominator * (k + 1)) << bits
        fresh = [
            sum(map(mul, rate.numerators, [sums[place] for place in places]))
            * width.numerator
            // (scale * rate.denominator)
            for places, rate in problem.rates
        ]
        if k == 0:
            for i, drift in enumerate(grid.integers(width * c for c in problem.constant)):
                fresh[i] += drift
        fresh += [_combined(form, fresh) for form in forms]
        for coefficients, z in zip(forward, fresh, strict=True):
            coefficients.append(z)
        for b, coefficients in backward.items():
            coefficients.insert(0, fresh[b])
    return forward[: len(state)]


def _combined(form: Combination, state: list[int]) -> int:
    """A form of the states it is made of, which come first."""
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


def _log2_reach(series: list[list[int]], moving: int, grid: Grid) -> float:
    """log2 of the fraction of the width at which the last terms fall below the slack.

    A root test over the last eighth of the orders, so that a series with gaps does not deceive it.
    1 where those terms are all zero: the width can then be doubled without harm. Where the motion
    has outgrown its units, so have the roundings, and the slack with them.
    """
    order, bits_per_order = grid.order, 1 / grid.orders_per_bit
    outgrown = max(abs(z[0]) for z in series[:moving]).bit_length() - grid.bits
    slack = grid.slack + max(0, outgrown)
    reach = 1.0
    for k in range(order - max(order // 8, 3), order + 1):
        size = max(abs(z[k]) for z in series).bit_length()
        if size:
            reach = min(reach, ((order - k) * bits_per_order + slack - size) / k)
    return reach


def _first_width(problem: Problem, span: Fraction, grid: Grid) -> Fraction:
    """A first guess of the step, from short series: no longer than the span, whose sign it has."""
    bits = grid.slack + _PILOT_BITS
    pilot = Grid(bits, grid.slack, grid.orders_per_bit)
    start = pilot.integers(problem.start)
    width = _dyadic(span if span else Fraction(1), 0.0)
    for _ in range(3):
        reach = _log2_reach(_series(problem, start, width, pilot), problem.moving, pilot)
        width = _dyadic(width, min(reach, 0.0))
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


def _quantities(scene: Scene, states: Sequence[Sequence[Any]]) -> Quantities:
    z = np.array(states, dtype=object).reshape(len(states), len(_start(scene)))
    if scene.model == "euler":
        parts, used = {"omega": z[:, :3]}, 3
    else:
        parts, used = {"linear_impulse": z[:, :3], "angular_impulse": z[:, 3:6]}, 6
    if scene.track:
        parts["attitude"] = z[:, used : used + 9].reshape(len(z), 3, 3)
    if "centre" in scene.track:
        parts["centre"] = z[:, used + 9 :]
    return parts
