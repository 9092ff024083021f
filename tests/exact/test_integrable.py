"""Fourth integrals: proven by algebra, recognised in rationals, held wherever such a body runs."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from fractions import Fraction
from random import Random
from typing import Any

import numpy as np
import pytest
from flint import Ordering, fmpq, fmpq_mat, fmpq_mpoly, fmpq_mpoly_ctx
from mpmath import mp, mpf

from taylor_verify.exact.kirchhoff import integrable
from taylor_verify.exact.kirchhoff.integrable import Fourth, fourth_integral
from taylor_verify.exact.taylor import TaylorSolution
from taylor_verify.models.problem import pose
from taylor_verify.numbers.precision import rung
from taylor_verify.numbers.tensors import Matrix, Vector
from taylor_verify.records.precisions import LADDER
from taylor_verify.records.status import Status
from taylor_verify.run import run
from taylor_verify.scenes.bodies import ImmersedBody
from taylor_verify.scenes.motion import Impulse, Motion
from taylor_verify.scenes.reading.reader import load
from taylor_verify.scenes.scene import Scene

SCENES = {
    "clebsch-second-case": "clebsch2",
    "equal-rotations": "neumann",
    "steklov": "steklov",
    "lyapunov": "lyapunov",
    "chaplygin": "chaplygin",
    "sokolov": "sokolov",
}
NAMES = ("x1", "x2", "x3", "y1", "y2", "y3")
CYCLIC = ((0, 1, 2), (1, 2, 0), (2, 0, 1))


def shipped(name: str) -> Scene:
    return load(f"kirchhoff/{name}")


def fourth(scene: Scene) -> Fourth:
    integral = fourth_integral(scene)
    assert integral is not None
    return integral


def body_of(scene: Scene) -> ImmersedBody:
    assert isinstance(scene.body, ImmersedBody)
    return scene.body


# The equations of motion, on polynomials.


def cross(a: Sequence[Any], b: Sequence[Any]) -> list[Any]:
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def rate(integral: fmpq_mpoly, T: fmpq_mpoly, x: Sequence[Any], y: Sequence[Any]) -> fmpq_mpoly:
    """The rate of a polynomial along 48 (3), (4), with U = dT/dx and Omega = dT/dy."""
    U, Omega = ([T.derivative(n + m) for m in range(3)] for n in (0, 3))
    torque = [p + q for p, q in zip(cross(y, Omega), cross(x, U), strict=True)]
    rates = cross(x, Omega) + torque
    return sum((integral.derivative(n) * r for n, r in enumerate(rates)), 0 * T)


def symbols(*names: str) -> tuple[Any, Any, dict[str, Any]]:
    """x, y and the coefficients by name; p0 and b0 are always among these."""
    every = (*NAMES, "p0", "b0", *names)
    generators = fmpq_mpoly_ctx.get(every, Ordering.lex).gens()
    return generators[:3], generators[3:6], dict(zip(every[6:], generators[6:], strict=True))


def squares(v: Sequence[Any]) -> Any:
    return sum(e * e for e in v)


def dot(v: Sequence[Any], w: Sequence[Any]) -> Any:
    return sum(p * q for p, q in zip(v, w, strict=True))


# Twice T of each family, and its integral, with every coefficient a symbol. Denominators are cleared:
# T times a constant only changes the unit of time.
Family = Callable[[], tuple[Any, Any, Any, Any]]


def clebsch2() -> tuple[Any, Any, Any, Any]:
    x, y, s = symbols("r1", "r2", "r3", "theta")
    r = [s["r1"], s["r2"], s["r3"]]
    T = sum(r[i] * y[i] ** 2 + s["theta"] * r[j] * r[k] * x[i] ** 2 for i, j, k in CYCLIC)
    return x, y, T + casimirs(x, y, s), integrable.clebsch2(x, y, r, s["theta"])


def neumann() -> tuple[Any, Any, Any, Any]:
    x, y, s = symbols("p1", "p2", "p3", "r")
    p = [s["p1"], s["p2"], s["p3"]]
    T = sum(s["r"] * y[i] ** 2 + p[i] * x[i] ** 2 for i in range(3))
    return x, y, T + casimirs(x, y, s), integrable.neumann(x, y, s["r"], p)


def steklov() -> tuple[Any, Any, Any, Any]:
    x, y, s = symbols("r1", "r2", "r3", "mu")
    r, mu = [s["r1"], s["r2"], s["r3"]], s["mu"]
    T = sum(
        r[i] * y[i] ** 2
        + 2 * mu * r[j] * r[k] * x[i] * y[i]
        + mu**2 * r[i] * (r[j] - r[k]) ** 2 * x[i] ** 2
        for i, j, k in CYCLIC
    )
    return x, y, T + casimirs(x, y, s), integrable.steklov(x, y, r, mu)


def lyapunov() -> tuple[Any, Any, Any, Any]:
    x, y, s = symbols("b1", "b2", "b3", "r")
    b, r = [s["b1"], s["b2"], s["b3"]], s["r"]
    T = sum(
        r**2 * y[i] ** 2 + 2 * r * b[i] * x[i] * y[i] + (b[j] - b[k]) ** 2 * x[i] ** 2
        for i, j, k in CYCLIC
    )
    return x, y, T + casimirs(x, y, s), integrable.lyapunov(x, y, r, b)


def chaplygin() -> tuple[Any, Any, Any, Any]:
    x, y, s = symbols("a", "c", "d")
    a, c, d = s["a"], s["c"], s["d"]
    T = a * (y[0] ** 2 + y[1] ** 2 + 2 * y[2] ** 2) + c * (x[0] ** 2 - x[1] ** 2)
    T = T + 2 * d * x[0] * x[1]
    return x, y, T + casimirs(x, y, s), integrable.chaplygin(x, y, a, c, d)


def sokolov() -> tuple[Any, Any, Any, Any]:
    x, y, s = symbols("a", "c", "d")
    a, c, d = s["a"], s["c"], s["d"]
    T = a**2 * (y[0] ** 2 + y[1] ** 2 + 2 * y[2] ** 2) + 2 * a * (c * x[0] + d * x[1]) * y[2]
    T = T - (c**2 + d**2) * x[2] ** 2
    return x, y, T + casimirs(x, y, s), integrable.sokolov(x, y, a, c, d)


def casimirs(x: Sequence[Any], y: Sequence[Any], s: dict[str, Any]) -> Any:
    return s["p0"] * squares(x) + s["b0"] * dot(x, y)


@pytest.mark.parametrize("family", [clebsch2, neumann, steklov, lyapunov, sokolov])
def test_the_integral_is_constant_for_every_coefficient(family: Family) -> None:
    """{I, T} = 0 identically in x, y and the coefficients, with any F^2 and FG added to T."""
    x, y, T, integral = family()
    assert integral != 0
    assert rate(integral, T, x, y) == 0


def test_chaplygins_is_constant_where_fg_is_zero_and_leaks_as_stated() -> None:
    """K' = 2 leak FG identically (twice T was put in), and the leak does not vanish."""
    x, y, T, integral = chaplygin()
    generators = integral.context().gens()
    a, c, d = generators[8:]
    leak = integrable.chaplygin_leak(x, y, a, c, d)
    assert leak != 0
    assert rate(integral, T, x, y) == 2 * leak * dot(x, y)


