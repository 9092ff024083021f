"""What a terminal shows: tables of any width that lose no character, and how far long work has come."""

from __future__ import annotations

import re
import sys
from itertools import pairwise
from time import monotonic

import pytest
from builders.processes import wait_until
from rich.text import Text

from taylor_verify.batch.job import Job
from taylor_verify.cli import progress
from taylor_verify.cli.console import EscapingConsole, print_table
from taylor_verify.cli.progress import PROGRESS, advancing, working
from taylor_verify.cli.streams import MANNER

HEADINGS = (
    *("scene", "rung", "verdict", ">error", ">at t", ">allowed", ">/floor", ">steps", "unit"),
)
ROWS = [
    *(("euler/generic", "f64", Text("pass", "green"), "2.17e-17", "0", "1.73e-15", "0.126"),),
    *(("a/very/long/" * 9, "mp2370", "undecided", "-1.23e-300", "1e+09", "inf", "4.56e+17"),),
]
CELLS = [(*row, "123456789", "scale of H_space") for row in ROWS]


def lines(width: int) -> list[str]:
    console = EscapingConsole(width=width, markup=False, emoji=False, highlight=False)
    with console.capture() as captured:
        print_table(console, HEADINGS, CELLS, keys=2)
    return captured.get().splitlines()


def test_no_character_of_a_number_is_lost() -> None:
    """Every cell but a long key stands whole in one line, none is beyond the width, none is cut."""
    cells = [str(cell) for row in CELLS for cell in row[1:]]
    for width in range(40, 201, 3):
        shown = lines(width)
        assert all(len(line) <= width for line in shown), width
        assert "…" not in "".join(shown)
        assert [cell for cell in cells if not any(cell in line for line in shown)] == [], width


@pytest.mark.parametrize("width", [40, 80, 200])
def test_a_long_key_is_folded_and_whole(width: int) -> None:
    """The parts of a path that is longer than the line, put together, are the path."""
    first = "".join(line.split(" ")[0] for line in lines(width) if line[:1] not in (" ", ""))
    assert "a/very/long/" * 9 in first.replace("mp2370", "")


def test_a_part_below_repeats_its_keys() -> None:
    """Where columns do not fit, every part begins with the scene and the precision of each row."""
    shown = lines(60)
    heads = [line for line in shown if line.startswith("scene")]
    assert len(heads) > 1
    assert all("rung" in line for line in heads)
    assert sum(line.count("mp2370") for line in shown) == len(heads)


# Long work says how far it has come, on stderr alone.


def test_news_of_long_work_is_told(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Each line has the latest news and comes after twice the time; nothing goes to stdout."""
    monkeypatch.setattr(MANNER, "quiet", False)
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
    monkeypatch.setattr(MANNER, "quiet", False)
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
