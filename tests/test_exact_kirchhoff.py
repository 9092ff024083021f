"""Clebsch's body in closed form, held to its equations, its integrals and a Taylor series of its own."""

from __future__ import annotations

import random
from collections.abc import Sequence
from fractions import Fraction

import pytest
from mpmath import mp, mpf

from verify.exact.kirchhoff.jacobi import closed_form
from verify.exact.kirchhoff.quartic import Nutation, RealRoots, value
from verify.exact.solution import NoClosedForm, Solution
from verify.scenes.bodies import Clebsch, ImmersedBody
from verify.scenes.motion import Clock, Impulse
from verify.scenes.scene import Scene
from verify.scenes.tensors import Vector

State = Sequence[Fraction]  # x1 x2 x3 y1 y2 y3
Six = list[mpf]

DIGITS = 40
# The solution promises DIGITS of |x| and of |y| apart, which here are below 100 each; the Taylor
# series and the differences below are carried far enough to be two digits better than that.
AGREEMENT = Fraction(1, 10 ** (DIGITS - 2))


def exact(*texts: str | int) -> tuple[Fraction, ...]:
    return tuple(Fraction(text) for text in texts)


def body(*six: str | int) -> Clebsch:
    """p, p', q, q', r, r'."""
    return Clebsch(*exact(*six))


def scene(
    solid: Clebsch | ImmersedBody, start: State, track: frozenset[str] = frozenset()
) -> Scene:
    immersed = solid.body() if isinstance(solid, Clebsch) else solid
    x, y = tuple(start[:3]), tuple(start[3:])
    clock = Clock(Fraction(0), (Fraction(1),))
    return Scene("test", "test", "kirchhoff", track, immersed, Impulse(x, y), clock)


def states(solution: Solution, times: Sequence[Fraction], digits: int) -> list[Six]:
    """One evaluation, without the agreement of two."""
    numbers = solution.evaluate(times, digits)
    pairs = zip(numbers["linear_impulse"], numbers["angular_impulse"], strict=True)
    return [[*x, *y] for x, y in pairs]


def state(solid: Clebsch, start: State, time: Fraction, digits: int = DIGITS) -> Six:
    """The state to ``digits``, as the rest of the project asks for it."""
    motion = closed_form(scene(solid, start)).motion([time], digits)
    return [*motion["linear_impulse"][0], *motion["angular_impulse"][0]]


def distance(a: Sequence[mpf | Fraction], b: Sequence[mpf | Fraction], digits: int) -> mpf:
    with mp.workdps(digits + 20):
        pairs = zip(a, b, strict=True)
        return max(abs(mp.convert(p) - mp.convert(q)) for p, q in pairs)


# The equations, written here once more, and their Taylor series: nothing elliptic, nothing shared.


def velocities(solid: Clebsch, s: Sequence[mpf]) -> tuple[Six, Six]:
    """U = dT/dx and Omega = dT/dy of Hydromechanics 49 (1)."""
    linear = [mp.convert(c) for c in (solid.p, solid.p, solid.p_prime)]
    screw = [mp.convert(c) for c in (solid.q, solid.q, solid.q_prime)]
    angular = [mp.convert(c) for c in (solid.r, solid.r, solid.r_prime)]
    U = [linear[i] * s[i] + screw[i] * s[3 + i] for i in range(3)]
    Omega = [screw[i] * s[i] + angular[i] * s[3 + i] for i in range(3)]
    return U, Omega


def cross(a: Sequence[mpf], b: Sequence[mpf]) -> Six:
    return [a[i - 2] * b[i - 1] - a[i - 1] * b[i - 2] for i in range(3)]


def derivative(solid: Clebsch, s: Sequence[mpf]) -> Six:
    """x' = x x Omega, y' = y x Omega + x x U."""
    U, Omega = velocities(solid, s)
    turning = zip(cross(s[3:], Omega), cross(s[:3], U), strict=True)
    return cross(s[:3], Omega) + [a + b for a, b in turning]


