"""Where the response to a rounding of the input is looked at: passages are short, and none is missed."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from typing import Any

import numpy as np
import pytest

from taylor_verify.exact.elements import elements
from taylor_verify.judge.floor import rounded_input
from taylor_verify.judge.floor.rounded_input import input_rounding
from taylor_verify.numbers.precision import rung
from taylor_verify.scenes.instants import evenly
from taylor_verify.scenes.motion import Clock, Spin
from taylor_verify.scenes.reading.reader import load
from taylor_verify.scenes.scene import Scene

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
