"""The environment of a script, made by uv, and of an engine in C++, compiled: when asked for, and whole."""

from __future__ import annotations

import shutil
import zipfile
from collections.abc import Callable
from pathlib import Path

import pytest
from builders.scenes import three_instants

from taylor_verify.numbers.precision import rung
from taylor_verify.run import run
from taylor_verify.solvers.engines import engine, native, python
from taylor_verify.solvers.engines.engine import SCRIPTS, engines, named, prepare
from taylor_verify.solvers.engines.launcher import NotMade
from taylor_verify.solvers.engines.script import read_script
from taylor_verify.solvers.registry import solver_named
from taylor_verify.solvers.trajectory import Outcome

# An environment, made for a script that needs nothing.

# It answers with the state of the start, only if it runs by itself and is asked as it should be.
TINY = """\
# /// script
# requires-python = ">=3.11"
# dependencies = [{requirements}]
# [tool.taylor-verify]
# title = "Tiny"
# models = ["euler"]
# [tool.taylor-verify.methods]
# still = "at rest"
# quiet = "at rest too"
# [tool.taylor-verify.settings]
# rtol = 1e-9
# atol = "rtol"
# order = ["first", "second"]
# ///
import json, sys
assert sys.prefix != sys.base_prefix
assert sys.argv[1:] == ["method=still", "rtol=1e-09", "atol=1e-10", "order=second"], sys.argv
{body}
scene = json.load(sys.stdin)
found = {{"t": scene["time"]["times"]["hex"], "steps": 7, "seconds": 0}}
for i, name in enumerate(("w1", "w2", "w3")):
    found[name] = [scene["initial"]["omega"]["hex"][i]] * len(found["t"])
json.dump(found, sys.stdout)
"""
NAME = "outside:tiny-still?rtol=1e-9&atol=1e-10&order=second"
NOWHERE = '"nothing @ file:///nowhere/nothing-1.0-py3-none-any.whl"'

Script = Callable[..., Path]


