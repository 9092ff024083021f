"""The environment of a script: made when it is asked for, once, whole, and never half."""

from __future__ import annotations

import os
import re
import shlex
import shutil
import sys
import threading
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from builders.scenes import THREE_INSTANTS

from taylor_verify.models.problem import Problem, pose
from taylor_verify.scenes.precision import rung
from taylor_verify.scenes.reading.reader import read
from taylor_verify.solvers.entrants import entrant
from taylor_verify.solvers.entrants.entrant import entrants, prepare
from taylor_verify.solvers.entrants.environment import Environment, NotMade, metadata
from taylor_verify.solvers.registry import check_name, solver_named
from taylor_verify.solvers.trajectory import Outcome


def problem(on: str = "f64") -> Problem:
    return pose(read(THREE_INSTANTS, "short"), rung(on))


# An environment, made for a script that needs nothing.

# It answers with the state of the start, only if it runs by itself and is asked as it should be.
TINY = """\
# /// script
# requires-python = ">=3.11"
# dependencies = [{requirements}]
# [tool.taylor-verify]
# methods = ["still", "quiet"]
# rungs = ["f64"]
# ///
import json, sys
assert sys.prefix != sys.base_prefix
assert sys.argv[1:] == ["still", "1e-09", "1e-10"], sys.argv
scene = json.load(sys.stdin)
found = {{"t": scene["time"]["times"]["hex"], "steps": 7, "seconds": 0}}
for i, name in enumerate(("w1", "w2", "w3")):
    found[name] = [scene["initial"]["omega"]["hex"][i]] * len(found["t"])
json.dump(found, sys.stdout)
"""
NAME = "outside:tiny-still?rtol=1e-9&atol=1e-10"
NOWHERE = '"nothing @ file:///nowhere/nothing-1.0-py3-none-any.whl"'

Script = Callable[..., Path]


@pytest.fixture
def cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An empty cache folder of the user, and no uv: it has a cache of its own."""
    folder = tmp_path / "cache"
    monkeypatch.setenv("XDG_CACHE_HOME", str(folder))
    monkeypatch.setattr(shutil, "which", lambda name: None)
    monkeypatch.setattr(entrant, "_failed", {})
    return folder


@pytest.fixture
def script(
    cache: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> Iterator[Callable[..., Path]]:
    """Writes the one script there is, in place of those that are shipped."""
    folder = tmp_path / "scripts"
    folder.mkdir()
    monkeypatch.setattr(entrant, "SCRIPTS", folder)

    def write(requirements: str = "", text: str = TINY) -> Path:
        file = folder / "with_tiny.py"
        file.write_text(text.format(requirements=requirements))
        entrants.cache_clear()
        return file

    yield write
    entrants.cache_clear()


def environment_of(name: str = "tiny-still") -> Environment:
    (found,) = [one.environment for one in entrants() if one.name == name]
    assert found
    return found


def test_an_entrant_runs_in_an_environment_of_its_own(script: Script, cache: Path) -> None:
    """Asked to solve, it has its environment made, and is told method and tolerances."""
    script()
    found = solver_named(NAME).solve(problem())
    assert (found.outcome, found.detail) == (Outcome.FINISHED, "")
    assert (found.steps, found.seconds) == (7, 0.0)
    assert environment_of().is_made
    assert cache in environment_of().folder.parents


def test_to_name_and_to_list_makes_no_environment(script: Script, cache: Path) -> None:
    """A list of the entrants, a check of a name and the question whether one can be had touch nothing."""
    script()
    assert [one.name for one in entrants()[:2]] == ["tiny-still", "tiny-quiet"]
    check_name(NAME)
    assert solver_named(NAME).unavailable(rung("f64")) == ""
    assert "f64 alone" in solver_named(NAME).unavailable(rung("f80"))
    assert not cache.exists()


def test_an_environment_is_made_once(script: Script) -> None:
    """An environment that is there is not made again, by whichever of its names it is asked for."""
    script()
    said: list[str] = []
    prepare("tiny-still", said.append)
    mark = environment_of().folder / "mine"
    mark.touch()
    prepare("tiny-quiet", said.append)
    prepare(NAME, said.append)
    assert mark.exists()
    assert said == ["making the environment of tiny, once: nothing"]


def test_one_that_is_half_made_is_made_anew(script: Script) -> None:
    """Without its mark an environment is not used, whatever is in the folder."""
    script()
    prepare("tiny-still")
    made = environment_of()
    (made.folder / ".whole").unlink()
    (made.folder / "left over").touch()
    assert not made.is_made
    prepare("tiny-still")
    assert made.is_made
    assert not (made.folder / "left over").exists()


def test_one_whose_python_is_gone_is_made_anew(script: Script) -> None:
    """An environment is whole only with an interpreter that can be started."""
    script()
    prepare("tiny-still")
    made = environment_of()
    made.python.unlink()
    made.python.symlink_to(made.folder / "no such python")
    assert not made.is_made
    prepare("tiny-still")
    assert made.is_made


def test_two_at_once_make_it_once(script: Script) -> None:
    """Whoever comes second waits for the first, and finds it made."""
    script()
    said: list[str] = []
    start = threading.Barrier(2)

    def make() -> None:
        start.wait()
        environment_of().make(said.append)

    both = [threading.Thread(target=make) for _ in range(2)]
    for one in both:
        one.start()
    for one in both:
        one.join(120)
    assert environment_of().is_made
    assert sum(line.startswith("making") for line in said) == 1


@pytest.mark.parametrize("works", [True, False], ids=["uv", "broken uv"])
def test_uv_is_used_where_it_works(
    works: bool, script: Script, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A uv on the PATH makes the environment; where it fails, venv and pip do."""
    uv, called = tmp_path / "uv", tmp_path / "called"
    making = f'{shlex.quote(sys.executable)} -m venv --without-pip "$5"' if works else "exit 2"
    uv.write_text(f'#!/bin/sh\necho "$@" > {shlex.quote(str(called))}\n{making}\n')
    uv.chmod(0o700)
    monkeypatch.setattr(shutil, "which", lambda name: str(uv) if name == "uv" else None)
    script()
    prepare("tiny-still")
    folder = environment_of().folder
    assert called.read_text().split() == [
        *("venv", "--quiet", "--python", sys.executable, str(folder))
    ]
    assert environment_of().is_made
    assert solver_named(NAME).solve(problem()).outcome is Outcome.FINISHED


