"""A solver's own events are judged against all events of the scene."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from types import SimpleNamespace
from typing import Any, Final
from xml.etree import ElementTree

import numpy as np
import pytest
from builders.turns import by_turns
from builders.written_loads import ABOUT_AXES, about_axes
from scipy.integrate import solve_ivp

from taylor_verify.check import check
from taylor_verify.cli import main
from taylor_verify.exact import events
from taylor_verify.explain import explain
from taylor_verify.records.faults import Refused
from taylor_verify.records.status import Status
from taylor_verify.run import run
from taylor_verify.scenes.motion import Clock
from taylor_verify.scenes.reading.reader import load, read

SCENE: Final = replace(load("euler/generic"), clock=Clock(Fraction(0), (Fraction(0), Fraction(20))))
TIMES: Final = [float(event) for event in events(SCENE, "w2 = 0", 20)]


@pytest.mark.parametrize(
    ("times", "digits", "missed", "invented"),
    [
        (TIMES, 14, 0, 0),
        (TIMES[1:], 14, 1, 0),
        ([*TIMES, 7.5], 14, 0, 1),
        ([*TIMES[:1], 13.0, *TIMES[2:]], 14, 1, 1),
        ([*TIMES, TIMES[0] + 1e-9], 14, 0, 1),
    ],
)
def test_every_time_is_answered_missed_or_invented(
    times: list[float], digits: int, missed: int, invented: int
) -> None:
    """Each event has at most one answer; what answers none is invented."""
    judged = check(SCENE, times, event="w2 = 0")
    assert (len(judged.missed), len(judged.invented)) == (missed, invented)
    assert all(each.digits >= digits for each in judged.answered)
    assert bool(judged) is not bool(missed or invented)
    assert str(judged).count("missed: ") == missed
    if not judged:
        with pytest.raises(AssertionError, match=r"missed: |invented: "):
            judged.raise_for_failure()


def test_a_tolerance_is_relative_to_the_time() -> None:
    """Times that are off by more than the tolerance fail."""
    late = SimpleNamespace(t_events=[[t * (1 + 1e-6) for t in TIMES]])
    assert check(SCENE, late, tolerance=1e-5, event="w2 = 0").passed
    assert not check(SCENE, late, tolerance=1e-7, event="w2 = 0").passed
    (row,) = check(SCENE, late, tolerance=1e-5, event="w2 = 0").verdicts
    assert (row.bound, row.tolerance) == (1e-5, 1e-5)
    assert row.max == pytest.approx(1e-6, rel=1e-6)
    assert row.attainable < 1e-14


@pytest.mark.parametrize("off", [0.05, 1e-3, 1e-9, 1e-13])
def test_without_a_tolerance_times_are_right_to_the_arithmetic(off: float) -> None:
    """A time may answer an event, being nearest to it, and still be off by more than rounding explains."""
    judged = check(SCENE, [t * (1 + off) for t in TIMES], event="w2 = 0")
    assert (judged.missed, judged.invented) == ((), ())
    (row,) = judged.verdicts
    assert row.verdict is Status.FAIL
    assert row.max == pytest.approx(off, rel=0.01)
    assert 1e-16 < row.bound < 1e-13
    assert row.at in map(float, judged.true)
    assert "10 x attainable" in row.because
    assert "3 answered" in row.because
    assert all(each["error"] > each["bound"] for each in judged.document()["events"])


def by_scipy(name: str, function: Callable[[Any], float], until: float) -> list[float]:
    """The times at which SciPy sees a function of omega pass zero, by short steps."""
    scene = load(name)
    inertia = np.array(scene.body.inertia, dtype=float)
    inverse = np.linalg.inv(inertia)
    solved = solve_ivp(
        lambda t, w: inverse @ np.cross(inertia @ w, w),
        (0, until),
        np.array(scene.initial.omega, dtype=float),
        method="DOP853",
        rtol=2.3e-14,
        atol=1e-16,
        max_step=0.05,
        events=lambda t, w: function(w),
    )
    return [float(t) for t in solved.t_events[0]]


@pytest.mark.parametrize(
    ("name", "text", "function"),
    [
        ("euler/generic", "w2 = 0", lambda w: w[1]),
        ("euler/generic", "w2 = w3/10", lambda w: w[1] - w[2] / 10),
        ("euler/tennis-racket", "w2 = 0", lambda w: w[1]),
    ],
)
def test_an_honest_solver_is_within_the_bound(
    name: str, text: str, function: Callable[[Any], float]
) -> None:
    """Times of a good method in doubles pass, and ones that are off by a hundred times the bound fail."""
    until = float(load(name).clock.instants[-1])
    times = by_scipy(name, function, until)
    right = check(name, times, event=text)
    assert right.answered
    assert right.passed, str(right)
    bounds = [each["bound"] for each in right.document()["events"]]
    wrong = [t + 100 * bound for t, bound in zip(times, bounds, strict=True)]
    assert check(name, wrong, event=text).is_wrong


@pytest.mark.parametrize(
    ("name", "text", "until"),
    by_turns(
        [
            ("euler/generic", "r33 = 0.2", 20),
            ("euler/generic", "q1 = 0", 20),
            ("kirchhoff/whole-motion", "c1 + u1 = 1/5", 10),
            ("kirchhoff/whole-motion", "abs(u1) = abs(u2)/2", 10),
            ("euler/moment-backward", "w1 = w2", -2),
        ],
        2,
    ),
)
def test_the_nearest_doubles_pass_for_any_expression(name: str, text: str, until: int) -> None:
    """The doubles nearest to events pass: of rates, attitude, place and velocities, in both directions."""
    scene = load(name)
    scene = replace(scene, clock=Clock(scene.clock.start, (scene.clock.start, Fraction(until))))
    judged = check(scene, [float(event) for event in events(scene, text, until)], event=text)
    assert judged.answered
    assert judged.passed, str(judged)
    assert judged.verdicts[0].bound is not None


def test_an_event_without_a_bound_is_judged_by_a_tolerance_alone() -> None:
    """The row of an extremum, where the expression has no rate, is undecided and says what judges it."""
    text = "extremum w2"
    times = [float(event) for event in events(SCENE, text, 20)]
    (row,) = check(SCENE, times, event=text).verdicts
    assert row.verdict is Status.UNDECIDED
    assert row.bound is None
    assert row.max is not None
    assert "--tolerance" in row.because
    assert check(SCENE, times, event=text, tolerance=1e-12).passed
    late = [t * (1 + 1e-9) for t in times]
    assert check(SCENE, late, event=text, tolerance=1e-12).is_wrong
    assert check(SCENE, times[1:], event=text).is_wrong


@pytest.mark.parametrize("answer", [SimpleNamespace(t_events=[[1.0], [2.0]]), 3.0])
def test_times_of_one_event_are_expected(answer: Any) -> None:
    """Times of several events, or of none, are refused."""
    with pytest.raises(Refused, match="times"):
        check(SCENE, answer, event="w2 = 0")


@pytest.mark.parametrize(
    ("name", "content", "event", "status"),
    [
        ("e.json", json.dumps({"events": TIMES}), "w2 = 0", 0),
        ("e.csv", "t,events\n0," + "\n1,".join(map(repr, TIMES)) + "\n9,\n", "w2 = 0", 0),
        ("e.json", json.dumps({"events": TIMES[:2]}), "w2 = 0", 1),
        ("e.json", json.dumps({"events": TIMES}), "w2^2 = 0", 3),
        ("e.json", json.dumps({"t": TIMES}), "w2 = 0", 2),
        ("e.json", json.dumps({"events": ["soon"]}), "w2 = 0", 2),
    ],
)
def test_a_file_of_events_has_an_exit_status(
    name: str, content: str, event: str, status: int, tmp_path: Path
) -> None:
    """A column or a list `events` is judged; touched zeros are undecided."""
    scene, file = tmp_path / "scene.toml", tmp_path / name
    shipped = Path("cases/euler/generic.toml").read_text(encoding="utf-8")
    scene.write_text(shipped.replace("end = 100", "end = 20"), encoding="utf-8")
    file.write_text(content, encoding="utf-8")
    assert main(["check", str(file), "--scene", str(scene), "--event", event, "--json"]) == status


def test_an_event_at_the_start_is_judged_by_its_absolute_error() -> None:
    """Rounded data move it from 0 by 1e-17 or so, which has no digit in common with 0."""
    shipped = Path("cases/euler/generic.toml").read_text(encoding="utf-8")
    scene, text = read(shipped.replace("[1, 0.4, 0.3]", "[1, 0.3, 0.3]"), "start"), "w2 = 0.3"
    times = [float(event) for event in events(scene, text, 100)]
    assert times[0] == 0
    judged = check(scene, times, event=text)
    assert 0 < judged.answered[0].error < 1e-15
    assert judged.passed, str(judged)
    assert judged.verdicts[0].max == pytest.approx(0, abs=1e-14)


# Motions that end on the way: no solver is blamed, and what is before the end is known.


WITHOUT_BOUND: Final = '["w1^2", "0", "0"]'
ENDS: Final = [
    (WITHOUT_BOUND, r"omega seems to grow without bound"),
    ('["-1 - sqrt(w1)", "0", "0"]', r"sqrt(w1) in body.moment[0] has no value"),
    ('["1/(1 - t)", "0", "0"]', r"1 / (1 - t) in body.moment[0] has no value"),
]


@pytest.mark.parametrize(("moment", "why"), ENDS)
@pytest.mark.parametrize("solver", ["taylor", "scipy:RK45"])
def test_a_solver_that_stops_at_the_end_is_not_blamed(moment: str, why: str, solver: str) -> None:
    """The verdict is undecided and says why and when the motion ends, or that the solver is not made for
    it."""
    (verdict,) = run(about_axes(moment, "[1, 0, 0]", end="2"), solver).verdicts
    assert verdict.verdict.value in ("undecided", "unavailable")
    assert (why in verdict.because) is (verdict.verdict.value == "undecided")


def test_a_solver_that_stops_before_the_end_of_its_motion_fails() -> None:
    """A motion that goes on is no excuse."""

    def stopping(problem: Any) -> Any:
        raise FloatingPointError("too hard")

    (verdict,) = run(about_axes(WITHOUT_BOUND, "[1, 0, 0]", end="0.75"), stopping).verdicts
    assert verdict.verdict.value == "fail"


@pytest.mark.parametrize(("moment", "why"), ENDS)
def test_an_explanation_goes_up_to_the_last_known_sample(moment: str, why: str) -> None:
    """All gates of the motion before its end are explained, and a warning says why no more."""
    scene = about_axes(moment, "[1, 0, 0]", end="2")
    sampled = scene.clock.__class__(Fraction(0), tuple(Fraction(k, 4) for k in range(9)))
    document = explain(scene.__class__(**{**vars(scene), "clock": sampled}))
    assert any(why in warning for warning in document["warnings"])
    assert {"omega", "T", "H2"} <= {gate["quantity"] for gate in document["gates"]}
    assert document["equations"]


def test_times_before_the_end_of_a_motion_are_judged() -> None:
    """A wrong one fails; if all are right the judgement is undecided; later ones are not judged."""
    scene = about_axes(WITHOUT_BOUND, "[1, 0, 0]", end="2")
    right, wrong = (check(scene, times, event="w1 = 4") for times in ([0.75, 1.5], [0.25]))
    assert (len(right.answered), right.invented, right.passed, right.is_wrong) == (
        1,
        (),
        False,
        False,
    )
    assert "grow without bound" in str(right)
    assert wrong.is_wrong


@pytest.mark.parametrize(
    ("moment", "times", "status", "element"),
    [
        ('["1", "0", "0"]', [0.75], 0, None),
        ('["1", "0", "0"]', [0.5], 1, "failure"),
        (WITHOUT_BOUND, [0.75], 3, "error"),
    ],
)
def test_a_judgement_of_events_is_written_for_a_ci(
    moment: str,
    times: list[float],
    status: int,
    element: str | None,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    """`check --event` writes JUnit and annotations as for states: green only with exit status 0."""
    scene, file, junit = (tmp_path / name for name in ("a.toml", "e.json", "out.xml"))
    scene.write_text(ABOUT_AXES.format(moment=moment, omega="[1, 0, 0]", end="2"))
    file.write_text(json.dumps({"events": times}))
    level = "7/4" if moment != WITHOUT_BOUND else "4"
    asked = ["--event", f"w1 = {level}", "--junit", str(junit), "--github"]
    assert main(["check", str(file), "--scene", str(scene), *asked]) == status
    (case,) = ElementTree.parse(junit).iter("testcase")
    assert case.get("name") == f"w1 = {level}"
    assert [inside.tag for inside in case] == ([element] if element else [])
    printed = capsys.readouterr()
    assert ("title=" in printed.out + printed.err) is bool(status)