@pytest.fixture
def cache(users_cache: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An empty cache folder of the user and of uv, and no network."""
    monkeypatch.setenv("UV_CACHE_DIR", str(users_cache / "uv"))
    monkeypatch.setenv("UV_OFFLINE", "1")
    return users_cache


@pytest.fixture
def script(cache: Path, only_script: Callable[[str, str], Path]) -> Script:
    """Writes the one script there is."""

    def write(requirements: str = "", text: str = TINY, body: str = "") -> Path:
        return only_script("with_tiny.py", text.format(requirements=requirements, body=body))

    return write


def interpreter(name: str = NAME) -> Path:
    """The Python of the environment, made if it is not there."""
    block = named(name).block
    return Path(python.interpreter("tiny", block, lambda line: None))


def test_an_engine_runs_in_an_environment_of_its_own(script: Script, cache: Path) -> None:
    """Asked to solve, it has its environment made, and gets its method and its settings."""
    script()
    trajectory = solver_named(NAME).solve(three_instants())
    assert (trajectory.outcome, trajectory.detail) == (Outcome.FINISHED, "")
    assert (trajectory.steps, trajectory.seconds) == (7, 0.0)
    assert cache in interpreter().parents


def test_to_name_and_to_list_makes_no_environment(script: Script, cache: Path) -> None:
    """A list of the engines, a name and the question whether one can be had touch nothing."""
    script()
    assert list(engines()) == ["tiny-still", "tiny-quiet"]
    assert engine.usages()[0] == "outside:tiny-still?rtol=NUMBER&atol=NUMBER&order=first|second"
    assert solver_named(NAME).unavailable(rung("f64")) == ""
    assert "f64 alone" in solver_named(NAME).unavailable(rung("f80"))
    assert not cache.exists()


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("outside:tiny-still?order=third", "expected one of first, second, got 'third' @ order"),
        ("outside:tiny-still?ordr=first", "did you mean order"),
        ("outside:tiny", r"expected a method \(tiny-still, tiny-quiet\), got 'tiny'"),
    ],
)
def test_a_setting_is_one_of_its_words(script: Script, name: str, words: str) -> None:
    """A word that is none, a key that is none and a library without its method are refused."""
    script()
    with pytest.raises(ValueError, match=words):
        solver_named(name)


def test_a_model_that_is_not_taken_is_unsuited(script: Script) -> None:
    """A script says in its metadata which models it takes."""
    script()
    solver = solver_named(NAME)
    assert solver.unsuited(three_instants()) == ""
    script(text=TINY.replace('["euler"]', '["kirchhoff"]'))
    assert "made for kirchhoff alone" in solver_named(NAME).unsuited(three_instants())


def test_an_environment_is_made_once(script: Script) -> None:
    """An environment that is there is not made again, by whichever of its names it is asked for."""
    script()
    messages: list[str] = []
    prepare("tiny-still", messages.append)
    mark = interpreter().parent / "mine"
    mark.touch()
    prepare("tiny-quiet", messages.append)
    prepare(NAME, messages.append)
    assert mark.exists()
    assert messages == []


def test_without_uv_it_is_unavailable(script: Script, monkeypatch: pytest.MonkeyPatch) -> None:
    """A missing uv is a missing package: never a failure, and with the command that mends it."""
    monkeypatch.setattr(python, "_uv", lambda: None)
    script()
    solver = solver_named(NAME)
    reason = solver.unavailable(rung("f64"))
    assert reason == "uv is not installed: pip install 'taylor-verify[engines]'"
    trajectory = solver.solve(three_instants())
    assert (trajectory.outcome, trajectory.detail) == (Outcome.NO_PACKAGE, reason)
    with pytest.raises(NotMade, match="uv is not installed"):
        prepare("tiny-still")


def wheel(folder: Path, name: str, version: str) -> None:
    """A package that knows its version, and nothing else."""
    about = f"{name}-{version}.dist-info"
    metadata = f"Metadata-Version: 2.1\nName: {name}\nVersion: {version}\n"
    kind = "Wheel-Version: 1.0\nGenerator: test\nRoot-Is-Purelib: true\nTag: py3-none-any\n"
    with zipfile.ZipFile(folder / f"{name}-{version}-py3-none-any.whl", "w") as file:
        file.writestr(f"{name}.py", f"VERSION = {version!r}\n")
        file.writestr(f"{about}/METADATA", metadata)
        file.writestr(f"{about}/WHEEL", kind)
        file.writestr(f"{about}/RECORD", "")


def test_a_version_is_that_of_the_package(
    script: Script, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """`version` runs the same script with another version of its package, each in its environment."""
    for version in ("1.0", "2.0"):
        wheel(tmp_path, "tinylib", version)
    monkeypatch.setenv("UV_FIND_LINKS", str(tmp_path))
    script('"tinylib==2.0"', body="import tinylib\nsys.exit(tinylib.VERSION)")
    for query, version in (("", "2.0"), ("&version=1.0", "1.0"), ("&version=2.0", "2.0")):
        trajectory = solver_named(f"{NAME}{query}").solve(three_instants())
        assert (trajectory.outcome, trajectory.detail) == (
            Outcome.CRASHED,
            f"exit status 1; stderr: {version}",
        )
    trajectory = solver_named(f"{NAME}&version=3.0").solve(three_instants())
    assert trajectory.outcome is Outcome.NO_PACKAGE
    assert "tinylib==3.0" in trajectory.detail


def test_an_environment_that_was_made_needs_no_network(
    script: Script, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A filled cache is enough, also for an environment that has to be made anew."""
    wheel(tmp_path, "tinylib", "1.0")
    monkeypatch.setenv("UV_FIND_LINKS", str(tmp_path))
    script('"tinylib==1.0"')
    prepare("tiny-still")
    monkeypatch.setenv("UV_INDEX_URL", "http://127.0.0.1:9/simple")
    monkeypatch.delenv("UV_OFFLINE")
    messages: list[str] = []
    prepare("tiny-still", messages.append)
    assert messages == []


def test_what_cannot_be_installed_is_told_in_one_line(
    script: Script, caplog: pytest.LogCaptureFixture
) -> None:
    """A failed installation is an outcome with its reason, and is not tried again."""
    script(NOWHERE)
    solver = solver_named(NAME)
    assert solver.unavailable(rung("f64")) == ""
    trajectories = [solver.solve(three_instants()) for _ in range(2)]
    assert {one.outcome for one in trajectories} == {Outcome.NO_PACKAGE}
    assert trajectories[0].detail == trajectories[1].detail == solver.unavailable(rung("f64"))
    assert "nothing" in trajectories[0].detail
    assert "\n" not in trajectories[0].detail
    assert [record.getMessage().partition(",")[0] for record in caplog.records] == [
        "making the environment of tiny"
    ]
    # An explicit request does not rest on the failure remembered.
    messages: list[str] = []
    with pytest.raises(NotMade, match="nothing"):
        prepare("tiny-still", messages.append)
    assert len(messages) == 1


def test_a_cache_that_is_a_file_is_told(script: Script, cache: Path) -> None:
    """A file where the folder should be is a reason like any other."""
    script()
    cache.write_text("")
    trajectory = solver_named(NAME).solve(three_instants())
    assert trajectory.outcome is Outcome.NO_PACKAGE
    assert str(cache) in trajectory.detail


# In C++

with_compiler = pytest.mark.skipif(
    bool(native.Native().unavailable()), reason="needs g++ and the packages of Debian"
)

# An engine that knows one motion: the turn of a ball, whose omega is constant in space.
BALL = """\
// /// script
// dependencies = []
// [tool.taylor-verify]
// title = "Ball"
// models = ["euler"]
// data = "tensor"
// [tool.taylor-verify.settings]
// step = 0.01
// ///
#include <cmath>
#include <cstring>
static double w[3], q[4], h;
extern "C" {
int takes_moments = 1;
void begin(const double *, const double *omega, const double *attitude, double step, const char *) {
  std::memcpy(w, omega, sizeof w);
  std::memcpy(q, attitude, sizeof q);
  h = step;
}
void push(const double *) {}
void advance() {
  const double rate = std::sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2]);
  const double c = std::cos(rate * h / 2), s = std::sin(rate * h / 2) / rate;
  const double x = s * w[0], y = s * w[1], z = s * w[2], p[] = {q[0], q[1], q[2], q[3]};
  q[0] = c * p[0] - x * p[1] - y * p[2] - z * p[3];
  q[1] = c * p[1] + x * p[0] + y * p[3] - z * p[2];
  q[2] = c * p[2] + y * p[0] + z * p[1] - x * p[3];
  q[3] = c * p[3] + z * p[0] + x * p[2] - y * p[1];
}
void state(double *row) {
  std::memcpy(row, w, sizeof w);
  std::memcpy(row + 3, q, sizeof q);
}
}
"""


@with_compiler
def test_an_engine_in_cpp_is_compiled_once_and_answers(
    only_script: Callable[[str, str], Path],
) -> None:
    """A ball turns rightly from an oblique start; a second call compiles nothing."""
    only_script("with_ball.cpp", BALL)
    judged = run("euler/spherical", "outside:ball?step=0.01", tolerance=1e-9, causes=False)
    assert judged.passed, judged.verdicts
    messages: list[str] = []
    prepare("ball", messages.append)
    assert messages == []


@with_compiler
def test_a_library_that_cannot_be_made_is_told_in_one_line(
    only_script: Callable[[str, str], Path], monkeypatch: pytest.MonkeyPatch
) -> None:
    """A compiler's error is the reason, and so is a missing compiler."""
    only_script("with_ball.cpp", BALL.replace("static double w[3]", "static nothing w[3]"))
    with pytest.raises(NotMade, match=r"g\+\+: .*nothing.* does not name a type"):
        prepare("ball")
    monkeypatch.setattr(shutil, "which", lambda program: None)
    assert "apt-get is not installed" in solver_named("outside:ball").unavailable(rung("f64"))


@with_compiler
def test_a_package_of_debian_is_pinned() -> None:
    """A version replaces the pins of a library and its headers; a requirement without one is refused."""
    assert (
        '"libode-dev=2:0.17-1", "libode8=2:0.17-1"' in named("outside:ode?version=2:0.17-1").block
    )
    assert read_script(SCRIPTS / "with_bullet.cpp").version == "3.24+dfsg-2"
