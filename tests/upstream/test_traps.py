"""Plain calls of heyoka go wrong as published, silently if marked so; the driver does not."""

import ast
import csv
import json
import re
import signal
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import lru_cache
from importlib.util import find_spec
from itertools import pairwise
from pathlib import Path

import heyoka as hy
import pytest
from interrupt import interrupted
from traps import page as published
from traps.document import TrapCase, TrapRow, TrapsStudy
from traps.measured import GENERIC, free
from traps.numbers import equal
from traps.outcomes import tolerance_of_zero
from traps.table import TRAPS, study
from traps.trap import Trap, shown

from taylor_verify.models.problem import pose
from taylor_verify.scenes.precision import rung
from taylor_verify.solvers.taylor import way
from taylor_verify.solvers.taylor.cache import heyoka_cache_off
from taylor_verify.solvers.taylor.driver import Taylor
from taylor_verify.solvers.taylor.plain import Plain
from taylor_verify.solvers.trajectory import Outcome

REPORTS = Path(__file__).resolve().parents[2] / "reports"
NAMED = {trap.key: trap for trap in TRAPS}
U = float(rung("f64").unit_roundoff)

needs_sympy = pytest.mark.skipif(
    find_spec("sympy") is None, reason="sympy asks for mpmath below 1.4 and is not installed"
)


@lru_cache
def cases(key: str) -> tuple[TrapCase, ...]:
    """The cases of a trap, measured once for all tests."""
    return tuple(NAMED[key].measured())


def case(key: str, name: str) -> TrapCase:
    (named,) = (named for named in cases(key) if named.case == name)
    return named


def on_rung(key: str, name: str, on: str) -> TrapCase:
    """The case on a rung that not every machine has; skips where it is missing."""
    if missing := Plain().unavailable(rung(on)):
        pytest.skip(missing)
    return case(key, name)


def errors(key: str) -> list[float]:
    values = [c.error for c in cases(key)]
    assert None not in values
    return [error for error in values if error is not None]


def driver_errors(key: str) -> list[float]:
    values = [c.driver_error for c in cases(key)]
    assert None not in values
    return [error for error in values if error is not None]


def rising(values: Sequence[float], factor: float) -> bool:
    """Return True if each value is more than ``factor`` times the one before."""
    return all(b >= factor * a for a, b in pairwise(values))


# The wrong answers.


@pytest.mark.parametrize("name", ["f128", "mp237"])
def test_typed_literal_limits_every_wide_rung_to_a_double(name: str) -> None:
    """The rounding of 1/3 to 53 bits stays in the answer, while the driver has the rung's digits."""
    row = on_rung("T1", name, name)
    assert row.said == "time_limit"
    # 1/3 is off by 2^-54 of itself, which ten radians may shrink or magnify by some powers of two.
    assert 2**-60 <= row.error <= 2**-48
    assert row.driver_error <= 1e4 * float(rung(name).unit_roundoff)


def test_literals_of_the_rung_leave_all_its_digits() -> None:
    """Only the type of the three moments differs, and the plain call is as good as the driver."""
    row = case("T1", "mp237, moments of its own type")
    assert row.error <= 1e4 * float(rung("mp237").unit_roundoff)
    assert {gate.verdict for gate in row.gates.values()} == {"pass"}


def test_error_of_a_literal_does_not_depend_on_the_rung() -> None:
    """The error of a literal is one of the equations, and the same at 113 and at 237 bits."""
    quad, octuple = on_rung("T1", "f128", "f128").error, case("T1", "mp237").error
    assert quad == pytest.approx(octuple, rel=1e-12)


def test_small_states_lose_digits_and_steps() -> None:
    """The smaller the state, the fewer the steps and the larger the relative error, at time_limit."""
    rows = cases("T2a")
    assert {c.said for c in rows} == {"time_limit"}
    steps = [c.steps for c in rows]
    assert steps == sorted(steps, reverse=True)
    assert len(set(steps)) == len(steps)
    # From size to size the absolute tolerance counts for at least a hundred times as much.
    assert rising(errors("T2a"), 10)
    assert errors("T2a")[-1] >= 1e6 * U


