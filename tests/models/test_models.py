"""The equations: equal to the texts, in every arithmetic, built only where required, damped or not."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from itertools import product
from random import Random

import numpy as np
import pytest
from builders.turns import by_turns
from flint import arb, fmpq
from mpmath import mp

from taylor_verify.exact.registry import kind_of
from taylor_verify.models.damping import WithDamping
from taylor_verify.models.euler import (
    angular_velocity,
    euler_equations,
    heinbockel_moment,
    momentum_rate,
)
from taylor_verify.models.fastest_rate import Linearised
from taylor_verify.models.form import Form
from taylor_verify.models.frame import attitude_rate, centre_rate, rotation
from taylor_verify.models.general import in_general_form
from taylor_verify.models.kirchhoff import (
    clebsch_equations,
    impulse_rates,
    kirchhoff_equations,
    velocities,
)
from taylor_verify.models.problem import NotRepresentable, Problem, pose
from taylor_verify.numbers import tensors
from taylor_verify.numbers.precision import rung
from taylor_verify.numbers.tensors import Vector
from taylor_verify.records.precisions import LADDER
from taylor_verify.scenes.bodies import ImmersedBody, RigidBody
from taylor_verify.scenes.library import names
from taylor_verify.scenes.loads.loads import Entry
from taylor_verify.scenes.motion import Impulse, Spin
from taylor_verify.scenes.named_numbers import Dimension
from taylor_verify.scenes.reading.reader import load
from taylor_verify.scenes.scene import Scene

PER_INERTIA = Dimension(-1, -2, 0)
EULER_STATES = ("H1", "H2", "H3", "e0", "e1", "e2", "e3")
EULER_PARAMETERS = ("K11", "K12", "K13", "K22", "K23", "K33", "M1", "M2", "M3")
KIRCHHOFF_STATES = ("x1", "x2", "x3", "y1", "y2", "y3", "e0", "e1", "e2", "e3", "c1", "c2", "c3")
KIRCHHOFF_PARAMETERS = tuple(
    [f"{m}{i}{j}" for m in "AC" for i in (1, 2, 3) for j in (1, 2, 3) if i <= j]
    + [f"B{i}{j}" for i in (1, 2, 3) for j in (1, 2, 3)]
    + [f"{v}{i}" for v in "XL" for i in (1, 2, 3)]
)
FORMS = [
    Form(euler_equations, EULER_STATES, EULER_PARAMETERS),
    Form(kirchhoff_equations, KIRCHHOFF_STATES, KIRCHHOFF_PARAMETERS),
    Form(clebsch_equations, KIRCHHOFF_STATES, ("p", "p'", "q", "q'", "r", "r'", "X1", "L3")),
]


def rationals(random: Random, count: int) -> list[Fraction]:
    """Dyadic rationals: a double, an mpf and an Arb ball hold them exactly."""
    return [Fraction(random.randint(-64, 64), 32) for _ in range(count)]


def vector(random: Random) -> tuple[Fraction, ...]:
    return tuple(rationals(random, 3))


def symmetric(random: Random) -> tuple[tuple[Fraction, ...], ...]:
    a, b, c, d, e, f = rationals(random, 6)
    return ((a, b, c), (b, d, e), (c, e, f))


@pytest.mark.parametrize("seed", range(20))
def test_momentum_form_is_the_form_of_the_text(seed: int) -> None:
    """With omega = K H and I = K^-1, H' = H x K H + M gives back M in Heinbockel (2.2.70)."""
    random = Random(seed)
    K, H, M = symmetric(random), vector(random), vector(random)
    K = tuple(tuple(v + 9 * (i == j) for j, v in enumerate(row)) for i, row in enumerate(K))
    omega = angular_velocity(H, K)
    omega_rate = angular_velocity(momentum_rate(H, K, M), K)
    assert heinbockel_moment(omega, omega_rate, tensors.inverse(K)) == list(M)


@pytest.mark.parametrize("seed", range(20))
def test_text_in_components_and_in_principal_axes(seed: int) -> None:
    """(2.2.70) written out is (2.2.71), and in principal axes (2.2.72), index by index."""
    random = Random(seed)
    I, w, a = symmetric(random), vector(random), vector(random)
    h = tensors.apply(I, w)
    components = [
        tensors.dot(I[0], a) + h[2] * w[1] - h[1] * w[2],
        tensors.dot(I[1], a) + h[0] * w[2] - h[2] * w[0],
        tensors.dot(I[2], a) + h[1] * w[0] - h[0] * w[1],
    ]
    assert heinbockel_moment(w, a, I) == components
    J = tensors.diagonal((I[0][0], I[1][1], I[2][2]))
    assert heinbockel_moment(w, a, J) == [
        J[0][0] * a[0] + (J[2][2] - J[1][1]) * w[1] * w[2],
        J[1][1] * a[1] + (J[0][0] - J[2][2]) * w[2] * w[0],
        J[2][2] * a[2] + (J[1][1] - J[0][0]) * w[0] * w[1],
    ]


