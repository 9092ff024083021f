"""The command line in a pipe and on a terminal: nothing that was not asked for, nothing lost."""

from __future__ import annotations

import io
import json
import os
import re
import sys
from itertools import pairwise
from pathlib import Path
from time import monotonic

import numpy as np
import pytest
from builders.processes import wait_until
from rich.text import Text

from taylor_verify.batch.job import Job
from taylor_verify.cli import main, progress, standard_input
from taylor_verify.cli.console import EscapingConsole, print_table
from taylor_verify.cli.progress import PROGRESS, advancing, working
from taylor_verify.cli.streams import MANNER
from taylor_verify.exact import exact
from taylor_verify.records.limit import Limit
from taylor_verify.scenes.reading.reader import load

SCENE = "euler/rest"
TIMES = [k / 5 for k in range(51)]
ROWS = {"t": TIMES, **{name: [0.0] * 51 for name in ("w1", "w2", "w3")}}
CSV = "\n".join(["t,w1,w2,w3", *(f"{t},0,0,0" for t in TIMES)]).encode()

Captured = pytest.CaptureFixture[str]


def packed() -> bytes:
    file = io.BytesIO()
    np.savez(file, **{name: np.array(column) for name, column in ROWS.items()})
    return file.getvalue()


CONTENTS = {
    "csv": CSV,
    "blanks": CSV.replace(b",", b" "),
    "json": json.dumps(ROWS).encode(),
    "npz": packed(),
}


@pytest.fixture
def pipe(monkeypatch: pytest.MonkeyPatch) -> io.BytesIO:
    content = io.BytesIO()
    monkeypatch.setattr("sys.stdin", io.TextIOWrapper(content))
    return content


def fill(pipe: io.BytesIO, content: bytes) -> None:
    pipe.write(content)
    pipe.seek(0)


@pytest.mark.parametrize("content", CONTENTS.values(), ids=CONTENTS)
def test_standard_input_is_judged_as_a_file_is(
    content: bytes, pipe: io.BytesIO, capsys: Captured
) -> None:
    """Its format is seen by its first bytes; its name is `-`; quiet prints the last line alone."""
    fill(pipe, content)
    assert main(["check", "-", "--scene", SCENE, "-q"]) == 0
    out, error = capsys.readouterr()
    assert out == "4 pass: passed (exit status 0)\n"
    assert error == ""


def test_what_is_wrong_with_standard_input_is_said(
    pipe: io.BytesIO, capsys: Captured, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Input of nothing, and of more than the limit of a file, ends with status 2, also when quiet."""
    assert main(["check", "-", "--scene", SCENE, "-q"]) == 2
    assert "got nothing @ -" in capsys.readouterr().err
    fill(pipe, CSV)
    monkeypatch.setattr(standard_input, "BYTES", Limit(10, "bytes", "a test"))
    assert main(["check", "-", "--scene", SCENE, "-q"]) == 2
    assert "expected at most 10 bytes" in capsys.readouterr().err


def test_a_named_pipe_stays_refused_and_names_the_dash(tmp_path: Path, capsys: Captured) -> None:
    """It would wait for a writer; `-` reads what is there."""
    os.mkfifo(tmp_path / "pipe.csv")
    assert main(["check", str(tmp_path / "pipe.csv"), "--scene", SCENE]) == 2
    assert "(name it -, and hand it over on standard input)" in capsys.readouterr().err


def test_colours_are_printed_where_they_are_asked_for(capsys: Captured) -> None:
    """`always` in a pipe too, `auto` and `never` not; the words are the same."""
    shown = {}
    for colour in ("always", "auto", "never"):
        assert main(["exact", SCENE, "--at", "1", "--color", colour]) == 0
        shown[colour] = capsys.readouterr().out
    assert "\x1b[1m" in shown["always"]
    assert "\x1b" not in shown["auto"] == shown["never"]


@pytest.mark.parametrize(
    "words", ["question euler/rest --csv", "question euler/rest", "exact euler/rest --at 1"]
)
def test_a_question_prints_nothing_else(words: str, capsys: Captured) -> None:
    """No message is mixed with what the next program reads."""
    assert main(words.split()) == 0
    assert capsys.readouterr().err == ""


# Short answers, by -q: the last line, below the lines on what is no pass.


COARSE = "geometric:lie-rk4?step=0.1"


def shown(
    arguments: list[str], status: int, capsys: pytest.CaptureFixture[str]
) -> tuple[list[str], str]:
    """Return the lines on stdout and the text on stderr of a quiet call with this exit status."""
    assert main([*arguments, "-q"]) == status
    out, error = capsys.readouterr()
    return out.splitlines(), error


def test_a_pass_is_one_line(capsys: pytest.CaptureFixture[str]) -> None:
    """The last line is all that a pass prints."""
    assert shown(["run", "euler/rest"], 0, capsys) == (["4 pass: passed (exit status 0)"], "")


def test_each_failing_row_has_its_line(capsys: pytest.CaptureFixture[str]) -> None:
    """The rows that failed stand above the counts, and no hint on what to do then."""
    (omega, energy, end), _ = shown(["run", "euler/generic", "--solver", COARSE], 1, capsys)
    assert omega.startswith("fail  omega: 4 digits are right")
    assert energy.startswith("fail  T: ")
    assert end == "2 pass, 2 fail: failed (exit status 1)"


def test_of_several_runs_each_line_names_its_own(capsys: pytest.CaptureFixture[str]) -> None:
    """Scene and rung stand in front of the quantity."""
    asked = ["run", "euler/rest", "euler/generic", "--solver", COARSE]
    (first, *_), _ = shown(asked, 1, capsys)
    assert first.startswith("fail  euler/generic f64 omega: ")


def test_a_failing_file_names_its_cause(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """The likely cause is one of the lines."""
    file, times = tmp_path / "mine.csv", load("euler/generic").times
    rows = 1.000001 * exact("euler/generic", times, 20).omega.astype(float)
    lines = [
        ",".join(map(repr, [float(t), *row])) for t, row in zip(times, rows.tolist(), strict=True)
    ]
    file.write_text("\n".join(["t,w1,w2,w3", *lines]))
    shown_lines, _ = shown(["check", str(file), "--scene", "euler/generic"], 1, capsys)
    assert any(line.startswith("likely cause: omega has the factor 1.0") for line in shown_lines)
    assert shown_lines[-1] == "4 fail: failed (exit status 1)"


def test_what_is_undecided_is_said(capsys: pytest.CaptureFixture[str]) -> None:
    """The message on stderr is the reason where there is no row."""
    asked = ["exact", "euler/generic", "--event", "sqrt(w2) = 2", "--until", "6", "--digits", "12"]
    _, error = shown(asked, 3, capsys)
    assert "undecided: the expression may have no value" in error


# A terminal

HEADINGS = (
    *("scene", "rung", "verdict", ">error", ">at t", ">allowed", ">/floor", ">steps", "unit"),
)
TABLE = [
    *(("euler/generic", "f64", Text("pass", "green"), "2.17e-17", "0", "1.73e-15", "0.126"),),
    *(("a/very/long/" * 9, "mp2370", "undecided", "-1.23e-300", "1e+09", "inf", "4.56e+17"),),
]
CELLS = [(*row, "123456789", "scale of H_space") for row in TABLE]


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
