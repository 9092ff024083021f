"""Enclosures of all motions that begin in a box of starts, and sharper runs from its corners."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from itertools import product

import pytest
from flint import arb, ctx

from builders.scenes import GENERAL, LOADED, QUATERNION, one_instant, sample_scene, vector
from taylor_verify.exact.balls import balls
from taylor_verify.exact.enclosure import step
from taylor_verify.exact.enclosure.coefficients import Rows
from taylor_verify.exact.enclosure.course import Course
from taylor_verify.exact.enclosure.loaded import posed
from taylor_verify.exact.enclosure.step import Stepper
from taylor_verify.exact.enclosure.walk import Row
from taylor_verify.numbers.irrational import ball
from taylor_verify.numbers.tensors import diagonal
from taylor_verify.scenes.bodies import RigidBody
from taylor_verify.scenes.motion import Spin, State
from taylor_verify.scenes.scene import Scene

WIDE = Fraction(1, 10**6)

CASES = {
    "euler": (sample_scene(RigidBody(diagonal(vector(1, 2, 3))), "attitude"), 6),
    "one axis": (
        one_instant(
            RigidBody(diagonal(vector(2, 1, 1))), Spin(vector(0, 0, 1), QUATERNION), "attitude"
        ),
        2,
    ),
    "kirchhoff": (sample_scene(GENERAL, "attitude", "centre"), 4),
    "loaded": (sample_scene(LOADED, "attitude", "centre"), -3),
}


def moved(start: State, signs: Sequence[int], size: Fraction) -> State:
    """The start with each component of the momenta moved by the size, in the direction of its sign."""
    return start.with_moving(
        tuple(v + sign * size for v, sign in zip(start.moving, signs, strict=True))
    )


def enclosed(asked: Scene, time: Fraction, size: Fraction, bits: int) -> Row:
    """The row at a time, of all starts within the size of the scene's own."""
    system = posed(asked)
    with ctx.workprec(bits):
        start, width = balls(system.start), arb(0, ball(size).upper())
        for i, _ in enumerate(asked.initial.moving):
            start[i] += width
        run = Course.of(system, start, bits, 10_000)
        (row,) = (row for _, row in run.rows([time]))
    return row


def with_few_orders(patch: pytest.MonkeyPatch) -> None:
    """Make steps that are too long for their eight orders: truncation is by far the largest error."""
    sharp = Stepper.root_test

    def coarse(self: Stepper, rows: Rows, spans: Sequence[range]) -> float:
        with ctx.workprec(30):
            return sharp(self, rows, spans)

    patch.setattr(Stepper, "order", property(lambda _: 8))
    patch.setattr(Stepper, "root_test", coarse)
    patch.setattr(step, "SPARE_BITS", 60)


def corners(asked: Scene) -> list[Sequence[int]]:
    size = 3 if isinstance(asked.body, RigidBody) else 6
    every = [tuple(signs) for signs in product((-1, 1), repeat=size)]
    return every if size == 3 else every[::9]


def is_contained(name: str, bits: int = 80, size: Fraction = WIDE) -> bool:
    """Return True if the balls of a box contain the motions from its corners, by far sharper runs."""
    asked, end = CASES[name]
    time = Fraction(end)
    row = enclosed(asked, time, size, bits)
    for signs in corners(asked):
        truth = TRUTHS[name, tuple(signs), size]
        with ctx.workprec(200):
            for got, exact in (
                (row.state, truth[0]),
                (row.turn, truth[1]),
            ):
                if not all(g.overlaps(e) for g, e in zip(got, exact, strict=True)):
                    return False
    return True


class _Truths(dict[tuple[str, tuple[int, ...], Fraction], tuple[list[arb], list[arb]]]):
    """Motions from corners, each computed once, before anything is broken."""

    def __missing__(
        self, key: tuple[str, tuple[int, ...], Fraction]
    ) -> tuple[list[arb], list[arb]]:
        name, signs, size = key
        asked, end = CASES[name]
        corner = replace(asked, initial=moved(asked.initial, signs, size))
        row = enclosed(corner, Fraction(end), Fraction(0), 160)
        self[key] = (row.state, row.turn)
        return self[key]


TRUTHS = _Truths()
