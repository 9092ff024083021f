"""The elements of an orbit against the motion by Taylor series, and the linearised equations."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from math import comb
from random import Random
from typing import Any

import numpy as np
import pytest
from builders.scenes import one_instant, vector
from builders.turns import by_turns
from mpmath import mp, mpf

import taylor_verify
from taylor_verify.exact.elements import elements
from taylor_verify.exact.euler.elements import disturbance
from taylor_verify.exact.euler.regime import FreeSpin
from taylor_verify.exact.kirchhoff.clebsch_elements import stability
from taylor_verify.exact.kirchhoff.quartic import Nutation, value
from taylor_verify.exact.taylor import TaylorSolution
from taylor_verify.explain.explanation import explanation
from taylor_verify.judge.floor.carrying import carrying
from taylor_verify.numbers import tensors
from taylor_verify.numbers.precision import exact_value
from taylor_verify.numbers.tensors import Vector
from taylor_verify.scenes.bodies import Clebsch, ImmersedBody, RigidBody
from taylor_verify.scenes.library import names
from taylor_verify.scenes.motion import Impulse, Spin
from taylor_verify.scenes.reading.reader import load
from taylor_verify.scenes.scene import Scene

DIGITS = 30
# A number of 30 digits, times rates of some units, moves a motion by less than this.
CLOSE = mpf("1e-26")


def rigid(inertia: Vector, omega: Vector) -> Scene:
    return one_instant(RigidBody(tensors.diagonal(inertia)), Spin(omega))


def immersed(body: Clebsch, linear: Vector, angular: Vector) -> Scene:
    return one_instant(body.body(), Impulse(linear, angular))


def nutation(scene: Scene) -> Nutation:
    assert isinstance(scene.body, ImmersedBody)
    assert isinstance(scene.initial, Impulse)
    assert scene.body.clebsch is not None
    return Nutation.of(scene.body.clebsch, scene.initial)


def number(scene: Scene, name: str, digits: int = DIGITS) -> mpf:
    return elements(scene, digits)[name].value


def moved(scene: Scene, quantity: str, *times: mpf) -> list[Any]:
    """The quantity by Taylor series at these times since the start."""
    alone = replace(scene, track=scene.track & {"attitude"})
    return list(TaylorSolution(alone).motion([exact_value(t) for t in times], DIGITS)[quantity])


def distance(a: Any, b: Any) -> mpf:
    return mp.norm(list((a - b).flat))


# Every orbit.


@pytest.mark.parametrize(
    "name", by_turns((n for n in names() if n.startswith(("euler/", "kirchhoff/"))), 6)
)
def test_the_digits_asked_for_are_right(name: str) -> None:
    """Fifteen digits agree with forty, name by name, and every number says what it is."""
    scene = load(name)
    few, many = elements(scene, 15), elements(scene, 40)
    assert list(few) == list(many)
    with mp.workdps(40):
        for element, better in zip(few.values(), many.values(), strict=True):
            # Rounding to fifteen digits in binary is one unit of the last one.
            room = mpf(10) ** -14 * max(abs(better.value), better.size)
            assert abs(element.value - better.value) <= room
            assert element.meaning
    assert few.sentences


def test_a_steady_precession_nutates_with_the_period_of_a_motion_beside_it() -> None:
    """Moved by 1e-8 it nutates, and the period is that of small nutations but for as much."""
    steady = load("kirchhoff/steady-precession")
    assert isinstance(steady.initial, Impulse)
    x1, x2, x3 = steady.initial.linear
    start = replace(steady.initial, linear=(x1, x2, x3 + Fraction(1, 10**8)))
    beside = replace(steady, initial=start)
    assert abs(number(steady, "nutation_period") / number(beside, "period") - 1) <= 1e-8


@pytest.mark.parametrize(("along", "is_near"), [("1/20", True), ("1/4", True), ("11/40", False)])
def test_the_law_of_the_flip_is_given_where_it_is_right_to_a_hundredth(
    along: str, is_near: bool
) -> None:
    """Beside the middle axis; at 11/40 along another one it is wrong by 1.1 %, and not given."""
    orbit = elements(rigid(vector(1, 2, 3), vector(along, 1, 0)))
    assert ("flip_law" in orbit) is is_near
    if is_near:
        assert abs(orbit["flip_law"].value / orbit["flip_time"].value - 1) < 0.01


STEADY = ("euler-top", "zero-impulse", "steady-precession")


@pytest.mark.parametrize(
    ("name", "quantity"),
    [
        *((f"euler/{n}", "omega") for n in ("generic", "full-tensor", "axisymmetric", "backward")),
        *((f"kirchhoff/{n}", "angular_impulse") for n in STEADY),
    ],
)
def test_a_motion_recurs_after_its_period_and_not_after_half(name: str, quantity: str) -> None:
    """The period is the least one: of omega, and where x3 is constant of x and y about axis 3."""
    scene = load(name)
    with mp.workdps(DIGITS):
        period = number(scene, "period")
        start, half, whole = moved(scene, quantity, mpf(0), period / 2, period)
        assert distance(start, whole) <= CLOSE
        assert distance(start, half) >= mpf("0.01")


@pytest.mark.parametrize(
    "name",
    by_turns(
        [
            *("four-real-roots", "two-real-roots", "cubic", "trigonometric", "through-the-pole"),
            *("beside-a-stable-spin", "planar-turn"),
        ],
        7,
    ),
)
def test_x3_recurs_after_the_period_of_nutation_and_not_after_half(name: str) -> None:
    """The shape recurs: x3 and dx3/dt = r (x1 y2 - x2 y1) are those of the start."""
    scene = load(f"kirchhoff/{name}")
    with mp.workdps(DIGITS):
        period = number(scene, "period")
        assert abs(period * number(scene, "nutation_frequency") - 2 * mp.pi) <= CLOSE
        shapes = [
            np.array([x[2], x[0] * y[1] - x[1] * y[0]])
            for x, y in zip(
                moved(scene, "linear_impulse", mpf(0), period / 2, period),
                moved(scene, "angular_impulse", mpf(0), period / 2, period),
                strict=True,
            )
        ]
        assert distance(shapes[0], shapes[2]) <= CLOSE
        assert distance(shapes[0], shapes[1]) >= mpf("0.01")


# Euler.


@pytest.mark.parametrize("name", ["euler/generic", "euler/tennis-racket"])
def test_amplitudes_and_phase_are_those_of_the_textbook(name: str) -> None:
    """omega is (A dn, B sn, C cn) of rate t + phase, by mpmath's functions, at the times of the scene.

    The axis that omega goes round nods as dn does, whose period is 2 K.
    """
    scene = load(name)
    orbit = elements(scene, 30)
    with mp.workdps(30):
        nod = 2 * mp.ellipk(orbit["m"].value) / orbit["rate"].value
        assert abs(nod * orbit["nutation_frequency"].value / (2 * mp.pi) - 1) <= 1e-25
        exact = taylor_verify.exact(scene, scene.times[:5], 25)["omega"]
        for t, omega in zip(scene.clock.elapsed, exact, strict=False):
            u = orbit["rate"].value * mp.convert(t) + orbit["phase"].value
            waves = [mp.ellipfun(kind, u=u, m=orbit["m"].value) for kind in ("dn", "sn", "cn")]
            sizes = [orbit[f"amplitude_{kind}"].value for kind in ("dn", "sn", "cn")]
            expected = sorted(abs(size * wave) for size, wave in zip(sizes, waves, strict=True))
            components = sorted(map(abs, omega))
            assert all(abs(a - b) <= 1e-20 for a, b in zip(expected, components, strict=True))


@pytest.mark.parametrize("off", ["0.1", "0.01", "1e-4", "1e-8", "1e-15"])
def test_the_laws_of_the_flip_close_in_on_it(off: str) -> None:
    """The leading law is off by m'/4 (1 - 1/L) of itself, and the next by 9/64 m'^2 at most."""
    orbit = elements(rigid(vector("1", "2", "3"), vector(off, "1", "0")), 100)
    with mp.workdps(100):
        m_prime, flip = orbit["m_prime"].value, orbit["flip_time"].value
        L = mp.log(16 / m_prime) / 2
        leading = (flip - orbit["flip_law"].value) / flip / (m_prime / 4)
        # K = L + (L - 1) m'/4 + O(m'^2 L)
        assert abs(leading - (1 - 1 / L)) <= m_prime
        assert abs(flip - orbit["flip_law_2"].value) <= flip * m_prime**2 * 9 / 64


@pytest.mark.parametrize("off", ["1", "0.01", "1e-10", "1e-25"])
def test_the_distance_to_the_separatrix_is_relatively_accurate(off: str) -> None:
    """|H^2 - 2T J2|/H^2 and m' as exact fractions, for moments 1 < 2 < 3 and omega_1 small."""
    small = Fraction(off)
    scene = rigid(vector("1", "2", "3"), (small, Fraction(1), small / 3))
    H2, T2 = small**2 + 4 + small**2, small**2 + 2 + small**2 / 3
    A, D = abs(H2 - T2 * (1 if H2 > 2 * T2 else 3)), abs(H2 - 2 * T2)
    orbit = elements(scene, DIGITS)
    with mp.workdps(DIGITS):
        expected = {"separation": D / H2, "m_prime": 2 * D / A}
        for name, exactly in expected.items():
            assert abs(orbit[name].value / mp.convert(exactly) - 1) <= mpf("1e-28")


