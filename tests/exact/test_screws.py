"""Steady screws: a start that its own turning holds, exactly, and starts beside it."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import pytest

from taylor_verify.exact.kirchhoff.solid import is_steady, solid
from taylor_verify.models.problem import pose
from taylor_verify.numbers.precision import rung
from taylor_verify.records.precisions import LADDER
from taylor_verify.scenes.reading.reader import load


@pytest.mark.parametrize("step", LADDER)
def test_the_shipped_screw_is_steady_on_every_rung(step: str) -> None:
    """Its numbers are dyadic, so that no rounding moves it; a start beside it by 2^-80 is not steady."""
    body, start = solid(pose(load("kirchhoff/steady-screw"), rung(step)).given)
    assert is_steady(body, start)
    first, *others = start.linear
    assert not is_steady(body, replace(start, linear=(first + Fraction(1, 2**80), *others)))