@pytest.mark.parametrize("seed", range(20))
def test_kirchhoff_conserves_identically(seed: int) -> None:
    """d(x.x)/dt = 2 x.X, d(x.y)/dt = X.y + x.L and dT/dt = U.X + Omega.L for any 21 numbers."""
    random = Random(seed)
    A, C, B = symmetric(random), symmetric(random), tuple(vector(random) for _ in range(3))
    x, y, X, L = (vector(random) for _ in range(4))
    U, Omega = velocities(x, y, A, B, C)
    x_rate, y_rate = impulse_rates(x, y, U, Omega, X, L)
    assert tensors.dot(x, x_rate) == tensors.dot(x, X)
    fg_rate = tensors.dot(x_rate, y) + tensors.dot(x, y_rate)
    assert fg_rate == tensors.dot(X, y) + tensors.dot(x, L)
    work = tensors.dot(U, x_rate) + tensors.dot(Omega, y_rate)
    assert work == tensors.dot(U, X) + tensors.dot(Omega, L)


@pytest.mark.parametrize("seed", range(10))
def test_attitude_turns_with_the_body(seed: int) -> None:
    """q' = q (0, omega)/2 is R' = R [omega]x for R = R(q), and keeps |q|; c' is R U + (1 - |q|^2) U."""
    random = Random(seed)
    q, w, U = rationals(random, 4), vector(random), vector(random)
    rate = attitude_rate(q, w)
    assert tensors.dot(tuple(q), tuple(rate)) == 0
    # R is quadratic in q, so its derivative along q' is an exact central difference.
    ahead = rotation([a + b for a, b in zip(q, rate, strict=True)])
    behind = rotation([a - b for a, b in zip(q, rate, strict=True)])
    R = rotation(q)
    for i in range(3):
        turned = tensors.cross(tuple(R[i]), w)
        assert [(ahead[i][j] - behind[i][j]) / 2 for j in range(3)] == list(turned)
    excess = 1 - tensors.dot(tuple(q), tuple(q))
    expected = [tensors.dot(tuple(row), U) + excess * U[i] for i, row in enumerate(R)]
    assert centre_rate(q, U) == expected


@pytest.mark.parametrize("form", FORMS, ids=lambda form: "".join(form.states))
def test_one_definition_serves_every_arithmetic(form: Form) -> None:
    """Fractions, mpf, Arb balls, NumPy arrays and heyoka expressions give one and the same number."""
    import heyoka as hy

    random = Random(1)
    state, parameters = rationals(random, len(form.states)), rationals(random, len(form.parameters))
    exact = form.rates(state, parameters)

    def rates_in(convert: object) -> list[object]:
        return form.rates([convert(v) for v in state], [convert(v) for v in parameters])

    # Dyadic data with 12 bits: products of four of them fit a double, so all agree to the bit.
    assert [float(v) for v in rates_in(mp.convert)] == [float(v) for v in exact]
    balls = rates_in(lambda v: arb(fmpq(v.numerator, v.denominator)))
    assert all(
        b.contains(fmpq(v.numerator, v.denominator)) for b, v in zip(balls, exact, strict=True)
    )
    arrays = rates_in(lambda v: np.full(2, float(v)))
    assert all(np.all(a == float(v)) for a, v in zip(arrays, exact, strict=True))
    symbols = hy.make_vars(*form.states)
    expressions = form.rates(symbols, [hy.par[i] for i in range(len(parameters))])
    compiled = hy.cfunc(expressions, vars=symbols)
    values = compiled([float(v) for v in state], pars=[float(v) for v in parameters])
    assert list(values) == [float(v) for v in exact]


def test_only_what_the_scene_tracks_is_built() -> None:
    """No attitude, no load and no zero coefficient leaves a trace in states, parameters or text."""
    free = pose(load("euler/generic"), rung("f64"))
    assert free.form.states == ("H1", "H2", "H3")
    assert free.form.parameters == ("D1", "D3")
    assert all("M" not in line and "K" not in line for line in free.form.text())
    loaded = pose(load("euler/constant-moment"), rung("f64"))
    assert set(loaded.form.parameters) == {"D1", "D3", "M1", "M2", "M3"}
    tracked = pose(load("euler/with-attitude"), rung("f64"))
    assert tracked.form.states == EULER_STATES


