"""Long work says how far it has come, on stderr alone."""

from __future__ import annotations

from time import sleep

import pytest

from taylor_verify.cli import progress
from taylor_verify.cli.progress import PROGRESS, working


def test_news_of_long_work_is_told(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Each line has the latest news, and nothing goes to stdout."""
    monkeypatch.setattr(progress, "_PATIENCE", 0.05)
    with working("exact scene"):
        sleep(0.08)
        PROGRESS.info("%d %% of the time", 40)
        PROGRESS.info("%d %% of the time", 50)
        sleep(0.5)
    out, error = capsys.readouterr()
    lines = error.splitlines()
    assert out == ""
    assert lines[0] == "taylor-verify: exact scene: computing"
    assert set(lines[1:]) == {"taylor-verify: exact scene: 50 % of the time"}
    # After 0.05, 0.1, 0.2 and 0.4 seconds: as many lines as doublings, and not one each 0.05 s.
    assert 2 <= len(lines) <= 5


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
