"""What is not judged: for want of a package or a format, or because numbers are beyond doubles."""

from __future__ import annotations

import json
import sys
from collections.abc import Sequence
from importlib import import_module
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pytest
from builders.scenes import scene_text
from builders.turns import by_turns

import taylor_verify
from taylor_verify.cli import main
from taylor_verify.records.reason import Cause
from taylor_verify.records.status import Status
from taylor_verify.run import run
from taylor_verify.scenes.reading.reader import read
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


# Beyond doubles

CLEBSCH = "clebsch = { p = 1, p_prime = 2, q = 0, q_prime = 0, r = 1, r_prime = 3 }"
TENSOR = '[[1, "1/10", 0], ["1/10", 2, 0], [0, 0, 3]]'
AT_REST = "[0, 0, 0]"


def body(inertia: str = "[1, 2, 3]", moment: str = AT_REST, omega: str = AT_REST) -> str:
    acting, top = f"inertia = {inertia}\nmoment = {moment}", 'track = ["attitude"]'
    return scene_text(acting, f"omega = {omega}", time="end = 10\nsamples = 11", top=top)


def solid(body: str = "", linear: str = "[1, 0, 2]", angular: str = AT_REST, end: str = "1") -> str:
    start, time = (
        f"linear_impulse = {linear}\nangular_impulse = {angular}",
        f"end = {end}\nsamples = 3",
    )
    return scene_text(f"{CLEBSCH}\n{body}", start, time=time, top='track = ["centre"]')


@pytest.mark.parametrize("size", ["1e-40", "1e-100", "1e-160", "1e-300"])
@pytest.mark.parametrize(
    ("inertia", "moment"),
    [
        ("[1, 2, 3]", "[{0}, 0, 0]"),
        (TENSOR, "[{0}, {0}, 0]"),
        ("[1, 2, 3]", '["{0}*cos(t)", {0}, "2*{0}"]'),
    ],
)
def test_a_body_at_rest_spins_up_under_a_moment_of_any_size(
    size: str, inertia: str, moment: str
) -> None:
    """Every quantity of the default solver passes, however small the moment of numbers or texts is."""
    scene = read(body(inertia, moment.format(size)), "spun up")
    assert {v.verdict for v in taylor_verify.run(scene).verdicts} == {Status.PASS}


@pytest.mark.parametrize("size", by_turns(["1e-300", "1e-20", "1e-160"], 3))
def test_a_start_that_is_nothing_beside_what_loads_give_is_judged(size: str) -> None:
    """A moment, or a force and a couple, drive a body that hardly moved; every quantity passes."""
    spun = read(body(moment="[1, 2, 0]", omega=f"[{size}, {size}, 0]"), "spun up")
    pushed = read(
        solid("force = [1, 0, 0]\ncouple = [0, 0, 1]", f"[{size}, 0, 0]", f"[0, {size}, 0]"),
        "pushed",
    )
    for scene in (spun, pushed):
        assert {v.verdict for v in taylor_verify.run(scene).verdicts} == {Status.PASS}


BEYOND = {
    "omega": body(omega="[1e-310, 1e-310, 1e-310]"),
    "moment": body(moment="[1e-320, 1e-320, 0]"),
    "inertia": body("[1e400, 2e400, 3e400]", omega="[1, 2, 3]"),
    "one inertia": body("[1, 1, 1e400]", omega="[1, 2, 3]"),
    "damping": body(moment=AT_REST + "\ndamping = 1e400", omega="[1, 2, 3]"),
    "text": body(moment='["exp(exp(20))", 0, 0]'),
    "impulse": solid(linear="[1e-320, 1e-320, 0]", angular="[0, 1e-320, 1e-320]"),
    "short": solid(linear="[1e200, 2e200, 1e200]", angular="[1e200, 2e200, 0]", end="1e-200"),
    "current": solid("current = [1e300, 0, 0]"),
    "knots": body(moment='["p", 0, 0]')
    + '[tables]\np = { times = [0, 1e-400], values = [0, 1], kind = "linear" }\n',
    "turn": body() + "[initial.axis_angle]\naxis = [1e5000, 1, 0]\ndegrees = 30\n",
    "long turn": body().replace("omega =", "rotation_vector = [1e5000, 1, 0]\nomega ="),
    "offset": body(moment='["h", 0, 0]')
    + '[states]\nh = { every = "1/10", offset = 1e300, start = 1, value = "-w1" }\n',
}
VERBS: Sequence[str] = (
    "run {scene} --rung f32",
    "run {scene}",
    "run {scene} --rung f128 mp237",
    "exact {scene} --at 1e-201",
    "explain {scene}",
    "question {scene}",
    "check {file} --scene {scene} --partial",
)


@pytest.mark.parametrize("name", BEYOND)
@pytest.mark.parametrize("verb", VERBS)
def test_no_number_of_a_scene_breaks_a_verb(
    name: str, verb: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Each verb answers, refuses, or leaves undecided what doubles cannot estimate; nothing is a fault."""
    scene, file = tmp_path / "scene.toml", tmp_path / "mine.csv"
    scene.write_text(BEYOND[name])
    columns = "w1,w2,w3" if "euler" in BEYOND[name] else "x1,x2,x3,y1,y2,y3"
    row = ",0" * len(columns.split(","))
    file.write_text(f"t,{columns}\n0{row}\n1e-201{row}\n")
    status = main(verb.format(scene=scene, file=file).split())
    captured = capsys.readouterr()
    assert status in ((0, 1, 2, 3) if verb.startswith("check") else (0, 2, 3))
    assert "a fault of taylor-verify" not in captured.err
    if status == 2:
        assert "expected " in captured.err


def test_what_is_beyond_doubles_is_named() -> None:
    """The verdict is undecided, and its sentence names the number that is farthest from one."""
    scene = read(body(omega="[1e-310, 1e-310, 1e-310]"), "slow")
    (verdict,) = taylor_verify.run(scene).verdicts
    assert verdict.verdict is Status.UNDECIDED
    assert verdict.because == (
        "expected a scene whose sizes are doubles, which estimate steps and roundings, "
        "got 1.0e-310 @ initial.omega"
    )