def series(solid: Clebsch, s: Six, order: int) -> list[Six]:
    """The Taylor coefficients of the six components, each a list from the constant term upwards.

    The equations are quadratic, so coefficient n + 1 is a sum of products of the earlier ones.
    """
    state: list[Six] = [[a] for a in s]
    speed: list[Six] = [[], [], [], [], [], []]  # U and Omega

    def product(a: list[Six], b: list[Six], i: int) -> mpf:
        """Component i of the newest coefficient of a x b."""
        j, k = (i + 1) % 3, (i + 2) % 3
        return mp.fdot(a[j], b[k][::-1]) - mp.fdot(a[k], b[j][::-1])

    for n in range(order):
        U, Omega = velocities(solid, [a[n] for a in state])
        for coefficients, newest in zip(speed, U + Omega, strict=True):
            coefficients.append(newest)
        x, y = state[:3], state[3:]
        new = [product(x, speed[3:], i) for i in range(3)]
        new += [product(y, speed[3:], i) + product(x, speed[:3], i) for i in range(3)]
        for coefficients, newest in zip(state, new, strict=True):
            coefficients.append(newest / (n + 1))
    return state


def stepped(solid: Clebsch, s: Six, left: mpf) -> tuple[Six, mpf]:
    """One step towards ``left``, and what is left then."""
    order = int(1.2 * mp.dps)
    rows = series(solid, s, order)
    # The n-th root of the n-th coefficient tends to 1/radius of convergence. At a seventh of that
    # radius the first term left out is 7^-(1.2 dps) < 10^-dps.
    growth = max(abs(row[n]) ** (mpf(1) / n) for row in rows for n in range(1, order + 1))
    h = min(1 / (7 * growth), abs(left)) * mp.sign(left)
    powers = [h**n for n in range(order + 1)]
    return [mp.fdot(row, powers) for row in rows], left - h


def taylor(solid: Clebsch, start: State, time: Fraction, digits: int = DIGITS) -> Six:
    with mp.workdps(digits + 10):
        s, left = [mp.convert(c) for c in start], mp.convert(time)
        while left != 0:
            s, left = stepped(solid, s, left)
        return s


# Bodies and starts: one per regime and per difficulty.

SHARP = body(1, 2, "1/10", "3/10", 1, "1/2")  # p' > p: four real roots
BLUNT = body(2, 1, "1/10", "3/10", 1, "1/2")  # p' < p: two or four
EVEN = body(1, 1, "1/10", "3/10", 1, "1/2")  # p' = p: a cubic
PLAIN = body(1, 2, 0, 0, 1, "1/2")  # no screw coupling
CHIRAL = body("3/2", 1, "1/5", "1/5", "4/5", "1/2")  # q' = q
GENERIC = exact("1/2", "1/3", 1, "1/5", "-1/4", 1)
TINY = Fraction(1, 10**10)