@pytest.mark.parametrize("axis", [0, 1, 2])
@pytest.mark.parametrize("turned", [False, True])
def test_a_disturbance_of_a_steady_rotation_has_the_linearised_spectrum(
    axis: int, turned: bool
) -> None:
    """Growth rate or wobble are the eigenvalues of the Jacobian of H' = H x K H."""
    inertia, spin = vector("1.5", "2", "3.25"), Fraction(7, 5)
    omega = tuple(spin if i == axis else Fraction(0) for i in range(3))
    tensor = tensors.diagonal(inertia)
    if turned:
        c, s = Fraction(3, 5), Fraction(4, 5)
        zero, one = Fraction(0), Fraction(1)
        P = ((c, -s, zero), (c * s, c * c, -s), (s * s, c * s, c))
        assert tensors.product(P, tensors.transpose(P)) == tensors.diagonal((one, one, one))
        tensor = tensors.product(tensors.product(P, tensor), tensors.transpose(P))
        omega = tensors.apply(P, omega)
    body = RigidBody(tensor)
    scene = one_instant(body, Spin(omega))
    K, H = np.array(body.inverse_inertia, dtype=float), tensors.apply(tensor, omega)
    eigenvalues = np.linalg.eigvals(_euler_jacobian(K, np.array(H, dtype=float)))
    largest = max(eigenvalues, key=abs)
    orbit = elements(scene, 15)
    assert orbit.regime == "steady"
    if axis == 1:
        # Eigenvalues of a 3x3 matrix of doubles of size 1.
        assert abs(float(orbit["growth_rate"].value) - abs(largest.real)) <= 1e-12
        assert "unstable" in orbit.sentences[0]
    else:
        assert abs(float(orbit["wobble_rate"].value) - abs(largest.imag)) <= 1e-12
        assert ", stable" in orbit.sentences[0]


