"""Derivatives of the motion by its start and its body are those of the linearised equations."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from fractions import Fraction
from functools import cache
from typing import Any

import numpy as np
import pytest
from builders.numbers import largest
from builders.scenes import IMPULSE, LOADED, MOMENT, SIX, SPIN, TENSOR, one_instant, vector
from mpmath import mp, mpf

from taylor_verify.exact.conditioning import sensitivity as module
from taylor_verify.exact.conditioning.differences import derivatives, difference
from taylor_verify.exact.conditioning.inputs import body_input
from taylor_verify.exact.conditioning.sensitivity import Sensitivity, sensitivity
from taylor_verify.exact.rotation import rotation_matrix
from taylor_verify.exact.route import solution
from taylor_verify.exact.solution import Unsettled
from taylor_verify.scenes.bodies import RigidBody
from taylor_verify.scenes.motion import Spin
from taylor_verify.scenes.reading.reader import load
from taylor_verify.scenes.scene import Scene
from taylor_verify.scenes.tensors import Vector, diagonal, scaled

Array = np.ndarray[Any, Any]
Twin = Callable[[Sensitivity], Sensitivity]


TUMBLING = one_instant(RigidBody(TENSOR), SPIN, "attitude")
CLEBSCH = one_instant(SIX.body(), IMPULSE, "attitude", "centre")
SCENES = {
    "tumbling": TUMBLING,
    "moment": one_instant(RigidBody(TENSOR, MOMENT), SPIN, "attitude"),
    "axisymmetric": one_instant(
        RigidBody(diagonal(vector(1, 1, 2))), Spin(vector("0.6", "0.8", "0.5")), "attitude"
    ),
    "clebsch": CLEBSCH,
    "general": one_instant(LOADED, IMPULSE, "attitude", "centre"),
    "damped": one_instant(RigidBody(TENSOR, damping=Fraction(1, 5)), SPIN, "attitude"),
    "damped, moment": one_instant(
        RigidBody(TENSOR, MOMENT, damping=Fraction(-1, 7)), SPIN, "attitude"
    ),
    "damped, clebsch": replace(CLEBSCH, body=CLEBSCH.body.with_damping(Fraction(2, 5))),
}


def column(entries: Vector) -> Array:
    return np.array([mp.convert(entry) for entry in entries], dtype=object)


def combined(derivatives: Sensitivity, quantity: str, weights: dict[str, Vector]) -> Array:
    """The derivative along one direction of all inputs, (n, 3)."""
    parts = [derivatives[quantity, name] @ column(direction) for name, direction in weights.items()]
    total: Array = sum(parts[1:], parts[0])
    return total


# The equations of motion, written once more for this comparison, and linearised by differences of
# polynomials: with a step of 1e-20 in 60 digits these are good to 1e-38.

ENTRIES = ((0, 0), (1, 1), (2, 2), (1, 2), (0, 2), (0, 1))
LITTLE = mpf("1e-20")
State = dict[str, Array]


def rates(problem: Scene, state: State, body: Sequence[Any], damping: Any) -> State:
    """z', R' and c' of a state; the body as the numbers that sensitivity calls its components."""
    R = state["attitude"]
    if isinstance(problem.body, RigidBody):
        inertia, omega = symmetric(body), state["omega"]
        inverse = np.array(mp.inverse(mp.matrix(inertia.tolist())).tolist(), dtype=object)
        torque = np.cross(inertia @ omega, omega) + column(problem.body.moment)
        slowing = damping * omega
        return {"omega": inverse @ torque - slowing, "attitude": R @ cross_matrix(omega)}
    x, y = state["linear_impulse"], state["angular_impulse"]
    A, B, C = matrices(body)
    U, omega = A @ x + B @ y, B.T @ x + C @ y
    return {
        "linear_impulse": np.cross(x, omega) + column(problem.body.force) - damping * x,
        "angular_impulse": (
            np.cross(y, omega) + np.cross(x, U) + column(problem.body.couple) - damping * y
        ),
        "attitude": R @ cross_matrix(omega),
        "centre": R @ U,
    }


