"""A yardstick for the enclosure: two plain Taylor runs at two precisions, compared by nobody.

Such a pair, believed where it agrees, is the cheapest truth without a proof. Numbers are integers that
count 2^-bits; nothing is bounded, and no component has a unit of its own.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import ceil, lcm
from operator import mul

from mpmath import libmp

from taylor_verify.exact import clocks
from taylor_verify.exact.registry import kind_of
from taylor_verify.numbers.precision import floor_log2, power_of_two
from taylor_verify.scenes.scene import Scene

# Of the two runs, beyond the digits asked for: what one rounding may become, and how they differ.
GUARD_DIGITS, APART_DIGITS = 3, 12
# What the roundings of all steps may come to, and what the truncation of one may leave, in last bits.
GUARD_BITS, SLACK_BITS, STEP_BITS = 24, 12, 6
ORDERS_PER_BIT = 0.36

Integer = libmp.MPZ
Polynomial = Mapping[tuple[int, int], Fraction]


@dataclass(frozen=True)
class Rate:
    """(constant + sum of factors[i] times the product at places[i])/divisor, of one variable."""

    constant: Fraction
    places: list[int]
    factors: list[int]
    divisor: int


@dataclass(frozen=True)
class Equations:
    """v' = rates of products of two variables, from ``start``; ``forms`` of the states come after them.

    Variable ``added[i]``, if there is one, is added to rate i.
    """

    start: list[Fraction]
    products: list[tuple[int, int]]
    rates: list[Rate]
    forms: list[tuple[list[int], int]]
    added: Mapping[int, int]


def equations(scene: Scene) -> Equations:
    """Those of the state and, where it is tracked, of a quaternion and of the way in body axes."""
    body, kind = scene.body, kind_of(scene.body)
    motion = body.manufactured
    driven = kind.equations(body).driven(motion)
    n, with_centre = len(driven.constant), "centre" in scene.track
    rates: list[Polynomial] = [polynomial(row, n) for row in driven.hessian.reshape(n, -1)]
    start, forms = list(kind.state(scene.initial)), list(driven.spin) if scene.track else []
    if n > len(start):
        start += clocks.start(motion or clocks.standing(len(start)))
    added: dict[int, int] = {}
    if scene.track:
        size = n + (7 if with_centre else 4)
        half, (q, d) = Fraction(1, 2), (n, n + 4)
        # q' = q Omega/2 and d' = U + d x Omega.
        rates.append({(q + 1 + i, size + i): -half for i in range(3)})
        for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
            turned = {(q + 1 + j, size + k): half, (q + 1 + k, size + j): -half}
            rates.append({(q, size + i): half, **turned})
        start += [Fraction(int(i == 0)) for i in range(4)]
        if with_centre:
            forms += list(driven.velocity)
            for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
                rates.append({(d + j, size + k): Fraction(1), (d + k, size + j): Fraction(-1)})
                added[d + i] = size + 3 + i
            start += [Fraction(0)] * 3
    products = sorted({pair for rate in rates for pair in rate})
    place = {pair: number for number, pair in enumerate(products)}
    constants = tuple(driven.constant) + (Fraction(0),) * (len(rates) - n)
    combined = [combination(list(form)) for form in forms]
    return Equations(
        start,
        products,
        [
            Rate(c, [place[pair] for pair in rate], *combination(list(rate.values())))
            for rate, c in zip(rates, constants, strict=True)
        ],
        combined,
        added,
    )


def polynomial(hessian: Sequence[Fraction], size: int) -> Polynomial:
    """The quadratic form with these second derivatives, row after row."""
    return {
        (a, b): hessian[a * size + b] / (2 if a == b else 1)
        for a in range(size)
        for b in range(a, size)
        if hessian[a * size + b]
    }


def combination(coefficients: Sequence[Fraction]) -> tuple[list[int], int]:
    """Numerators over one denominator."""
    divisor = lcm(*(c.denominator for c in coefficients))
    return [Integer(c.numerator * (divisor // c.denominator)) for c in coefficients], divisor


def two_runs(scene: Scene, elapsed: Sequence[Fraction], digits: int) -> list[list[list[int]]]:
    """The variables at the times, which lie on one side of 0 in their order, by either run."""
    posed_once = equations(scene)
    runs = []
    for more in (GUARD_DIGITS, GUARD_DIGITS + APART_DIGITS):
        bits = ceil((digits + more) * 3.3219280948873626) + GUARD_BITS
        runs.append(run(posed_once, [t for t in elapsed if t], bits))
    return runs


def run(posed_once: Equations, times: Sequence[Fraction], bits: int) -> list[list[int]]:
    """The variables at the times, in units of 2^-bits."""
    state = [fixed(z, bits) for z in posed_once.start]
    now, width, pending, rows = Fraction(0), cut(times[-1], 0), list(times[::-1]), []
    while pending:
        rows_of = coefficients(posed_once, state, width, bits)
        reach = root_test(rows_of)
        if reach < -1:
            # Powers of so small a share would have no bits: the first width is a mere guess.
            width = cut(width, reach)
            continue
        step = width if reach >= 0 else cut(width, reach)
        while pending and abs(pending[-1] - now) <= abs(step):
            rows.append(value(rows_of, (pending.pop() - now) / width, bits))
        state, now = value(rows_of, step / width, bits), now + step
        width = cut(width, min(reach + 0.1, 1.0))
    return rows


def coefficients(
    posed_once: Equations, state: list[int], width: Fraction, bits: int
) -> list[list[int]]:
    """The series of each state, order k times width^k."""
    order, scale = ceil(ORDERS_PER_BIT * (bits - SLACK_BITS)), Integer(width.numerator)
    forms = posed_once.forms
    forward = [[z] for z in state] + [[formed(form, state)] for form in forms]
    backward = [[z[0]] for z in forward]
    pairs = [(a == b, forward[a], backward[b]) for a, b in posed_once.products]
    for k in range(order):
        sums = [square(p, q) if same else sum(map(mul, p, q)) for same, p, q in pairs]
        fresh = []
        for i, rate in enumerate(posed_once.rates):
            total = sum(map(mul, rate.factors, map(sums.__getitem__, rate.places)))
            total = (total >> bits) // rate.divisor
            if i in posed_once.added:
                total += forward[posed_once.added[i]][k]
            if k == 0:
                total += fixed(rate.constant, bits)
            fresh.append(total * scale // (width.denominator * (k + 1)))
        fresh += [formed(form, fresh) for form in forms]
        for rows, reverse, z in zip(forward, backward, fresh, strict=True):
            rows.append(z)
            reverse.insert(0, z)
    return forward[: len(state)]


def square(forward: list[int], backward: list[int]) -> int:
    """The last coefficient of a square: its terms are equal by twos but for a middle one."""
    half, odd = divmod(len(forward), 2)
    twice: int = 2 * sum(map(mul, forward[:half], backward))
    return twice + forward[half] ** 2 if odd else twice


def formed(form: tuple[list[int], int], state: Sequence[int]) -> int:
    """A linear form of the states that come first."""
    factors, divisor = form
    total: int = sum(map(mul, factors, state))
    return total // divisor


def value(rows: list[list[int]], share: Fraction, bits: int) -> list[int]:
    """The sums at this share of the width."""
    s = fixed(share, bits)
    powers = [Integer(1) << bits]
    for _ in rows[0][1:]:
        powers.append(powers[-1] * s >> bits)
    return [sum(map(mul, row, powers)) >> bits for row in rows]


def root_test(rows: list[list[int]]) -> float:
    """log2 of the factor at which the last terms fall to the slack."""
    order = len(rows[0]) - 1
    sizes = {k: max(abs(row[k]) for row in rows).bit_length() for k in range(order - 3, order + 1)}
    return min(((SLACK_BITS - size) / k for k, size in sizes.items() if size), default=1.0)


def fixed(number: Fraction, bits: int) -> int:
    return Integer(round(number * 2**bits))


def cut(width: Fraction, log2_factor: float) -> Fraction:
    """The width times 2^log2_factor, cut to six bits."""
    whole = int(log2_factor // 1)
    wide = width * power_of_two(whole) * Fraction(2.0 ** (log2_factor - whole))
    unit = power_of_two(floor_log2(abs(wide)) - STEP_BITS + 1)
    return int(wide / unit) * unit
