"""Results of the public functions: read by name, printed in full, pickled, shown in a notebook."""

from __future__ import annotations

import pickle
from collections.abc import Callable
from copy import deepcopy
from dataclasses import replace
from fractions import Fraction
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pytest

import taylor_verify
from taylor_verify.records.showing import picture
from taylor_verify.tradeoff.setting import chosen

SCENE = "euler/with-attitude"
TIMES = [0, "1/3", 2]
DIGITS = 40
MAKERS: dict[str, Callable[[], Any]] = {
    "Motion": lambda: taylor_verify.exact(SCENE, TIMES, DIGITS),
    "Trajectory": lambda: taylor_verify.solve("euler/spherical", "geometric:lie-rk4?step=0.1"),
    "Scene": lambda: taylor_verify.load("loads/gravity-gradient"),
    "Judgement": lambda: taylor_verify.run(
        "euler/tennis-racket", "geometric:lie-rk4?step=0.1", causes=False
    ),
}


@pytest.fixture(scope="module")
def results() -> dict[str, Any]:
    return {name: make() for name, make in MAKERS.items()}


@pytest.mark.parametrize("name", MAKERS)
def test_a_result_is_pickled_and_compared_without_losing_a_bit(
    name: str, results: dict[str, Any]
) -> None:
    """A pickled result equals what was written; mpmath's own pickle rounds numbers to doubles."""
    result = results[name]
    assert pickle.loads(pickle.dumps(result)) == result == deepcopy(result)
    assert result != "another"
    assert type(result).__name__ == name == getattr(taylor_verify, name).__name__


@pytest.mark.parametrize("name", MAKERS)
def test_a_repr_is_one_line_that_says_what_it_is(name: str, results: dict[str, Any]) -> None:
    """It names the type and what is in it, and is no dump of numbers."""
    text = repr(results[name])
    assert text.startswith(f"<{name} ")
    assert len(text) < 200
    assert "\n" not in text


RESULTS: dict[str, Callable[[], Any]] = {
    **{name: make for name, make in MAKERS.items() if name != "Scene"},
    "Events": lambda: taylor_verify.events("euler/tennis-racket", "w2 = 0", 20),
    "Judgements": lambda: taylor_verify.run_many(["euler/rest"], rungs=["f64"]),
    "SweepSummary": lambda: taylor_verify.sweep("satellites", count=1),
    "TradeOff": lambda: taylor_verify.tradeoff("euler/rest", chosen([], ["f64"]), repeats=1),
    "Recommendation": lambda: taylor_verify.recommend("euler/rest", 1e-6, chosen([], ["f64"])),
}


@pytest.mark.parametrize("name", RESULTS)
def test_all_results_have_the_same_face(name: str) -> None:
    """Each has passed, which is its truth value, raise_for_failure, a table, a short repr and HTML."""
    result = RESULTS[name]()
    assert type(result).__name__ == name
    assert bool(result) is result.passed
    if result.passed:
        result.raise_for_failure()
    else:
        with pytest.raises(AssertionError):
            result.raise_for_failure()
    assert len(result.to_dataframe())
    assert repr(result).startswith(f"<{name}")
    assert len(repr(result)) < 200
    page = ElementTree.fromstring(f"<div>{result._repr_html_()}</div>")
    assert page.find("table/tbody/tr/td") is not None


def test_a_sweep_is_read_by_quantity() -> None:
    """Each spread is found under its quantity; the table has a row for each."""
    summary = taylor_verify.sweep("satellites", count=1)
    assert [summary[each.quantity] for each in summary.quantities] == [*summary.quantities]
    frame = summary.to_dataframe()
    assert [*frame["quantity"]] == [each.quantity for each in summary.quantities]
    assert {"pass", "ratio_median", "max_largest"} <= {*frame.columns}
    with pytest.raises(KeyError, match="omega"):
        _ = summary["centre"]


def test_a_trajectory_passed_if_its_outcome_is_success() -> None:
    """A trajectory that did not reach the last sample is false, and its error says why."""

    def broken(problem: Any) -> Any:
        raise FloatingPointError("too hard")

    answer = taylor_verify.solve("euler/rest", broken)
    assert not answer
    with pytest.raises(AssertionError, match="too hard"):
        answer.raise_for_failure()


def test_a_motion_passed_if_its_rows_have_the_digits() -> None:
    """A row that is known to fewer digits than asked for makes it false."""
    motion = taylor_verify.exact("euler/generic", [1, 2], 20)
    assert motion.passed
    assert not replace(motion, digits=200).passed


