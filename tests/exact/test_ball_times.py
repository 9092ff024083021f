"""Closed forms at times that are balls, or numbers of mpmath, instead of rationals."""

from __future__ import annotations

from fractions import Fraction
from functools import cache
from typing import Any

import pytest
from builders.routes import has_route
from builders.scenes import everything
from flint import arb, ctx

from taylor_verify.exact.balls import Enclosed
from taylor_verify.exact.route import solution
from taylor_verify.numbers.irrational import ball
from taylor_verify.scenes.library import names
from taylor_verify.scenes.reading.reader import load
from taylor_verify.scenes.scene import Scene


@cache
def free_forms() -> list[str]:
    """The shipped scenes without loads and wheels that have a closed form."""
    forms = []
    for name in names():
        scene = load(name)
        body = scene.body
        if body.is_free and not body.damping and "gyrostat" not in name:
            forms += [name] * has_route(scene, "arb")
    return forms


def all_that_is_closed(scene: Scene) -> Scene:
    """The scene with all that its closed form knows."""
    whole = everything(scene)
    return whole if has_route(whole, "arb") else scene


@pytest.mark.parametrize("name", free_forms())
def test_a_wide_ball_of_time_contains_the_motion_at_its_ends(name: str) -> None:
    """The enclosure at the ball 1/3 +- 1/1000 overlaps those at both of its ends and at its middle."""
    inner = solution(all_that_is_closed(load(name)), "arb")
    assert isinstance(inner, Enclosed)
    middle, reach = Fraction(1, 3), Fraction(1, 1000)
    with ctx.workprec(160):
        wide = inner.enclose([ball(middle) + arb(0, ball(reach))], 160)
        for t in (middle - reach, middle, middle + reach):
            narrow = inner.enclose([t], 160)
            for name, rows in narrow.items():
                pairs = zip(flat(wide[name][0]), flat(rows[0]), strict=True)
                assert all(one.is_finite() and one.overlaps(other) for one, other in pairs)


def flat(row: Any) -> list[Any]:
    """The entries of a vector or a matrix."""
    return [entry for part in row for entry in flat(part)] if hasattr(row, "__len__") else [row]
