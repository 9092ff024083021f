"""The transition norms: of the linearised equations, under written loads, and where input is rounded."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from fractions import Fraction
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from builders.scenes import CLEBSCH, LOADED, MOMENT, QUATERNION, TENSOR, sample_scene, vector
from builders.turns import by_turns
from builders.written_loads import euler, kirchhoff
from mpmath import mp

from taylor_verify.exact.conditioning.by_differences import derivatives
from taylor_verify.exact.conditioning.condition import Path, path, sharp, transition
from taylor_verify.exact.conditioning.path_times import many
from taylor_verify.exact.conditioning.variation import integrated
from taylor_verify.exact.elements import elements
from taylor_verify.exact.registry import kind_of
from taylor_verify.exact.route import solution
from taylor_verify.exact.taylor import TaylorSolution
from taylor_verify.judge.floor import rounded_input
from taylor_verify.judge.floor.rounded_input import input_rounding
from taylor_verify.numbers.precision import rung
from taylor_verify.numbers.tensors import Matrix, apply, diagonal, inverse, product, transpose
from taylor_verify.scenes.bodies import RigidBody
from taylor_verify.scenes.instants import evenly
from taylor_verify.scenes.motion import Clock, Spin
from taylor_verify.scenes.reading.reader import load
from taylor_verify.scenes.scene import Scene

Array = np.ndarray[Any, Any]


LOADED_EULER = sample_scene(RigidBody(TENSOR, MOMENT), "attitude")
LOADED_KIRCHHOFF = sample_scene(LOADED, "attitude", "centre")


def test_axisymmetric_body() -> None:
    """For moments (J, J, S) the transition matrix is a rotation and a shear, known exactly."""
    body = RigidBody(diagonal(vector(1, 1, 2)))
    spinning = sample_scene(body, start=Spin(vector("0.6", "0.8", "0.5")))
    instants = vector(0, "0.7", 3, 40)
    flow = transition(spinning, instants)
    momentum = TaylorSolution(spinning).motion(instants, 30)["omega"].astype(float) * [1, 1, 2]
    expected = [np.linalg.norm(_shear(momentum[0], float(instant)), 2) for instant in instants]
    # float64 sines of angles of some tens, and differences that hold far more digits.
    assert np.abs(flow.norms("momentum", "momentum") / expected - 1).max() <= 1e-13


def _shear(momentum: Array, time: float) -> Array:
    """H_perp turns by -s t with s = (1/S - 1/J) H_3 ... the derivative by (H_1, H_2, H_3)."""
    rate = 1 / 2 - 1 / 1
    angle = rate * momentum[2] * time
    cosine, sine = np.cos(angle), np.sin(angle)
    h1, h2 = momentum[0] * cosine + momentum[1] * sine, momentum[1] * cosine - momentum[0] * sine
    return np.array(
        [[cosine, sine, h2 * rate * time], [-sine, cosine, -h1 * rate * time], [0, 0, 1]]
    )


def test_place_moves_with_the_path() -> None:
    """A turn stays a turn, a shift a shift, and a turn at the start swings c by |c - c(0)|."""
    instants = vector(0, "0.5", 2)
    flow = transition(LOADED_KIRCHHOFF, instants)
    path = TaylorSolution(LOADED_KIRCHHOFF).motion(instants, 30)["centre"].astype(float)
    distances = np.linalg.norm(path - path[0], axis=1)
    assert (flow.norms("attitude", "attitude") == 1).all()
    assert (flow.norms("centre", "centre") == 1).all()
    # float64 differences of a path of ten units.
    assert np.abs(flow.norms("centre", "attitude") - distances).max() <= 1e-13
    for out, into in (
        ("linear_impulse", "attitude"),
        ("angular_impulse", "centre"),
        ("attitude", "centre"),
    ):
        assert not flow.norms(out, into).any()
    assert flow.norms("centre", "linear_impulse")[0] == 0


def test_growth_beside_an_unstable_rotation() -> None:
    """About the intermediate axis an error grows as cosh of the classical rate, for 10^20 too."""
    body = RigidBody(diagonal(vector(1, 2, 3)))
    steady = sample_scene(body, start=Spin(vector(0, 1, 0)))
    # H2 = 2; H1' = H2 (K3 - K2) H3, H3' = H2 (K2 - K1) H1, so rate^2 = 4 (1/6)(1/2) = 1/3.
    rate = np.sqrt(1 / 3)
    norms = transition(steady, vector(0, 10, 80)).norms("momentum", "momentum")
    for i, time in ((1, 10.0), (2, 80.0)):
        block = [
            [np.cosh(rate * time), -np.sinh(rate * time) / (3 * rate)],
            [-np.sinh(rate * time) * rate * 3, np.cosh(rate * time)],
        ]
        expected = np.linalg.norm(block, 2)
        # The matrix is held to conserve volume to 10^-6; with errors of 10^-25 grown 10^20 times,
        # the orbits compared are 10^-5 apart, and what is neglected is its square.
        assert abs(norms[i] / expected - 1) <= 1e-6


def test_a_body_at_rest() -> None:
    """At rest momentum stays as it is, and turns the body by K per unit of momentum and time."""
    resting = sample_scene(RigidBody(TENSOR), "attitude", start=Spin(vector(0, 0, 0), QUATERNION))
    flow = transition(resting, vector(0, 2, 6))
    inverse_inertia = np.array(inverse(TENSOR), dtype=float)
    stiffest = np.linalg.norm(inverse_inertia, 2)
    # Perturbed by 10^-12 of a unit, the body turns by as much, and the norms are off by as much.
    assert np.abs(flow.norms("momentum", "momentum") - 1).max() <= 1e-10
    assert abs(flow.norms("attitude", "momentum")[2] / (6 * stiffest) - 1) <= 1e-10
    assert abs(flow.norms("omega", "momentum")[0] / stiffest - 1) <= 1e-10


@pytest.mark.parametrize(
    "start",
    [
        LOADED_EULER,
        pytest.param(LOADED_KIRCHHOFF, marks=pytest.mark.slow),
        sample_scene(CLEBSCH, "attitude", "centre"),
        sample_scene(RigidBody(TENSOR)),
    ],
    ids=["loaded euler", "loaded kirchhoff", "clebsch", "full tensor"],
)
def test_variational_equations_agree_with_differences(start: Scene) -> None:
    """The two routes to the condition, float64 steps and differences of the truth, give the same norms.

    To four digits: that is what the variational equations are integrated to.
    """
    instants = vector(0, "0.5", "1.25", 4)
    steps = integrated(start, instants)
    assert steps is not None
    by_steps = Path(start, instants, steps)
    differences = derivatives(start, instants, 12, 36).steps(by_steps.flow)[0]
    by_differences = Path(start, instants, differences)
    assert np.allclose(steps.steps, differences.steps, rtol=1e-4, atol=1e-4)
    for out in (*by_steps.blocks, *(["omega"] if start.model == "euler" else [])):
        for into in by_steps.blocks:
            one, other = (way.norms(out, into) for way in (by_steps, by_differences))
            assert np.abs(one - other).max() <= 1e-4 * max(other.max(), 1e-12)


def test_errors_that_shrink_again_are_as_small_by_steps_as_by_differences() -> None:
    """Errors grow by 3e8 in a fall, and shrink to a thousandth of that; rough steps would hide it."""
    start = load("extremes/kirchhoff-unstable-spin-1e-8")
    by_steps = path(start)
    points = by_steps.elapsed
    by_differences = sharp(start, points, least=50)
    rough = integrated(start, points, more_digits=9, is_rough=True)
    assert (by_steps.exponent, by_differences.exponent) == (0, 50)
    assert rough is not None
    unit = np.ones((len(points), 3 * len(by_steps.blocks)))
    by_rough_steps = Path(start, points, rough).gathered(unit)
    for name, expected in by_differences.gathered(unit).items():
        assert np.allclose(by_steps.gathered(unit)[name], expected, rtol=1e-2), name
        assert by_rough_steps[name][-1] > 10 * expected[-1], name
        assert expected.max() > 1000 * expected[-1], name


def test_steps_that_cannot_hold_what_shrinks_are_told_apart() -> None:
    """Errors grow by 2e20 and shrink by more than float64 has digits: differences take over there."""
    start = load("extremes/euler-unstable-axis-1e-20")
    condition = path(start)
    steps = integrated(start, condition.elapsed, more_digits=21)
    assert steps is not None
    followed = Path(start, condition.elapsed, steps)
    assert not followed.is_resolved
    assert condition.exponent > 60
    assert np.allclose(followed.growth[:60], condition.growth[:60], rtol=1e-6)


def test_growth_whose_cube_is_beyond_float64_is_known() -> None:
    """A start 1e-110 from the unstable axis: errors grow by about the inverse of that, and no more.

    Whether steps of float64 can be trusted where errors shrink again is a matter of their last bits.
    """
    saddle = sample_scene(RigidBody(diagonal(vector(1, 2, 3))), start=Spin(vector("1e-110", 1, 0)))
    saddle = replace(saddle, clock=Clock(Fraction(0), vector(0, 400, 500)))
    chosen = path(saddle)
    by_differences = sharp(saddle, chosen.elapsed)
    assert by_differences.exponent > 300
    for condition in (chosen, by_differences):
        assert 1e109 < condition.growth.max() < 1e111


def test_the_first_differences_tell_how_small_the_next_must_be() -> None:
    """Errors grow by 1e41 in proportion to time; the differences chosen give what those of 10^-250 give."""
    start = load("extremes/kirchhoff-linear-1e20")
    condition = path(start)
    smallest_differences = sharp(start, condition.elapsed, least=250)
    assert 82 < condition.exponent < smallest_differences.exponent == 250
    for name in ("linear_impulse", "angular_impulse"):
        for into in ("linear_impulse", "angular_impulse"):
            norms = condition.norms(name, into)
            assert np.allclose(norms, smallest_differences.norms(name, into), rtol=1e-9)


def test_where_float64_cannot_follow_there_are_no_variational_norms() -> None:
    """A turn 1e-40 from the middle axis in a rotated tensor is out of reach of float64: no answer."""
    c, s = Fraction(3, 5), Fraction(4, 5)
    turn: Matrix = ((c, -s, Fraction(0)), (s, c, Fraction(0)), vector(0, 0, 1))
    turned = product(product(turn, diagonal(vector(1, 2, 3))), transpose(turn))
    near = vector("1e-40", 1, "1e-40")
    saddle = sample_scene(RigidBody(turned), start=Spin(apply(turn, near)))
    assert integrated(saddle, vector(0, 250)) is None


# The choice of times.


@pytest.mark.parametrize("end", [40, -40])
def test_points_lie_a_radian_apart_up_to_the_last_sample(end: int) -> None:
    """Also where most of the time lies between the last two samples, and backward in time."""
    times = many([Fraction(0), Fraction(end, 40), Fraction(end)], rate=2.0)
    assert (times[0], times[-1]) == (0, end)
    # A 64th part of the time is longer than a radian after 32 units.
    for a, b in pairwise(times):
        assert abs(b) > abs(a)
        # A sum is rounded once.
        assert abs(b - a) <= max(Fraction(1, 2), abs(a) / 64) + abs(b) / 2**53


# Written loads

SMALL = Fraction(1, 10**12)
TIMES = [Fraction(0), Fraction(1, 4), Fraction(1, 2)]
SCENES: Mapping[str, Scene] = {
    "clock": euler(["sin(2*t)", "-w2/20", "(w1 - w3)/30"]),
    "attitude": euler(["r31*w2 + q1", "-r32*tanh(t)", "r11 - exp(-t)*q2"]),
    "switch": euler(["1 if t < 0.55 else -2", "0", "r12*t"]),
    "centre": kirchhoff(
        ["-c1*r11 - norm(u1, u2, u3)*u1/4", "c2", "-r33"], ["-w1/5", "x1*r21", "sin(t)*c3"]
    ),
    "untouched": kirchhoff(["-u1/4", "cos(t)", "0"], ["-w1/5", "x1", "sin(t)"]),
}


def moved(scene: Scene, column: int) -> Scene:
    """The scene with one component of momentum, turn or centre greater at the start."""
    kind, initial = kind_of(scene.body), scene.initial
    d = 3 * len(kind.momenta)
    if column < d:
        momentum = list(kind.momentum(scene.body, kind.state(initial)))
        momentum[column] += SMALL
        state = kind.of_momentum(scene.body, tuple(momentum))
        return replace(scene, initial=kind.with_state(initial, state))
    if column < d + 3:
        a, b, c, e = initial.attitude
        half = [SMALL / 2 * (column - d == i) for i in range(3)]
        x, y, z = half
        turned = (
            a - x * b - y * c - z * e,
            b + x * a + y * e - z * c,
            c + y * a + z * b - x * e,
            e + z * a + x * c - y * b,
        )
        return replace(scene, initial=replace(initial, attitude=turned))
    centre = tuple(v + SMALL * (column - d - 3 == i) for i, v in enumerate(initial.centre))
    return replace(scene, initial=replace(initial, centre=centre))


def end(scene: Scene, motion: Any) -> Any:
    momentum = kind_of(scene.body).momentum_rows(scene.body, motion.quantities)
    centre = motion["centre"][-1] if "centre" in scene.track else []
    return momentum[-1], motion["attitude"][-1], centre


@pytest.mark.parametrize("name", by_turns(SCENES))
def test_the_derivative_is_that_of_differences(name: str) -> None:
    """Momentum, turn and centre move as motions from starts beside this one, to six digits."""
    scene = SCENES[name]
    along = transition(scene, TIMES)
    d = along.momentum.shape[1]
    size = d + 3 + 3 * ("centre" in scene.track)
    centre_unit = float(along.units["centre"])
    units = np.array([*map(float, along.flow.components), *[1.0] * 3, *[centre_unit] * 3])[:size]
    since = along.carried.since_first[-1][:size, :size] * units[:, None] / units
    with mp.workdps(40):
        momentum, R, centre = end(scene, solution(scene).motion(TIMES, 30))
        for column in range(size):
            other, turned, shifted = end(scene, solution(moved(scene, column)).motion(TIMES, 30))
            turn = turned @ R.T
            change = [*(other - momentum), turn[2, 1], turn[0, 2], turn[1, 0]]
            change += [b - a for a, b in zip(centre, shifted, strict=True)]
            slopes = np.array([float(v / mp.convert(SMALL)) for v in change])
            assert np.allclose(since[:, column], slopes, rtol=1e-6, atol=1e-6)


def test_an_orbit_carries_the_attitude_that_a_load_reads_though_nobody_tracks_it() -> None:
    """The blocks of the condition are those that move the state, tracked or not."""
    scene = replace(SCENES["attitude"], track=frozenset())
    assert path(scene).blocks == ("momentum", "attitude")
    assert path(replace(SCENES["clock"], track=frozenset())).blocks == ("momentum",)


# Roundings of the input

F64 = rung("f64")
HALVES, SAMPLES = 24, 145


@pytest.fixture(scope="module")
def flipping() -> Scene:
    """Half a period between any two of 25 even samples: at each the body spins about its middle axis."""
    scene = replace(
        load("euler/generic"), initial=Spin((Fraction(1, 1000), Fraction(1), Fraction(0)))
    )
    period = Fraction(float(elements(scene)["period"].value))
    end = HALVES * period / 2
    times = tuple(end * k / (SAMPLES - 1) for k in range(SAMPLES))
    return replace(scene, clock=Clock(Fraction(0), times))


def response(scene: Scene, monkeypatch: pytest.MonkeyPatch, nodes: list[int]) -> Any:
    """The response to the input at every sample, looked at where one says."""
    monkeypatch.setattr(rounded_input, "looked_at", lambda asked: nodes)
    return input_rounding(scene, F64).at_samples["omega"]


def test_no_passage_is_missed(flipping: Scene, monkeypatch: pytest.MonkeyPatch) -> None:
    """At every sample the response is at least half of what it is there, in a flip as between two."""
    allowed = input_rounding(flipping, F64).at_samples["omega"]
    whole = response(flipping, monkeypatch, list(range(SAMPLES)))
    # A start that is not moved at all leaves nothing at the first sample.
    assert np.all(allowed >= whole / 2)
    assert allowed.max() <= 2 * whole.max()


def test_even_samples_would_miss_them(flipping: Scene, monkeypatch: pytest.MonkeyPatch) -> None:
    """25 even ones, each half a period after the other, know less than a tenth of the flips' response."""
    whole = response(flipping, monkeypatch, list(range(SAMPLES)))
    missed = response(flipping, monkeypatch, evenly(SAMPLES, HALVES + 1))
    assert np.min(missed[1:] / whole[1:]) <= 0.1