def symmetric(six: Sequence[Any]) -> Array:
    tensor = np.zeros((3, 3), dtype=object)
    for (i, k), entry in zip(ENTRIES, six, strict=True):
        tensor[i, k] = tensor[k, i] = entry
    return tensor


def matrices(body: Sequence[Any]) -> tuple[Array, Array, Array]:
    if len(body) == 6:
        p, p_prime, q, q_prime, r, r_prime = body
        return tuple(np.diag(row) for row in ((p, p, p_prime), (q, q, q_prime), (r, r, r_prime)))
    return symmetric(body[:6]), np.array(body[6:15]).reshape(3, 3), symmetric(body[15:])


def cross_matrix(v: Array) -> Array:
    zero = mpf(0)
    return np.array([[zero, -v[2], v[1]], [v[2], zero, -v[0]], [-v[1], v[0], zero]], dtype=object)


def numbers(problem: Scene) -> list[Any]:
    """The components of the body, rounded at the ambient precision."""
    body = problem.body
    if isinstance(body, RigidBody):
        return [mp.convert(body.inertia[i][k]) for i, k in ENTRIES]
    if body.clebsch is not None:
        six = body.clebsch
        return [mp.convert(c) for c in (six.p, six.p_prime, six.q, six.q_prime, six.r, six.r_prime)]
    outer = [[m[i][k] for i, k in ENTRIES] for m in (body.linear, body.angular)]
    inner = [entry for row in body.coupling for entry in row]
    return [mp.convert(c) for c in (*outer[0], *inner, *outer[1])]


TIMES = vector("0.7", 3, -5)
DIGITS = 20
# The digits asked for, times sums of six numbers of size ten.
CLOSE = mpf(10) ** (2 - DIGITS)
MIDDLE, STEP = Fraction(1, 2), Fraction(1, 2**33)


@cache
def known(name: str) -> Sensitivity:
    """At the start, and at three times close together."""
    return sensitivity(SCENES[name], [MIDDLE - STEP, MIDDLE, MIDDLE + STEP, Fraction(0)], 25)


def misfit(name: str, twin: Twin = lambda derivatives: derivatives) -> mpf:
    """How far each derivative's rate of change is from the linearised equations, at the most.

    The rate is a central difference over 2^-33 of a unit of time: right to 1e-21 of a third
    derivative of some tens, and to 1e-25/1e-10 by the digits asked for.
    """
    problem, derivatives = SCENES[name], twin(known(name))
    motion = solution(problem).motion(derivatives.elapsed[:3], 40)
    with mp.workdps(60):
        states = [{name: rows[k] for name, rows in motion.quantities.items()} for k in range(3)]
        body, damping = numbers(problem), mp.convert(problem.body.damping)
        worst = mpf(0)
        for into, names in derivatives.components.items():
            for j in range(len(names)):
                moved = [deviation(derivatives, states[k], into, j, k) for k in range(3)]
                ahead, behind = (
                    rates(
                        problem,
                        {name: states[1][name] + s * moved[1][name] for name in states[1]},
                        [
                            entry + s * (i == j and into in ("inertia", "clebsch", "energy"))
                            for i, entry in enumerate(body)
                        ],
                        damping + s * (into == "damping"),
                    )
                    for s in (LITTLE, -LITTLE)
                )
                for name in states[1]:
                    change = (moved[2][name] - moved[0][name]) / (2 * mp.convert(STEP))
                    rate = (ahead[name] - behind[name]) / (2 * LITTLE)
                    worst = max(worst, largest(change - rate))
        return worst


def deviation(derivatives: Sensitivity, state: State, into: str, j: int, k: int) -> State:
    """The derivatives by one component, that of R as a matrix [theta]x R."""
    parts = {name: derivatives[name, into][k, :, j] for name in state}
    return {**parts, "attitude": cross_matrix(parts["attitude"]) @ state["attitude"]}


# As the third derivatives of these motions, and sums of a few of them, are below 1e5.
FITS = mpf("1e-14")


