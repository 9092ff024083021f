"""FMUs stepped as solvers: real ones, made by pythonfmu, sound and broken."""

from __future__ import annotations

import json
import math
import platform
import sys
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest
from builders.lacking import lacking
from builders.verdicts import by_quantity
from pythonfmu.builder import FmuBuilder

import taylor_verify
from taylor_verify.cli import main
from taylor_verify.numbers.precision import rung
from taylor_verify.records.status import Status
from taylor_verify.records.verdict import Verdict
from taylor_verify.solvers.fmu import runner as fmu_runner
from taylor_verify.solvers.fmu.fmu import PREFIX, named
from taylor_verify.solvers.process.process import LIMIT_VARIABLE

SCENE = "euler/generic"
SOURCE = Path(__file__).parents[1] / "fmus" / "top.py"
pytestmark = pytest.mark.skipif(
    sys.platform != "linux" or platform.machine() != "x86_64",
    reason="pythonfmu ships the binaries of its FMUs for Linux and Windows on x86-64 alone",
)
# A Modelica tool gives the entries of a vector such names.
OWN_NAMES = """
            own = {"I11": "J[1]", "I22": "J[2]", "I33": "J[3]"}
            own |= {f"w{i}": f"body.w[{i}]" for i in (1, 2, 3)}
            own |= {f"w{i}_start": f"body.w0[{i}]" for i in (1, 2, 3)}
            access = {
                "getter": lambda name=name: getattr(self, name),
                "setter": lambda value, name=name: setattr(self, name, value),
            }
            self.register_variable(Real(own[name], **access, """
# A twin of the sound FMU for each way to be wrong: what is replaced in its source, and by what.
TWINS = {
    "sound": ("", ""),
    "no gyroscopic term": ("return [(b - c)", "return [0 * (b - c)"),
    "own names": ("self.register_variable(Real(name, ", OWN_NAMES),
    "crash": ("w, h =", "import os; os.abort(); w, h ="),
    "endless": ("w, h =", "while True: pass\n        w, h ="),
    "refusal": ("return True", "return False"),
}


@pytest.fixture(scope="module")
def built(tmp_path_factory: pytest.TempPathFactory) -> Callable[[str], Path]:
    """Build the FMU of a twin by its name."""
    made: dict[str, Path] = {}

    def build(twin: str) -> Path:
        if twin not in made:
            folder = tmp_path_factory.mktemp("fmu")
            old, new = TWINS[twin]
            source = folder / "top.py"
            content = SOURCE.read_text()
            assert old in content
            source.write_text(content.replace(old, new.strip(), -1 if twin == "own names" else 1))
            FmuBuilder.build_FMU(source, dest=folder)
            made[twin] = folder / "Top.fmu"
        return made[twin]

    return build


def judged(file: Path, query: str = "step=0.05", scene: str = SCENE) -> dict[str, Verdict]:
    run = taylor_verify.run(scene, f"{PREFIX}{file}?{query}")
    return by_quantity(run)


Build = Callable[[str], Path]


def test_the_error_falls_with_the_fourth_power_of_the_step(built: Build) -> None:
    """Every sample is met exactly, so that halving the step of a sound FMU divides its error by 16."""
    file = built("sound")
    errors = [judged(file, f"step={step}")["omega"].max for step in ("0.1", "0.05", "0.025")]
    orders = [math.log2(a / b) for a, b in pairwise(errors)]
    # Of a method of order four, whose next term is half as large at half the step.
    assert all(3.8 <= order <= 4.2 for order in orders), orders


def test_a_missing_gyroscopic_term_is_caught(built: Build) -> None:
    """A twin without a term of the first axis is as near at the start, and far off later."""
    sound, broken = (judged(built(twin), "step=0.01") for twin in ("sound", "no gyroscopic term"))
    assert sound["omega"].max <= 1e-8 < 0.1 <= broken["omega"].max
    assert broken["initial state"].verdict is Status.PASS
    assert broken["H2"].verdict is Status.FAIL


@pytest.mark.parametrize("inertia", ["J", "J[1],J[2],J[3]"])
def test_own_names_of_an_fmu_are_mapped(inertia: str, built: Build) -> None:
    """Vectors and lists of other names are the quantities that they are given for."""
    query = f"step=0.05&omega=body.w&omega_start=body.w0&inertia={inertia}"
    own, sound = judged(built("own names"), query), judged(built("sound"))
    assert {q: v.max for q, v in own.items()} == {q: v.max for q, v in sound.items()}
    unknown = judged(built("own names"))["omega"].because
    assert "variables for inertia (I11 ... I33), omega_start (w1_start ... w3_start)" in unknown
    assert "name its own: ?inertia=NAME,NAME,...; what is built into it: ?fixed=inertia" in unknown


