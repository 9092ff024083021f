"""The attitude and the path of Clebsch's body in closed form, held to Taylor and the equations."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from builders.turns import by_turns
from mpmath import mp, mpf

from taylor_verify.exact.elliptic import Landen
from taylor_verify.exact.kirchhoff import orbit
from taylor_verify.exact.kirchhoff.closed import closed_form
from taylor_verify.exact.kirchhoff.jacobi import NutatingBody
from taylor_verify.exact.kirchhoff.quartic import Nutation
from taylor_verify.exact.kirchhoff.regime import turning_points
from taylor_verify.exact.kirchhoff.space import CayleyKlein
from taylor_verify.exact.kirchhoff.wave import Rise, SquareIntegral
from taylor_verify.exact.rotation import rotation_matrix
from taylor_verify.exact.solution import Quantities
from taylor_verify.exact.taylor import TaylorSolution
from taylor_verify.scenes.bodies import Clebsch, ImmersedBody
from taylor_verify.scenes.motion import Clock, Impulse, Motion
from taylor_verify.scenes.scene import Scene

Array = np.ndarray[Any, Any]

DIGITS = 40
# Both routes promise DIGITS of each vector and matrix, which here are below 100.
AGREEMENT = mpf(10) ** -(DIGITS - 2)
# What is wrong in kind, and no matter of digits, is wrong by more than this.
GROSS = mpf(1) / 10


def exact(text: str) -> tuple[Fraction, ...]:
    return tuple(Fraction(word) for word in text.split())


TILTED = exact("2 -1 1 3")  # of length sqrt 15
ASIDE = exact("1 -2 1/2")

# Bodies by p p' q q' r r', and starts by x and y: every regime, and the difficulties of each.
SHARP = "1 2 1/10 3/10 1 1/2"  # p' > p
BLUNT = "2 1 1/10 3/10 1 1/2"  # p' < p
EVEN = "1 1 1/10 3/10 1 1/2"  # p' = p
PLAIN = "1 2 0 0 1 1/2"
GENERIC = "1/2 1/3 1 1/5 -1/4 1"
FALLING = "3/5 0 4/5 1/6 1/2 1/2"  # F = 1, G = y3
OVER_BOTH = "3/5 1/5 4/5 1/5 -3/5 0"

MOTIONS = {
    "four real roots": (SHARP, GENERIC, "four-roots"),
    "four real roots, the two largest": (
        "3 1 -1/10 7/20 2 1",
        "1 1 3/4 1/4 -1/4 -1/8",
        "four-roots",
    ),
    "four real roots, the two smallest": (
        "5 1 1/10 -2/5 2 1",
        "1/2 -1/2 -1 1/8 3/8 1/8",
        "four-roots",
    ),
    "two real roots": (BLUNT, GENERIC, "two-roots"),
    "cubic, third root above": (EVEN, GENERIC, "cubic"),
    "cubic, third root below": (EVEN, "1/2 1/3 1 1/5 -1/4 -1", "cubic"),
    "no screw coupling": (PLAIN, GENERIC, "four-roots"),
    "q' = q": ("3/2 1 1/5 1/5 4/5 1/2", GENERIC, "two-roots"),
    "from the lower turning point": (SHARP, "1 1 2 1/3 1/3 2", "four-roots"),
    "from the upper turning point": (BLUNT, "1 1 2 1/3 1/3 3", "two-roots"),
    "below a root at the pole": (SHARP, "3/5 0 4/5 1/3 1/7 1", "four-roots"),
    "through the pole": (SHARP, "3/5 0 4/5 1/3 2 1", "four-roots"),
    "through the pole, two roots": (BLUNT, "3/5 0 4/5 1/3 1/7 1", "two-roots"),
    "through the pole, cubic": (EVEN, "3/5 0 4/5 1/3 1/7 1", "cubic"),
    "through the lower pole": (BLUNT, "3/5 0 4/5 3 1/7 -1", "two-roots"),
    "through both poles": (SHARP, "3/5 0 4/5 0 3 0", "four-roots"),
    "through both poles, two roots": (BLUNT, "3/5 0 4/5 0 3 0", "two-roots"),
    "from the axis": (EVEN, "0 0 1 1/3 1/7 2", "cubic"),
    "from the axis, two roots": (BLUNT, "0 0 -2 1/3 1/7 2", "two-roots"),
    "planar, through a pole": (BLUNT, OVER_BOTH, "four-roots"),
    "planar, |x| irrational": (BLUNT, "1 1 2 1 -1 0", "four-roots"),
    "G = 0": (SHARP, "1/2 1/2 1 -1/2 -1/2 1/2", "four-roots"),
    "near the pole": (BLUNT, "3/5 0 4/5 1/3 1/7 9999999999/10000000000", "two-roots"),
    "near the separatrix": (SHARP, "1e-10 0 1 0 1e-10 1/5", "four-roots"),
    "nearly p' = p": ("1 1.00000000000000000001 1/10 3/10 1 1/2", GENERIC, "four-roots"),
    "nearly steady": (BLUNT, "1e-10 0 1 0 1e-10 1/5", "two-roots"),
    "weak impulse": (SHARP, "5e-21 -3e-21 1e-20 1/5 -1/4 1", "four-roots"),
    "falling from the pole": ("1 287/162 0 0 1 1/2", FALLING, "hyperbolic"),
    "falling from the pole, screw": ("1 269/162 1/10 3/10 1 1/2", FALLING, "hyperbolic"),
    "falling from the pole, a cubic": ("1 1 0 25/18 1 9", FALLING, "hyperbolic"),
    "falling from elsewhere": (
        "6 4417/1089 1/3 6629/4356 1 2",
        "1/3 5/6 -2/3 -1/6 1 -2/3",
        "hyperbolic",
    ),
    "beside a double root": (
        "6 23219/4500 1/3 2374/5625 1 2",
        "1/3 1 1 1/2 -2/3 5/6",
        "trigonometric",
    ),
    "quadratic": ("1 1 1/10 1/10 1 1/2", GENERIC, "trigonometric"),
    "quadratic, over both poles": (EVEN, OVER_BOTH, "trigonometric"),
    "quadratic, from the axis": ("1 1 1/10 1/10 1 1/2", "0 0 1 1/3 1/7 1", "trigonometric"),
    "quadratic, from the lower pole": (EVEN, "0 0 -1 1/3 1/7 0", "trigonometric"),
    "border": ("6 -23/72 1/3 943/72 1 2", FALLING, "algebraic"),
    "heteroclinic": (PLAIN, "3/5 0 4/5 0 3/5 0", "heteroclinic"),
    "heteroclinic, downwards": ("1 2 1/5 -1/3 1 1/2", "1/2 1 1 1 -1/2 0", "heteroclinic"),
    "steady": ("1 92/81 1/10 3/10 1 1/2", "3/5 0 4/5 1/3 0 1", "steady"),
    "steady, about its axis": (SHARP, "0 0 -2 0 0 1", "steady"),
    "steady, without turning": (PLAIN, "0 0 3 0 0 0", "steady"),
    "top": (EVEN, "0 0 0 1/5 -1/4 2/3", "euler-top"),
    "top about its axis": (EVEN, "0 0 0 0 0 2/3", "euler-top"),
    "rest": (SHARP, "0 0 0 0 0 0", "rest"),
}
by_motion = pytest.mark.parametrize("name", MOTIONS)
of_each_regime = pytest.mark.parametrize(
    "name", by_turns(MOTIONS, 4, lambda name: MOTIONS[name][2])
)


def scene(name: str) -> Scene:
    solid, start, _ = MOTIONS[name]
    state = exact(start)
    impulse = Impulse(state[:3], state[3:], TILTED, ASIDE)
    track = frozenset({"attitude", "centre"})
    clock = Clock(Fraction(0), (Fraction(1),))
    return Scene(name, "", "kirchhoff", track, Clebsch(*exact(solid)).body(), impulse, clock)


# What a motion is held to: the largest error of a row.


def off_taylor(asked: Scene, times: Sequence[Fraction], digits: int = DIGITS) -> mpf:
    """The largest error of an attitude or a centre, by the Taylor route."""
    motion = closed_form(asked).motion(times, digits)
    series = TaylorSolution(asked).motion(times, digits)
    return max(off(motion[name], series[name]) for name in ("attitude", "centre"))


def off(values: Any, expected: Any) -> mpf:
    """The largest difference of two arrays."""
    with mp.workdps(DIGITS + 40):
        return max(abs(a - b) for a, b in zip(np.ravel(values), np.ravel(expected), strict=True))


def off_space_integrals(asked: Scene, motion: Motion) -> mpf:
    """By how much R x and R y + c x R x, the impulse and its moment in space, are not as at first."""
    with mp.workdps(DIGITS + 40):
        R0, start = numbers(rotation_matrix(asked.initial.attitude)), asked.initial
        at_first = in_space(R0, numbers(start.linear), numbers(start.angular), numbers(ASIDE))
        rows = ("attitude", "linear_impulse", "angular_impulse", "centre")
        later = [
            in_space(*row) for row in zip(*(motion.quantities[name] for name in rows), strict=True)
        ]
        return max(off(row, at_first) for row in later)


def in_space(R: Array, x: Array, y: Array, c: Array) -> Array:
    return np.concatenate([R @ x, R @ y + np.cross(c, R @ x)])


def numbers(exact_numbers: Any) -> Array:
    """The array of mpf, at the ambient precision."""
    return np.vectorize(mp.convert, otypes=[object])(np.array(exact_numbers, dtype=object))


def velocities(body: ImmersedBody, x: Array, y: Array) -> tuple[Array, Array]:
    """U = dT/dx and Omega = dT/dy."""
    a, b, c = numbers(body.linear), numbers(body.coupling), numbers(body.angular)
    return a @ x + b @ y, b.T @ x + c @ y


def crossing(w: Array) -> Array:
    zero = mpf(0)
    return np.array([[zero, -w[2], w[1]], [w[2], zero, -w[0]], [-w[1], w[0], zero]], dtype=object)


@pytest.mark.slow
@by_motion
def test_agrees_with_the_taylor_route(name: str) -> None:
    """Attitude and centre are those of the Taylor route, both ways in time."""
    asked = scene(name)
    assert closed_form(asked).regime == MOTIONS[name][2]
    assert off_taylor(asked, [Fraction(3, 2), Fraction(-5, 2)]) <= AGREEMENT


@pytest.mark.parametrize("name", [name for name in MOTIONS if name.startswith("through")])
def test_the_pole_is_passed(name: str) -> None:
    """The motions said to go through a pole do: it is an end of the swing, exactly."""
    asked = scene(name)
    body, start = asked.body, asked.initial
    assert isinstance(body, ImmersedBody)
    assert isinstance(start, Impulse)
    assert body.clebsch is not None
    points = turning_points(Nutation.of(body.clebsch, start), 20)
    assert points.at_top == ("lower" not in name)
    assert points.at_bottom == ("lower" in name or "both" in name)


@of_each_regime
def test_starts_where_it_is_told_to(name: str) -> None:
    """At time zero R is the matrix of the quaternion, whose length does not matter; c its start."""
    asked = scene(name)
    motion = closed_form(asked).motion([Fraction(0)], DIGITS)
    with mp.workdps(DIGITS + 40):
        assert off(motion["attitude"][0], numbers(rotation_matrix(TILTED))) <= AGREEMENT
        assert off(motion["centre"][0], numbers(ASIDE)) <= AGREEMENT
    longer = replace(asked.initial, attitude=tuple(-7 * c for c in TILTED))
    again = closed_form(replace(asked, initial=longer)).motion([Fraction(0)], DIGITS)
    assert off(motion["attitude"], again["attitude"]) <= AGREEMENT


@of_each_regime
def test_impulse_and_moment_are_fixed_in_space(name: str) -> None:
    """R x and R y + c x R x stay as they were, for ever, and R stays a rotation."""
    asked = scene(name)
    # The centre is some 1e5 away by then, of which DIGITS are promised; the moment has its errors.
    motion = closed_form(asked).motion(
        [Fraction(1, 7), Fraction(10**5), Fraction(-12345)], DIGITS + 7
    )
    assert off_space_integrals(asked, motion) <= AGREEMENT
    with mp.workdps(DIGITS + 20):
        for R in motion["attitude"]:
            assert off(R @ R.T, np.eye(3, dtype=int)) <= AGREEMENT
            assert mp.det(mp.matrix(R.tolist())) > 0


@of_each_regime
def test_obeys_the_equations_of_motion(name: str) -> None:
    """R' = R [Omega]x and c' = R U, by differences of the closed form."""
    # Eighth-order differences at h: the error is h^8 D^9/630. No rate here is above 10 per unit of
    # time, so it is below 1e-48 * 1e9 / 630, times the size; rounding leaves 10^-digits / h.
    h, digits, middle = Fraction(1, 10**6), DIGITS + 14, Fraction(-239, 7)
    weights = (Fraction(4, 5), Fraction(-1, 5), Fraction(4, 105), Fraction(-1, 280))
    asked = scene(name)
    near = closed_form(asked).evaluate([middle + k * h for k in range(-4, 5)], digits)
    with mp.workdps(digits + 10):

        def slope(values: Array) -> Array:
            return sum(
                mp.convert(weight / h) * (values[4 + k] - values[4 - k])
                for k, weight in enumerate(weights, 1)
            )

        R = near["attitude"][4]
        U, Omega = velocities(asked.body, near["linear_impulse"][4], near["angular_impulse"][4])
        assert off(slope(near["attitude"]), R @ crossing(Omega)) <= AGREEMENT
        assert off(slope(near["centre"]), R @ U) <= AGREEMENT


GOING_ON = ("four real roots", "two real roots", "cubic, third root above", "through the pole")


@pytest.mark.parametrize(
    "name", by_turns([*GOING_ON, "falling from elsewhere", "beside a double root"])
)
def test_a_new_start_goes_on(name: str) -> None:
    """R(s + t) = R(s) R*(t) and c(s + t) = c(s) + R(s) c*(t), where * starts anew at s."""
    asked, first, second = scene(name), Fraction(37, 3), Fraction(-251, 9)
    through = closed_form(asked).motion([first, first + second], 60)
    with mp.workdps(90):
        x, y = (
            tuple(Fraction(*map(int, c.as_integer_ratio())) for c in through[name][0])
            for name in ("linear_impulse", "angular_impulse")
        )
    onward = closed_form(replace(asked, initial=Impulse(x, y))).motion([second], DIGITS)
    with mp.workdps(90):
        R = through["attitude"][0]
        # The restart holds 60 digits. What it leaves out grows by less than 1e6 in this time where
        # the motion recurs, and falling by e^(lambda t), lambda < 1.5, where it does not: 1e18.
        assert off(R @ onward["attitude"][0], through["attitude"][1]) <= AGREEMENT
        centre = through["centre"][0] + R @ onward["centre"][0]
        assert off(centre, through["centre"][1]) <= AGREEMENT


@pytest.mark.slow
@pytest.mark.parametrize("name", [*GOING_ON, "planar, |x| irrational", "from the axis"])
def test_a_million_nutations_are_a_power_of_one(name: str) -> None:
    """After n periods R and c are those of n equal screws, of which a Taylor series gives one.

    After the period P the impulses are back but for the angle D about axis 3, so that in axes
    turned back by it every nutation is the same displacement of space.
    """
    asked, n, digits = scene(name), 10**6, DIGITS + 20
    solution = closed_form(asked)
    assert isinstance(solution, NutatingBody)
    with mp.workdps(digits + 10):
        period = Fraction(*map(int, solution.elements(digits + 5)["period"].as_integer_ratio()))
    once = TaylorSolution(asked).motion([period], digits)
    motion = solution.motion([n * period], DIGITS + 8)
    with mp.workdps(digits + 10):
        x, y = once["linear_impulse"][0], once["angular_impulse"][0]
        x0, y0 = numbers(asked.initial.linear), numbers(asked.initial.angular)
        back, across = (x, x0) if asked.initial.linear[0] else (y, y0)
        turn = mp.mpc(back[0], back[1]) / mp.mpc(across[0], across[1])
        R0 = numbers(rotation_matrix(TILTED))
        step = np.zeros((4, 4), dtype=object)
        step[:3, :3] = R0.T @ once["attitude"][0] @ about_axis(turn)
        step[:3, 3] = R0.T @ (once["centre"][0] - numbers(ASIDE))
        step[3, 3] = mpf(1)
        whole = np.linalg.matrix_power(step, n)
        R, c = R0 @ whole[:3, :3] @ about_axis(turn**-n), numbers(ASIDE) + R0 @ whole[:3, 3]
        assert off(motion["attitude"][0], R) <= AGREEMENT
        assert off(motion["centre"][0], c) <= AGREEMENT * mp.norm(list(c))


def about_axis(turn: Any) -> Array:
    """The rotation about axis 3 by the argument of the complex number."""
    zero = mpf(0)
    rows = [[turn.real, -turn.imag, zero], [turn.imag, turn.real, zero], [zero, zero, mpf(1)]]
    return np.array(rows, dtype=object)


def test_a_short_way_has_its_digits() -> None:
    """From the origin, after 1e-30 units of time, the centre has all the digits asked for."""
    for name in (
        "four real roots",
        "cubic, third root above",
        "heteroclinic",
        "quadratic",
        "steady",
    ):
        asked = scene(name)
        asked = replace(asked, initial=replace(asked.initial, centre=exact("0 0 0")))
        short = Fraction(1, 10**30)
        motion = closed_form(asked).motion([Fraction(0), short], DIGITS)
        assert not any(motion["centre"][0])
        with mp.workdps(DIGITS + 40):
            x, y = numbers(asked.initial.linear), numbers(asked.initial.angular)
            way = numbers(rotation_matrix(TILTED)) @ velocities(asked.body, x, y)[0]
            # The way is U t but for a part in 1e30.
            relative = off(motion["centre"][1] / mp.convert(short), way) / mp.norm(list(way))
            assert relative <= mpf(10) ** -28
        series = TaylorSolution(asked).motion([short], DIGITS)
        assert off(motion["centre"][1], series["centre"][0]) <= AGREEMENT * mp.convert(short)


@pytest.mark.parametrize("track", [{"attitude"}, {"attitude", "centre"}, set[str]()])
@pytest.mark.parametrize("name", ["two real roots", "quadratic", "steady"])
def test_answers_what_is_tracked(name: str, track: set[str]) -> None:
    """Attitude (n, 3, 3) and centre (n, 3) are there if tracked, and only then."""
    asked = replace(scene(name), track=frozenset(track))
    quantities: Quantities = closed_form(asked).evaluate([Fraction(1), Fraction(2)], 20)
    assert set(quantities) == {"linear_impulse", "angular_impulse"} | track
    shapes = {"attitude": (2, 3, 3), "centre": (2, 3)}
    assert all(quantities[name].shape == shapes[name] for name in track)


@pytest.mark.parametrize("m", ["1e-40", "1/10", "9/10", "1 - 1e-40"])
def test_the_squared_sine_is_integrated(m: str) -> None:
    """m int sn^2 = u - E(u), by mpmath's incomplete integrals, from a small m to one near 1."""
    with mp.workdps(120):
        small = mpf(10) ** -40
        m_, m_prime = (1 - small, small) if "-" in m[1:3] else (mp.convert(Fraction(m)), None)
        m_prime = 1 - m_ if m_prime is None else m_prime
        K = mp.ellipk(m_)
        u = [K / 3, -K * mpf(9) / 10]
        expected = [v - mp.ellipe(mp.asin(mp.ellipfun("sn", v, m=m_)), m_) for v in u]
    with mp.workdps(50):
        integrals = [Landen(+m_, +m_prime).squared_sine(+v) for v in u]
        # 50 digits of u, which is below 100.
        assert max(abs(a - b) for a, b in zip(integrals, expected, strict=True)) <= mpf(10) ** -46