def _euler_jacobian(K: Any, H: Any) -> Any:
    """Of H x K H: column j is e_j x K H + H x K e_j."""
    unit = np.eye(3)
    return np.array([np.cross(unit[j], K @ H) + np.cross(H, K @ unit[j]) for j in range(3)]).T


def test_a_spin_across_the_axis_of_symmetry_is_neutral() -> None:
    """s^2 = 0 exactly: neither growth nor wobble, and the words say that omega drifts."""
    scene = rigid(vector("2", "2", "1/3"), vector("0.6", "0.8", "0"))
    assert disturbance(FreeSpin(scene.body.inertia, scene.initial.omega)) == 0
    orbit = elements(scene, 15)
    assert "drift" in orbit.sentences[0]
    assert {"growth_rate", "wobble_rate"}.isdisjoint(orbit)


def test_the_separatrix_falls_away_at_the_rate_of_its_saddle() -> None:
    """On the separatrix lam is the growth rate of the spin that the orbit comes from."""
    orbit = elements(load("euler/separatrix-full-tensor"), DIGITS)
    with mp.workdps(DIGITS):
        ratio = orbit["rate"].value / orbit["saddle_rate"].value
        assert abs(ratio - 1) <= mpf("1e-28")
    assert orbit["separation"].value == 0
    assert "period" not in orbit


