"""Motions that end on the way: no solver is blamed, and what is before the end is known."""

from __future__ import annotations

import json
from fractions import Fraction
from pathlib import Path
from typing import Any, Final
from xml.etree import ElementTree

import pytest
from builders.written_loads import ABOUT_AXES, about_axes

from taylor_verify.check import check
from taylor_verify.cli import main
from taylor_verify.explain import explain
from taylor_verify.run import run

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