@pytest.mark.slow
@pytest.mark.parametrize("name", SCENES)
def test_derivatives_obey_the_linearised_equations(name: str) -> None:
    """By every component of the start and of the body, in every quantity, from the right start."""
    assert misfit(name) <= FITS
    with mp.workdps(30):
        for (out, into), rows in known(name).by.items():
            expected = np.eye(3) if out == into else 0
            assert largest(rows[3] - expected) <= mpf("1e-24")


@pytest.mark.parametrize("name", ["tumbling", "clebsch", "damped", "damped, clebsch"])
def test_damping_slows_the_clock_and_shrinks_the_momenta(name: str) -> None:
    """Where z = e^{-ct} Z(tau) with tau = (1 - e^{-ct})/c, the derivative by c is that of this formula.

    It is -t z + s (z' + c z), and s times the rates of attitude and centre, where s = e^{ct} dtau/dc is
    -t^2 M(1, 3, ct)/2 in Kummer's M, for c = 0 too.
    """
    problem, derivatives = SCENES[name], sensitivity(SCENES[name], TIMES, DIGITS)
    motion = solution(problem).motion(TIMES, DIGITS + 5)
    with mp.workdps(40):
        c, t = mp.convert(problem.body.damping), column(TIMES)
        s = np.array([-(time**2) * mp.hyp1f1(1, 3, c * time) / 2 for time in t])[:, None]
        for name, flow in derivatives.flow.items():
            expected = s * flow
            if name not in ("attitude", "centre"):
                expected = expected + (c * s - t[:, None]) * motion[name]
            difference = derivatives[name, "damping"][:, :, 0] - expected
            assert largest(difference) <= CLOSE * (1 + largest(expected))


def test_wheels_and_loads_have_no_derivative_by_a_damping_that_is_not_there() -> None:
    """With a constant moment damping is an input of the damped body alone."""
    assert "damping" not in known("moment").components
    assert known("damped, moment").components["damping"] == ("c",)


def transposed(derivatives: Sensitivity) -> Sensitivity:
    turned = derivatives["attitude", "omega"].transpose(0, 2, 1)
    return replace(derivatives, by={**derivatives.by, ("attitude", "omega"): turned})


def turned_the_other_way(derivatives: Sensitivity) -> Sensitivity:
    return replace(
        derivatives,
        by={pair: rows if pair[0] == "omega" else -rows for pair, rows in derivatives.by.items()},
    )


def one_product_alone(derivatives: Sensitivity) -> Sensitivity:
    """A product of inertia that changes one of its two entries."""
    half = np.array([1, 1, 1, mpf("0.5"), mpf("0.5"), mpf("0.5")], dtype=object)
    rows = derivatives["omega", "inertia"] * half
    return replace(derivatives, by={**derivatives.by, ("omega", "inertia"): rows})


def rounded_to_singles(derivatives: Sensitivity) -> Sensitivity:
    rows = derivatives["omega", "omega"].astype(np.float32).astype(object)
    return replace(derivatives, by={**derivatives.by, ("omega", "omega"): rows})


@pytest.mark.parametrize(
    "twin", [transposed, turned_the_other_way, one_product_alone, rounded_to_singles]
)
def test_a_broken_twin_is_noticed(twin: Twin) -> None:
    """A transposed block, a turn of the wrong sense, half a tensor, seven digits: none fits."""
    assert not misfit("tumbling", twin) <= FITS


# Closed formulas and laws of scale.


