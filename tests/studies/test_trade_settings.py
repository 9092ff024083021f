"""Settings of a trade-off: those that cannot run or cannot reach a target, and the page of all of them."""

from __future__ import annotations

import csv
import re
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import pytest
from builders.scenes import asked_at
from builders.studies.tradeoff import NUMBERS_MADE, POINTS, TIMES_MADE

import taylor_verify
from taylor_verify.numbers.precision import rung
from taylor_verify.records.quantities import GATE_FACTOR
from taylor_verify.records.standing import Standing
from taylor_verify.records.status import Status
from taylor_verify.scenes.motion import Clock
from taylor_verify.scenes.reading.reader import load
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.registry import solver_names
from taylor_verify.solvers.taylor.driver import Taylor
from taylor_verify.tradeoff.attainability import least_error, left_out, narrowest
from taylor_verify.tradeoff.recommendation import MARGIN, OutOfReach, recommend
from taylor_verify.tradeoff.setting import (
    NOTHING,
    STEP,
    TOLERANCE,
    chosen,
    outside,
    setting,
    settings,
)
from taylor_verify.tradeoff.trade_off import trade_off
from taylor_verify.words.cells import NOTHING as NO_VALUE
from taylor_verify_reports.studies.tradeoff.tradeoff_page import page, sheet
from taylor_verify_reports.studies.tradeoff.trades import Trades

F32, F64, F80 = rung("f32"), rung("f64"), rung("f80")


def short(name: str) -> Scene:
    return asked_at(name, 0, 1, 2)


# Names.


def test_every_solver_of_the_sweep_is_listed() -> None:
    """`list` shows a name of the form of every setting that is measured."""
    listed = {name.partition("?")[0] for name in solver_names()}
    measured = {one.solver.name.partition("?")[0] for one in settings(load("euler/generic"))}
    assert measured <= listed


# Settings.


@pytest.mark.parametrize(
    ("scene", "expected"),
    [
        ("loads/sampled-controller", True),
        ("loads/thruster-pulses", True),
        ("loads/heavy-top", False),
    ],
)
def test_stops_are_measured_both_ways(scene: str, expected: bool) -> None:
    """Settings that step over switches and held states are there where there are any."""
    families = {one.family for one in settings(load(scene), ["f64"])}
    assert ("scipy DOP853 without stops" in families) is expected
    assert "scipy DOP853" in families


@pytest.mark.parametrize(
    ("name", "asked", "requested", "family"),
    [
        ("taylor", TOLERANCE, 2.0**-52, "taylor f64"),
        ("taylor?tol=1e-6", TOLERANCE, 1e-6, "taylor f64"),
        ("scipy:RK45?atol=1e-3&rtol=1e-7", TOLERANCE, 1e-7, "scipy RK45"),
        ("scipy:RK45?rtol=1e-7&stop=no", TOLERANCE, 1e-7, "scipy RK45 without stops"),
        ("scipy:LSODA", NOTHING, None, "scipy LSODA"),
        ("geometric:splitting?step=1/64", STEP, 1 / 64, "geometric splitting"),
        ("mpmath:odefun?degree=9&tol=1e-5", TOLERANCE, 1e-5, "mpmath odefun"),
        ("process:./mine?tol=1e-3", NOTHING, None, "process:./mine?tol=1e-3"),
    ],
)
def test_a_setting_is_read_from_its_name(
    name: str, asked: str, requested: float | None, family: str
) -> None:
    """The setting of a solver is read from its name, but for a command of one's own."""
    parsed = setting(name, F64)
    assert (parsed.asked, parsed.requested, parsed.family) == (asked, requested, family)
    assert parsed.solver.name == name


def test_the_chosen_stand_beside_the_yardstick() -> None:
    """Named solvers on the rungs they know, every tolerance of taylor, and nothing else, each once."""
    names = ["scipy:DOP853?rtol=1e-6", "taylor?tol=1e-6", "process:./mine"]
    asked_settings = chosen(names, ["f64", "f128"])
    assert len(set(asked_settings)) == len(asked_settings)
    others = [one for one in asked_settings if not isinstance(one.solver, Taylor)]
    assert [(one.solver.name, one.rung.name) for one in others] == [
        ("scipy:DOP853?rtol=1e-6", "f64"),
        ("process:./mine", "f64"),
        ("process:./mine", "f128"),
    ]
    taylor = {one.rung.name for one in asked_settings if one.solver == Taylor()}
    assert taylor == {"f64", "f128"}