def test_tiny_states_are_taken_in_one_step() -> None:
    """Ten radians at 1e-16 are one step, which is called a success and ends outside of the motion."""
    assert {(c.said, c.steps) for c in cases("T2b")} == {("time_limit", 1)}
    # No two states of one body differ by more than twice its largest.
    assert all(error > 2 for error in errors("T2b"))


@pytest.mark.parametrize("key", ["T2a", "T2b", "S1", "T3"])
def test_driver_answers_at_every_size_and_distance(key: str) -> None:
    """The driver's error is within 100 roundings, as of 400 steps with a few random roundings each."""
    assert all(error <= 100 * U for error in driver_errors(key))


def test_error_beside_the_unstable_axis_grows_as_the_distance_shrinks() -> None:
    """d = 1e-8 costs four digits, d = 1e-40 all of them in a single step, always at time_limit."""
    rows = cases("T3")
    assert {c.said for c in rows} == {"time_limit"}
    # The first, at d = 1e-4, is not yet above the roundings.
    in_doubles = [c.error for c in rows if c.case.endswith("f64")]
    assert len(in_doubles) == 7
    assert rising(in_doubles[1:], 10)
    assert case("T3", "d = 1e-08, f64").error >= 1000 * U
    assert case("T3", "d = 1e-40, f64").error >= 0.1
    assert case("T3", "d = 1e-40, f64").steps == 1


@pytest.mark.parametrize(
    ("name", "on"), [("d = 1e-20, f128", "f128"), ("d = 1e-80, mp237", "mp237")]
)
def test_more_digits_do_not_help_beside_the_unstable_axis(name: str, on: str) -> None:
    """A wide rung with moments of its own type loses as many digits as d has, the driver none."""
    row, u = on_rung("T3", name, on), float(rung(on).unit_roundoff)
    assert row.said == "time_limit"
    assert row.error >= 1e12 * u
    # At most 640 steps of a few roundings, in random directions.
    assert row.driver_error <= 300 * u


def test_the_gate_of_the_state_alone_sees_what_is_lost_beside_the_unstable_axis() -> None:
    """Energy and momentum pass at every distance; omega fails from where the loss shows, at 1e-8."""
    for row in cases("T3"):
        assert row.gates["T"].verdict == row.gates["H2"].verdict == "pass"
        near = float(row.case.partition(",")[0].removeprefix("d = ")) <= 1e-8
        assert row.gates["omega"].verdict == ("fail" if near else "pass")
        assert row.driver.endswith("state: pass")


@pytest.mark.parametrize("key", ["T2a", "T2b"])
def test_every_gate_sees_a_state_that_is_too_small(key: str) -> None:
    """State, energy and momentum all fail from 1e-5 on; at size one all pass."""
    for row in cases(key):
        expected = "pass" if row.case == "omega of size 1" else "fail"
        assert {gate.verdict for gate in row.gates.values()} == {expected}


def test_conserved_quantities_certify_no_state() -> None:
    """A body back at its unstable spin is off by its own size, driver and all; what is kept, passes."""
    (row,) = cases("T10")
    assert min(row.error, row.driver_error) >= 0.1
    assert row.gates["T"].verdict == row.gates["H2"].verdict == "pass"
    assert row.driver.endswith("state: vacuous")


def test_overflow_is_reported_and_in_other_units_does_not_happen() -> None:
    """heyoka says at 1e15 that the state is not finite; at 1e14 it is right."""
    near, *beyond = cases("S1")
    assert (near.said, near.error <= 100 * U) == ("time_limit", True)
    assert {(c.said, c.error) for c in beyond} == {("err_nf_state", None)}


# Numbers.


def test_wide_numbers_become_doubles_in_other_hands() -> None:
    """Norm, root and printout have the error of one rounding to 53 bits; ours that of 237."""
    assert all(2**-60 <= error <= 2**-52 for error in errors("T4"))
    assert all(error <= 2**-236 for error in driver_errors("T4"))


