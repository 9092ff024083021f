"""A solver's own events are judged against all events of the scene."""

from __future__ import annotations

import json
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from types import SimpleNamespace
from typing import Any, Final

import pytest

from taylor_verify.check import check
from taylor_verify.cli import main
from taylor_verify.exact import events
from taylor_verify.records.faults import Refused
from taylor_verify.scenes.motion import Clock
from taylor_verify.scenes.reading.reader import load

SCENE: Final = replace(load("euler/generic"), clock=Clock(Fraction(0), (Fraction(0), Fraction(20))))
TIMES: Final = [float(event) for event in events(SCENE, "w2 = 0", 20)]


@pytest.mark.parametrize(
    ("times", "digits", "missed", "invented"),
    [
        (TIMES, 14, 0, 0),
        ([t * (1 + 3e-7) for t in TIMES], 6, 0, 0),
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


def test_times_without_a_right_digit_do_not_pass() -> None:
    """A time may answer an event, being nearest to it, and have no right digit: it is no pass."""
    off = check(SCENE, [t + 0.15 * TIMES[0] for t in TIMES], event="w2 = 0")
    assert (off.missed, off.invented) == ((), ())
    assert min(each.digits for each in off.answered) == 0
    assert not off.passed


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
