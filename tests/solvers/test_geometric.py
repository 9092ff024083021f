"""The geometric integrators: their orders, what each conserves and what not, and how a run can end."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from itertools import product
from typing import Any

import numpy as np
import pytest
from builders.integrators import by_step, has_order
from builders.scenes import asked_at
from builders.turns import by_turns
from builders.verdicts import by_quantity
from hypothesis import given, settings
from hypothesis import strategies as st

from taylor_verify.models.frame import rotation
from taylor_verify.models.problem import Problem, pose
from taylor_verify.numbers.precision import rung
from taylor_verify.records.quantities import INITIAL
from taylor_verify.records.status import Status
from taylor_verify.records.verdict import Verdict
from taylor_verify.run import run
from taylor_verify.scenes.reading.reader import load
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.geometric import fixed_step
from taylor_verify.solvers.geometric.fixed_step import Body, FixedStep, Step
from taylor_verify.solvers.geometric.implicit import MoserVeselov
from taylor_verify.solvers.geometric.methods import METHODS
from taylor_verify.solvers.geometric.methods import named as geometric
from taylor_verify.solvers.geometric.vectors import Quaternion, Vector
from taylor_verify.solvers.trajectory import Outcome, Trajectory

ORDERS = {
    "implicit-midpoint": 2,
    "splitting": 2,
    "moser-veselov": 2,
    "preprocessed-moser-veselov": 4,
    "lie-rk4": 4,
}
# The maps that have T among their invariants; all have |H|^2 and, with the attitude, R H.
KEEP_T = ["implicit-midpoint", "moser-veselov", "preprocessed-moser-veselov"]
# The methods whose step -h undoes the step h.
SYMMETRIC = ["implicit-midpoint", "splitting", "moser-veselov", "preprocessed-moser-veselov"]
F64 = rung("f64")
U = 2.0**-53


def at(scene: str, *instants: Fraction | int, track: str = "") -> Scene:
    """A shipped scene at instants of its own."""
    return replace(asked_at(scene, *instants), track=frozenset(track.split()))


def short(scene: str) -> Scene:
    """Two turns of a body with its attitude; the steps below divide the spans between its samples."""
    return at(scene, *(Fraction(12 * k, 10) for k in range(11)), track="attitude")


PRINCIPAL, FULL = short("euler/with-attitude"), short("euler/full-tensor")
WHEELS = short("euler/gyrostat")
# Its tensor is not diagonal, so that splitting turns the wheels into the principal axes.
OBLIQUE_WHEELS = at("euler/gyrostat-momentum-bias", *range(0, 110, 10), track="attitude")
# The methods that turn wheels.
TURN_WHEELS = ["implicit-midpoint", "splitting"]
STEPS = [0.1, 0.05, 0.025, 0.0125]


def solving(make: Callable[[Fraction], FixedStep]) -> Callable[[Problem, float], Any]:
    """Return the method as a callable that `sweep` takes."""

    def solve(problem: Problem, step: float) -> Any:
        trajectory = make(Fraction(str(step))).solve(problem)
        assert trajectory.outcome is Outcome.FINISHED, trajectory.detail
        return np.hstack(list(trajectory.quantities.values()))

    return solve


def method(name: str) -> Callable[[Fraction], FixedStep]:
    return lambda step: METHODS[name](step, f"geometric:{name}")


def verdicts(scene: Scene | str, name: str, step: str) -> dict[str, Verdict]:
    judgement = run(scene, f"geometric:{name}?step={step}", causes=False)
    return by_quantity(judgement)


# Order: the motion is that of the truth, and how fast it becomes so.


@pytest.mark.parametrize(
    ("name", "scene"),
    by_turns(product(METHODS, [PRINCIPAL, FULL]), 5, lambda name, scene: name),
    ids=lambda part: {PRINCIPAL: "principal", FULL: "full tensor"}.get(part, part),
)
def test_a_method_is_of_its_order(name: str, scene: Scene) -> None:
    """Omega and attitude approach the exact motion with the method's order, in any axes."""
    orders = by_step(scene, solving(method(name)), STEPS)
    for quantity in ("omega", "attitude"):
        assert has_order(orders[quantity], ORDERS[name]), orders[quantity].reason
        assert orders[quantity].level is None


@pytest.mark.parametrize(("scene", "unit"), [(WHEELS, 1), (OBLIQUE_WHEELS, 10)])
@pytest.mark.parametrize("name", TURN_WHEELS)
def test_wheels_are_turned_at_the_order(name: str, scene: Scene, unit: int) -> None:
    """The motion of a gyrostat is approached with the method's order, in any axes."""
    orders = by_step(scene, solving(method(name)), [unit * step for step in STEPS])
    assert all(has_order(orders[name], 2) for name in ("attitude", "omega"))