def test_half_of_the_conversions_to_real128_are_not_the_nearest() -> None:
    """Cutting off is wrong for one number in two (within ten standard deviations of 2000 draws)."""
    if missing := Plain().unavailable(rung("f128")):
        pytest.skip(missing)
    (row,) = cases("T5")
    wrong = int(re.search(r"for (\d+) of 2000", row.said)[1])
    assert abs(wrong - 1000) <= 10 * (2000 / 4) ** 0.5
    u = float(rung("f128").unit_roundoff)
    assert u < row.error <= 2 * u
    assert row.driver_error <= u


@needs_sympy
def test_sympy_number_of_fifty_digits_arrives_as_a_double() -> None:
    """The error is that of 0.1 as a double, and with mpmath's precision raised it is gone."""
    (row,) = cases("T6")
    assert row.error == pytest.approx(2**-54, rel=0.1)


def test_equal_numbers_of_two_libraries_are_unequal() -> None:
    """A real of 1/2 is not equal to mpmath's 1/2, as it is to a double of 1/2."""
    (row,) = cases("S2")
    assert row.said == "equal: False"
    assert equal(hy.real("0.5", 237), 0.5)


# Time.


def test_equation_in_time_loses_digits_with_a_late_start() -> None:
    """The error of x' = cos(t - t0) rises with t0; a body's does not depend on its start at all."""
    assert {c.said for c in cases("T7")} == {"time_limit"}
    assert rising(errors("T7"), 100)
    assert len(set(driver_errors("T7"))) == 1


def test_continuous_output_answers_beyond_its_end() -> None:
    """Ninety units beyond the end the answer is larger than any omega of the body."""
    assert errors("T8a")[0] > 2
    assert driver_errors("T8a")[0] <= 1000 * U


def test_continuous_output_overwrites_its_last_answer() -> None:
    """The array of the first call is no longer the state at that time."""
    assert errors("T8b")[0] >= 0.01
    assert driver_errors("T8b")[0] <= 100 * U


def test_late_end_is_reached_without_a_step() -> None:
    """Adding 0.3 to 1e16 changes no double: the body stands still, at time_limit."""
    (near, late) = cases("S3")
    assert (late.said, late.steps) == ("time_limit", 0)
    assert near.error >= 1000 * U
    assert late.error >= 0.01
    assert all(error <= 100 * U for error in driver_errors("S3"))


# Outcomes.


def test_one_lane_stops_the_others_which_report_success() -> None:
    """The sound lanes of a batch end far from the time asked for, and each calls it a success."""
    *sound, broken = cases("T9")
    assert all(c.said.startswith("success, at t = 0.") for c in sound)
    assert all(c.error >= 0.1 and c.driver_error <= 100 * U for c in sound)
    assert broken.said == "err_nf_state"
    assert "expected a finite number, got nan @ initial.omega[0]" in broken.driver


@pytest.mark.parametrize(
    ("key", "outcome"),
    [
        ("S4", "err_nf_state; time nan, state nan"),
        ("S5", "err_nf_state at t = 0.99999"),
        ("S6", "step_limit, at t = 3."),
        ("S7", "cb_stop, at t = 1."),
        ("S8", "time_limit is True, err_nf_state is True"),
        ("S9", "time_limit; smallest step inf, largest 0"),
        ("S10", "tol = 2.22e-16"),
        ("S11", "KeyboardInterrupt at t = 200000"),
    ],
)
def test_outcome_is_reported_as_published(key: str, outcome: str) -> None:
    """heyoka reports today what the page quotes."""
    (row,) = cases(key)
    assert row.said.startswith(outcome)


def test_forgotten_parameters_stop_the_body() -> None:
    """A body without its coefficients keeps its omega, and ends at time_limit."""
    (row,) = cases("S13")
    assert row.said == "time_limit"
    assert row.error >= 0.1
    assert row.driver_error <= 100 * U


def test_tolerance_of_zero_is_refused_here() -> None:
    """The driver refuses the tolerance that heyoka takes for its default."""
    (row,) = cases("S10")
    assert row.driver.startswith("refused: expected a positive")


