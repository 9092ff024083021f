"""The figures the suite promises: errors of an ensemble of regular bodies on every rung."""

from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from itertools import pairwise
from random import Random
from statistics import median

import pytest

from taylor_verify.exact.elements import elements
from taylor_verify.numbers import tensors
from taylor_verify.records.precisions import LADDER
from taylor_verify.records.quantities import STATES
from taylor_verify.records.status import Status
from taylor_verify.records.verdict import Verdict
from taylor_verify.run import run
from taylor_verify.scenes.bodies import Clebsch, RigidBody
from taylor_verify.scenes.motion import Clock, Impulse, Spin
from taylor_verify.scenes.scene import Scene

BODIES = 32
PERIODS = 15
SEED = 20261121


@dataclass(frozen=True)
class Ensemble:
    """The verdicts of the motion's own error, and of every conserved quantity."""

    states: tuple[Verdict, ...]
    conserved: tuple[Verdict, ...]


def decimal(random: Random, low: float, high: float) -> Fraction:
    """A number with three decimals, as a person would write it."""
    return Fraction(round(random.uniform(low, high) * 1000), 1000)


def rigid_body(random: Random) -> Scene:
    """A real body (the triangle inequality holds) with a spin about no axis in particular.

    Regular means well away from the borders: moments at least a fifth of the largest apart (nearly
    symmetric bodies have long periods, with many turns in each), and 1 - k^2 at least a fifth.
    """
    while True:
        scene = _any_rigid_body(random)
        moments = sorted(scene.body.inertia[i][i] for i in range(3))
        apart = all(5 * (b - a) >= moments[2] for a, b in pairwise(moments))
        if apart and elements(scene)["m_prime"].value >= 0.2:
            return scene


def _any_rigid_body(random: Random) -> Scene:
    squares = [decimal(random, 0.3, 2) for _ in range(3)]
    total = sum(squares, Fraction(0))
    body = RigidBody(tensors.diagonal(tuple(total - s for s in squares)))
    omega = tuple(random.choice((-1, 1)) * decimal(random, 0.2, 1) for _ in range(3))
    return _over_periods("euler", body, Spin(omega))


def clebsch_body(random: Random) -> Scene:
    """A body of revolution with screw coupling; |q| stays below sqrt(p r), so that T is positive."""
    p, p_prime, r, r_prime = (decimal(random, 0.5, 2) for _ in range(4))
    q, q_prime = (decimal(random, -0.4, 0.4) for _ in range(2))
    body = Clebsch(p, p_prime, q, q_prime, r, r_prime).body()
    x, y = (tuple(decimal(random, -1, 1) for _ in range(3)) for _ in range(2))
    return _over_periods("kirchhoff", body, Impulse(x, y))


def _over_periods(model: str, body: object, initial: object) -> Scene:
    """Sampled 101 times over fifteen periods."""
    start = Clock(Fraction(0), (Fraction(1),))
    scene = Scene("drawn", "drawn", model, frozenset(), body, initial, start)
    span = PERIODS * Fraction(str(float(elements(scene, 20)["period"].value)))
    clock = Clock(Fraction(0), tuple(span * k / 100 for k in range(101)))
    return Scene("drawn", "drawn", model, frozenset(), body, initial, clock)


@lru_cache
def drawn(model: str) -> tuple[Scene, ...]:
    """Thirty-two regular bodies from a fixed seed."""
    random = Random(SEED)
    draw = rigid_body if model == "euler" else clebsch_body
    return tuple(draw(random) for _ in range(BODIES))


@lru_cache
def ensemble(model: str, rung: str) -> Ensemble:
    verdicts_by_scene = [run(scene, "taylor", rung).verdicts for scene in drawn(model)]
    return Ensemble(
        tuple(v for verdicts in verdicts_by_scene for v in verdicts if v.quantity in STATES),
        tuple(v for verdicts in verdicts_by_scene for v in verdicts if v.is_conserved),
    )


@pytest.mark.slow
@pytest.mark.parametrize("rung", LADDER)
@pytest.mark.parametrize("model", ["euler", "kirchhoff"])
def test_half_of_the_bodies_have_the_figures(model: str, rung: str) -> None:
    """After fifteen periods errors of half are within 300 epsilon = 600 u and what perfect rounding leaves.

    Their conserved quantities drift by less than 30 u, and no gate of any body fails.
    """
    drawn_bodies = ensemble(model, rung)
    states, conserved = drawn_bodies.states, drawn_bodies.conserved
    assert {v.verdict for v in states + conserved} == {Status.PASS}
    assert median(v.max / (2 * v.roundoff) for v in states) <= 300
    assert median(v.ratio for v in states) <= 1
    for quantity in {v.quantity for v in conserved}:
        assert median(v.max / v.roundoff for v in conserved if v.quantity == quantity) <= 30