@pytest.mark.parametrize(
    ("rung", "kind"), [("f32", np.float32), ("f64", np.float64), ("f128", object)]
)
def test_solved_doubles_are_arrays_of_numpy(rung: str, kind: type) -> None:
    """Quantities on f64 are float64, on f32 float32, each rounded once; on other rungs they are exact."""
    answer = taylor_verify.solve("euler/with-attitude", "taylor", rung)
    assert {rows.dtype for rows in answer.quantities.values()} == {np.dtype(kind)}
    assert answer.motion(53).attitude.shape[1:] == (3, 3)
    if rung == "f64":
        assert taylor_verify.check(SCENE, {"t": answer.times, **answer.quantities})


def test_a_motion_prints_all_digits_that_were_asked_for(results: dict[str, Any]) -> None:
    """The motion, an array, a row, a number and a table have them, and a rounded one is another motion."""
    motion = results["Motion"]
    longer = taylor_verify.exact(SCENE, TIMES, DIGITS + 10)
    number = str(motion.omega[1, 0])
    assert len(number.removeprefix("0.")) == DIGITS
    assert str(longer.omega[1, 0]).startswith(number[:-2])
    frame = motion.to_dataframe()
    for text in (
        motion,
        motion.omega,
        motion["omega"][1],
        f"{motion.omega[1, 0]}",
        frame.to_string(),
    ):
        assert number in str(text)
    assert motion != longer
    assert motion.times == (Fraction(0), Fraction(1, 3), Fraction(2))
    assert float(motion.omega[1, 0]) == float(number)


def test_own_equations_and_events_print_their_digits() -> None:
    """Numbers of `enclose` and times of `events` print as those of `exact` do."""
    motion = taylor_verify.enclose({"x": "-x"}, {"x": 1}, [1], DIGITS)
    assert str(motion.x[0]) == "0.3678794411714423215955237701614608674458"
    assert motion.times == (Fraction(1),)
    first, *_ = taylor_verify.events("euler/tennis-racket", "w2 = 0", 20, DIGITS)
    assert len(str(first.t)) == DIGITS + 1


def test_quantities_are_attributes_and_columns(results: dict[str, Any]) -> None:
    """They are the arrays by name; a table has the columns of a file; an unknown name is answered."""
    motion, trajectory = results["Motion"], results["Trajectory"]
    assert motion.attitude is motion["attitude"]
    frame = motion.to_dataframe()
    assert [*frame.columns] == [
        *("t", "w1", "w2", "w3"),
        *(f"r{i}{k}" for i in (1, 2, 3) for k in (1, 2, 3)),
    ]
    assert frame["r12"][1] == motion.attitude[1, 0, 1]
    table = trajectory.to_dataframe()
    assert len(table) == len(trajectory.times) == len(trajectory.omega)
    with pytest.raises(
        AttributeError, match="expected one of the quantities omega, attitude, got 'omga'"
    ):
        _ = motion.omga


def test_a_judgement_is_read_by_quantity(results: dict[str, Any]) -> None:
    """Each verdict is found under its quantity, and the truth value is that of `passed`."""
    judged = results["Judgement"]
    assert [judged[v.quantity] for v in judged.verdicts] == [*judged.verdicts]
    assert bool(judged) is judged.passed
    assert len(judged.times) == len(taylor_verify.load("euler/tennis-racket").times)
    with pytest.raises(KeyError, match="omega"):
        _ = judged["centre"]


@pytest.mark.parametrize("name", ["Motion", "Trajectory", "Judgement"])
def test_a_notebook_shows_a_table_and_a_picture(name: str, results: dict[str, Any]) -> None:
    """The HTML is well-formed, with a table, and an SVG with a curve."""
    page = ElementTree.fromstring(f"<div>{results[name]._repr_html_()}</div>")
    assert page.find("table/tbody/tr") is not None
    assert any(node.tag.endswith("polyline") for node in page.iter())


def test_a_picture_leaves_out_what_has_no_place() -> None:
    """NaN, infinity, and zero on a logarithmic axis are gaps; without any number there is no picture."""
    drawn = picture([0, 1, 2, 3], {"a<b": [1.0, np.nan, 0.0, 100.0]}, log=True)
    points = ElementTree.fromstring(drawn)[0].attrib["points"]
    assert len(points.split()) == 2
    assert "a&lt;b" in drawn
    assert picture([0, 1], {"a": [np.nan, np.inf]}) == ""


def test_a_refusal_is_a_value_error() -> None:
    """Whoever catches ValueError catches every refusal, with all its faults."""
    assert issubclass(taylor_verify.Refused, ValueError)
    with pytest.raises(ValueError, match="did you mean"):
        taylor_verify.load("euler/generics")