# The shipped scenes.


def polynomial(terms: integrable.Terms) -> fmpq_mpoly:
    context = fmpq_mpoly_ctx.get(NAMES, Ordering.lex)
    return context.from_dict({n: fmpq(c.numerator, c.denominator) for n, c in terms.items()})


def energy(body: ImmersedBody) -> fmpq_mpoly:
    state = fmpq_mpoly_ctx.get(NAMES, Ordering.lex).gens()
    entries = [[fmpq(e.numerator, e.denominator) for e in row] for row in body.energy_matrix]
    return sum(
        (entries[n][m] * state[n] * state[m] for n in range(6) for m in range(6)), 0 * state[0]
    ) * fmpq(1, 2)


def remainder(integral: fmpq_mpoly, T: fmpq_mpoly, only_orthogonal: bool) -> fmpq_mpoly:
    """The integral's rate; for Chaplygin's what FG = 0 leaves of it."""
    state = T.context().gens()
    change = rate(integral, T, state[:3], state[3:])
    return divmod(change, dot(state[:3], state[3:]))[1] if only_orthogonal else change


@pytest.mark.parametrize("name", SCENES)
def test_a_wrong_coefficient_is_caught(name: str) -> None:
    """The integral of the scene is one; with any single coefficient 1 + 2^-40 of itself it is not."""
    scene = shipped(name)
    integral, T = fourth(scene), energy(body_of(scene))
    assert remainder(polynomial(integral.terms), T, bool(integral.leak)) == 0
    for powers, c in integral.terms.items():
        wrong = {**integral.terms, powers: c * (1 + Fraction(1, 2**40))}
        assert remainder(polynomial(wrong), T, bool(integral.leak)) != 0


