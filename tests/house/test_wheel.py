"""The wheel: an installed copy is complete, and runs without the checkout."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import zipfile
from collections.abc import Iterable, Iterator
from email import message_from_bytes
from importlib.metadata import distribution, files, requires
from pathlib import Path

import pytest
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

from taylor_verify.scenes.library import STANDARD_SET

CHECKOUT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A wheel built from this checkout, by the backend itself: nothing is downloaded."""
    folder = tmp_path_factory.mktemp("wheel")
    command = [sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", str(folder)]
    subprocess.run(command, cwd=CHECKOUT, check=True)
    (built,) = folder.glob("*.whl")
    return built


@pytest.fixture(scope="module")
def installed(wheel: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder that the wheel was installed into, apart from this environment's own copy."""
    folder = tmp_path_factory.mktemp("installed")
    pip = [sys.executable, "-m", "pip", "--quiet", "--disable-pip-version-check"]
    options = ["--no-deps", "--no-index", "--no-compile", "--target", str(folder)]
    subprocess.run([*pip, "install", *options, str(wheel)], check=True)
    return folder


def shipped(folder: str) -> Iterator[Path]:
    """The files of a top-level folder, without what Python and editors leave behind."""
    for file in (CHECKOUT / folder).rglob("*"):
        path = file.relative_to(CHECKOUT)
        if file.is_file() and not any(part.startswith((".", "__pycache__")) for part in path.parts):
            yield path


def test_the_wheel_holds_every_file(wheel: Path) -> None:
    """The wheel holds both packages, templates and data included, and all of cases/ inside the first."""
    packages = [*shipped("verify/taylor_verify"), *shipped("verify/taylor_verify_reports")]
    expected = {path.relative_to("verify").as_posix() for path in packages}
    expected |= {f"taylor_verify/{path.as_posix()}" for path in shipped("cases")}
    assert "taylor_verify/cli/__init__.py" in expected
    names = zipfile.ZipFile(wheel).namelist()
    assert {name for name in names if ".dist-info/" not in name} == expected


def test_the_installed_command_lists_the_shipped_scenes(installed: Path, tmp_path: Path) -> None:
    """`taylor-verify list --json` of an installed copy, run elsewhere, names the standard set."""
    standard = {
        f"{path.parts[1]}/{path.stem}"
        for path in shipped("cases")
        if path.parts[1] in STANDARD_SET and path.suffix == ".toml"
    }
    assert standard
    answer = run(installed, tmp_path, str(installed / "bin" / "taylor-verify"), "list", "--json")
    assert standard <= set(json.loads(answer)["scenes"])


# What another project writes to hold its simulator to the exact motion: two lines a test.
ANOTHER_PROJECT = """
import pathlib, shlex, sys
import pytest
import taylor_verify

OUTSIDE = pathlib.Path(taylor_verify.__file__).parent / "solvers" / "outside"
RK4 = "process:" + shlex.join([sys.executable, str(OUTSIDE / "rk4.py"), "step=0.05"])

def still(problem):
    return [problem.given.initial.omega] * len(problem.times)

def test_callable(verify_solver):
    verify_solver("euler/spherical", still)

def test_program(verify_solver):
    verify_solver("euler/generic", RK4, tolerance=1e-6)

@pytest.mark.verify_scenes("euler/steady-*", "euler/rest", rung="f32")
def test_scene(verify_scene):
    verify_scene(still)

def test_wrong(verify_solver):
    verify_solver("euler/generic", still)

def test_coarse(verify_solver):
    verify_solver("euler/generic", RK4)
"""


def run(installed: Path, folder: Path, *command: str) -> str:
    """Standard output of a command that sees the installed copy first, and succeeds."""
    done = launch(installed, folder, *command)
    done.check_returncode()
    return done.stdout


def launch(installed: Path, folder: Path, *command: str) -> subprocess.CompletedProcess[str]:
    """A command that sees the installed copy first, run in another folder."""
    environment = {**os.environ, "PYTHONPATH": str(installed)}
    return subprocess.run(
        command, cwd=folder, env=environment, check=False, stdout=subprocess.PIPE, text=True
    )


# What the wheel requires by itself, in an environment of its own.


def required(wheel: Path, extra: str = "") -> set[str]:
    """The names of the distributions that the wheel asks for, with an extra or without."""
    with zipfile.ZipFile(wheel) as archive:
        (name,) = [name for name in archive.namelist() if name.endswith("/METADATA")]
        metadata = message_from_bytes(archive.read(name))
    return asked_for(metadata.get_all("Requires-Dist", []), extra)


def asked_for(requirements: Iterable[str], extra: str = "") -> set[str]:
    """The names in these requirements, without those for other systems and extras."""
    needed = map(Requirement, requirements)
    applying = [r for r in needed if r.marker is None or r.marker.evaluate({"extra": extra})]
    return {canonicalize_name(requirement.name) for requirement in applying}


def closure(names: Iterable[str]) -> set[str]:
    """The distributions of these names, and all that they require themselves."""
    distributions: set[str] = set()
    waiting = set(names)
    while waiting:
        distributions |= waiting
        waiting = {
            each for name in waiting for each in asked_for(requires(name) or ())
        } - distributions
    return distributions


@pytest.fixture(scope="module")
def bare(wheel: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """An environment with the wheel, what it requires, and pytest; linked, as nothing is downloaded."""
    folder = tmp_path_factory.mktemp("bare")
    subprocess.run([sys.executable, "-m", "venv", "--without-pip", str(folder)], check=True)
    (site,) = folder.glob("lib/python*/site-packages")
    for name in closure(required(wheel) | {"pytest"}):
        for part in {file.parts[0] for file in files(name) or ()} - {"..", "__pycache__"}:
            (site / part).symlink_to(Path(distribution(name).locate_file(part)))
    pip = [sys.executable, "-m", "pip", "--quiet", "--disable-pip-version-check"]
    pip += ["--python", str(folder / "bin" / "python")]
    subprocess.run(
        [*pip, "install", "--no-deps", "--no-index", "--no-compile", str(wheel)], check=True
    )
    return folder


def test_the_wheel_requires_no_solver(wheel: Path) -> None:
    """heyoka, SciPy, matplotlib and pyarrow are extras, and no requirement requires them."""
    needed = closure(required(wheel))
    assert {"gmpy2", "mpmath", "numpy", "python-flint"} <= needed
    assert needed.isdisjoint({"heyoka", "scipy", "matplotlib", "pyarrow", "pytest"})
    assert required(wheel, "taylor") - required(wheel) == {"heyoka"}


@pytest.mark.slow
def test_a_bare_environment_judges(bare: Path, tmp_path: Path) -> None:
    """With the wheel alone `exact`, `check` and the plugin work; `run` names what it lacks."""
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}

    def bare_run(*command: str) -> subprocess.CompletedProcess[str]:
        program = str(bare / "bin" / command[0])
        return subprocess.run(
            [program, *command[1:]],
            cwd=tmp_path,
            env=environment,
            check=False,
            capture_output=True,
            text=True,
        )

    exact = bare_run("taylor-verify", "exact", "euler/generic", "--at", "1")
    assert (exact.returncode, "0.886993695743147990920637547598" in exact.stdout) == (0, True)
    question = bare_run("taylor-verify", "question", "euler/rest", "--csv").stdout.splitlines()
    rows = [f"{row.partition(',')[0]},0,0,0" for row in question[1:]]
    (tmp_path / "mine.csv").write_text("\n".join([question[0], *rows]))
    check = bare_run("taylor-verify", "check", "mine.csv", "--scene", "euler/rest")
    assert check.returncode == 0, check.stdout
    lacking = bare_run("taylor-verify", "run", "euler/generic", "--json")
    assert lacking.returncode == 2
    (row,) = json.loads(lacking.stdout)["verdicts"]
    assert "pip install 'taylor-verify[taylor]'" in row["because"]
    (tmp_path / "test_simulator.py").write_text(ANOTHER_PROJECT)
    session = bare_run("python", "-m", "pytest", "-p", "no:cacheprovider")
    assert "2 failed, 4 passed" in session.stdout, session.stdout