def test_stored_code_is_found_without_naming_a_processor() -> None:
    """The key has versions alone, and is read without leaving the cache elsewhere than before."""
    heyoka_cache_off()
    before = hy.llvm_state.get_diskcache_path(), hy.llvm_state.get_diskcache_enabled()
    (row,) = cases("S12")
    assert re.fullmatch(r"HEYOKA_VERSION=[\d.]+;LLVM_VERSION=[\d.]+", row.said)
    after = hy.llvm_state.get_diskcache_path(), hy.llvm_state.get_diskcache_enabled()
    assert after == before


def test_interruption_leaves_no_handler_and_no_timer() -> None:
    """Handler and timer are put back after an interruption."""
    before = signal.getsignal(signal.SIGALRM)
    interrupted(10.0, 1.0)
    assert signal.getsignal(signal.SIGALRM) is before
    assert signal.getitimer(signal.ITIMER_REAL) == (0.0, 0.0)


def test_driver_hears_signals_on_the_way(monkeypatch: pytest.MonkeyPatch) -> None:
    """A signal that is repeated during a long run is heard between its stretches, not at its end."""
    heard = []
    # What takes half a second otherwise: ten times that would be a long test.
    monkeypatch.setitem(way._RADIANS_AT_ONCE, "f64", 1e4)
    problem = pose(free("a long run", GENERIC, 2e5), rung("f64"))
    Taylor().solve(pose(free("compiled before", GENERIC, 1.0), rung("f64")))
    before = signal.signal(signal.SIGALRM, lambda *_: heard.append(1))
    signal.setitimer(signal.ITIMER_REAL, 1e-3, 1e-3)
    try:
        trajectory = Taylor().solve(problem)
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)
    assert trajectory.outcome is Outcome.FINISHED
    # More than ten stretches of some 50000 steps, each far longer than a millisecond.
    assert len(heard) >= 10


# The table.


@pytest.mark.parametrize("trap", [pytest.param(trap, id=trap.key) for trap in TRAPS])
def test_silent_is_what_reports_no_failure(trap: Trap) -> None:
    """A trap is called silent if some case is not told by an outcome that is no success."""
    reported = ("err_nf_state", "step_limit", "cb_stop")
    behind = published.worst_of(stored(trap.key))
    if behind is None:
        pytest.skip("what it needs is not installed here")
    assert trap.silent == (not behind.said.startswith(reported))


@lru_cache
def fresh() -> TrapsStudy:
    """The rows of all traps as they are read back, by way of a file."""
    from tempfile import TemporaryDirectory

    with TemporaryDirectory() as folder:
        remembered = [replace(trap, cases=as_measured(trap.key)) for trap in TRAPS]
        published.publish(Path(folder), study(remembered))
        return published.load(Path(folder))


def as_measured(key: str) -> Callable[[], list[TrapCase]]:
    return lambda: list(cases(key))


def stored(key: str) -> TrapRow:
    (matching,) = (trap for trap in fresh().traps if trap.key == key)
    return matching


def test_shown_code_is_python_without_hints() -> None:
    """The code on the page parses, and defines the functions that were run."""
    for trap in TRAPS:
        for call in trap.calls:
            (definition,) = ast.parse(shown(call)).body
            assert isinstance(definition, ast.FunctionDef)
            assert definition.name == call.__name__
            assert not any(argument.annotation for argument in definition.args.args)


def test_shown_code_does_what_was_measured() -> None:
    """Run as it is shown, a call gives what the function itself gives."""
    names = {"hy": hy}
    exec(shown(tolerance_of_zero), names)
    assert names["tolerance_of_zero"]() == tolerance_of_zero()


def test_keys_are_unique_and_in_order() -> None:
    """T1 to T10, then S1 on, each once, T2 and T8 in two parts."""
    keys = [trap.key for trap in TRAPS]
    assert len(NAMED) == len(keys)
    numbered = [(key[0], int(re.search(r"\d+", key)[0])) for key in keys]
    assert {number for letter, number in numbered if letter == "T"} == set(range(1, 11))
    assert [n for letter, n in numbered if letter == "S"] == list(range(1, len(keys) - 11))


