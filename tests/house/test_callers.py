"""What a Python caller may hand over: it works, or is refused in one sentence."""

from __future__ import annotations

from collections.abc import Callable
from decimal import Decimal
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from mpmath import mp

import taylor_verify
from taylor_verify.cli import main
from taylor_verify.explain.explanation import explanation
from taylor_verify.judge.judgement import Judgement
from taylor_verify.judge.series.files import checked_steps
from taylor_verify.judge.tolerances import tolerances
from taylor_verify.models.problem import Problem
from taylor_verify.records.faults import Refused
from taylor_verify.records.status import Status
from taylor_verify.scenes.library import cases_directory
from taylor_verify.solvers.registry import solver_named
from taylor_verify.tradeoff.recommendation import recommend

pytestmark = pytest.mark.usefixtures("without_causes")
SCENE = "euler/generic"
FILE = cases_directory() / "euler" / "generic.toml"
COARSE = "geometric:splitting?step=0.1"


class Table:
    """A table with named columns, as pandas and polars have it, and NumPy takes it."""

    columns = ("w1", "w2", "w3")

    def __init__(self, values: np.ndarray[Any, Any]) -> None:
        self.values = values

    def __array__(self, dtype: Any = None, copy: Any = None) -> np.ndarray[Any, Any]:
        return self.values


def still(problem: Problem) -> np.ndarray[Any, Any]:
    return np.zeros((len(problem.times), 3))


def outcome(solve: Callable[[Problem], Any]) -> str:
    """The reason of a run that is not scored, or how it ended."""
    (first, *_) = taylor_verify.check(SCENE, solve).verdicts
    return first.because if first.max is None else first.outcome


# Times.


@pytest.mark.parametrize(
    ("time", "exact"),
    [
        (np.int64(3), Fraction(3)),
        (0.1, Fraction(0.1)),
        (np.float64(0.1), Fraction(0.1)),
        (np.float32(0.1), Fraction(float(np.float32(0.1)))),
        (np.longdouble(1) / 3, Fraction(*(np.longdouble(1) / 3).as_integer_ratio())),
        (mp.mpf("0.1"), Fraction(0.1)),
        ("0.1", Fraction(1, 10)),
        ("1/3", Fraction(1, 3)),
        (Decimal("0.1"), Fraction(1, 10)),
        (Fraction(1, 3), Fraction(1, 3)),
    ],
)
def test_times_of_every_kind_are_taken_exactly(time: Any, exact: Fraction) -> None:
    """A binary number is the rational it is, text and Decimal the one they write."""
    expected = taylor_verify.exact(SCENE, [exact])["omega"]
    assert np.all(taylor_verify.exact(SCENE, [time])["omega"] == expected)


@pytest.mark.parametrize(
    ("times", "fault"),
    [
        ("10", "expected a sequence of times, got the text '10'"),
        (1, "expected a sequence of times, got 1"),
        ({1, 2}, "expected a sequence of times, got the set"),
        (np.array(1.0), "expected a sequence of times, got array"),
        (Table(np.zeros(3)), "expected a sequence of times, got the Table"),
        (np.zeros((1, 2)), r"expected a finite number, got array.* @ times\[0\]"),
        (
            np.ma.array([0.0, 1.0], mask=[0, 1]),
            r"expected a finite number, got masked @ times\[1\]",
        ),
        ([0, float("nan")], r"expected a finite number, got nan @ times\[1\]"),
        ([np.inf], "expected a finite number, got inf"),
        ([Decimal("NaN")], r"expected a finite number, got Decimal\('NaN'\)"),
        ([True], "expected a finite number, got True"),
        ([np.True_], "expected a finite number, got np.True_"),
        ([None], "expected a finite number, got None"),
        ([1j], "expected a finite number, got 1j"),
        (["soon"], "expected a number .* got 'soon'"),
        (["1e999999999"], "expected a number with powers of ten up to 5000"),
    ],
)
def test_what_is_no_sequence_of_times_is_refused(times: Any, fault: str) -> None:
    """One sentence says what was expected, what came and where."""
    with pytest.raises(Refused, match=fault) as refused:
        taylor_verify.exact(SCENE, times)
    assert len(refused.value.faults) == 1