@pytest.mark.parametrize(
    ("twin", "words"),
    [("crash", "signal SIGABRT"), ("refusal", "exit status 1"), ("endless", "2 seconds")],
)
def test_what_an_fmu_does_is_an_outcome(
    twin: str, words: str, built: Build, monkeypatch: pytest.MonkeyPatch
) -> None:
    """An FMU that crashes, fails or never ends is a run that did not finish, and ends alone."""
    monkeypatch.setenv(LIMIT_VARIABLE, "2")
    (verdict,) = judged(built(twin)).values()
    assert verdict.verdict is Status.FAIL
    assert words in verdict.because


@pytest.mark.parametrize(
    ("scene", "query", "fault"),
    [
        ("euler/with-attitude", "step=0.1", "expected variables for attitude_start"),
        ("euler/constant-moment", "step=0.1", "expected variables for moment"),
        ("euler/full-tensor", "step=0.1", "expected variables for inertia"),
        (SCENE, "omega=w1,w2,w3", "expected ?step=NUMBER, got none"),
        (SCENE, "step=0.1&omega=w1,w2", "expected 3 names, got 2 @ omega"),
        (SCENE, "step=0.1&omega=w1,w2,w4", "expected a variable of the FMU, got w4 @ omega"),
        ("kirchhoff/screw", "step=0.1", "expected variables for linear"),
    ],
)
def test_what_the_fmu_cannot_be_told_is_said(
    scene: str, query: str, fault: str, built: Build
) -> None:
    """An FMU that lacks a part of the problem is not run as if it had it."""
    (verdict,) = judged(built("sound"), query, scene).values()
    assert verdict.verdict is Status.FAIL
    assert fault in verdict.because


@pytest.mark.parametrize(
    ("name", "fault"),
    [
        ("fmu:", "expected an FMU, got no such file @ fmu:"),
        ("fmu:none.fmu?step=1", "expected an FMU, got no such file @ none.fmu"),
        (f"fmu:{SOURCE}?stepp=1", "got 'stepp'; did you mean step?"),
        (f"fmu:{SOURCE}?step=-1", "expected a positive number, got '-1' @ step"),
        (f"fmu:{SOURCE}?fixed=omega", "expected a quantity .* got 'omega' @ fixed"),
    ],
)
def test_names_that_mean_nothing_are_refused(name: str, fault: str) -> None:
    """A file that is not there and a key that means nothing are faults of the call."""
    with pytest.raises(ValueError, match=fault):
        named(name)


def test_where_it_is_not_asked(built: Build) -> None:
    """An FMU is made in float64, steps forwards, and knows constant loads alone."""
    solver = named(f"{PREFIX}{built('sound')}?step=0.1")
    assert solver.unavailable(rung("f64")) == ""
    assert "f64 alone" in solver.unavailable(rung("f128"))
    backward = taylor_verify.run("euler/backward", solver)
    assert [v.verdict for v in backward.verdicts] == [Status.UNAVAILABLE]
    assert "steps forwards in time" in backward.verdicts[0].because


def test_without_the_package_the_install_command_is_said(built: Build, tmp_path: Path) -> None:
    """Exit status 2, and the command that installs FMPy."""
    call = ("-m", "taylor_verify", "run", SCENE, "--solver", f"{PREFIX}{built('sound')}?step=0.1")
    done = lacking(tmp_path, ["fmpy"], *call)
    assert done.returncode == 2, done.stdout
    assert "pip install 'taylor-verify[fmu]'" in done.stdout + done.stderr


def test_the_command_runs_it(built: Build, capsys: pytest.CaptureFixture[str]) -> None:
    """`run --solver fmu:FILE` judges it as any solver; what it prints is in nobody's way."""
    assert main(["run", SCENE, "--solver", f"{PREFIX}{built('sound')}?step=0.1", "--json"]) == 1
    rows: Any = json.loads(capsys.readouterr().out)["verdicts"]
    assert {row["outcome"] for row in rows} == {"reached the last sample"}


# Names and steps, without an FMU.


def test_communication_points_meet_every_sample() -> None:
    """The last point before a sample is the sample itself, also where the distances vary."""
    samples = [0.0, 0.1, 0.3, 1.0]
    ways = list(fmu_runner.points(samples, 0.1, varies=True))
    assert [way[-1:] for way in ways] == [[], [0.1], [0.3], [1.0]]
    assert [len(way) for way in ways] == [0, 1, 2, 7]
    with pytest.raises(fmu_runner.Fault, match="a step that divides every distance of samples"):
        list(fmu_runner.points([0.0, 0.1, 0.25], 0.1, varies=False))