def judged(traps: Sequence[TrapRow]) -> dict[tuple[str, str], object]:
    """Return, of each case, the driver's words and the verdicts of the gates on the plain answer."""
    return {
        (t.key, c.case): (c.driver, {name: gate.verdict for name, gate in c.gates.items()})
        for t in traps
        for c in t.cases
    }


def test_page_says_that_conservation_does_not_certify_and_that_the_state_does() -> None:
    """The sentence is there, with the worst case and its error, and no answer that no gate sees."""
    text = " ".join(published.proven(fresh().traps))
    assert "pass every gate on conserved quantities and be wrong" in text
    assert "The worst is d = 1e-40, f64 (T3)" in text
    (names,) = re.findall(r"The gate of the state sees ([^.]*), from", text)
    assert {"T2a", "T2b", "T3"} <= set(names.split(", "))
    assert "No gate of this suite sees" not in text


def test_nothing_is_said_to_be_proven_by_rows_that_do_not() -> None:
    """Neither sentence is said if the plain answers are as good as the driver's."""
    equal = [
        replace(trap, cases=tuple(replace(c, error=c.driver_error) for c in trap.cases))
        for trap in fresh().traps
    ]
    text = " ".join(published.proven(equal))
    assert "be wrong" not in text
    assert "No gate of this suite sees" not in text


def test_rows_that_are_no_rows_are_refused(tmp_path: Path) -> None:
    """A file with something else in it is a ValueError that names the file."""
    file = tmp_path / published.TRAPS
    file.parent.mkdir()
    file.write_text(json.dumps({"versions": {}, "traps": [{"key": "T1"}]}), encoding="utf-8")
    with pytest.raises(
        ValueError, match=r"expected a key title, got none @ traps\[0\] @ .*traps\.json"
    ):
        published.load(tmp_path)


# The sheet, and what is published.


def measured_report(folder: Path) -> Path:
    """A report with two traps of more than one case, and with gates on each."""
    some = [replace(NAMED[key], cases=as_measured(key)) for key in ("T1", "T3")]
    published.publish(folder, study(some))
    return folder


def number(cell: str) -> float | None:
    return float(cell) if cell else None


def test_sheet_has_a_row_for_every_case(tmp_path: Path) -> None:
    """A row has heyoka's report, the error, and the verdict of each gate; its headings are unique."""
    rows = published.load(measured_report(tmp_path)).traps
    headings, *lines = csv.reader(published.sheet(rows).splitlines())
    assert len(set(headings)) == len(headings)
    sheet = [dict(zip(headings, line, strict=True)) for line in lines]
    cases = [(row, case) for row in rows for case in row.cases]
    assert len(sheet) == len(cases)
    for cells, (row, case) in zip(sheet, cases, strict=True):
        assert (cells["trap"], cells["reports"]) == (row.key, " ".join(case.said.split()))
        assert number(cells["error"]) == case.error
        for name, gate in case.gates.items():
            assert cells[f"{name}_verdict"] == gate.verdict
            assert number(cells[f"{name}_over_bound"]) == gate.over_bound


def test_remade_files_are_page_and_sheet(tmp_path: Path) -> None:
    """The end of the page names the command and the versions that made it."""
    pages = published.pages(measured_report(tmp_path))
    assert set(pages) == {published.PAGE, published.SHEET}
    end = pages[published.PAGE].rpartition("\n## ")[2]
    assert "heyoka 7." in end
    assert "`make traps`" in end


def test_published_files_are_those_of_the_stored_rows() -> None:
    """The page and the sheet of reports/tables are what reports/data/traps.json gives, to the letter."""
    for path, text in published.pages(REPORTS).items():
        assert (REPORTS / path).read_text(encoding="utf-8") == text


def test_published_traps_are_those_measured_now() -> None:
    """Words, code, cases and verdicts are equal; the digits of an error may differ by processor."""
    stored_rows, measured_rows = published.load(REPORTS).traps, fresh().traps
    assert [replace(t, cases=()) for t in stored_rows] == [
        replace(t, cases=()) for t in measured_rows
    ]
    known = judged(stored_rows)
    # A rung or a library that is not here has no case here.
    assert {name: known.get(name) for name in judged(measured_rows)} == judged(measured_rows)
