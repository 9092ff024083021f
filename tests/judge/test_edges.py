"""The edges of what the judge measures and says, part by part."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from mpmath import mpf

from taylor_verify.judge.conventions.meanings import readings
from taylor_verify.judge.conventions.worlds import worlds
from taylor_verify.judge.files.coverage import Extent
from taylor_verify.numbers.precision import rung
from taylor_verify.scenes.motion import Clock
from taylor_verify.scenes.reading.reader import load


@pytest.mark.parametrize("order", [1, -1])
@pytest.mark.parametrize(("instants", "rows"), [((5, 6, 7), (7, 8, 9)), ((5, 3, 1), (7, 6, 4))])
def test_a_file_is_late_against_the_start_of_its_scene(
    instants: tuple[int, ...], rows: tuple[int, ...], order: int
) -> None:
    """A row at 7 is late by 2 where the scene starts at 5, forwards or back, first or last in the file."""
    plain = load("euler/generic")
    scene = replace(plain, clock=Clock(Fraction(5), tuple(map(Fraction, instants))))
    words = [world.words for world in worlds(scene, tuple(map(Fraction, rows[::order])))]
    assert "t is late by 2" in words


def test_the_slack_of_a_clock_grows_with_its_start() -> None:
    """A late clock is rounded as its own size is."""
    slacks = []
    for start in map(Fraction, (0, 990)):
        times = tuple(start + k for k in range(11))
        scene = replace(load("euler/generic"), clock=Clock(start, times))
        slacks.append(Extent.of(scene, times, rung("f64")).slack)
    assert slacks[1] == 100 * slacks[0] > 0


@pytest.mark.parametrize("number", [float, mpf])
def test_units_of_angular_velocity(number: Any) -> None:
    """A turn is 2 pi, a degree its 360th part; a turn in a minute is a 60th of it in a second."""
    parts = {
        "": 1 / (2 * np.pi),
        "in degrees per unit of time": 1 / 360,
        "in turns per unit of time": 1,
        "in turns per minute, the unit of time being the second": 1 / 60,
    }
    rows, R = np.array([[number(0), number(3), number(0)]]), np.eye(3)[None]
    other = ("space", "rates")
    plain = [r for r in readings("omega") if not any(word in "".join(r.words) for word in other)]
    assert len(plain) == len(parts)
    for reading, (unit, part) in zip(plain, parts.items(), strict=True):
        assert "".join(reading.words) == f"w1 w2 w3 are {unit}" * bool(unit)
        assert float(reading.read(rows, R)[0, 1]) == pytest.approx(3 * 2 * np.pi * part)


def test_units_of_time_are_as_long_as_their_names() -> None:
    """A file may count time in any of these units, for a scene in seconds."""
    scene = load("euler/generic")
    lengths = {
        world.time_words[0].partition("(")[2].partition(" for")[0]: world.scale
        for world in worlds(scene, scene.clock.instants)
        if world.scale != 1 and not world.shift
    }
    names = ("milli", "micro", "nano")
    parts = {f"{name}seconds": Fraction(1, 1000**k) for k, name in enumerate(names, 1)}
    assert lengths == parts | {"minutes": 60, "hours": 3600, "days": 86400}