def wheels(problem: Problem) -> Vector:
    """The momentum at the start of wheels that a text writes, whose entries are numbers or own states."""
    loads = problem.given.body.loads
    if loads is None or not loads.rotor:
        return tensors.ZERO_VECTOR
    starts: dict[Entry, Fraction] = {}
    for state in loads.states:
        starts |= dict(zip(state.components, state.start or (), strict=True))
    return tuple(
        starts[entry] if isinstance(entry, str) else problem.rung.round(entry)
        for entry in loads.rotor
    )


@pytest.mark.parametrize(
    ("name", "rung_name"), by_turns(product(names(), LADDER), 12, lambda name, _: name)
)
def test_posed_data_are_numbers_of_the_rung_and_an_exact_body(name: str, rung_name: str) -> None:
    """Every number handed to a solver is held by its rung, and `given` is the body they define."""
    problem = pose(load(name), rung(rung_name))
    numbers = (*problem.parameters, *problem.initial_momenta, *problem.times)
    assert all(problem.rung.holds(value) for value in numbers)
    units, parameter = problem.units, problem.parameter
    if problem.scene.model == "euler":
        K = tensors.inverse(problem.given.body.inertia)
        assert K == tensors.transpose(K)
        assert K[0][1] == parameter.get("K12", 0) * units.of(PER_INERTIA)
        H = tuple(problem.state[f"H{i}"] * units.momentum for i in (1, 2, 3))
        assert problem.given.initial.omega == tensors.apply(K, tensors.minus(H, wheels(problem)))
    else:
        x = tuple(problem.state[f"x{i}"] * units.impulse for i in (1, 2, 3))
        assert problem.given.initial.linear == x


def test_a_third_is_rounded_once_and_not_through_a_double() -> None:
    """On mp237 the coefficient 1/3 is wrong by less than 2^-238, not by the 2e-17 of a double."""
    scene = load("euler/generic")
    problem = pose(scene, rung("mp237"))
    exact = scene.body.inverse_inertia[2][2] / problem.units.of(PER_INERTIA)
    assert problem.parameter["K33"] != exact
    assert abs(problem.parameter["K33"] / exact - 1) <= Fraction(1, 2**237)


@pytest.mark.parametrize("ratio", ["1e-4", "1e-10", "1e-40", "1e12"])
def test_the_fastest_rate_is_of_order_one_however_far_apart_the_moments_are(ratio: str) -> None:
    """H may turn far faster than the body: a Taylor series in units of omega would overflow.

    The bound on the roots is within a factor of two, the power of two within another one on each side.
    """
    moments = tensors.diagonal((Fraction(ratio), Fraction(1), Fraction(9, 10)))
    scene = replace(load("euler/generic"), body=RigidBody(moments))
    problem = pose(scene, rung("f64"))
    fastest = Linearised(problem).fastest([float(value) for value in problem.initial_momenta])
    assert 2**-3 <= fastest <= 2**2


@pytest.mark.parametrize("exponent", [-300, -7, 12, 500])
def test_units_are_chosen_so_that_a_rescaled_scene_is_the_same_problem(exponent: int) -> None:
    """Momenta and time rescaled by powers of two pose bit for bit the same numbers."""
    scene = load("kirchhoff/screw")
    factor = Fraction(2) ** exponent
    faster = replace(
        scene,
        body=_scaled_body(scene.body, factor),
        initial=scene.initial.with_moving(tuple(v / factor for v in scene.initial.moving)),
    )
    one, other = pose(scene, rung("f64")), pose(faster, rung("f64"))
    assert (one.parameters, one.initial_momenta, one.times) == (
        other.parameters,
        other.initial_momenta,
        other.times,
    )


def _scaled_body(body: ImmersedBody, factor: Fraction) -> ImmersedBody:
    def scaled(matrix: tensors.Matrix) -> tensors.Matrix:
        return tuple(tensors.scaled(factor, row) for row in matrix)

    return ImmersedBody(scaled(body.linear), scaled(body.coupling), scaled(body.angular))


def test_rest_and_zero_impulse_are_posed() -> None:
    """A body at rest, and one with x = 0, have units of size one and finite numbers."""
    scene = load("kirchhoff/screw")
    still = replace(scene, initial=Impulse((Fraction(0),) * 3, scene.initial.angular))
    rest = replace(scene, initial=Impulse((Fraction(0),) * 3, (Fraction(0),) * 3))
    for posed in (pose(still, rung("f64")), pose(rest, rung("f64"))):
        assert all(posed.rung.holds(value) for value in posed.parameters)