@pytest.mark.parametrize(
    ("name", "scene", "instants"),
    [
        ("implicit-midpoint", "euler/constant-moment", (0, 1, 2)),
        ("lie-rk4", "euler/damped", (0, 1, 2)),
        ("lie-rk4", "euler/with-attitude", (-3, -5, -6)),
    ],
)
def test_a_moment_damping_and_time_running_backward_leave_the_order(
    name: str, scene: str, instants: tuple[int, ...]
) -> None:
    """Under a moment or damping, before the start and from one that is no sample, the order is the same."""
    orders = by_step(at(scene, *instants, track="attitude"), solving(method(name)), STEPS)
    assert all(has_order(orders[quantity], ORDERS[name]) for quantity in ("attitude", "omega"))


# Conservation, as the judge's own gates see it: drift against rounding.


@pytest.mark.parametrize(
    ("name", "scene"),
    [
        *by_turns(product(METHODS, [PRINCIPAL, FULL]), 3, lambda name, scene: name),
        *((name, WHEELS) for name in TURN_WHEELS),
    ],
    ids=lambda part: {PRINCIPAL: "principal", FULL: "full", WHEELS: "wheels"}.get(part, part),
)
def test_what_is_promised_is_conserved_at_any_step(name: str, scene: Scene) -> None:
    """|H|^2 and the momentum in space, wheels included, stay within rounding; T where promised."""
    by_quantity = verdicts(scene, name, "0.2")
    conserved = {
        quantity for quantity, verdict in by_quantity.items() if verdict.verdict is Status.PASS
    }
    assert conserved == {INITIAL, "H2", "H_space"} | ({"T"} if name in KEEP_T else set())


@pytest.mark.parametrize("scene", ["euler/axisymmetric", "euler/generic"])
def test_turns_of_nearly_one_angle_leave_no_bias(scene: str) -> None:
    """Through 300,000 turns by small, nearly equal angles |H|^2 moves no more than by chance."""
    instants = tuple(Fraction(k) for k in range(7))
    verdict = verdicts(at(scene, *instants), "splitting", "0.0001")["H2"]
    assert verdict.verdict is Status.PASS
    # Ten is what the gate allows; a bias of half an ulp a step would be a hundred and more here.
    assert verdict.ratio <= 10


def test_T_swings_and_does_not_drift_in_the_splitting() -> None:
    """T of the splitting is off by order h^2, no more at the end of a long run than at its start."""
    orders = by_step(PRINCIPAL, solving(method("splitting")), STEPS)
    assert has_order(orders["T"], 2)
    coarse = verdicts(at("euler/generic", *range(0, 10)), "splitting", "0.1")["T"].max
    longer = verdicts(at("euler/generic", *range(0, 400)), "splitting", "0.1")["T"].max
    # Ten samples miss some of the swing; a drift would be forty times as large.
    assert longer <= 4 * coarse


# One step, for any body.


@st.composite
def bodies(draw: st.DrawFn) -> Body:
    """A symmetric tensor with eigenvalues between 0.3 and 3, in axes of any direction."""
    values = [draw(st.floats(0.3, 3)) for _ in range(3)]
    q = [draw(st.floats(-1, 1)) for _ in range(3)]
    P = np.array(rotation([1.0, *q])) / (1 + sum(e * e for e in q))
    K = P @ np.diag(values) @ P.T
    K = (K + K.T) / 2
    return Body(tuple(tuple(row) for row in K.tolist()), (0.0, 0.0, 0.0))  # type: ignore[arg-type]


# Longer momenta at longer steps have no Moser-Veselov step: h |H| is bounded by the body.
momenta = st.tuples(*[st.floats(-1, 1)] * 3).filter(lambda H: np.linalg.norm(H) > 0.1)
steps = st.floats(0.001, 0.1)
few = settings(max_examples=30)


def stepping(name: str, body: Body, H: Vector, h: float) -> Step:
    solver = method(name)(Fraction(1))
    if solver.in_principal_axes:
        body, _ = fixed_step.principal(body)
    return solver.stepping(body, H, h)


def matrix(q: Quaternion) -> Any:
    return np.array(rotation(q)) / sum(e * e for e in q)


@pytest.mark.parametrize("name", METHODS)
@few
@given(bodies(), momenta, steps)
def test_the_frame_and_the_momentum_turn_alike(name: str, body: Body, H: Vector, h: float) -> None:
    """A step takes H to F^T H, with F the turn of the frame: the momentum in space stays."""
    after, trace, _ = stepping(name, body, H, h)(H)
    F = matrix(method(name)(Fraction(1)).turn(trace))
    # Some dozens of roundings of numbers of size |H|.
    assert np.linalg.norm(F @ after - H) <= 50 * U * np.linalg.norm(H)