def test_the_integrators_of_other_libraries_are_asked_for_by_name() -> None:
    """The integrators of other libraries have four tolerances each, coarsest first, on f64."""
    integrators = outside(["f64", "f128"])
    assert integrators
    assert {one.rung.name for one in integrators} == {"f64"}
    for name in {one.family for one in integrators}:
        its = [one for one in integrators if one.family == name]
        assert name.startswith("outside ")
        assert [one.requested for one in its] == [1e-3, 1e-6, 1e-9, 1e-12]
    assert outside(["f128"]) == ()
    few = outside(["f64"], ["cyrk-dop853"], ["1e-8", "1e-11"])
    assert [one.requested for one in few] == [1e-8, 1e-11]


def test_odefun_is_withheld_from_a_long_motion() -> None:
    """The trade does not run odefun on a long motion, and gives the reason."""
    scene = load("euler/generic")
    long = replace(scene, clock=Clock(Fraction(0), (Fraction(0), Fraction(10**6))))
    slow = [one for one in settings(long, ["f64"]) if one.family == "mpmath odefun"]
    assert slow
    for p in trade_off(long, slow, repeats=1).points:
        assert p.standing is Standing.NOT_RUN
        assert "would take minutes" in p.because


# What a solver is not made for.


@pytest.mark.parametrize(
    ("scene", "name", "reason"),
    [
        ("euler/constant-moment", "geometric:splitting?step=0.1", "a body without a moment"),
        ("kirchhoff/screw", "geometric:lie-rk4?step=0.1", "made for Euler's equations"),
    ],
)
def test_an_unsuited_solver_is_unavailable_and_not_run(scene: str, name: str, reason: str) -> None:
    """An unsuited solver fails no gate, and its point in the trade is not run, with the reason."""
    (verdict,) = taylor_verify.run(short(scene), name).verdicts
    assert verdict.verdict is Status.UNAVAILABLE
    assert reason in verdict.because
    (p,) = trade_off(short(scene), [setting(name, F64)], repeats=1).points
    assert (p.standing, p.timed.trajectory.steps) == (Standing.NOT_RUN, 0)
    assert reason in p.because


# The page


def section(text: str, heading: str) -> str:
    return text.partition(f"## {heading}\n")[2].partition("\n## ")[0]


def line(text: str, *words: str) -> list[str]:
    """The cells of the only line that has all these words."""
    (matching,) = [row for row in text.splitlines() if all(word in row for word in words)]
    return [cell.strip() for cell in re.split(r"(?<!\\)\|", matching)[1:-1]]


def test_a_peer_that_is_ahead_is_named(tmp_path: Path) -> None:
    """The fastest stands before the times with its lead; level are two whose intervals meet."""
    name = "outside:cvode-bdf?rtol=1e-9&atol=1e-9"
    lines = {}
    for ratio in (0.2, 0.7, 2.0):
        low, high = ratio * 0.9, ratio * 1.2
        timings = tuple(
            replace(one, ratio=ratio, low=low, high=high, setup_seconds=7.0)
            if one.solver == name
            else one
            for one in TIMES_MADE.timings
        )
        made = Trades(NUMBERS_MADE, replace(TIMES_MADE, timings=timings))
        table = section(page(made, tmp_path), "Beside compiled integrators of other libraries")
        assert "7.00 s" in table
        lines[ratio] = line(table, "`euler/generic`", " 6 |")
        twelve = line(table, " 12 |")
    # taylor at 1e-6 takes 0.8, from 0.72 to 0.96.
    cells = ["**cvode-bdf**, 4.0 times", "**0.800** @ 1e-06", NO_VALUE, "**0.200** @ 1e-09"]
    assert lines[0.2][2:] == cells
    assert lines[0.7][2] == "level: cvode-bdf and taylor"
    assert lines[2.0][2] == "taylor, 2.5 times"
    # The yardstick takes two milliseconds, one of them in heyoka.
    assert twelve[2:] == ["taylor, alone", "**1.00**", "0.500", "not reached"]


def test_a_failure_is_listed_and_nowhere_else(tmp_path: Path) -> None:
    """A false success is no digit and no cell of a cost; its reason cannot break the table."""
    text = page(Trades(NUMBERS_MADE, TIMES_MADE), tmp_path)
    listed = section(text, "What failed, and what was not run")
    assert "false success" in line(listed, "RK45?rtol=1e-3")
    assert r"size \| of the motion" in listed
    assert "it would take minutes" in listed
    assert "rtol=1e-3" not in section(text, "What so many digits cost")
    assert "false success" in line(section(text, "Asked for and achieved"), "SciPy RK45")


def test_the_sheet_has_a_row_for_every_setting() -> None:
    """The sheet has every setting with every digit, the failed ones included."""
    rows = list(csv.DictReader(sheet(Trades(NUMBERS_MADE, TIMES_MADE)).splitlines()))
    assert [row["solver"] for row in rows] == [p.solver for p in POINTS]
    assert rows[1]["ratio"] == "1.0"
    assert rows[6]["standing"] == "false success"


# What a precision can reach


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
