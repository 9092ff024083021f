"""The solution of quadratic equations by Taylor series, in exact integers.

z' = c + sum of products of states and linear forms of them, so the coefficients of a series follow
from convolutions alone. Numbers are integers that count 2^-bits of a unit, a power of two near the
size of what it measures; times are exact dyadic rationals and the equations' coefficients stay
rational: nothing is rounded but the states.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from math import ceil, lcm
from operator import mul
from typing import Any, Final, NamedTuple

from mpmath import libmp, mp

from verify.exact.clocks import Polynomial
from verify.exact.grid import STEP_DIGITS, Grid, Integer
from verify.exact.solution import Unsettled
from verify.scenes import tensors
from verify.scenes.precision import floor_log2, power_of_two
from verify.scenes.tensors import Matrix, Vector

_BITS_PER_DIGIT: Final = 3.3219280948873626
# What the truncation of a series may leave, in last bits, so that it stays visible above the roundings
# of its own coefficients: those of one step add up to some hundred last bits.
_SLACK_BITS: Final = 12
# A long span has so many steps, and each may leave the slack.
_LONG_SPAN: Final = 10_000
_MOST_STEPS: Final = 1_000_000
_PILOT_BITS: Final = 64
# As a logarithm: more than what cutting a width to the bits of a step takes away.
_A_LITTLE_WIDER: Final = 0.1


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


def exponent(vector: Vector) -> int | None:
    """log2 of the length, rounded; None for zero."""
    square = tensors.dot(vector, vector)
    return floor_log2(square) // 2 if square else None


# The same, in integers.


@dataclass(frozen=True)
class Combination:
    """sum of numerators[i] v_i / denominator: a linear combination with exact coefficients."""

    numerators: tuple[int, ...]
    denominator: int


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

    def begun(self, start: Vector) -> Problem:
        """The same equations and units from another state, given in the scene's own units."""
        units = self.units.variables[: len(start)]
        return replace(self, start=_scaled(start, [power_of_two(e) for e in units]))

    def grid(self, digits: int, steps: int = _LONG_SPAN) -> Grid:
        """Bits for these digits of the smallest block, after what coefficients and steps make of a bit."""
        blocks = [exponent(self.start[i : i + 3]) for i in range(0, self.moving, 3)]
        small = max(0, *(-exponent for exponent in blocks if exponent is not None), 0)
        rows = [*self.forms, *(rate for _, rate in self.rates)]
        strong = max(
            (sum(map(abs, row.numerators)) // row.denominator).bit_length() for row in rows
        )
        slack = _SLACK_BITS + strong
        guard = _SLACK_BITS + steps.bit_length()
        bits = ceil(digits * _BITS_PER_DIGIT) + guard + strong + small
        return Grid(bits, slack, digits // STEP_DIGITS % 2)

    @cached_property
    def is_still(self) -> tuple[bool, ...]:
        """True for each state that the equations keep exactly at zero, or that has no rate at all.

        A state leaves zero by its constant, or by a product of two variables that are not zero. What
        is zero by cancellation counts as moving.
        """
        size = len(self.start)
        constants = self.constant + (Fraction(0),) * size
        nonzero = [bool(z or c) for z, c in zip(self.start, constants, strict=False)]
        while True:
            forms = [
                any(n and z for n, z in zip(form.numerators, nonzero, strict=False))
                for form in self.forms
            ]
            every = nonzero + forms
            driven = [every[a] and every[b] for a, b in self.products]
            fresh = [
                z or any(driven[place] for place in places)
                for z, (places, _) in zip(nonzero, self.rates, strict=True)
            ]
            if fresh == nonzero:
                break
            nonzero = fresh
        has_rate = [
            bool(places or c) for (places, _), c in zip(self.rates, constants, strict=False)
        ]
        return tuple(not (z and r) for z, r in zip(nonzero, has_rate, strict=True))

    def reals(self, state: Sequence[int], grid: Grid) -> list[Any]:
        """The state in the scene's own units, exactly, whatever the ambient precision."""
        units = self.units.variables[: len(state)]
        return [
            mp.make_mpf(libmp.from_man_exp(count, unit - grid.bits))
            for count, unit in zip(state, units, strict=True)
        ]


def problem(equations: Equations, units: Units, start: Vector, moving: int) -> Problem:
    """The equations with the start, exactly, in these units."""
    size, products = len(start), sorted({pair for p in equations.right for pair in p})
    unit = [power_of_two(exponent) for exponent in units.variables]
    per_time = [power_of_two(units.time) / one for one in unit]
    places = {pair: place for place, pair in enumerate(products)}
    return Problem(
        units=units,
        start=_scaled(start, unit[:size]),
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


def _scaled(vector: Vector, units: Sequence[Fraction]) -> Vector:
    return tuple(z / one for z, one in zip(vector, units, strict=True))


def _combination(coefficients: Sequence[Fraction]) -> Combination:
    denominator = lcm(*(c.denominator for c in coefficients))
    numerators = (c.numerator * (denominator // c.denominator) for c in coefficients)
    return Combination(tuple(map(Integer, numerators)), denominator)


# The recursion.


def march(
    problem: Problem, times: Sequence[Fraction], grid: Grid, width: Fraction
) -> dict[Fraction, list[int]]:
    """The states at these times, which lie on one side of 0 and go away from it.

    ``width`` is a guess of the first step, with the sign of the times: `first_width` makes one.
    """
    unit, noise = power_of_two(problem.units.time), grid.noise()
    state, now, last = grid.integers(problem.start), Fraction(0), times[-1] / unit
    reached: dict[Fraction, list[int]] = {}
    steps, pending = 0, list(times[::-1])
    while pending:
        state = [
            z if still else z + next(noise)
            for z, still in zip(state, problem.is_still, strict=True)
        ]
        series = _series(problem, state, width, grid)
        growth = _log2_reach(series, problem.moving, grid)
        step = grid.step(width, min(growth, 0.0))
        while pending and abs(pending[-1] / unit - now) <= abs(step):
            time = pending.pop()
            reached[time] = _value(series, (time / unit - now) / width, grid)
        steps += 1
        _refuse_endless(steps + abs(last - now) / abs(step), times[-1])
        state, now = _value(series, step / width, grid), now + step
        # The next step may be longer.
        width = grid.step(width, min(growth + _A_LITTLE_WIDER, 1.0))
    return reached


def leap(problem: Problem, span: Fraction, grid: Grid) -> list[int]:
    """The state after a time so short that most often one series reaches."""
    width = span / power_of_two(problem.units.time)
    if not width:
        return grid.integers(problem.start)
    return march(problem, [span], grid, grid.step(width, _A_LITTLE_WIDER))[span]


def _series(problem: Problem, state: list[int], width: Fraction, grid: Grid) -> list[list[int]]:
    """Taylor coefficients of every state, those of order k held multiplied by width^k.

    They end where terms have become too small to matter, which in a short series is before its order.
    """
    forms, products = problem.forms, problem.products
    rates = [_Rate.of(places, rate, width, grid.bits) for places, rate in problem.rates]
    forward = [[z] for z in state]
    forward += [[_combined(form, state)] for form in forms]
    # The second factor of a convolution is kept in reverse, so that the two lists just pair up.
    backward = {b: forward[b][:] for _, b in products}
    pairs = [(a == b, forward[a], backward[b]) for a, b in products]
    enough, small, last_terms = 1 << grid.slack, 0, grid.last_terms
    for k in range(grid.order):
        sums = [_square(p, q) if same else sum(map(mul, p, q)) for same, p, q in pairs]
        fresh = [
            (sum(map(mul, factors, map(sums.__getitem__, places))) >> shift) // (odd * (k + 1))
            for places, factors, shift, odd in rates
        ]
        if k == 0:
            for i, drift in enumerate(grid.integers(width * c for c in problem.constant)):
                fresh[i] += drift
        fresh += [_combined(form, fresh) for form in forms]
        for coefficients, z in zip(forward, fresh, strict=True):
            coefficients.append(z)
        for b, coefficients in backward.items():
            coefficients.insert(0, fresh[b])
        small = small + 1 if all(-enough <= z <= enough for z in fresh) else 0
        if small == last_terms:
            break
    return forward[: len(state)]


def _square(forward: list[int], backward: list[int]) -> int:
    """The last coefficient of a series' square: its terms are equal by twos but for a middle one."""
    half, odd = divmod(len(forward), 2)
    twice: int = 2 * sum(map(mul, forward[:half], backward))
    return twice + forward[half] ** 2 if odd else twice


class _Rate(NamedTuple):
    """What one state's rate makes of the products, for one width: sum of factors[i] products[i].

    To be divided by 2^shift and, at order k, by odd (k + 1): two roundings downwards are like one.
    """

    places: tuple[int, ...]
    factors: tuple[int, ...]
    shift: int
    odd: int

    @classmethod
    def of(cls, places: tuple[int, ...], rate: Combination, width: Fraction, bits: int) -> _Rate:
        whole = rate.denominator * width.denominator
        shift = (whole & -whole).bit_length() - 1
        factors = tuple(n * width.numerator for n in rate.numerators)
        return cls(places, factors, shift + bits, whole >> shift)


def _combined(form: Combination, state: list[int]) -> int:
    """A form of the states it is made of, which come first."""
    total: int = sum(map(mul, form.numerators, state))
    return total // form.denominator


def _value(series: list[list[int]], fraction: Fraction, grid: Grid) -> list[int]:
    """The states at this fraction of the series' width."""
    bits = grid.bits
    argument = Integer(round(fraction * 2**bits))
    powers = [Integer(1) << bits]
    for _ in series[0][1:]:
        powers.append(powers[-1] * argument >> bits)
    return [sum(map(mul, coefficients, powers)) >> bits for coefficients in series]


def _log2_reach(series: list[list[int]], moving: int, grid: Grid) -> float:
    """log2 of the fraction of the width at which the last terms fall below the slack.

    A root test over the last terms. 1 where those terms are all zero: the width can then be doubled
    without harm. Where the motion has outgrown its units, so have the roundings, and the slack with
    them.
    """
    order, bits_per_order = len(series[0]) - 1, 1 / grid.orders_per_bit
    outgrown = max(abs(z[0]) for z in series[:moving]).bit_length() - grid.bits
    slack = grid.slack + max(0, outgrown)
    reach = 1.0
    for k in range(order + 1 - grid.last_terms, order + 1):
        size = max(abs(z[k]) for z in series).bit_length()
        if size:
            reach = min(reach, ((order - k) * bits_per_order + slack - size) / k)
    return reach


def first_width(problem: Problem, last: Fraction, grid: Grid) -> Fraction:
    """A first guess of the step towards a time, from short series; never beyond that time."""
    span = last / power_of_two(problem.units.time)
    bits = grid.slack + _PILOT_BITS
    pilot = Grid(bits, grid.slack, grid.parity)
    start = pilot.integers(problem.start)
    width = grid.step(span if span else Fraction(1), 0.0)
    for _ in range(3):
        reach = _log2_reach(_series(problem, start, width, pilot), problem.moving, pilot)
        width = grid.step(width, min(reach, 0.0))
        # The first step finds its own length: within a factor of two its guess is good enough.
        if reach > -1:
            break
    return width


def _refuse_endless(steps: Fraction, span: Fraction) -> None:
    if steps > _MOST_STEPS:
        raise Unsettled(
            f"the Taylor recursion would take about {float(steps):.1e} steps to reach "
            f"{float(span):g}; expected at most {_MOST_STEPS}: ask for a shorter time"
        )