# Broken on purpose: what the tests above see, and what the integrals in space do not.

SEEN_AT = [Fraction(8)]  # beyond a nutation


def test_a_centre_that_does_not_rise_is_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    """Without Z the integrals in space are as they should be; the Taylor route sees it."""
    monkeypatch.setattr(Rise, "at", lambda self, t, place: mpf(0))
    asked = scene("four real roots")
    motion = closed_form(asked).motion(SEEN_AT, DIGITS)
    assert off_space_integrals(asked, motion) <= AGREEMENT
    assert off_taylor(asked, SEEN_AT) > GROSS


def test_a_transposed_attitude_is_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    """R turned round does not keep the impulse fixed in space."""
    frame = CayleyKlein.frame
    monkeypatch.setattr(
        CayleyKlein, "frame", lambda self: [list(row) for row in zip(*frame(self), strict=True)]
    )
    asked = scene("four real roots")
    motion = closed_form(asked).motion(SEEN_AT, DIGITS)
    assert off_space_integrals(asked, motion) > GROSS


def test_a_lost_winding_is_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    """An integral of the third kind that forgets its whole periods: Taylor sees it, beyond one."""
    at = SquareIntegral.at
    monkeypatch.setattr(SquareIntegral, "at", lambda self, place: at(self, replace(place, turns=0)))
    asked = scene("four real roots")
    assert off_taylor(asked, [Fraction(1, 10)]) <= AGREEMENT
    motion = closed_form(asked).motion(SEEN_AT, DIGITS)
    assert off_space_integrals(asked, motion) <= AGREEMENT
    assert off_taylor(asked, SEEN_AT) > GROSS


def test_a_fixed_chart_at_the_pole_is_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    """With Euler's theta kept in [0, pi] the attitude is wrong once the axis has passed the pole."""
    root = orbit.Pole.root

    def fixed_chart(pole: orbit.Pole, place: Any, weight: mpf) -> tuple[mpf, mpf]:
        size, slope = root(pole, place, weight)
        return abs(size), slope

    asked = scene("through the pole")
    passed = _passages(asked)
    monkeypatch.setattr(orbit.Pole, "root", fixed_chart)
    before, after = passed - Fraction(1, 5), passed + Fraction(1, 5)
    assert off_taylor(asked, [before]) <= AGREEMENT
    assert off_taylor(asked, [after]) > GROSS


def _passages(asked: Scene) -> Fraction:
    """The first time at which x3 is largest, which is F here, to a hundredth."""
    times = [Fraction(k, 100) for k in range(1, 800)]
    z = TaylorSolution(asked).motion(times, 15)["linear_impulse"][:, 2]
    return next(t for t, a, b in zip(times, z, z[1:], strict=False) if b < a)