CASES = {
    "four real roots": (SHARP, GENERIC, "four-roots"),
    "four real roots, the two largest": (
        body(3, 1, "-1/10", "7/20", 2, 1),
        exact(1, 1, "3/4", "1/4", "-1/4", "-1/8"),
        "four-roots",
    ),
    "four real roots, the two smallest": (
        body(5, 1, "1/10", "-2/5", 2, 1),
        exact("1/2", "-1/2", -1, "1/8", "3/8", "1/8"),
        "four-roots",
    ),
    "two real roots": (BLUNT, GENERIC, "two-roots"),
    "cubic, third root above": (EVEN, GENERIC, "cubic"),
    "cubic, third root below": (EVEN, exact("1/2", "1/3", 1, "1/5", "-1/4", -1), "cubic"),
    "no screw coupling": (PLAIN, GENERIC, "four-roots"),
    "q' = q": (CHIRAL, GENERIC, "two-roots"),
    "start at the lower turning point": (SHARP, exact(1, 1, 2, "1/3", "1/3", 2), "four-roots"),
    "start at the upper turning point": (BLUNT, exact(1, 1, 2, "1/3", "1/3", 3), "two-roots"),
    "through the pole": (SHARP, exact("3/5", 0, "4/5", "1/3", "1/7", 1), "four-roots"),
    "through the lower pole": (BLUNT, exact("3/5", 0, "4/5", 3, "1/7", -1), "two-roots"),
    "start on the axis": (EVEN, exact(0, 0, 1, "1/3", "1/7", 2), "cubic"),
    "start on the axis, two roots": (BLUNT, exact(0, 0, -2, "1/3", "1/7", 2), "two-roots"),
    "planar, over both poles": (
        BLUNT,
        exact("3/5", "1/5", "4/5", "1/5", "-3/5", 0),
        "four-roots",
    ),
    "planar, |x| irrational": (BLUNT, exact(1, 1, 2, 1, -1, 0), "four-roots"),
    "near the pole": (
        BLUNT,
        (*exact("3/5", 0, "4/5", "1/3", "1/7"), 1 - TINY),
        "two-roots",
    ),
    "near the separatrix": (
        SHARP,
        (TINY, Fraction(0), Fraction(1), Fraction(0), TINY / 3, Fraction(1, 5)),
        "four-roots",
    ),
    "nearly p' = p": (body(1, 1 + TINY**2, "1/10", "3/10", 1, "1/2"), GENERIC, "four-roots"),
    "nearly steady": (
        BLUNT,
        (TINY, Fraction(0), Fraction(1), Fraction(0), TINY / 3, Fraction(1, 5)),
        "two-roots",
    ),
    "steady": (
        body(1, "92/81", "1/10", "3/10", 1, "1/2"),  # p' solves f'(4/5) = 0
        exact("3/5", 0, "4/5", "1/3", 0, 1),
        "steady",
    ),
}

by_case = pytest.mark.parametrize(
    ("solid", "start", "regime"), list(CASES.values()), ids=list(CASES)
)


@by_case
def test_starts_where_it_is_told_to(solid: Clebsch, start: State, regime: str) -> None:
    """The closed form names its regime, and at time zero it is the initial state."""
    solution = closed_form(scene(solid, start))
    assert solution.regime == regime
    assert distance(state(solid, start, Fraction(0)), start, DIGITS) <= AGREEMENT


@by_case
def test_obeys_the_equations_of_motion(solid: Clebsch, start: State, regime: str) -> None:
    """x' = x x Omega and y' = y x Omega + x x U, at a time beyond several periods."""
    # Eighth-order differences at h: the error is h^8 D^9/630. No rate here is above 10 per unit of
    # time, so it is below 1e-48 * 1e9 / 630; rounding leaves 10^-digits / h.
    h, digits = Fraction(1, 10**6), DIGITS + 10
    weights = (Fraction(4, 5), Fraction(-1, 5), Fraction(4, 105), Fraction(-1, 280))
    middle = Fraction(-239, 7)
    steps = range(-len(weights), len(weights) + 1)
    near = states(closed_form(scene(solid, start)), [middle + k * h for k in steps], digits)
    with mp.workdps(digits + 10):
        found = [
            sum(
                mp.convert(weight / h) * (near[4 + k][i] - near[4 - k][i])
                for k, weight in enumerate(weights, 1)
            )
            for i in range(6)
        ]
        assert distance(found, derivative(solid, near[4]), digits) <= AGREEMENT


@by_case
def test_agrees_with_a_taylor_series(solid: Clebsch, start: State, regime: str) -> None:
    """The closed form is the solution that starts there: a Taylor series finds the same state."""
    time = Fraction(5, 2)
    assert distance(state(solid, start, time), taylor(solid, start, time), DIGITS) <= AGREEMENT
