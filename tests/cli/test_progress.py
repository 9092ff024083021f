"""Long work says how far it has come, on stderr alone."""

from __future__ import annotations

import re
import sys
from itertools import pairwise
from time import monotonic

import pytest
from builders.processes import wait_until

from taylor_verify.batch.job import Job
from taylor_verify.cli import progress
from taylor_verify.cli.progress import PROGRESS, advancing, working


def test_news_of_long_work_is_told(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Each line has the latest news and comes after twice the time; nothing goes to stdout."""
    monkeypatch.setattr(progress, "_PATIENCE", 0.05)
    times: list[float] = []
    say = progress.say
    monkeypatch.setattr(progress, "say", lambda text: say(text) or times.append(monotonic()))
    with working("exact scene"):
        # After the clock of the product: a thread that a loaded machine starts late changes nothing.
        began = monotonic()
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


def test_a_terminal_shows_the_news_and_the_share(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """A bar is as long as the share that is done, of one thing and of many jobs."""
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setenv("COLUMNS", "100")
    for stream in (sys.stderr, sys.stdout):
        monkeypatch.setattr(stream, "isatty", lambda: True)
    with working("exact scene"):
        PROGRESS.info("4096 of 8192 rows", extra={"share": 0.5})
    out, error = capsys.readouterr()
    assert out == ""
    shown = re.sub(r"\x1b\[[0-9;?]*[a-zA-Z]", "", error)
    assert f"exact scene: 4096 of 8192 rows {'━' * 20}╺" in shown
    with advancing() as progress:
        progress(0, 4, None)
        progress(3, 4, Job("euler/rest", "taylor", ("f64",)))
    assert "3/4 euler/rest" in capsys.readouterr().err