@pytest.mark.parametrize("name", SYMMETRIC)
@few
@given(bodies(), momenta, steps)
def test_a_symmetric_step_is_undone_by_its_reverse(
    name: str, body: Body, H: Vector, h: float
) -> None:
    """The step -h leads back to where the step h started."""
    after = stepping(name, body, H, h)(H).H
    back = stepping(name, body, after, -h)(after).H
    assert np.linalg.norm(np.subtract(back, H)) <= 100 * U * np.linalg.norm(H)


@few
@given(bodies(), momenta, steps)
def test_moser_veselov_solves_its_own_equation(body: Body, H: Vector, h: float) -> None:
    """The turn F satisfies h [m]x = F D - D F^T with D = tr(I)/2 - I, as the paper has it."""
    _, trace, _ = stepping("moser-veselov", body, H, h)(H)
    F = matrix(MoserVeselov(Fraction(1)).turn(trace))
    I = np.linalg.inv(np.array(body.K))
    D = np.trace(I) / 2 * np.eye(3) - I
    m1, m2, m3 = H
    skew = h * np.array([[0, -m3, m2], [m3, 0, -m1], [-m2, m1, 0]])
    # The entries of D, up to five, are what is rounded, some dozens of times.
    assert np.linalg.norm(F @ D - D @ F.T - skew) <= 300 * U * np.linalg.norm(D)


# Steps and samples.


def solved(scene: Scene | str, name: str, step: str) -> Trajectory:
    posed = pose(load(scene) if isinstance(scene, str) else scene, F64)
    return geometric(f"geometric:{name}?step={step}").solve(posed)


@pytest.mark.parametrize("scene", ["euler/listed-times", "euler/later-start", "euler/apollo"])
def test_equal_steps_lead_to_each_sample(scene: str) -> None:
    """The steps are as many as fit, in the scene's own unit of time; one that divides a span is not cut."""
    elapsed = load(scene).clock.elapsed
    spans = [abs(b - a) for a, b in zip((Fraction(0), *elapsed), elapsed, strict=False)]
    for step in (max(spans), max(spans) / 4, max(spans) / Fraction("7.3")):
        expected = sum(-(-span // step) for span in spans)
        assert solved(scene, "lie-rk4", str(step)).steps == expected


# How a run ends that is none.


WITHOUT = "made for a body without "
REFUSED = {
    "euler/gyrostat": (TURN_WHEELS, WITHOUT + "wheels"),
    "euler/constant-moment": (["implicit-midpoint"], WITHOUT + "a moment"),
    "euler/damped": (["lie-rk4"], WITHOUT + "damping"),
    "kirchhoff/screw": ([], "made for Euler's equations, got kirchhoff"),
}


@pytest.mark.parametrize("scene", REFUSED)
def test_what_a_method_is_not_made_for_is_refused(scene: str) -> None:
    """A method that does not follow what acts on the body says so, and answers nothing."""
    takers, words = REFUSED[scene]
    for name in sorted(set(METHODS) - set(takers)):
        trajectory = solved(scene, name, "0.1")
        assert trajectory.outcome is Outcome.NOT_STARTED
        assert trajectory.detail == f"geometric:{name}?step=0.1 is {words}"
        assert not trajectory.quantities


def test_a_step_without_a_solution_ends_the_run() -> None:
    """h |H| too large for [m]x = F D - D F^T: the run stops and says what to do."""
    trajectory = solved("euler/generic", "moser-veselov", "1")
    assert trajectory.outcome is Outcome.INTERRUPTED
    assert trajectory.detail.endswith("take shorter steps")
    assert not trajectory.quantities


def test_a_run_without_end_is_not_begun() -> None:
    """Days of steps are refused before the first."""
    trajectory = solved("euler/generic", "splitting", "1e-9")
    assert trajectory.outcome is Outcome.STEP_LIMIT
    assert trajectory.detail == "1e+11 steps, more than 1e+08"


def test_what_overflows_is_an_outcome() -> None:
    """A step of 10^200 leaves the range of float64."""
    trajectory = solved(at("euler/generic", 10**200), "lie-rk4", "1e300")
    assert trajectory.outcome is Outcome.NON_FINITE
    assert not trajectory.quantities


def test_a_body_at_rest_stays_there() -> None:
    """No method divides by a scale of zero."""
    for name in METHODS:
        by_quantity = verdicts("euler/rest", name, "5")
        assert all(verdict.verdict is Status.PASS for verdict in by_quantity.values())
