"""Steps that add the same amount count together in the roundoff floor, and all others singly."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from builders.honest import Answer, Push, Rows, answers
from builders.scenes import LOADED, TENSOR, sample_scene, tracking_all, vector
from builders.turns import by_turns

from taylor_verify import check
from taylor_verify.exact.conditioning.condition import path
from taylor_verify.judge.floor.repeats import with_repeats
from taylor_verify.numbers import tensors
from taylor_verify.records.quantities import CONSERVED_QUANTITIES
from taylor_verify.records.status import Status
from taylor_verify.records.verdict import Verdict
from taylor_verify.scenes.bodies import Body, Clebsch, RigidBody
from taylor_verify.scenes.motion import Clock, Impulse, Spin
from taylor_verify.scenes.scene import Scene

# The number of steps of a run, one from row to row.
STEPS = 200
SPHERE = RigidBody(tensors.diagonal(vector(2, 2, 2)), vector("0.1", "0.03", "-0.02"))
AXIS = RigidBody(tensors.diagonal(vector(1, 2, 3)), vector(0, "0.1", 0))
SPINS = {"sphere": (SPHERE, ("0.3", "0.5", "0.7")), "axis": (AXIS, ("0", "0.6", "0"))}
WORDS = "each step adds nearly the same amount here"


def spun(body: Body, omega: Sequence[float | str], end: int = 3, steps: int = STEPS) -> Scene:
    """A spin of a body, asked once in every step."""
    scene = sample_scene(body, start=Spin(vector(*omega)))
    return replace(scene, clock=clock(end, steps))


def clock(end: int, steps: int) -> Clock:
    # A step of few bits, which every precision holds.
    row = Fraction(round(2**14 * end / steps), 2**14)
    return Clock(Fraction(0), tuple(k * row for k in range(steps + 1)))


def repeated(scene: Scene, steps: int, bits: int) -> Rows:
    """The size of a rounding with those alike before it, over its own, by time and component."""
    orbit = path(scene)
    times = np.array([abs(float(t)) for t in orbit.elapsed])
    steps_at = np.diff(times, prepend=0.0) * steps / times[-1]
    steps_at[0] = 1.0
    single = np.ones((len(times), 3 * len(orbit.blocks)))
    return with_repeats(single, orbit, steps_at, steps, bits)


# Motions.

GENERIC = {
    "free": spun(RigidBody(TENSOR), ("0.3", 1, "0.2")),
    "moment": spun(RigidBody(TENSOR, vector("0.1", "-0.2", "0.05")), ("0.3", 1, "0.2")),
    "in a fluid": replace(tracking_all(sample_scene(LOADED)), clock=clock(3, STEPS)),
    "free sphere": spun(RigidBody(tensors.diagonal(vector(2, 2, 2))), ("0.3", 1, "0.2")),
}


@pytest.mark.parametrize("name", by_turns(GENERIC))
def test_floor_of_a_generic_orbit_is_that_of_independent_roundings(name: str) -> None:
    """Increments that vary by many units, or that are zero, leave each rounding as it is."""
    assert (repeated(GENERIC[name], 50, 53) == 1.0).all()


@pytest.mark.parametrize("name", SPINS)
@pytest.mark.parametrize("bits", [24, 53, 237])
def test_floor_grows_with_the_steps_where_increments_repeat(name: str, bits: int) -> None:
    """A hundred times the steps make a hundred times the floor of T, and ten times on a generic orbit."""
    scene, generic = spun(*SPINS[name]), GENERIC["moment"]
    few, many = (np.sum(repeated(scene, n, bits) ** 2) * n for n in (100, 10000))
    assert many / few == pytest.approx(100**2, rel=0.05)
    if bits > 24:
        few, many = (np.sum(repeated(generic, n, bits) ** 2) * n for n in (100, 10000))
        assert many / few == pytest.approx(100, rel=1e-12)


def test_centre_repeats_along_a_straight_line() -> None:
    """A solid that goes straight ahead adds the same to its centre in each step, along the line alone."""
    body = Clebsch(*vector(1, 2, 0, 0, 1, "0.5")).body()
    start = Impulse(vector(0, 0, 1), vector(0, 0, 0), centre=vector(1, 2, 3))
    scene = replace(sample_scene(body, "attitude", "centre", start=start), clock=clock(3, 20))
    sizes = repeated(scene, 100, 53)[-1]
    assert (sizes[:-1] == 1.0).all()
    # The last steps have a hundred alike ones before them.
    assert sizes[-1] == pytest.approx((2 * 100) ** 0.5, rel=0.1)


def test_damped_body_at_its_final_spin_repeats() -> None:
    """Where a moment balances damping, an answer that is off adds the same amount again and again."""
    body = RigidBody(
        tensors.diagonal(vector(2, 2, 2)), vector("0.2", 0, 0), damping=Fraction(1, 10)
    )
    sizes = repeated(spun(body, (1, 0, 0)), 100, 53)[-1]
    assert sizes[0] == pytest.approx((2 * 100) ** 0.5, rel=0.1)
    assert (sizes[1:] == 1.0).all()


# Verdicts.

pytestmark = pytest.mark.usefixtures("without_causes")


def conserved(scene: Scene, answer: Answer) -> list[Verdict]:
    """The verdicts on T and H2 of a float32 answer."""
    verdicts = check(scene, answer, "f32").verdicts
    return [verdict for verdict in verdicts if verdict.quantity in CONSERVED_QUANTITIES]


def biased(units: int) -> Push:
    """A step that is too large by so many units in the last place."""
    return lambda before, after: after + np.float32(units) * np.spacing(after)


@pytest.mark.parametrize("name", by_turns(SPINS, 2))
def test_sentence_says_that_roundings_add_up(name: str) -> None:
    """The reason says in words why the floor grows in proportion to the number of steps."""
    scene = spun(*SPINS[name])
    (answer,) = answers([scene], "f32", 1)
    for verdict in conserved(scene, answer):
        assert verdict.verdict is Status.PASS
        assert WORDS in verdict.because
        assert verdict.reason.floor is not None
        assert 1 < verdict.reason.floor.alike <= verdict.reason.floor.steps


@pytest.mark.parametrize("name", by_turns(SPINS, 2))
def test_bias_of_ten_units_in_each_step_is_caught(name: str) -> None:
    """A broken twin whose steps all err one way, ten times as much as a rounding, fails every gate."""
    scene = spun(*SPINS[name])
    (answer,) = answers([scene], "f32", 1, biased(10))
    assert {verdict.verdict for verdict in check(scene, answer, "f32").verdicts[1:]} == {
        Status.FAIL
    }


def test_bias_of_one_unit_in_each_step_is_caught_on_a_generic_orbit() -> None:
    """Where increments do not repeat, one unit in the last place of each step fails T and H2."""
    scene = spun(RigidBody(TENSOR), ("0.3", 1, "0.2"), 20)
    sound, twin = (answers([scene], "f32", 1, biased(n))[0] for n in (0, 1))
    assert {verdict.verdict for verdict in conserved(scene, sound)} == {Status.PASS}
    assert {verdict.verdict for verdict in conserved(scene, twin)} == {Status.FAIL}
    assert not any(WORDS in verdict.because for verdict in conserved(scene, twin))