def test_axisymmetric_body() -> None:
    """For moments (J, J, S) omega turns about axis 3 at n = (S - J) omega3/J."""
    problem = SCENES["axisymmetric"]
    derivatives = sensitivity(problem, TIMES, DIGITS)
    with mp.workdps(40):
        w = column(problem.initial.omega)
        J, S = mpf(1), mpf(2)
        for k, time in enumerate(TIMES):
            t = mp.convert(time)
            sin, cos = mp.sin((S - J) / J * w[2] * t), mp.cos((S - J) / J * w[2] * t)
            forward = np.array([-w[0] * sin - w[1] * cos, w[0] * cos - w[1] * sin, 0]) * t
            by_omega = np.array([[cos, -sin, 0], [sin, cos, 0], [0, 0, 1]], dtype=object)
            by_omega[:, 2] += forward * (S - J) / J
            assert largest(derivatives["omega", "omega"][k] - by_omega) <= CLOSE
            by_inertia = derivatives["omega", "inertia"][k]
            assert largest(by_inertia[:, 2] - forward * w[2] / J) <= CLOSE
            across = by_inertia[:, 0] + by_inertia[:, 1]
            assert largest(across + forward * w[2] * S / J**2) <= CLOSE


def test_a_spin_multiplied_runs_faster() -> None:
    """omega0 -> (1 + e) omega0 gives omega + t omega', and turns the body by t omega."""
    derivatives = sensitivity(TUMBLING, TIMES, DIGITS)
    omega = solution(TUMBLING).motion(TIMES, DIGITS + 5)["omega"]
    with mp.workdps(40):
        t = column(TIMES)[:, None]
        along = {"omega": TUMBLING.initial.omega}
        expected = omega + t * derivatives.flow["omega"]
        assert largest(combined(derivatives, "omega", along) - expected) <= CLOSE
        turning = combined(derivatives, "attitude", along) - t * derivatives.flow["attitude"]
        assert largest(turning) <= CLOSE


def test_a_heavier_body_moves_alike() -> None:
    """The whole tensor multiplied leaves the free motion as it is."""
    derivatives = sensitivity(TUMBLING, TIMES, DIGITS)
    along = {"inertia": tuple(TENSOR[i][k] for i, k in ENTRIES)}
    with mp.workdps(40):
        assert largest(derivatives["omega", "inertia"]) >= 1
        assert largest(combined(derivatives, "omega", along)) <= CLOSE
        assert largest(combined(derivatives, "attitude", along)) <= CLOSE


def test_impulses_or_coefficients_multiplied() -> None:
    """Either runs the same path faster; the impulses alone are also multiplied themselves."""
    derivatives = sensitivity(CLEBSCH, TIMES, DIGITS)
    motion = solution(CLEBSCH).motion(TIMES, DIGITS + 5)
    impulses = {"linear_impulse": IMPULSE.linear, "angular_impulse": IMPULSE.angular}
    coefficients = {"clebsch": (SIX.p, SIX.p_prime, SIX.q, SIX.q_prime, SIX.r, SIX.r_prime)}
    with mp.workdps(40):
        t = column(TIMES)[:, None]
        for name, rows in motion.quantities.items():
            faster = t * derivatives.flow[name]
            assert largest(combined(derivatives, name, coefficients) - faster) <= CLOSE
            expected = faster + rows if name in impulses else faster
            assert largest(combined(derivatives, name, impulses) - expected) <= CLOSE


@pytest.mark.parametrize(
    "name", [pytest.param(n, marks=pytest.mark.slow if n == "general" else ()) for n in SCENES]
)
def test_the_flow_is_the_derivative_by_time(name: str) -> None:
    """For R as the rotation vector of space axes, R omega; the rest as it is."""
    flow = known(name).flow
    before, after = (solution(SCENES[name]).motion([MIDDLE + s], 40) for s in (-STEP, STEP))
    with mp.workdps(40):
        slopes = difference(before.quantities, after.quantities, 2 * mp.convert(STEP))
        assert set(slopes) == set(flow)
        for quantity, rates in flow.items():
            # STEP^2/6 of a third derivative of some tens.
            assert largest(slopes[quantity][0] - rates[1]) <= mpf("1e-17")


def test_units() -> None:
    """In a unit of mass 2^20 times smaller every derivative by the inertia is as much smaller."""
    heavy = replace(TUMBLING, body=RigidBody(tuple(scaled(Fraction(2**20), r) for r in TENSOR)))
    light, other = (sensitivity(problem, TIMES, DIGITS) for problem in (TUMBLING, heavy))
    with mp.workdps(40):
        for pair, rows in light.by.items():
            ratio = 2**20 if pair[1] == "inertia" else 1
            assert largest(other[pair] * ratio - rows) <= CLOSE


