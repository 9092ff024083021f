"""What perfect rounding leaves on each precision, and what `recommend` makes of it."""

from __future__ import annotations

from dataclasses import replace

import pytest

import taylor_verify
from taylor_verify.numbers.precision import rung
from taylor_verify.records.quantities import GATE_FACTOR
from taylor_verify.scenes.reading.reader import load
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.taylor.driver import Taylor
from taylor_verify.tradeoff.attainability import least_error, left_out, narrowest
from taylor_verify.tradeoff.recommendation import MARGIN, OutOfReach, recommend
from taylor_verify.tradeoff.setting import setting

F32, F64, F80 = rung("f32"), rung("f64"), rung("f80")


@pytest.fixture(scope="module")
def generic() -> Scene:
    whole = load("euler/generic")
    return replace(whole, clock=replace(whole.clock, instants=whole.clock.instants[:6]))


def test_the_least_error_is_below_what_is_measured(generic: Scene) -> None:
    """A floor of one rounding a sample is no more than that of the steps that the solver takes."""
    for name in ("f32", "f64"):
        least = least_error(generic, rung(name))
        (_, omega, *_) = taylor_verify.run(generic, Taylor(), name).verdicts
        assert least is not None
        assert 0 < least <= omega.attainable * GATE_FACTOR
        assert omega.max <= GATE_FACTOR * omega.attainable


def test_a_rung_that_cannot_reach_it_is_not_measured(generic: Scene) -> None:
    """Single precision is left out at 1e-10 with the reason in words, and double is recommended."""
    asked = [setting("taylor", F32), setting("taylor", F64)]
    recommendation = recommend(generic, 1e-10, asked)
    assert recommendation.rung == F64
    (reason,) = recommendation.left_out
    assert "on f32 rounding alone leaves" in reason
    assert reason in recommendation.sentence
    assert recommendation.document()["left_out"] == [reason]


def test_a_rung_is_left_out_by_its_own_floor(generic: Scene) -> None:
    """A rung is left out if its floor is the judge's factor times the target, and measured below that."""
    least = least_error(generic, F64)
    assert least is not None
    assert left_out(generic, [F64], 0.99 * least / GATE_FACTOR).keys() == {F64}
    assert left_out(generic, [F64], 1.01 * least / GATE_FACTOR) == {}
    assert recommend(generic, 1e-3, [setting("taylor", F32)]).left_out == ()


def test_the_narrowest_precision_is_named(generic: Scene) -> None:
    """The text of the error names the narrowest rung whose floor reaches the target."""
    target = 1e-30
    with pytest.raises(OutOfReach) as caught:
        recommend(generic, target, [setting("taylor", F64)])
    precision = narrowest(generic, target / MARGIN)
    assert precision is not None
    wide, least = precision
    assert least <= target / MARGIN
    assert (
        f"the narrowest precision on which rounding alone leaves so little is {wide.name}"
        in str(caught.value)
    )
    assert narrowest(generic, 1e-5)[0] in (F32, F64)
    assert least_error(generic, F80) > target / MARGIN


def test_what_computes_elsewhere_is_measured_anyway(generic: Scene) -> None:
    """A solver that works on wider numbers than it answers on is not judged by the floor of these."""
    with pytest.raises(OutOfReach, match="most accurate"):
        recommend(generic, 1e-25, [setting("mpmath:odefun?tol=1e-6", F64)])