def test_an_axis_of_symmetry_precesses_about_H() -> None:
    """In space the axis recurs after precession_period, always at precession_angle from H."""
    scene = replace(load("euler/axisymmetric"), track=frozenset({"attitude"}))
    orbit = elements(scene, DIGITS)
    inertia = [scene.body.inertia[i][i] for i in range(3)]
    axis = next(i for i in range(3) if inertia.count(inertia[i]) == 1)
    with mp.workdps(DIGITS):
        period = orbit["precession_period"].value
        frames = moved(scene, "attitude", mpf(0), period / 2, period)
        axes = [frame[:, axis] for frame in frames]
        assert distance(axes[0], axes[2]) <= CLOSE
        assert distance(axes[0], axes[1]) >= mpf("0.01")
        momentum = [mp.convert(J * w) for J, w in zip(inertia, scene.initial.omega, strict=True)]
        H = frames[0] @ np.array(momentum, dtype=object)
        for e in axes:
            cosine = abs(mp.fdot(list(e), list(H))) / mp.norm(list(H))
            assert abs(mp.cos(orbit["precession_angle"].value) - cosine) <= CLOSE


# Clebsch's body.


@pytest.mark.parametrize(
    "name",
    by_turns(
        [
            *("four-real-roots", "two-real-roots", "cubic", "trigonometric", "through-the-pole"),
            *("beside-a-stable-spin", "onto-the-axis", "algebraic", "half-turn"),
        ],
        8,
    ),
)
def test_x3_stays_between_two_roots_and_reaches_them(name: str) -> None:
    """f vanishes at both ends and is positive between, and the Taylor motion keeps inside."""
    scene = load(f"kirchhoff/{name}")
    orbit, of = elements(scene, DIGITS), nutation(scene)
    with mp.workdps(DIGITS):
        low, high = orbit["x3_low"].value, orbit["x3_high"].value
        for end in (low, high):
            # f'(z) times an error of z: coefficients and F are of size 1.
            assert abs(mp.polyval([mp.convert(c) for c in of.f[::-1]], end, asc=True)) <= CLOSE
        for part in range(1, 8):
            assert value(of.f, exact_value(low + (high - low) * part / 8)) > 0
        heights = [x[2] for x in moved(scene, "linear_impulse", *(mpf(k) / 2 for k in range(20)))]
        assert all(low - CLOSE <= z <= high + CLOSE for z in heights)


def drawn_bodies(count: int) -> list[tuple[Clebsch, Fraction, Fraction]]:
    """Clebsch's bodies with F and G, of both signs."""
    random = Random(20261121)

    def decimal(low: int, high: int) -> Fraction:
        return Fraction(random.randint(low, high), 100)

    return [
        (
            Clebsch(
                *(decimal(50, 200), decimal(50, 200), decimal(-40, 40), decimal(-40, 40)),
                *(decimal(50, 200), decimal(50, 200)),
            ),
            decimal(50, 150),
            decimal(-250, 250),
        )
        for _ in range(count)
    ]


