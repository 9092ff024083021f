"""Short answers, by -q: the last line, below the lines on what is no pass."""

from __future__ import annotations

from pathlib import Path

import pytest

from taylor_verify.cli import main
from taylor_verify.exact import exact
from taylor_verify.scenes.reading.reader import load

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
