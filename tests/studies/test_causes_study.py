"""The confusion table of likely causes and its list of kinds; what is said of answers, vectors hold."""

from __future__ import annotations

import json
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from builders.turns import by_turns

from taylor_verify.judge.causes import cause_search
from taylor_verify.judge.causes.material import ExactMotion
from taylor_verify.models.problem import adopt
from taylor_verify.numbers.precision import rung
from taylor_verify_reports.studies.causes import measured_causes as measure
from taylor_verify_reports.studies.causes.bodies import SORTS
from taylor_verify_reports.studies.causes.kind import right
from taylor_verify_reports.studies.causes.kinds import KINDS
from taylor_verify_reports.studies.causes.loaded import LOADED, any_sample
from taylor_verify_reports.studies.causes.measured_causes import (
    OUTCOMES,
    Named,
    measured,
    page,
    said_of,
    table,
)
from taylor_verify_reports.studies.finished_parts import Parts


def test_the_page_has_what_is_false() -> None:
    """Below the table each false sentence stands with its kind and its body."""
    answers = [Named("a", "free", "right", ("x",)), Named("b", "free", "false", ("y",))]
    assert page(answers).splitlines()[-1] == "- b, free: y"


def test_the_table_counts_every_answer() -> None:
    """The last row is the sum of all rows, outcome by outcome."""
    answers = [Named("a", "free", "right", ()), Named("b", "free", "false", ("x",))]
    assert table(answers).splitlines()[0] == f"| answers | {' | '.join(OUTCOMES)} |"
    assert table(answers).splitlines()[-1] == "| all | 1 | 0 | 0 | 0 | 0 | 1 |"


def test_a_finished_answer_is_not_made_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """After an interrupt the study goes on with the answers that are not finished yet."""
    kind = next(kind for kind in KINDS if kind.name == "degrees")
    (first,) = measured(1, 1, Parts(tmp_path), [kind])
    asked = list[object]()
    monkeypatch.setattr(measure, "run_all", lambda work, waiting, **_: asked.extend(waiting))
    assert measured(1, 2, Parts(tmp_path), [kind]) == [first]
    assert asked == [(1, kind.name, 1)]


@pytest.mark.parametrize(
    ("kind", "number", "words"),
    by_turns(
        [("asleep", 4, "at rest from t = 5.727 on"), ("jump", 5, "exact motion between jumps")]
    ),
)
def test_an_attitude_that_follows_from_its_own_omega_has_no_cause(
    kind: str, number: int, words: str
) -> None:
    """Roundings of the arcs beside a fault of omega are no attitude that is set anew."""
    (sentence,) = json.loads(said_of((1, kind, number)))["sentences"]
    assert words in sentence


def test_a_motion_that_is_not_reached_from_its_own_start_has_no_cause(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The search for causes from there ends, though the first row of these momenta stays another one.

    That is so where their axes are not asked for.
    """
    name = "axes exchanged"
    kinds = (replace(k, sorts=SORTS) if k.name == name else k for k in measure.KINDS)
    monkeypatch.setattr(measure, "KINDS", tuple(kinds))
    (sentence,) = json.loads(measure.said_of((69, name, 1)))["sentences"]
    assert "made of velocities of which the angular ones have other axes: 2 1 3" in sentence
    monkeypatch.setattr(cause_search, "printed_by_another_body", lambda _: None)
    assert json.loads(measure.said_of((69, name, 1)))["sentences"] == []


@pytest.mark.parametrize(
    ("kind", "words"),
    by_turns(
        [
            ("switch missed", "switch at t = 1.072 missed; leaves"),
            (
                "rate of the current left out",
                "the rate of the current in body axes is left out of the",
            ),
            (
                "C_A over ground",
                "the Coriolis terms of the added mass take the velocity over ground",
            ),
            (
                "added mass over ground",
                "the added mass moves over ground, not through the water: M_A",
            ),
            ("weight turned by R", "weight and buoyancy turned the wrong way, by R; "),
            (
                "drag along space axes",
                "drag of force and couple by coefficients along space axes; ",
            ),
            ("slerp", "linear interpolation and slerp of the attitude between exact rows: every "),
            ("clock that steps", "the clock is in time, and late by "),
        ],
        3,
    ),
)
def test_one_fault_has_one_sentence(kind: str, words: str) -> None:
    """A thrust that does not end is a switch that was missed, and terms over ground are no other number."""
    (sentence,) = json.loads(said_of((1, kind, 1)))["sentences"]
    assert sentence.startswith(words)


def test_silence_is_right_where_no_fault_has_a_name() -> None:
    """Silence is the right word for a law that no family has."""
    assert json.loads(said_of((1, "growing load", 0)))["outcome"] == "right"


# The kinds of the faults that the contract of likely causes names, and of those of given files.
_NAMED = """
clock factor, early clock, times in frames, times rounded, times that scatter, times by a float32 sum,
rows at whole steps,
rows saved twice, own start, space frame turned, body frame turned, velocity of another point, path of
another point, frame that turns, rates of Euler angles, constant current, asleep, speed capped, load for
a while, row repeated, RK4, held rate of the attitude, attitude in place, components updated in place,
momentum turned, attitude on the wrong side, RK4 and another load, a fault and Euler steps, steps that do
not divide the rows, added mass missing in C, added mass of the other sign in C, added mass twice in C,
entry of C_A zeroed, entry of C_A of the other sign, entries of C_A as simulators zero them, centre of
mass in M alone, thrust left out, thrust of the other sign, load in space axes, loads held over a step,
pulses late by a step, switch missed, controller at another rate, controller one sample late, controller
without its delay, controller continuous, one load more, moment in space, couple of weight and buoyancy
left out, drag on one axis, quadratic drag, wheels left out, wheel, gyroscopic factor, cubic
interpolation, linear interpolation, attitude alone, switch late by a step, drag over ground, load turned
the wrong way, products left out of the gravity gradient
"""


def test_every_name_of_the_vocabulary_is_a_kind() -> None:
    """Each fault that the search shall name is a kind of the study, so that a silent one is counted."""
    named, kinds = " ".join(_NAMED.split()).split(", "), [kind.name for kind in KINDS]
    assert set(named) <= set(kinds)
    assert len(set(kinds)) == len(kinds)


def test_loads_as_texts_and_as_plain_code_are_the_same() -> None:
    """The exact motion of a scene with texts is that of the plain code, to the digits that it prints."""
    for sort in LOADED:
        body = any_sample(sort, np.random.default_rng([3, LOADED.index(sort)]))
        rows = right(body)
        times = tuple(Fraction(str(t)) for t in rows.times[:3])
        given = adopt(body.scene, rung("f64"), times).given
        exact = ExactMotion(given, has_centre=body.n == 6).at([*given.clock.elapsed], False)
        assert np.max(np.abs(exact.v - rows.v[:3])) < 1e-10
        if exact.c is not None and rows.c is not None:
            assert np.max(np.abs(exact.c - rows.c[:3])) < 1e-10