@pytest.mark.parametrize("pole", [1, -1])
@pytest.mark.parametrize("drawn", drawn_bodies(12), ids=str)
def test_the_axial_spin_has_the_linearised_spectrum(
    drawn: tuple[Clebsch, Fraction, Fraction], pole: int
) -> None:
    """Eigenvalues i c +- (r/2) sqrt A: a growth rate, or two frequencies r sqrt(-A) apart."""
    body, F, G = drawn
    zero = Fraction(0)
    scene = immersed(body, (zero, zero, pole * F), (zero, zero, pole * G))
    orbit = elements(scene, 15)
    state = np.array([0, 0, pole * F, 0, 0, pole * G], dtype=float)
    eigenvalues = np.linalg.eigvals(_kirchhoff_jacobian(body.body(), state))
    # A is a square root away from the eigenvalues: half of the digits of a double near A = 0.
    room = 1e-6
    if orbit["A"].value > 0:
        assert abs(float(orbit["axial_growth"].value) - max(eigenvalues.real)) <= room
        assert "unstable" in orbit.sentences[-1]
    else:
        assert max(eigenvalues.real) <= room
        upper = sorted(abs(eigenvalues.imag))[2:]  # the two zeros are along F and G
        apart = 2 * np.pi * float(orbit["axial_nutations"].value)
        either = (abs(upper[-1] - upper[0]), upper[-1] + upper[0])
        assert min(abs(apart - candidate) for candidate in either) <= room
        assert "is stable" in orbit.sentences[-1]


def _kirchhoff_jacobian(body: ImmersedBody, state: Any) -> Any:
    """Of (x x Omega, y x Omega + x x U): central differences are exact for a quadratic field."""
    energy = np.array(body.energy_matrix, dtype=float)

    def field(z: Any) -> Any:
        velocities = energy @ z
        U, Omega = velocities[:3], velocities[3:]
        x, y = z[:3], z[3:]
        return np.concatenate([np.cross(x, Omega), np.cross(y, Omega) + np.cross(x, U)])

    unit = np.eye(6)
    return np.array([(field(state + e) - field(state - e)) / 2 for e in unit]).T


def tilted(body: Clebsch, G: Fraction, tilt: Fraction) -> Scene:
    """F = 1, with x turned off the axis by 2 atan(tilt), and y still along the axis."""
    zero, size = Fraction(0), 1 + tilt**2
    linear = (2 * tilt / size, zero, (1 - tilt**2) / size)
    return immersed(body, linear, (zero, zero, G))


@pytest.mark.parametrize("name", ["falling-away", "onto-the-axis", "half-turn", "half-turn-path"])
def test_an_end_that_is_approached_is_a_root_of_both_f_and_its_slope(name: str) -> None:
    """At it f'' is twice the square of the rate: from one side, or from both where it turns over."""
    scene = load(f"kirchhoff/{name}")
    orbit, f = elements(scene, DIGITS), nutation(scene).f
    with mp.workdps(DIGITS):
        curvatures = []
        for end in (orbit["x3_low"].value, orbit["x3_high"].value):
            slope, half = (
                sum(
                    comb(k, n) * mp.convert(c) * end ** (k - n)
                    for k, c in enumerate(f[::-1])
                    if k >= n
                )
                for n in (1, 2)
            )
            if abs(slope) <= CLOSE:
                curvatures.append(half)
        assert curvatures
        for half in curvatures:
            assert abs(half - orbit["approach_rate"].value ** 2) <= CLOSE


# F = 1 and A = 0: kappa = 1/4, lambda = 0, G = 1, B = 1/2; kappa = -3/4, lambda = -1, G = -1, B = -1/2.
BORDER = {
    "B > 0": (Clebsch(*vector("1", "1.25", "0.125", "0.125", "1", "0.5")), Fraction(1)),
    "B < 0": (Clebsch(*vector("2", "1.25", "0.5", "-0.5", "1", "1")), Fraction(-1)),
    # kappa = -1/4, lambda = 1/2, G = 1, B = 0.
    "C < 0": (Clebsch(*vector("0.75", "0.5", "0", "0.5", "1", "1")), Fraction(1)),
}


@pytest.mark.parametrize(("case", "power"), [("B > 0", 0.5), ("B < 0", 0), ("C < 0", 1 / 3)])
def test_at_the_border_of_stability_B_decides(case: str, power: float) -> None:
    """The widest tilt goes as the root of a small one where B > 0, and stays large where B < 0.

    Where B = 0 too and C < 0, it goes as the cube root.
    """
    body, G = BORDER[case]
    assert stability(nutation(tilted(body, G, Fraction(0))))[0] == 0
    words = elements(tilted(body, G, Fraction(0)), 15).sentences[-1]
    assert case in words
    assert ("unstable" in words) is (power == 0)
    widest = []
    for tilt in (Fraction(1, 10**8), Fraction(1, 10**10)):
        with mp.workdps(DIGITS):
            widest.append(mp.acos(number(tilted(body, G, tilt), "x3_low")))
    # The next order of the law is relative to sqrt(tilt) = 1e-4.
    assert abs(widest[0] / widest[1] / 100**power - 1) <= mpf("0.01")
    assert (widest[1] >= 1) is (power == 0)


