"""Right answers to drawn loads pass: the driver's own, in doubles, at many times."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from random import Random

import pytest
from builders.drawn_loads import drawn

from taylor_verify.records.status import Status
from taylor_verify.run import run
from taylor_verify.scenes.motion import Clock
from taylor_verify.scenes.scene import Scene

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
