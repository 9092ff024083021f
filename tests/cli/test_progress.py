"""Long work says how far it has come, on stderr alone."""

from __future__ import annotations

from itertools import pairwise
from time import monotonic

import pytest
from builders.processes import wait_until

from taylor_verify.cli import progress
from taylor_verify.cli.progress import PROGRESS, working


def test_news_of_long_work_is_told(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Each line has the latest news and comes after twice the time; nothing goes to stdout."""
    monkeypatch.setattr(progress, "_PATIENCE", 0.05)
    times: list[float] = []
    say = progress.say
    monkeypatch.setattr(progress, "say", lambda text: say(text) or times.append(monotonic()))
    began = monotonic()
    with working("exact scene"):
        wait_until(lambda: times)
        PROGRESS.info("%d %% of the time", 40)
        PROGRESS.info("%d %% of the time", 50)
        wait_until(lambda: len(times) >= 4)
    out, error = capsys.readouterr()
    lines = error.splitlines()
    assert out == ""
    assert lines[0] == "taylor-verify: exact scene: computing"
    assert lines[-1] == "taylor-verify: exact scene: 50 % of the time"
    assert all(later - began > 1.5 * (earlier - began) for earlier, later in pairwise(times))


def test_short_work_says_nothing(capsys: pytest.CaptureFixture[str]) -> None:
    """What takes less than a second has no news, and leaves no listener behind."""
    with working("exact scene"):
        PROGRESS.info("half of it")
    assert capsys.readouterr() == ("", "")
    assert not PROGRESS.handlers


def test_a_share_is_drawn_and_told() -> None:
    """News that say how much is done have a bar as long as that; others have none."""
    with progress._news() as latest:
        assert latest().bar == ""
        PROGRESS.info("50 % of 8192 rows", extra={"share": 0.5})
        assert latest().words == "50 % of 8192 rows"
        assert latest().bar == f"[{'#' * 15}{'.' * 15}] "