def test_a_turn_or_a_shift_of_the_start_moves_the_path() -> None:
    """As differences of scenes turned by a small rational angle, and shifted, say too."""
    e = Fraction(1, 10**12)
    derivatives = sensitivity(CLEBSCH, TIMES, DIGITS)
    for axis in range(3):
        motions = [solution(turned(CLEBSCH, axis, s * e)).motion(TIMES, 40) for s in (-1, 1)]
        with mp.workdps(40):
            # A quaternion 1 + e/2 turns by 2 atan(e/2): the angle is 2 e apart, up to e^3.
            moved = difference(motions[0].quantities, motions[1].quantities, 2 * mp.convert(e))
            for name, rows in moved.items():
                assert largest(rows - derivatives[name, "attitude"][:, :, axis]) <= mpf("1e-18")
    with mp.workdps(40):
        shift = derivatives["centre", "centre"]
        assert all((shift[k] == np.eye(3)).all() for k in range(len(TIMES)))
        for name in ("linear_impulse", "angular_impulse", "attitude"):
            assert not derivatives[name, "centre"].any()


def test_the_place_of_the_start_costs_no_digits() -> None:
    """Begun 1e60 units away, the same path has the same derivatives."""
    far = replace(CLEBSCH, initial=replace(IMPULSE, centre=vector("1e60", 0, "-1e60")))
    near, away = (sensitivity(problem, TIMES[:1]) for problem in (CLEBSCH, far))
    assert all((away[pair] == rows).all() for pair, rows in near.by.items())


def turned(problem: Scene, axis: int, angle: Fraction) -> Scene:
    """The start turned in space about one of its axes."""
    s, v = Fraction(1), [angle / 2 * (i == axis) for i in range(3)]
    w, u = problem.initial.attitude[0], problem.initial.attitude[1:]
    product = (
        s * w - sum(a * b for a, b in zip(v, u, strict=True)),
        *(
            s * u[i] + w * v[i] + v[i - 2] * u[i - 1] - v[i - 1] * u[i - 2]
            for i in range(3)
        ),
    )  # fmt: skip
    assert rotation_matrix(product) != rotation_matrix(problem.initial.attitude)
    return replace(problem, initial=replace(problem.initial, attitude=product))


def test_the_condition_of_an_orbit_is_made_of_the_same_derivatives() -> None:
    """One-sided differences by the impulses, at other steps and digits, agree."""
    by_start = sensitivity(CLEBSCH, TIMES, DIGITS)
    other = derivatives(CLEBSCH, TIMES, 25, 80)
    with mp.workdps(40):
        units = column(other.units)
        both = [by_start["centre", name] for name in ("linear_impulse", "angular_impulse")]
        rows = np.concatenate(both, axis=2) * units
        assert largest(rows - other.others["centre"]) <= CLOSE


# What is claimed about the error.


@pytest.mark.parametrize(
    "name", ["kirchhoff/whole-motion", "euler/tennis-racket", "kirchhoff/rest"]
)
def test_the_estimate_is_above_the_error(name: str) -> None:
    """Ten digits differ from thirty by no more than they estimate; and both are as good as asked."""
    problem = load(name)
    times = list(vector(2, 40))
    rough, fine = sensitivity(problem, times, 10), sensitivity(problem, times, 30)
    with mp.workdps(40):
        for pair, rows in rough.by.items():
            difference = rows - fine[pair]
            for k in range(len(times)):
                for j in range(rows.shape[2]):
                    error = mp.norm(list(difference[k, :, j]))
                    assert error <= rough.error[pair][k, j] + fine.error[pair][k, j]


