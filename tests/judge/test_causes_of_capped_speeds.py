"""Likely causes of engines that cut a speed to a largest one after each step."""

from __future__ import annotations

from functools import partial
from pathlib import Path

import numpy as np
import pytest
from builders.caused_rows import Array, titles
from builders.integrators import rk4, turned
from builders.numbers import cross
from builders.trajectories import QUATERNION, VECTORS, Columns, named
from builders.turns import by_turns

INERTIA = np.array([1.0, 2.2, 2.9])
SCENE = """
title = "A racket that flips"
model = "euler"
track = ["omega", "attitude"]
[body]
inertia = [1, 2.2, 2.9]
[initial]
omega = [0.4, 3, 0.2]
attitude = [1, 0, 0, 0]
[time]
end = 8
samples = 81
"""


def free(w: Array) -> Array:
    return np.asarray(cross(INERTIA * w, w) / INERTIA)


def cut(cap: float, w: Array) -> Array:
    size = float(np.linalg.norm(w))
    return w * min(1.0, cap / size)


def clipped(cap: float, w: Array) -> Array:
    return np.clip(w, -cap, cap)


def stepped(limit: partial[Array], every: int) -> Columns:
    """Rows of fine steps, a limit after every so many of them, and a turn by the new omega."""
    h, w, q = 0.1 / every, np.array([0.4, 3.0, 0.2]), np.array([1.0, 0, 0, 0])
    rows = [[*w, *q]]
    for step in range(1, 80 * every + 1):
        w = limit(rk4(free, rk4(free, w, h / 2)[0], h / 2)[0])
        q = turned(q, h * w)
        if step % every == 0:
            rows.append([*w, *q])
    made = np.array(rows)
    times = np.round(np.arange(81) * 0.1, 6)[:, None]
    return (
        named(("t",), times) | named(VECTORS["omega"], made[:, :3]) | named(QUATERNION, made[:, 3:])
    )


@pytest.mark.parametrize("every", by_turns([5, 1], 2))
def test_a_speed_that_is_cut_again_and_again_is_named(every: int, tmp_path: Path) -> None:
    """The length of the rows is the cap wherever it acts; the step is that of the engine."""
    names = titles(tmp_path, SCENE, stepped(partial(cut, 2.8), every))
    words = f"omega is cut to the length 2.8 after each step, h = {0.1 / every:g}"
    assert any(words in each for each in names)


def test_a_cut_of_each_component_is_no_cut_of_the_length(tmp_path: Path) -> None:
    """A clip of single components is no cut of the length, and the word is not said."""
    names = titles(tmp_path, SCENE, stepped(partial(clipped, 2.8), 1))
    assert not any("cut to the length" in each for each in names)


def test_a_speed_below_the_cap_is_not_cut(tmp_path: Path) -> None:
    """A free motion that never reaches the cap has no word of it."""
    names = titles(tmp_path, SCENE, stepped(partial(cut, 9.0), 1))
    assert not any("cut to the length" in each for each in names)