@pytest.mark.parametrize("name", SCENES)
def test_it_says_what_the_three_others_do_not(name: str) -> None:
    """The gradients of T, F^2, FG and the integral are independent at the start."""
    scene = shipped(name)
    assert isinstance(scene.initial, Impulse)
    state = fmpq_mpoly_ctx.get(NAMES, Ordering.lex).gens()
    x, y = state[:3], state[3:]
    four = [energy(body_of(scene)), squares(x), dot(x, y), polynomial(fourth(scene).terms)]
    start = [fmpq(e.numerator, e.denominator) for e in scene.initial.linear + scene.initial.angular]
    rows = [[p.derivative(n)(*start) for n in range(6)] for p in four]
    assert fmpq_mat(rows).rank() == 4


@pytest.mark.parametrize("name", SCENES)
@pytest.mark.parametrize("step", LADDER)
def test_every_rung_has_the_integral_of_the_shipped_scene(name: str, step: str) -> None:
    """Their coefficients are dyadic: no rung rounds the relation away."""
    given = pose(shipped(name), rung(step)).given
    assert fourth(given).name == SCENES[name]
    assert fourth(given).terms == fourth(shipped(name)).terms


def test_a_wrong_theta_fails_the_gate_of_clebsch2_and_no_other(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The broken twin: theta off by a part in 10^9 is no constant of the motion, and is seen."""
    right = integrable.clebsch2
    monkeypatch.setitem(
        integrable.FORMULAS,
        "clebsch2",
        lambda x, y, r, theta: right(x, y, r, theta * (1 + fmpq(1, 10**9))),
    )
    verdicts = run(shipped("clebsch-second-case"), "taylor", "f64").verdicts
    assert {v.quantity for v in verdicts if v.verdict is not Status.PASS} == {"clebsch2"}
    assert {v.quantity for v in verdicts} >= {"impulse", "T", "F2", "FG"}


# Recognition.


def changed(matrix: Matrix, i: int, j: int, by: Fraction) -> Matrix:
    rows = [list(row) for row in matrix]
    rows[i][j] += by
    return tuple(tuple(row) for row in rows)


def with_body(scene: Scene, **parts: Any) -> Scene:
    return replace(scene, body=replace(body_of(scene), **parts))


@pytest.mark.parametrize("name", [n for n in SCENES if n != "equal-rotations"])
def test_what_holds_nearly_is_no_integral_until_a_rung_rounds_it(name: str) -> None:
    """p_1 off by 2^-60 is another body on f128, and the same one on f64."""
    scene = shipped(name)
    near = with_body(scene, linear=changed(body_of(scene).linear, 0, 0, Fraction(1, 2**60)))
    assert fourth_integral(near) is None
    assert fourth_integral(pose(near, rung("f128")).given) is None
    assert fourth(pose(near, rung("f64")).given).name == SCENES[name]


def test_any_p_will_do_where_the_r_are_equal_but_no_other_r() -> None:
    """With r_3 off by 2^-60 the body with equal rotations has no fourth integral."""
    scene = shipped("equal-rotations")
    C = body_of(scene).angular
    near = with_body(scene, angular=changed(C, 2, 2, Fraction(1, 2**60)))
    assert fourth_integral(near) is None
    other_p = changed(body_of(scene).linear, 1, 1, Fraction(1, 3))
    assert fourth(with_body(scene, linear=other_p)).name == "neumann"


@pytest.mark.parametrize("name", SCENES)
def test_casimirs_in_the_energy_change_nothing(name: str) -> None:
    """p0 F^2 and b0 FG more in T leave the word and every difference of the integral's terms."""
    scene = shipped(name)
    body = body_of(scene)
    A, B = body.linear, body.coupling
    for n in range(3):
        A, B = changed(A, n, n, Fraction(5, 3)), changed(B, n, n, Fraction(1, 7))
    integral = fourth(with_body(scene, linear=A, coupling=B))
    assert (integral.name, integral.terms) == (SCENES[name], fourth(scene).terms)


def test_chaplygins_needs_orthogonal_impulses_and_no_body_is_loaded() -> None:
    """With FG != 0, or with a couple, nothing is recognised."""
    scene = shipped("chaplygin")
    assert isinstance(scene.initial, Impulse)
    askew = replace(scene.initial, angular=(Fraction(1), Fraction(0), Fraction(0)))
    assert fourth_integral(replace(scene, initial=askew)) is None
    couple: Vector = (Fraction(0), Fraction(0), Fraction(1))
    assert fourth_integral(with_body(shipped("steklov"), couple=couple)) is None
    assert fourth_integral(load("kirchhoff/general-body")) is None
    assert fourth_integral(load("kirchhoff/four-real-roots")) is None  # it has y3


# Scale and sensitivity.


def still(x: Sequence[Fraction], y: Sequence[Fraction]) -> Motion:
    rows = {"linear_impulse": x, "angular_impulse": y}
    quantities = {
        n: np.array([[mp.convert(e) for e in row]], dtype=object) for n, row in rows.items()
    }
    return Motion(quantities, np.array([mp.zero], dtype=object))


@pytest.mark.parametrize("name", SCENES)
def test_the_scale_is_never_less_than_the_integral_and_vanishes_never(name: str) -> None:
    """Drawn states: |I| <= scale > 0; no motion, or an integral without terms left, has scale 1."""
    integral, draw = fourth(shipped(name)), Random(name)
    with mp.workdps(40):
        for _ in range(50):
            x, y = ([Fraction(draw.randint(-9, 9), 7) for _ in range(3)] for _ in range(2))
            motion = still(x, y)
            slack = 1 + mpf(10) ** -38
            assert abs(integral.value(motion)[0]) <= slack * integral.scale(motion)
            assert integral.scale(motion) > 0
        assert integral.scale(still([Fraction(0)] * 3, [Fraction(0)] * 3)) == 1


@pytest.mark.parametrize("name", SCENES)
def test_sensitivity_is_the_norm_of_the_gradient(name: str) -> None:
    """Difference quotients of the value, by x and by y; Chaplygin's leak comes on top of it."""
    integral = fourth(shipped(name))
    step = Fraction(1, 10**20)
    state = [Fraction(n, 7) for n in (5, -3, 4, 2, 6, -1)]
    with mp.workdps(60):
        here = still(state[:3], state[3:])
        bare = replace(integral, leak={}).sensitivity(here)
        for block, places in (("linear_impulse", (0, 1, 2)), ("angular_impulse", (3, 4, 5))):
            quotients = []
            for n in places:
                moved = [e + step * (m == n) for m, e in enumerate(state)]
                there = still(moved[:3], moved[3:])
                quotients.append((integral.value(there)[0] - integral.value(here)[0]) / step)
            # The quotient differs from the derivative by the step times a second derivative.
            assert abs(mp.norm(quotients) - bare[block][0]) <= mpf(10) ** -17 * bare[block][0]
            whole = integral.sensitivity(here)[block][0]
            assert whole > bare[block][0] if integral.leak else whole == bare[block][0]


def test_what_leaks_by_a_disturbed_fg_stays_within_the_sensitivity() -> None:
    """Chaplygin's K after y was moved along x by 10^-12 changes by no more than was stated."""
    scene = shipped("chaplygin")
    assert isinstance(scene.initial, Impulse)
    integral, move = fourth(scene), Fraction(1, 10**12)
    x, y = scene.initial.linear, scene.initial.angular
    nudged = replace(scene.initial, angular=tuple(b + move * a for a, b in zip(x, y, strict=True)))
    elapsed = [Fraction(n, 2) for n in range(11)]
    plain = TaylorSolution(scene).motion(elapsed, 30)
    there = TaylorSolution(replace(scene, initial=nudged)).motion(elapsed, 30)
    with mp.workdps(40):
        size = mp.convert(move) * mp.norm([mp.convert(e) for e in x])
        stated = size * max(integral.sensitivity(plain)["angular_impulse"])
        differences = abs(integral.value(there) - integral.value(plain))
        assert max(differences) <= stated
        # And it does leak: K of the disturbed motion is no constant of it.
        assert max(abs(integral.value(there) - integral.value(there)[0])) >= mpf(10) ** -14