@pytest.mark.parametrize("sign", [1, -1])
def test_the_sign_of_A_is_exact(sign: int) -> None:
    """G^2 beside 4 kappa F^2 by a relative 1e-60, which no rounding would show."""
    body, G = BORDER["B > 0"]
    near = G * (1 - sign * Fraction(1, 10**60))
    zero = Fraction(0)
    scene = immersed(body, (zero, zero, Fraction(1)), (zero, zero, near))
    orbit = elements(scene, 15)
    assert mp.sign(orbit["A"].value) == sign
    assert ("unstable" in orbit.sentences[-1]) is (sign > 0)


# Without a closed form.


def test_without_a_closed_form_there_are_invariants_or_nothing() -> None:
    """A general body has T, F and G; of one under loads there is no number, and the words say why."""
    assert list(elements(load("kirchhoff/general-body"))) == ["T", "F", "G"]
    for name in ("euler/constant-moment", "kirchhoff/constant-loads"):
        orbit = elements(load(name), 15)
        assert (orbit.regime, len(orbit)) == ("no closed form", 0)
        assert "no closed form" in orbit.sentences[0]


# How an error is carried, and what `explain` says.


def test_a_steady_unstable_spin_carries_an_error_by_its_matrix_exponential() -> None:
    """The factor at the end is the norm of K exp(J t), relative to |H| and |omega|."""
    scene = load("euler/steady-middle-axis")
    growth = carrying(scene)
    assert growth is not None
    omega = np.array(scene.initial.omega, dtype=float)
    K = np.array(scene.body.inverse_inertia, dtype=float)
    H = np.linalg.solve(K, omega)
    rates, modes = np.linalg.eig(_euler_jacobian(K, H))
    flow = (modes * np.exp(rates * (growth.times[-1] - growth.times[0]))) @ np.linalg.inv(modes)
    expected = np.linalg.norm(K @ flow.real, 2) * np.linalg.norm(H) / np.linalg.norm(omega)
    # Doubles, and an exponential of some thousands.
    assert abs(growth.factors[-1] / expected - 1) <= 1e-9
    assert growth.pace is None


@pytest.mark.parametrize("name", ["euler/generic", "kirchhoff/euler-top", "euler/rest"])
def test_explain_holds_the_elements_and_the_condition(name: str) -> None:
    """The document has every element as text, its words, and the carried error; null at rest."""
    scene = load(name)
    document, orbit = explanation(scene, "f64"), elements(scene, 15)
    assert list(document["orbit"]) == list(orbit)
    assert [e["name"] for e in document["elements"]] == list(orbit)
    assert all(mpf(text) == mpf(text) for text in document["orbit"].values())
    assert document["sentences"] == list(orbit.sentences)
    if name == "euler/rest":
        assert document["condition"] is None
    else:
        assert document["condition"]["worst"] >= document["condition"]["end"] > 0
        assert f"{document['condition']['worst']:.3g}" in document["condition"]["sentence"]


@pytest.mark.parametrize(
    ("name", "on", "rounded", "regimes"),
    [
        ("kirchhoff/vacuum-ellipsoid", "f64", ["body", "start"], ("separatrix", "min-axis")),
        ("euler/separatrix", "f64", [], ("separatrix", "separatrix")),
        ("euler/separatrix", "f32", [], ("separatrix", "separatrix")),
    ],
)
def test_explain_tells_the_scenes_own_orbit_and_what_the_rung_rounds(
    name: str, on: str, rounded: list[str], regimes: tuple[str, str]
) -> None:
    """The regime is decided in the scene's own numbers; beside it stands that of the rounded ones."""
    document = explanation(name, on)
    assert document["rounded"] == rounded
    assert (document["regime"], document["rung_regime"]) == regimes