@pytest.mark.parametrize(
    "name",
    [
        "euler/rest",
        "euler/spherical",
        "euler/axisymmetric",
        "euler/separatrix",
        "euler/steady-middle-axis",
        "kirchhoff/rest",
        "kirchhoff/zero-impulse",
        "kirchhoff/algebraic-path",
        "kirchhoff/from-the-axis",
        "kirchhoff/unstable-spin",
    ],
)
def test_degenerate_orbits_have_derivatives(name: str) -> None:
    """Beside a separatrix, a pole or a body of equal moments, and at rest; times scale as they do.

    The tensor multiplied as a whole changes nothing, and the coefficients of T run the path faster.
    """
    problem = load(name)
    times = list(vector(0, "1.5"))
    derivatives = sensitivity(problem, times, 12)
    with mp.workdps(40):
        into = "inertia" if problem.model == "euler" else "clebsch"
        along = numbers(problem)
        for quantity, flow in derivatives.flow.items():
            expected = column(tuple(times))[:, None] * flow if into == "clebsch" else 0 * flow
            change = derivatives[quantity, into] @ np.array(along, dtype=object)
            # 12 digits of six columns, of the size of the columns or of the motion itself.
            size = 1 + largest(derivatives[quantity, into] * along) + largest(flow)
            assert largest(change - expected) <= mpf("1e-10") * size


def test_an_unstable_orbit_takes_smaller_steps() -> None:
    """About the middle axis an error grows as cosh: 10^20 times after 80, and known to 15 digits."""
    problem = one_instant(RigidBody(diagonal(vector(1, 2, 3))), Spin(vector(0, 1, 0)))
    by_omega = sensitivity(problem, [Fraction(80)])["omega", "omega"][0]
    with mp.workdps(30):
        # omega1' = (2 - 3) omega2 omega3, omega3' = (1 - 2)/3 omega1 omega2.
        rate = mp.sqrt(mpf(1) / 3)
        grown = [[mp.cosh(80 * rate), -mp.sinh(80 * rate) / rate]]
        grown.append([-mp.sinh(80 * rate) * rate, mp.cosh(80 * rate)])
        expected = np.array(grown, dtype=object)
        assert largest(by_omega[np.ix_([0, 2], [0, 2])] / expected - 1) <= mpf("1e-15")


def test_what_does_not_settle_is_not_answered(monkeypatch: pytest.MonkeyPatch) -> None:
    """With one attempt only an orbit that grows so has no derivative; the error names the input."""
    monkeypatch.setattr(module, "_ATTEMPTS", 1)
    problem = one_instant(RigidBody(diagonal(vector(1, 2, 3))), Spin(vector(0, 1, 0)))
    with pytest.raises(Unsettled, match="depends on omega omega1"):
        sensitivity(problem, [Fraction(80)])


def test_no_times_are_refused() -> None:
    """An empty list of times is a mistake of the caller, and said to be."""
    with pytest.raises(ValueError, match="at least one time"):
        sensitivity(TUMBLING, [])


def test_a_number_that_is_none_is_not_settled() -> None:
    """A NaN in the error, or in the column with an error beside it, is no agreement."""
    column = np.array([[mpf(1), mpf(0), mpf(0)]], dtype=object)
    none = np.array([[mp.nan, mpf(0), mpf(0)]], dtype=object)
    error = np.array([mpf("1e-20")], dtype=object)
    floor = np.array([mpf(1)], dtype=object)
    assert module._is_settled(column, error, floor, 15)
    assert not module._is_settled(column, error, floor, 25)
    assert not module._is_settled(column, error * mp.nan, floor, 15)
    assert not module._is_settled(none, error * mp.inf, floor, 15)


def test_components_are_named_in_the_order_of_the_columns() -> None:
    """Six, or twenty-one, and three for what is a vector."""
    names = body_input(SCENES["general"]).components
    assert names[:6] == ("A11", "A22", "A33", "A23", "A13", "A12")
    assert names[6:9] == ("B11", "B12", "B13")
    assert len(names) == 21
    derivatives = sensitivity(TUMBLING, [Fraction(0)])
    for (_, into), rows in derivatives.by.items():
        assert rows.shape == (1, 3, len(derivatives.components[into]))
