"""A run in which nothing was judged: a missing package, a missing number format, or an unfit solver."""

from __future__ import annotations

import json
import sys
from importlib import import_module
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pytest

from taylor_verify.cli import main
from taylor_verify.records.reason import Cause
from taylor_verify.records.status import Status
from taylor_verify.run import run
from taylor_verify.solvers import scipy as solver
from taylor_verify.solvers.engines import python
from taylor_verify.solvers.trajectory import Outcome

SCENE = "euler/generic"
INSTALL = "pip install 'taylor-verify[scipy]'"
Captured = pytest.CaptureFixture[str]


def last_line(text: str) -> str:
    return text.rstrip().splitlines()[-1]


def without_scipy(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(solver, "find_spec", lambda name: None)


def with_broken_scipy(monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(name: str) -> Any:
        if name.startswith("scipy"):
            raise ImportError("a broken build")
        return import_module(name)

    monkeypatch.setattr(solver, "import_module", broken)


def without_uv(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(python, "_uv", lambda: None)


def without_heyoka(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "heyoka", None)


@pytest.mark.parametrize(
    ("missing", "name", "command"),
    [
        (without_scipy, "scipy:DOP853", INSTALL),
        (with_broken_scipy, "scipy:DOP853", INSTALL),
        (without_heyoka, "taylor", "pip install 'taylor-verify[taylor]'"),
        (without_uv, "outside:cvode-bdf", "pip install 'taylor-verify[engines]'"),
    ],
)
def test_a_missing_package_is_exit_2_with_the_command(
    missing: Any, name: str, command: str, monkeypatch: pytest.MonkeyPatch, capsys: Captured
) -> None:
    """The row is unavailable, the last line says that nothing was judged, and stderr how to install it."""
    missing(monkeypatch)
    assert main(["run", SCENE, "--solver", name]) == 2
    output = capsys.readouterr()
    assert "1 unavailable" in output.out
    assert last_line(output.out).startswith("nothing was judged: ")
    assert command in last_line(output.out)
    assert command in output.err


def test_a_missing_package_is_a_cause_of_its_own(monkeypatch: pytest.MonkeyPatch) -> None:
    """A program reads it in a word; a rung that a scene does not fit has another."""
    without_scipy(monkeypatch)
    (verdict,) = run(SCENE, "scipy:DOP853").verdicts
    (remark,) = verdict.reason.remarks
    assert (remark.cause, verdict.outcome) == (Cause.MISSING_PACKAGE, Outcome.NO_PACKAGE.value)
    (verdict,) = run(SCENE, "geometric:splitting?step=0.1", "f128").verdicts
    assert [each.cause for each in verdict.reason.remarks] == [Cause.NOT_POSED]


@pytest.mark.parametrize(("is_terminal", "times"), [(True, 0), (False, 1)])
def test_on_a_terminal_the_reason_is_said_once(
    is_terminal: bool, times: int, monkeypatch: pytest.MonkeyPatch, capsys: Captured
) -> None:
    """Both streams are read together there, however the text is folded; a pipe has it on stderr too."""
    without_scipy(monkeypatch)
    monkeypatch.setattr(sys.stdout, "isatty", lambda: is_terminal)
    monkeypatch.setenv("COLUMNS", "50")
    assert main(["run", SCENE, "--solver", "scipy:DOP853"]) == 2
    output = capsys.readouterr()
    assert output.out.count("nothing was judged") == 1
    assert output.err.count("nothing was judged") == times


def test_a_missing_number_format_is_exit_0_and_said(
    monkeypatch: pytest.MonkeyPatch, capsys: Captured
) -> None:
    """A rung that the processor lacks is nobody's fault: unavailable, exit status 0, the last line."""
    finfo = np.finfo

    class Other:
        """A long double that is a double in all but its name."""

        nmant = 52

        def __getattr__(self, name: str) -> Any:
            return getattr(finfo(np.longdouble), name)

    monkeypatch.setattr(np, "finfo", lambda t: Other() if t is np.longdouble else finfo(t))
    (verdict,) = run(SCENE, "taylor", "f80").verdicts
    assert (verdict.verdict, verdict.outcome) == (Status.UNAVAILABLE, Outcome.NO_FORMAT.value)
    assert main(["run", SCENE, "--rung", "f80"]) == 0
    assert last_line(capsys.readouterr().out).startswith("nothing was judged: the long double")
    # Beside a rung that was judged it is no more than a row.
    assert main(["run", SCENE, "--rung", "f80", "f64"]) == 0
    assert "nothing was judged" not in capsys.readouterr().out


@pytest.mark.parametrize(
    ("name", "on"),
    [
        ("scipy:DOP853", "f32"),
        ("scipy:DOP853", "f80"),
        ("geometric:splitting?step=0.1", "f128"),
        ("outside:cvode-bdf", "f80"),
        ("taylor?tol=1e-60", "f32"),
    ],
)
def test_an_unfit_solver_is_exit_3(name: str, on: str, tmp_path: Path, capsys: Captured) -> None:
    """Nothing was judged and nothing is missing: undecided, in a JUnit file too."""
    report = tmp_path / "junit.xml"
    call = ["run", SCENE, "--solver", name, "--rung", on]
    assert main([*call, "--junit", str(report)]) == 3
    assert last_line(capsys.readouterr().out).startswith("nothing was judged: ")
    assert ElementTree.parse(report).getroot().get("errors") == "1"
    assert main([*call, "--json"]) == 3
    (row,) = json.loads(capsys.readouterr().out)["verdicts"]
    assert row["outcome"] == Outcome.UNSUITED.value