def test_all_wrong_times_are_refused_at_once() -> None:
    """Each time that is none has its line."""
    with pytest.raises(Refused) as refused:
        taylor_verify.exact(SCENE, [0, "x", 1, float("nan")])
    assert [line.split(" @ ")[1] for line in refused.value.faults] == ["times[1]", "times[3]"]


@pytest.mark.parametrize("digits", [0, -1, 2.5, "30", True, None, 10_001])
def test_digits_are_a_number_from_one_to_ten_thousand(digits: Any) -> None:
    """Zero digits are no answer, and text is no number."""
    with pytest.raises(Refused, match=r"expected digits from 1 to 10000, got .* @ digits"):
        taylor_verify.exact(SCENE, [1], digits=digits)


# Scenes, solvers, rungs and files.


def test_a_path_stands_wherever_a_path_may_stand(tmp_path: Path) -> None:
    """Every call takes a pathlib.Path for a scene, and `check` for a file too."""
    file = tmp_path / "mine.csv"
    file.write_text("t,w1,w2,w3\n0,0,0,0\n1,0,0,0\n")
    assert taylor_verify.load(FILE).title
    assert taylor_verify.exact(FILE, [1])["omega"].shape == (1, 3)
    assert taylor_verify.run(FILE, COARSE).verdicts
    assert taylor_verify.check(FILE, file).verdicts
    assert taylor_verify.check(FILE, still).verdicts
    assert explanation(FILE, "f64")["title"]
    with pytest.raises(ValueError, match="expected a positive error"):
        recommend(FILE, -1)


@pytest.mark.parametrize("scene", [None, 3, {}, [SCENE]])
def test_what_is_no_scene_is_refused(scene: Any) -> None:
    """A scene is a Scene, text or a path."""
    for call in (taylor_verify.load, taylor_verify.run, lambda s: taylor_verify.exact(s, [1])):
        with pytest.raises(
            Refused, match="expected a path or the name of a shipped scene, got the"
        ):
            call(scene)


def test_what_is_no_solver_and_no_rung_is_refused() -> None:
    """A solver is a Solver, named, or a callable; a rung is named, or a Rung."""
    with pytest.raises(
        ValueError, match="expected a Solver, the name of one or a callable, got None"
    ):
        taylor_verify.run(SCENE, None)
    for rung in (64, None, "f65"):
        with pytest.raises(ValueError, match="expected a rung f32, f64"):
            taylor_verify.run(SCENE, COARSE, rung)


@pytest.mark.parametrize("answer", [None, np.zeros((3, 3)), [0, 1], Table(np.zeros((3, 3)))])
def test_what_is_neither_callable_nor_file_is_refused(answer: Any) -> None:
    """An array without names is not judged: nobody knows its times."""
    with pytest.raises(
        ValueError, match=r"expected a callable solve\(problem\), a trajectory file"
    ):
        taylor_verify.check(SCENE, answer)


# States.


def test_a_mask_is_not_dropped() -> None:
    """NumPy would hand over what is under the mask; a masked answer is refused, in rows too."""

    def masked(problem: Problem) -> Any:
        states = np.ma.array(still(problem))
        states[3, 1] = np.ma.masked
        return states

    assert "expected states without a mask, got 1 masked numbers" in outcome(masked)
    assert "got 1 masked numbers" in outcome(lambda problem: list(masked(problem)))
    assert outcome(lambda problem: np.ma.array(still(problem))) == "reached the last sample"


