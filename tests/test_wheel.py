"""The wheel: an installed copy is complete, and runs without the checkout."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import zipfile
from collections.abc import Iterator
from pathlib import Path

import pytest

CHECKOUT = Path(__file__).resolve().parents[1]


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
    options = ["--no-deps", "--no-index", "--target", str(folder)]
    subprocess.run([*pip, "install", *options, str(wheel)], check=True)
    return folder


def shipped(folder: str) -> Iterator[Path]:
    """The files of a top-level folder, without what Python and editors leave behind."""
    for file in (CHECKOUT / folder).rglob("*"):
        path = file.relative_to(CHECKOUT)
        if file.is_file() and not any(part.startswith((".", "__pycache__")) for part in path.parts):
            yield path


def test_the_wheel_holds_every_file(wheel: Path) -> None:
    """The wheel holds all of verify/, templates and data included, and all of cases/ inside it."""
    expected = {path.as_posix() for path in shipped("verify")}
    expected |= {f"verify/{path.as_posix()}" for path in shipped("cases")}
    assert "verify/cli/__init__.py" in expected
    names = zipfile.ZipFile(wheel).namelist()
    assert {name for name in names if name.startswith("verify/")} == expected


def test_the_installed_command_lists_the_shipped_scenes(installed: Path, tmp_path: Path) -> None:
    """`taylor-verify list --json` of an installed copy, run elsewhere, names the standard set."""
    standard = {
        f"{path.parts[1]}/{path.stem}"
        for path in shipped("cases")
        if path.parts[1] in {"euler", "kirchhoff", "manufactured"} and path.suffix == ".toml"
    }
    assert standard
    answer = run(installed, tmp_path, str(installed / "bin" / "taylor-verify"), "list", "--json")
    assert standard <= set(json.loads(answer)["scenes"])


def test_the_installed_copy_is_the_one_that_runs(installed: Path, tmp_path: Path) -> None:
    """The installed package and its scenes are found inside the folder, not in the checkout."""
    script = "from verify.scenes.library import cases_directory; print(cases_directory())"
    answer = run(installed, tmp_path, sys.executable, "-c", script)
    assert Path(answer.strip()) == installed.resolve() / "verify" / "cases"


def run(installed: Path, folder: Path, *command: str) -> str:
    """Standard output of a command that sees the installed copy first, run in another folder."""
    environment = {**os.environ, "PYTHONPATH": str(installed)}
    done = subprocess.run(
        command, cwd=folder, env=environment, check=True, stdout=subprocess.PIPE, text=True
    )
    return done.stdout