def test_another_pin_is_another_environment(script: Script) -> None:
    """A changed requirement is never answered by the versions of before."""
    script()
    before = environment_of().folder
    script('"numpy==2.0.0"')
    assert environment_of().folder != before


def test_what_cannot_be_installed_is_told_in_one_line(
    script: Script, caplog: pytest.LogCaptureFixture
) -> None:
    """A failed installation is an outcome with its reason, leaves nothing, and is not tried again."""
    script(NOWHERE)
    solver = solver_named(NAME)
    assert solver.unavailable(rung("f64")) == ""
    found = [solver.solve(problem()) for _ in range(2)]
    assert {one.outcome for one in found} == {Outcome.NO_PACKAGE}
    assert found[0].detail == found[1].detail == solver.unavailable(rung("f64"))
    assert "nothing" in found[0].detail
    assert "\n" not in found[0].detail
    assert not environment_of().folder.exists()
    assert [record.getMessage().partition(",")[0] for record in caplog.records] == [
        "making the environment of tiny"
    ]
    # An explicit request does not rest on the failure remembered.
    said: list[str] = []
    with pytest.raises(NotMade, match="nothing"):
        prepare("tiny-still", said.append)
    assert len(said) == 1


@pytest.mark.skipif(os.geteuid() == 0, reason="root may write anywhere")
def test_a_cache_that_cannot_be_written_is_told(script: Script, cache: Path) -> None:
    """A folder without permission is a reason like any other."""
    script()
    cache.mkdir(mode=0o500)
    found = solver_named(NAME).solve(problem())
    assert found.outcome is Outcome.NO_PACKAGE
    assert "Permission denied" in found.detail


def test_a_cache_that_is_a_file_is_told(script: Script, cache: Path) -> None:
    """So is a file where the folder should be."""
    script()
    cache.write_text("")
    found = solver_named(NAME).solve(problem())
    assert found.outcome is Outcome.NO_PACKAGE
    assert str(cache) in found.detail


def test_a_python_that_does_not_fit_is_told(script: Script) -> None:
    """A script for another Python is unavailable before anything is made."""
    script(text=TINY.replace(">=3.11", ">=3.99"))
    reason = solver_named(NAME).unavailable(rung("f64"))
    assert reason.startswith("needs Python >=3.99, this is 3.")
    with pytest.raises(NotMade, match=re.escape(">=3.99")):
        prepare("tiny-still")


@pytest.mark.parametrize(
    ("version", "fits"),
    [
        *(((3, 10, 99), False), ((3, 11, 0), True), ((3, 14, 9), True)),
        *(((3, 15, 0), False), ((4, 0, 0), False)),
    ],
)
def test_the_bounds_of_python_hold(tmp_path: Path, version: Any, fits: bool) -> None:
    """>=3.11,<3.15 takes its lower bound in and leaves its upper bound out."""
    file = tmp_path / "script.py"
    file.write_text('# /// script\n# requires-python = ">=3.11,<3.15"\n# ///\n')
    assert (metadata(file).unfit(version) == "") is fits


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("print(1)\n", "expected one block of script metadata, got 0"),
        ("# /// script\n# a = 1\n# ///\nprint(1)\n" * 2, "got 2"),
        ("# /// script\n# a = \n# ///\n", "expected TOML"),
    ],
)
def test_metadata_that_is_none_is_refused(tmp_path: Path, text: str, words: str) -> None:
    """A script has one block of metadata, and it is TOML."""
    file = tmp_path / "script.py"
    file.write_text(text)
    with pytest.raises(ValueError, match=f"{words}.* @ script.py"):
        metadata(file)