@pytest.mark.parametrize("size", [1e200, 1e308, 10**5000, mp.mpf(10) ** 5000], ids=range(4))
def test_answers_whose_square_is_no_double_are_judged(size: Any) -> None:
    """An answer may be as large as it likes: it fails, and nothing breaks."""
    judged = taylor_verify.check(SCENE, lambda p: [[size] * 3] * len(p.times))
    assert judged.verdicts[0].verdict is Status.FAIL
    assert not judged.verdicts[0].max < 1e200


# Tolerances, targets, steps and settings.


@pytest.fixture(scope="module")
def judgement() -> Judgement:
    return taylor_verify.run(SCENE, COARSE, causes=False)


@pytest.mark.parametrize(
    "number",
    ["1e-3", 0, -1, float("nan"), float("inf"), True, 1j, [1e-3], None, 10**400, 10**5000],
    ids=range(11),
)
def test_a_tolerance_a_target_and_a_step_are_positive_numbers(
    number: Any, judgement: Judgement
) -> None:
    """Text, truth values and what is zero, negative or not finite are refused with the place."""
    with pytest.raises(ValueError, match=r"expected a positive error, got .* @ error"):
        recommend(SCENE, number)
    with pytest.raises(ValueError, match=r"expected a positive number, got .* @ steps\[1\]"):
        checked_steps([0.1, number], 2)
    scene = taylor_verify.load(SCENE)
    if number is not None:  # which asks for no tolerance
        with pytest.raises(ValueError, match=r"expected a positive number .*, got .* @ tolerance"):
            tolerances(number, [scene])
    with pytest.raises(
        ValueError, match=r"expected a positive number .*, got .* @ tolerance omega"
    ):
        tolerances({"omega": number}, [scene])


@pytest.mark.parametrize(
    "solver",
    [
        *(
            "taylor?tol={}",
            "geometric:splitting?step={}",
            "scipy:RK45?rtol={}",
            "scipy:RK45?atol={}",
        ),
        *("mpmath:odefun?tol={}", "mpmath:odefun?degree={}", "outside:cvode-bdf?rtol={}"),
    ],
)
@pytest.mark.parametrize("number", ["0", "-1", "nan", "inf", "1e999", "1e-999", "", "one"])
def test_no_setting_of_a_solver_is_taken_for_a_fault_of_ours(solver: str, number: str) -> None:
    """Every number of a solver's name is positive and one that a double holds."""
    with pytest.raises(ValueError, match=r"^expected .*, got .*"):
        solver_named(solver.format(number))


def test_settings_that_never_end_are_refused() -> None:
    """mpmath would look for the bits of a huge tolerance, and sum a series of a billion terms, for ever."""
    with pytest.raises(ValueError, match="expected a tolerance of at most 1, got '1e300' @ tol"):
        solver_named("mpmath:odefun?tol=1e300")
    with pytest.raises(
        ValueError, match="expected a whole number from 2 to 1000, got '1e9' @ degree"
    ):
        solver_named("mpmath:odefun?degree=1e9")


# What is not ours.


@pytest.mark.parametrize(
    ("error", "expected"),
    [
        (MemoryError(), "expected more memory, got none left"),
        (ImportError("libquadmath.so.0: failed to map segment"), "expected a library to load"),
    ],
)
def test_the_machines_faults_are_not_called_ours(
    error: Exception, expected: str, monkeypatch: pytest.MonkeyPatch, capsys: Any
) -> None:
    """Memory that runs out, and a library that does not load, are told as what they are."""

    def break_down(*_: Any) -> None:
        raise error

    monkeypatch.setattr("taylor_verify.solvers.solver.pose", break_down)
    assert main(["run", SCENE]) == 2
    messages = capsys.readouterr().err
    assert expected in messages
    assert "a fault of taylor-verify" not in messages
    monkeypatch.setattr("taylor_verify.solvers.solver.pose", lambda *_: 1 / 0)
    assert main(["run", SCENE]) == 2
    assert "a fault of taylor-verify" in capsys.readouterr().err
