"""Clebsch's body in closed form, held to its equations, its integrals and a Taylor series."""

from __future__ import annotations

import random
from collections.abc import Sequence
from fractions import Fraction

import pytest
from builders.clebsch import GENERIC, PLAIN, Six, State, around, body, derivative, slope, velocities
from builders.scenes import one_instant, vector
from builders.turns import by_turns
from mpmath import mp, mpf

from taylor_verify.exact.kirchhoff.closed import closed_form
from taylor_verify.exact.kirchhoff.quartic import Nutation, value
from taylor_verify.exact.solution import NoClosedForm, Solution
from taylor_verify.scenes.bodies import Clebsch, ImmersedBody
from taylor_verify.scenes.motion import Impulse
from taylor_verify.scenes.precision import power_of_two
from taylor_verify.scenes.reading.reader import load
from taylor_verify.scenes.scene import Scene
from taylor_verify.scenes.tensors import diagonal

DIGITS = 40
# The solution promises DIGITS of |x| and of |y| apart, which here are below 100 each; the Taylor
# series and the differences below are carried far enough to be two digits better than that.
AGREEMENT = Fraction(1, 10 ** (DIGITS - 2))


def scene(
    solid: Clebsch | ImmersedBody, start: State, track: frozenset[str] = frozenset()
) -> Scene:
    immersed = solid.body() if isinstance(solid, Clebsch) else solid
    x, y = tuple(start[:3]), tuple(start[3:])
    return one_instant(immersed, Impulse(x, y), *track)


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
    growth = max(abs(row[n]) ** (mpf(1) / n) for row in rows for n in range(order // 2, order + 1))
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
CHIRAL = body("3/2", 1, "1/5", "1/5", "4/5", "1/2")  # q' = q
TINY = Fraction(1, 10**10)

CASES = {
    "four real roots": (SHARP, GENERIC, "four-roots"),
    "four real roots, the two largest": (
        body(3, 1, "-1/10", "7/20", 2, 1),
        vector(1, 1, "3/4", "1/4", "-1/4", "-1/8"),
        "four-roots",
    ),
    "four real roots, the two smallest": (
        body(5, 1, "1/10", "-2/5", 2, 1),
        vector("1/2", "-1/2", -1, "1/8", "3/8", "1/8"),
        "four-roots",
    ),
    "two real roots": (BLUNT, GENERIC, "two-roots"),
    "cubic, third root above": (EVEN, GENERIC, "cubic"),
    "cubic, third root below": (EVEN, vector("1/2", "1/3", 1, "1/5", "-1/4", -1), "cubic"),
    "no screw coupling": (PLAIN, GENERIC, "four-roots"),
    "q' = q": (CHIRAL, GENERIC, "two-roots"),
    "start at the lower turning point": (SHARP, vector(1, 1, 2, "1/3", "1/3", 2), "four-roots"),
    "start at the upper turning point": (BLUNT, vector(1, 1, 2, "1/3", "1/3", 3), "two-roots"),
    "through the pole": (SHARP, vector("3/5", 0, "4/5", "1/3", 2, 1), "four-roots"),
    "through the lower pole": (BLUNT, vector("3/5", 0, "4/5", 3, "1/7", -1), "two-roots"),
    "start on the axis": (EVEN, vector(0, 0, 1, "1/3", "1/7", 2), "cubic"),
    "start on the axis, two roots": (BLUNT, vector(0, 0, -2, "1/3", "1/7", 2), "two-roots"),
    "planar, over both poles": (
        BLUNT,
        vector("3/5", "1/5", "4/5", "1/5", "-3/5", 0),
        "four-roots",
    ),
    "planar, |x| irrational": (BLUNT, vector(1, 1, 2, 1, -1, 0), "four-roots"),
    "near the pole": (
        BLUNT,
        (*vector("3/5", 0, "4/5", "1/3", "1/7"), 1 - TINY),
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
        vector("3/5", 0, "4/5", "1/3", 0, 1),
        "steady",
    ),
}

by_case = pytest.mark.parametrize(
    ("solid", "start", "regime"), list(CASES.values()), ids=list(CASES)
)
of_each_regime = pytest.mark.parametrize(
    ("solid", "start", "regime"),
    by_turns(CASES.values(), 3, lambda solid, start, regime: regime),
    ids=list(CASES),
)


@by_case
def test_starts_where_it_is_told_to(solid: Clebsch, start: State, regime: str) -> None:
    """The closed form names its regime, and at time zero it is the initial state."""
    solution = closed_form(scene(solid, start))
    assert solution.regime == regime
    assert distance(state(solid, start, Fraction(0)), start, DIGITS) <= AGREEMENT


@of_each_regime
def test_obeys_the_equations_of_motion(solid: Clebsch, start: State, regime: str) -> None:
    """x' = x x Omega and y' = y x Omega + x x U, at a time beyond several periods."""
    # No rate here is above 10 per unit of time: differences err by less than 1e-48 * 1e9 / 630.
    h, digits = Fraction(1, 10**6), DIGITS + 10
    times = around(Fraction(-239, 7), h)
    near = states(closed_form(scene(solid, start)), times, digits)
    with mp.workdps(digits + 10):
        assert distance(slope(near, h), derivative(solid, near[4]), digits) <= AGREEMENT


@pytest.mark.slow
@by_case
def test_agrees_with_a_taylor_series(solid: Clebsch, start: State, regime: str) -> None:
    """The closed form is the solution that starts there: a Taylor series finds the same state."""
    time = Fraction(3, 2)
    assert distance(state(solid, start, time), taylor(solid, start, time), DIGITS) <= AGREEMENT


def random_body(seed: int, pattern: str) -> tuple[Clebsch, State]:
    """A positive definite body (p r > q^2, p' r' > q'^2) and a start, in small rationals."""
    rng = random.Random(seed)

    def between(low: int, high: int) -> Fraction:
        return Fraction(rng.randint(20 * low, 20 * high), 20)

    p, p_prime, r, r_prime = (between(1, 3) for _ in range(4))
    q, q_prime = between(-1, 1) / 2, between(-1, 1) / 2
    solid = Clebsch(
        p=p,
        p_prime=p if pattern == "p' = p" else p_prime,
        q=q,
        q_prime=q if pattern == "q' = q" else q_prime,
        r=r,
        r_prime=r_prime,
    )
    return solid, tuple(between(-2, 2) for _ in range(6))


seeds = pytest.mark.parametrize("seed", range(4))


@seeds
@pytest.mark.parametrize("pattern", ["", "p' = p", "q' = q"])
def test_keeps_the_integrals(seed: int, pattern: str) -> None:
    """T, F^2, FG and y3 keep their initial, rational values on random bodies."""
    solid, start = random_body(seed, pattern)
    nutation = Nutation.of(solid, Impulse(tuple(start[:3]), tuple(start[3:])))
    times = [Fraction(1, 3), Fraction(-1000, 7)]
    with mp.workdps(DIGITS + 10):
        energy = _energy(solid, [mp.convert(c) for c in start])
        promised = [energy, *map(mp.convert, (nutation.F2, nutation.FG, nutation.y3))]
        for s in states(closed_form(scene(solid, start)), times, DIGITS + 5):
            x, y = s[:3], s[3:]
            integrals = [_energy(solid, s), mp.fdot(x, x), mp.fdot(x, y), y[2]]
            # Each is quadratic in numbers below 10: an error grows at most a hundredfold.
            assert distance(integrals, promised, DIGITS) <= AGREEMENT


def _energy(solid: Clebsch, s: Sequence[mpf]) -> mpf:
    U, Omega = velocities(solid, s)
    return (mp.fdot(s[:3], U) + mp.fdot(s[3:], Omega)) / 2


@pytest.mark.parametrize("seed", by_turns(range(4)))
@pytest.mark.parametrize("pattern", ["", "p' = p", "q' = q"])
def test_is_a_flow(seed: int, pattern: str) -> None:
    """Going on from a state on the way leads to the same end as going through."""
    solid, start = random_body(seed, pattern)
    first, second = Fraction(37, 3), Fraction(-251, 9)
    # The restart holds 60 digits; what it leaves out grows linearly, by less than 1e6 in this time.
    half_way = [_rational(c) for c in state(solid, start, first, 60)]
    through = state(solid, start, first + second)
    assert distance(state(solid, half_way, second), through, DIGITS) <= AGREEMENT


def _rational(number: mpf) -> Fraction:
    sign, mantissa, exponent, _ = number._mpf_
    size = int(mantissa) * power_of_two(int(exponent))
    return -size if sign else size


@of_each_regime
def test_runs_backwards_as_forwards(solid: Clebsch, start: State, regime: str) -> None:
    """The motion from (-x, -y) is the motion from (x, y) in reverse, with both signs changed."""
    time = Fraction(77, 10)
    forwards = state(solid, start, time)
    backwards = state(solid, [-c for c in start], -time)
    with mp.workdps(DIGITS + 40):  # a sign changed outside would round
        backwards = [-c for c in backwards]
    assert distance(backwards, forwards, DIGITS) <= AGREEMENT


@pytest.mark.slow
@pytest.mark.parametrize("solid", [SHARP, BLUNT, EVEN], ids=["four", "two", "cubic"])
def test_a_billion_units_of_time_are_a_whole_number_of_nutations(solid: Clebsch) -> None:
    """At t = 1e9 the state is that of a Taylor series over one nutation, turned about axis 3.

    After a nutation of period N the state returns but for an angle D about axis 3, so at
    t = n N + s it is the state at s turned by n D. N and D come from the series alone.
    """
    time = Fraction(10**9)
    digits = DIGITS + 20  # n is about 1e9: N and D lose nine digits, and the rates one or two
    with mp.workdps(digits):
        period, angle = _nutation(solid, [mp.convert(c) for c in GENERIC])
        whole = int(mp.floor(mp.convert(time) / period))
        turn = mp.expj(whole * angle)
        s, left = [mp.convert(c) for c in GENERIC], mp.convert(time) - whole * period
        while left != 0:
            s, left = stepped(solid, s, left)
        x, y = turn * mp.mpc(s[0], s[1]), turn * mp.mpc(s[3], s[4])
        expected = [x.real, x.imag, s[2], y.real, y.imag, s[5]]
    assert distance(state(solid, GENERIC, time), expected, DIGITS) <= AGREEMENT


def _nutation(solid: Clebsch, start: Six) -> tuple[mpf, mpf]:
    """The period of x3 and the angle (modulo 2 pi) by which (x1, x2) has turned after it."""
    s, elapsed = start, mpf(0)

    def ahead(s: Six) -> bool:
        """Past the start in x3, and moving as at the start."""
        pace, pace_0 = derivative(solid, s)[2], derivative(solid, start)[2]
        return bool(pace * pace_0 > 0 and (s[2] - start[2]) * pace_0 >= 0)

    left_start = False
    while not (left_start and ahead(s)):
        s, left = stepped(solid, s, mpf(1))
        elapsed += 1 - left
        left_start = left_start or not ahead(s)
    for _ in range(7):  # Newton doubles the first digit or two, to more than there are
        left = (start[2] - s[2]) / derivative(solid, s)[2]
        elapsed += left
        while left != 0:
            s, left = stepped(solid, s, left)
    return elapsed, mp.arg(mp.mpc(s[0], s[1]) / mp.mpc(start[0], start[1]))


def test_one_evaluation_gets_better_with_its_digits() -> None:
    """Each evaluation is as good as its digits say, near the separatrix too."""
    solid, start, _ = CASES["near the separatrix"]
    solution = closed_form(scene(solid, start))
    best = states(solution, [Fraction(60)], 90)[0]
    for digits in (20, 40, 60):
        state = states(solution, [Fraction(60)], digits)[0]
        assert distance(state, best, 90) <= mpf(10) ** -digits


def test_rest_stays_at_rest() -> None:
    """Without impulse nothing moves."""
    solution = closed_form(scene(SHARP, vector(0, 0, 0, 0, 0, 0)))
    assert solution.regime == "rest"
    assert states(solution, [Fraction(10**6)], 30)[0] == [0] * 6


REFUSED = {
    "not of Clebsch's form": scene(
        ImmersedBody(SHARP.body().linear, SHARP.body().coupling, diagonal(vector(1, 2, 3))),
        GENERIC,
    ),
    "a force or a couple": scene(SHARP.body(force=vector(0, 0, 1)), GENERIC),
}


@pytest.mark.parametrize("reason", REFUSED)
def test_says_why_there_is_no_closed_form(reason: str) -> None:
    """What is not built is refused with its reason, never answered by a neighbouring formula."""
    with pytest.raises(NoClosedForm, match=reason):
        closed_form(REFUSED[reason])


@seeds
def test_the_quartic_is_the_square_of_the_speed(seed: int) -> None:
    """f(x3) = (dx3/dt)^2 at the start, and f(+-F) <= 0 where F is rational, exactly."""
    solid, start = random_body(seed, "")
    nutation = Nutation.of(solid, Impulse(tuple(start[:3]), tuple(start[3:])))
    assert value(nutation.f, nutation.z) == nutation.speed**2
    start = (*vector("3/5", 0, "-4/5"), *start[3:])  # F = 1
    nutation = Nutation.of(solid, Impulse(tuple(start[:3]), tuple(start[3:])))
    for side in (1, -1):
        pull = solid.r * (nutation.FG - side * nutation.y3)
        assert value(nutation.f, Fraction(side)) == -(pull**2)


@pytest.mark.parametrize("name", ["four-real-roots", "two-real-roots", "cubic", "trigonometric"])
def test_x3_recurs_after_the_period(name: str) -> None:
    """x3(t + P) = x3(t) for the period among the elements, and m + m' = 1 where it is elliptic."""
    exact = closed_form(load(f"kirchhoff/{name}"))
    elements = exact.elements(50)
    with mp.workdps(60):
        period = Fraction(*(int(part) for part in elements["period"].as_integer_ratio()))
        now, later = exact.motion([Fraction(3), Fraction(3) + period], 45)["linear_impulse"]
        # The period is known to 50 digits, and x3 changes by some units in unit time.
        assert abs(later[2] - now[2]) <= mpf(10) ** -43
        if "m" in elements:
            assert abs(elements["m"] + elements["m_prime"] - 1) <= mpf(10) ** -48
