"""Judgements of damped motions: what is conserved of e^{ct} times the momenta, and what has a balance."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from builders.turns import by_turns

from taylor_verify.exact.conditioning.condition import path, transition
from taylor_verify.judge.floor.attainable import floor
from taylor_verify.models.problem import pose
from taylor_verify.numbers.precision import rung
from taylor_verify.records.status import Status
from taylor_verify.run import run
from taylor_verify.scenes.motion import Clock
from taylor_verify.scenes.reading.reader import load
from taylor_verify.scenes.scene import Scene

RIGID, NEGATIVE, FLUID = "euler/damped", "euler/damped-negative", "kirchhoff/damped"


def with_damping(name: str, damping: Fraction, end: int | None = None) -> Scene:
    """A shipped scene with this damping, asked at ten instants of its own span or another."""
    scene = load(name)
    start = scene.clock.start
    span = scene.clock.elapsed[-1] if end is None else Fraction(end)
    instants = tuple(start + span * Fraction(k, 10) for k in range(11))
    body = replace(scene.body, damping=damping)  # type: ignore[type-var]
    return replace(scene, body=body, clock=Clock(start, instants))


@pytest.mark.parametrize("on", by_turns(["f64", "f32", "f80"]))
@pytest.mark.parametrize("name", [RIGID, NEGATIVE, FLUID])
def test_the_shipped_scenes_pass(name: str, on: str) -> None:
    """Every row of a damped scene passes, the invariants times their factors among them."""
    judgement = run(name, "taylor", on)
    assert {verdict.verdict for verdict in judgement.verdicts} == {Status.PASS}
    conserved = (
        {"T", "H2", "H_space"} if "euler" in name else {"T", "F2", "FG", "y3", "x_space", "y_space"}
    )
    assert {verdict.quantity for verdict in judgement.verdicts} >= conserved


@pytest.mark.parametrize(
    ("name", "damping"),
    by_turns(
        [
            ("euler/gyrostat", Fraction(1, 10)),
            ("euler/constant-moment", Fraction(-1, 50)),
            ("kirchhoff/constant-loads", Fraction(1, 10)),
            ("euler/gyrostat", Fraction(-1, 50)),
            ("euler/constant-moment", Fraction(1, 10)),
            ("kirchhoff/constant-loads", Fraction(-1, 50)),
        ],
        6,
        lambda name, damping: name,
    ),
)
def test_loads_and_wheels_have_balances(name: str, damping: Fraction) -> None:
    """With a load or with wheels the balances of T and of the momenta pass, by Taylor series."""
    judgement = run(with_damping(name, damping, 4), "taylor", "f64")
    assert {verdict.verdict for verdict in judgement.verdicts} == {Status.PASS}
    assert judgement.record.route == "taylor"


def test_what_has_decayed_below_the_least_number_excuses_itself() -> None:
    """On f32 e^{-280} is zero: the invariants are vacuous there, while omega is judged and passes."""
    judgement = run(with_damping(RIGID, Fraction(14), 20), "taylor", "f32")
    verdicts = {verdict.quantity: verdict.verdict for verdict in judgement.verdicts}
    assert verdicts["omega"] is Status.PASS
    assert {verdicts[name] for name in ("T", "H2", "H_space")} == {Status.VACUOUS}
    wide = run(with_damping(RIGID, Fraction(14), 20), "taylor", "f64")
    assert {verdict.verdict for verdict in wide.verdicts} == {Status.PASS}


def test_a_decay_beyond_float64_is_undecided() -> None:
    """Where errors shrink by more than e^300 nothing is said of them, and the reason is."""
    (verdict,) = run(with_damping(RIGID, Fraction(1000)), "taylor", "f64").verdicts
    assert verdict.verdict is Status.UNDECIDED
    assert "beyond e^300" in verdict.sentence


@pytest.mark.parametrize("name", [RIGID, FLUID])
def test_errors_decay_with_the_motion(name: str) -> None:
    """The volume of a small cloud of momenta shrinks by e^{-ct} in each direction."""
    scene = load(name)
    orbit = transition(scene, scene.clock.elapsed)
    d = orbit.momentum.shape[1]
    volumes = np.linalg.det(orbit.carried.since_first[:, :d, :d])
    times = np.array([float(t) for t in scene.clock.elapsed])
    expected = np.exp(-d * float(scene.body.damping) * times)
    assert np.allclose(volumes / expected, 1, atol=1e-4)
    assert path(scene).is_regular


def test_a_weak_damping_has_the_floor_of_none() -> None:
    """With c = 1e-12 all that is attainable is what it is without damping, to six digits."""
    floors = []
    for damping in (Fraction(0), Fraction(1, 10**12)):
        scene = with_damping(RIGID, damping)
        given = pose(scene, rung("f64")).given
        weak = floor(given, scene, rung("f64").unit_roundoff, 100)
        floors.append(np.concatenate([weak.carried[name] for name in ("momentum", "attitude")]))
    assert np.allclose(*floors, rtol=1e-6)
