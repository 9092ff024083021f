"""Honest answers pass: roundings add up as the floor says, also where each step adds the same amount."""

from __future__ import annotations

import random
from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from random import Random

import pytest
from builders.drawn_loads import drawn
from builders.honest import answers, arithmetic
from builders.scenes import vector
from builders.turns import by_turns

from taylor_verify import check
from taylor_verify.numbers import tensors
from taylor_verify.numbers.tensors import Matrix, Vector
from taylor_verify.records.status import Status
from taylor_verify.run import run
from taylor_verify.scenes.bodies import Body, Clebsch, ImmersedBody, RigidBody
from taylor_verify.scenes.motion import Clock, Impulse, Quaternion, Spin, State
from taylor_verify.scenes.scene import Scene

ZERO = Fraction(0)
# A rotation with rational entries, and a unit quaternion.
TURN: Matrix = (
    vector("0.6", "-0.8", 0),
    vector("0.48", "0.36", "-0.8"),
    vector("0.64", "0.48", "0.6"),
)
UNIT: Quaternion = (Fraction(1, 10), Fraction(1, 2), Fraction(1, 2), Fraction(7, 10))
# Numbers of bits of a step, so that every precision holds its multiples.
STEP_BITS = 8


class Draw(random.Random):
    """Draws of numbers in thousandths, of vectors, and of clocks."""

    def number(self, low: float, high: float) -> Fraction:
        return Fraction(self.randint(round(1000 * low), round(1000 * high)), 1000)

    def vector(self, size: float, share: float = 1) -> Vector:
        """Return a vector, or zero except in this share of the draws."""
        entries = tuple(self.number(-size, size) for _ in range(3))
        return entries if self.random() < share else (ZERO,) * 3

    def moments(self) -> Vector:
        """Return three moments that two are enough to close a triangle with."""
        a = self.number(1, 2)
        return a, a + self.number(0, 0.3), a + self.number(0.3, 0.6)

    def tensor(self, moments: Vector) -> tuple[Matrix, Matrix]:
        """Return a tensor of these moments and its axes, those of the body or those of TURN."""
        axes = self.choice((tensors.diagonal(vector(1, 1, 1)), TURN))
        half = tensors.product(axes, tensors.diagonal(moments))
        return tensors.product(half, tensors.transpose(axes)), axes

    def damping(self) -> Fraction:
        return self.number(0.01, 0.3) if self.random() < 0.3 else ZERO

    def clock(self, bits: int, rows: int, every: int, damping: Fraction) -> Clock:
        """Return rows of steps h with h^5/120 below a rounding, or up to 64 times shorter; both signs.

        Backwards a damped motion grows, and the step would be too long if it grew by more than e.
        """
        exponent = bits / 5 + self.uniform(0, 6)
        places = round(exponent) + STEP_BITS
        row = every * Fraction(round(2.0 ** (places - exponent)), 2**places)
        sign = self.choice((-1, 1)) if damping * rows * row <= 1 else 1
        return Clock(ZERO, tuple(sign * k * row for k in range(rows + 1)))


def rigid(draw: Draw) -> tuple[Body, State]:
    """Return a generic body, a sphere, or a spin about a principal axis along which all vectors lie."""
    kind, moments = draw.choice(("generic", "sphere", "axis")), draw.moments()
    inertia, axes = draw.tensor(moments[:1] * 3 if kind == "sphere" else moments)
    omega, moment, wheels = draw.vector(1), draw.vector(0.3, 0.7), draw.vector(0.5, 0.3)
    if kind == "axis":
        axis = tensors.transpose(axes)[draw.randrange(3)]
        omega, moment, wheels = (tensors.scaled(v[0], axis) for v in (omega, moment, wheels))
    damping, start = draw.damping(), Spin(omega, UNIT)
    if any(wheels):
        return RigidBody(inertia, moment, wheels, damping), start
    return RigidBody(inertia, moment, damping=damping), start