def test_the_two_starts_of_a_problem_cannot_be_confused() -> None:
    """One is named for its momenta, I omega; the other is omega; and `initial` alone is neither."""
    problem = pose(load("euler/generic"), rung("f64"))
    given = problem.given
    assert isinstance(given.body, RigidBody)
    assert isinstance(given.initial, Spin)
    H = tensors.apply(given.body.inertia, given.initial.omega)
    assert H != given.initial.omega
    assert tuple(problem.units.momentum * value for value in problem.initial_momenta) == H
    assert not hasattr(problem, "initial")
    with pytest.raises(
        AttributeError, match=r"expected problem\.given\.initial .* or problem\.initi"
    ):
        problem.initial  # noqa: B018 (to ask for it is what is tested)


# Damping

SCENES = ("euler/generic", "euler/full-tensor", "euler/gyrostat", "kirchhoff/four-real-roots")
SCENES += ("kirchhoff/general-body", "kirchhoff/constant-loads", "kirchhoff/trigonometric")


def damped(name: str, damping: Fraction) -> Scene:
    scene = load(name)
    return replace(scene, body=replace(scene.body, damping=damping))  # type: ignore[type-var]


@pytest.mark.parametrize("name", SCENES)
def test_no_damping_builds_the_same_equations(name: str) -> None:
    """With damping = 0 the problem is the one without the key: equations, parameters, units and all."""
    asked, plain = (pose(scene, rung("f64")) for scene in (damped(name, Fraction(0)), load(name)))
    assert replace(asked, scene=plain.scene).__dict__ == plain.__dict__
    assert not isinstance(asked.form.equations, WithDamping)
    assert "d" not in asked.parameter


@pytest.mark.parametrize("on", ["f32", "f64", "f80", "f128", "mp237"])
@pytest.mark.parametrize("name", SCENES)
def test_the_rates_are_those_of_the_truth(name: str, on: str) -> None:
    """-d z in the rate of every momentum, both forms alike, as the truth has it from the texts."""
    problem = pose(damped(name, Fraction(-1, 3)), rung(on))
    kind, body, units = kind_of(problem.given.body), problem.given.body, problem.units
    z = np.array(kind.momentum(body, kind.state(problem.given.initial)), dtype=object)
    equations = kind.momentum_equations(body)
    truth = equations.constant + equations.linear @ z + (equations.hessian @ z) @ z / 2
    sizes = [units.momentum] * 3 if len(z) == 3 else [units.impulse] * 3 + [units.momentum] * 3
    for posed in (problem, in_general_form(problem)):
        state = [posed.state[s] for s in posed.form.states]
        rates = dict(zip(posed.form.states, posed.form.rates(state, posed.parameters), strict=True))
        names = ("H1", "H2", "H3") if len(z) == 3 else ("x1", "x2", "x3", "y1", "y2", "y3")
        for k, component in enumerate(names):
            assert rates[component] * sizes[k] / units.time == truth[k]


def test_a_component_that_damping_alone_moves_is_a_state() -> None:
    """y3 of Clebsch's body is a constant, and no state, without damping; with damping it decays."""
    free = pose(load("kirchhoff/four-real-roots"), rung("f64"))
    asked = pose(damped("kirchhoff/four-real-roots", Fraction(1, 4)), rung("f64"))
    assert "y3" not in free.form.states
    assert "y3' = -d y3" in asked.form.text()


def test_damping_is_rounded_once() -> None:
    """The body that was given has the nearest number of the rung, counted in units of time exactly."""
    scene = damped("euler/generic", Fraction(1, 10))
    problem = pose(scene, rung("f32"))
    assert problem.given.body.damping == Fraction(float(np.float32(0.1)))
    assert problem.parameter["d"] == problem.given.body.damping * problem.units.time


def test_a_fast_decay_sets_the_unit_of_time() -> None:
    """A damping of 1000 has a unit of time to fit it, and a weak one leaves the unit as it was."""
    free = pose(load("euler/generic"), rung("f64")).units
    assert pose(damped("euler/generic", Fraction(1000)), rung("f64")).units.time == Fraction(1, 512)
    assert pose(damped("euler/generic", Fraction(1, 10**30)), rung("f64")).units == free


def test_what_a_rung_cannot_hold() -> None:
    """A damping below the least number of a rung is refused, or none: it is never another one."""
    scene = damped("euler/generic", Fraction(1, 10**60))
    try:
        problem = pose(scene, rung("f32"))
    except NotRepresentable:
        return
    assert problem.given.body.damping == 0
    assert not isinstance(problem.form.equations, WithDamping)