def immersed(draw: Draw) -> tuple[Body, State]:
    """Return a body with 21 coefficients, one of revolution, or one that goes and turns along its axis."""
    kind = draw.choice(("generic", "revolution", "axis"))
    p, p_prime, r, r_prime = (draw.number(0.5, 1) for _ in range(4))
    force, couple, x, y = (
        draw.vector(0.2, 0.6),
        draw.vector(0.2, 0.6),
        draw.vector(1),
        draw.vector(1),
    )
    if kind == "axis":
        force, couple, x, y = ((ZERO, ZERO, v[2]) for v in (force, couple, x, y))
    body = Clebsch(p, p_prime, ZERO, ZERO, r, r_prime).body(force, couple)
    if kind == "generic":
        linear, angular = (draw.tensor(draw.moments())[0] for _ in range(2))
        coupling = tuple(draw.vector(0.1) for _ in range(3))
        body = ImmersedBody(linear, coupling, angular, force, couple)
    return body.with_damping(draw.damping()), Impulse(x, y, UNIT, draw.vector(2))


BODIES: dict[str, Callable[[Draw], tuple[Body, State]]] = {"euler": rigid, "kirchhoff": immersed}
FRAMES = {
    "euler": (frozenset[str](), frozenset({"attitude"})),
    "kirchhoff": (frozenset[str](), frozenset({"attitude", "centre"})),
}


def drawn_scenes(model: str, rung: str, count: int, rows: int, every: int) -> list[Scene]:
    """Return drawn scenes of a model, whose rows are ``every`` steps apart."""
    draw, bits = Draw(f"{model} {rung} {rows} {every}"), arithmetic(rung).bits
    scenes = []
    for k in range(count):
        body, start = BODIES[model](draw)
        track, clock = draw.choice(FRAMES[model]), draw.clock(bits, rows, every, body.damping)
        scenes.append(Scene(f"{rung} {k}", "drawn", model, track, body, start, clock))
    return scenes


# Model, precision, number of answers, rows, and steps from row to row. An answer of half as many rows is
# quick on each precision.
GROUPS = [
    ("euler", "f32", 40, 60, 4),
    ("euler", "f64", 15, 60, 1),
    ("euler", "f80", 20, 60, 2),
    ("kirchhoff", "mp40", 10, 30, 1),
    ("euler", "mp113", 10, 40, 1),
    ("euler", "f32", 30, 60, 1),
    ("euler", "mp40", 20, 60, 1),
    ("kirchhoff", "f32", 20, 30, 2),
]


@pytest.mark.parametrize(
    ("model", "rung", "count", "rows", "every"),
    [
        *by_turns(
            [(model, rung, 1, rows // 2, every) for model, rung, _, rows, every in GROUPS],
            len(GROUPS),
            lambda model, rung, *rest: rung,
        ),
        *(pytest.param(*group, marks=pytest.mark.slow) for group in GROUPS),
    ],
)
def test_no_honest_answer_fails(model: str, rung: str, count: int, rows: int, every: int) -> None:
    """A method whose steps err by less than a rounding passes, whatever the body and the precision."""
    scenes = drawn_scenes(model, rung, count, rows, every)
    failed = [
        (scene.name, verdict.sentence, verdict.because)
        for scene, answer in zip(scenes, answers(scenes, rung, every), strict=True)
        for verdict in check(scene, answer, rung).verdicts
        if verdict.verdict is Status.FAIL
    ]
    assert not failed


# Times the span of a drawn scene.
LONGER = 4


def scene_of(seed: int, rows: int) -> Scene:
    """A scene under drawn loads, every third one with states of its own, with so many rows."""
    scene = drawn(Random(seed), with_states=seed % 3 == 2).scene
    start, end = scene.clock.start, scene.clock.instants[-1]
    instants = [start + LONGER * (end - start) * Fraction(k, rows) for k in range(rows + 1)]
    return replace(scene, clock=Clock(start, tuple(instants)))


def failed(seed: int, rows: int) -> list[str]:
    """The quantities that fail; a load that the driver cannot have is refused, and not judged."""
    judged = run(scene_of(seed, rows), "taylor", "f64")
    return [v.quantity for v in judged.verdicts if v.verdict is Status.FAIL]


@pytest.mark.slow
def test_an_answer_is_judged_whose_first_row_takes_more_digits() -> None:
    """The derivative of the whole motion stays where the start alone is computed again."""
    assert failed(134, 8) == []


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(40))
def test_no_right_answer_to_drawn_loads_fails(seed: int) -> None:
    """Roundings of all functions, of the frame's length and of held values are within the floor."""
    assert failed(seed, 32) == []
