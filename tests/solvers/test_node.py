"""The environments of scripts in JavaScript: made by npm when they are asked for, whole, and never half."""

from __future__ import annotations

import json
import os
import re
import shutil
import sys
import threading
from collections.abc import Callable
from pathlib import Path

import pytest
from builders.scenes import three_instants

from taylor_verify.numbers.precision import rung
from taylor_verify.solvers.engines.engine import SCRIPTS, engines, named, prepare
from taylor_verify.solvers.engines.launcher import NotMade
from taylor_verify.solvers.engines.node import lock
from taylor_verify.solvers.engines.script import read_script
from taylor_verify.solvers.registry import solver_named
from taylor_verify.solvers.trajectory import Outcome

# What stands for npm: it notes how it was called, and installs what package.json asks for. It has 1.0.0 in
# its cache once it was allowed to download.
NPM = """\
#!{python}
import json, pathlib, sys
notes, cache = pathlib.Path({notes!r}), pathlib.Path({cache!r})
with notes.open("a") as file:
    file.write(" ".join(sys.argv[1:]) + chr(10))
package = json.loads(pathlib.Path("package.json").read_text())
if "--offline" in sys.argv and not cache.exists():
    sys.exit("npm error code ENOTCACHED" + chr(10) + "npm error nothing is cached")
if "9.9.9" in package["dependencies"].values():
    said = ["code ETARGET", "notarget No version 9.9.9", "Log files were not written"]
    sys.exit(chr(10).join(f"npm error {{line}} " for line in said))
if "--package-lock-only" in sys.argv:
    pathlib.Path("package-lock.json").write_text(json.dumps({{"packages": {{"": package}}}}))
    sys.exit()
cache.touch()
for name in package["dependencies"]:
    place = pathlib.Path("node_modules", name)
    place.mkdir(parents=True)
    (place / "package.json").write_text("{{}}")
"""

# What stands for node: it answers with the state at rest, if the script is where node would find packages.
NODE = """\
#!{python}
import json, pathlib, sys
script, *settings = sys.argv[1:]
script = pathlib.Path(script)
assert (script.parent / "free_body.mjs").exists()
assert (script.parents[1] / "node_modules/tiny/package.json").exists()
scene = json.load(sys.stdin)
found = {{"t": scene["time"]["times"]["hex"], "steps": len(settings), "seconds": 0}}
for i, name in enumerate(("w1", "w2", "w3")):
    found[name] = [scene["initial"]["omega"]["hex"][i]] * len(found["t"])
json.dump(found, sys.stdout)
"""

TINY = """\
// /// script
// requires-node = ">=20"
// dependencies = ["tiny@1.0.0"]
// [tool.taylor-verify]
// title = "Tiny"
// [tool.taylor-verify.settings]
// flags = ["2", "0"]
// step = 0.01
// ///
import "tiny";
"""
NAME = "outside:tiny?flags=0&step=0.1"

Script = Callable[..., Path]
Calls = Callable[[], list[str]]


@pytest.fixture
def cache(users_cache: Path) -> Path:
    """The user's cache folder for environments, empty."""
    return users_cache / "taylor-verify" / "outside"


@pytest.fixture
def calls(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Calls:
    """What npm was called with, a line for each call; npm and node are programs of our own."""
    programs, notes = tmp_path / "bin", tmp_path / "notes"
    programs.mkdir()
    filled = {"python": sys.executable, "notes": str(notes), "cache": str(tmp_path / "cached")}
    for name, text in (("npm", NPM), ("node", NODE)):
        (programs / name).write_text(text.format(**filled))
        (programs / name).chmod(0o700)
    monkeypatch.setenv("PATH", str(programs))
    return lambda: notes.read_text().splitlines() if notes.exists() else []


@pytest.fixture
def script(calls: Calls, only_script: Callable[[str, str], Path]) -> Script:
    """Writes the one script there is, beside a shared file."""
    only_script("free_body.mjs", "export const x = 1;\n")
    return lambda text=TINY: only_script("with_tiny.mjs", text)


def test_a_script_runs_in_an_environment_of_its_own(script: Script, calls: Calls) -> None:
    """Asked to solve, it has its environment made without running a script of a package, and answers."""
    script()
    trajectory = solver_named(NAME).solve(three_instants())
    assert (trajectory.outcome, trajectory.detail, trajectory.steps) == (Outcome.FINISHED, "", 2)
    assert calls()
    assert all("--ignore-scripts" in call.split() for call in calls())


def test_a_cache_is_asked_before_the_network(script: Script, calls: Calls) -> None:
    """npm is first called without a network; a download is told, and is not needed a second time."""
    script()
    messages: list[str] = []
    prepare("tiny", messages.append)
    assert messages == ["making the environment of tiny, once: a download"]
    assert ["--offline" in call for call in calls()] == [True, False]
    script(TINY.replace("Tiny", "Another title"))
    shutil.rmtree(environment())
    prepare("tiny", messages.append)
    assert len(messages) == 1
    assert ["--offline" in call for call in calls()] == [True, False, True]


def environment(name: str = NAME) -> Path:
    """The folder of the environment, made if it is not there."""
    solver = named(name)
    about = solver.engine.script
    words = about.launcher.command("tiny", about.path, solver.block, lambda line: None)
    return Path(words[1]).parents[1]


def test_an_environment_is_made_once(script: Script, calls: Calls) -> None:
    """One that is there is not made again, whatever the text of the script; one that lost a package is."""
    script()
    first = environment()
    made = calls()
    script(TINY + "// changed\n")
    assert environment() == first
    assert calls() == made
    copies = [file.read_text() for file in first.glob("*/with_tiny.mjs")]
    assert sorted(copies) == [TINY, TINY + "// changed\n"]
    shutil.rmtree(first / "node_modules" / "tiny")
    assert (environment() / "node_modules" / "tiny").exists()
    assert len(calls()) > len(made)


def both(make: Callable[[], Path], seconds: float) -> list[Path]:
    """Return what each of two threads has made, of those that ended within the time."""
    made: list[Path] = []
    start = threading.Barrier(2)

    def one() -> None:
        start.wait()
        made.append(make())

    threads = [threading.Thread(target=one) for _ in range(2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(seconds)
    return made


def test_two_at_once_make_it_together(script: Script) -> None:
    """Two that ask for an environment at once have the same one, and nothing is left beside it."""
    script()
    results = both(environment, 60)
    assert len(results) == 2
    assert results[0] == results[1]
    assert list(results[0].parent.iterdir()) == [results[0]]


def test_a_lock_holds_for_its_own_versions_alone(script: Script, calls: Calls) -> None:
    """The pinned version is installed as the lock says; another one is not in it, and is without it."""
    file = script()
    assert lock(file, read_script(file).block) == file.with_name("with_tiny.lock.json")
    pinned = environment()
    assert (pinned / "package-lock.json").read_text() == lock_of(file).read_text()
    assert calls()[-1].startswith("ci ")
    other = environment(f"{NAME}&version=2.0.0")
    assert other != pinned
    assert not (other / "package-lock.json").exists()
    assert calls()[-1].startswith("install --no-package-lock ")
    package = json.loads((other / "package.json").read_text())
    assert package["dependencies"] == {"tiny": "2.0.0"}
    assert package["engines"] == {"node": ">=20"}


def lock_of(file: Path) -> Path:
    return file.with_suffix(".lock.json")


def test_what_cannot_be_installed_is_told_in_one_line(script: Script, cache: Path) -> None:
    """A failed installation is an outcome with its reason, and leaves nothing behind."""
    script()
    trajectory = solver_named(f"{NAME}&version=9.9.9").solve(three_instants())
    assert trajectory.outcome is Outcome.NO_PACKAGE
    reason = "npm: code ETARGET notarget No version 9.9.9"
    assert trajectory.detail == f"the environment of tiny could not be made: {reason}"
    assert list(cache.iterdir()) == []
    with pytest.raises(NotMade, match="No version"):
        prepare(f"{NAME}&version=9.9.9")


@pytest.mark.parametrize("missing", ["node", "npm"])
def test_without_node_or_npm_it_is_unavailable(
    missing: str, script: Script, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A missing program is a missing package: never a failure, and with the command that mends it."""
    script()
    Path(os.environ["PATH"], missing).unlink()
    solver = solver_named(NAME)
    reason = solver.unavailable(rung("f64"))
    assert reason == f"{missing} is not installed: conda install -c conda-forge nodejs"
    trajectory = solver.solve(three_instants())
    assert (trajectory.outcome, trajectory.detail) == (Outcome.NO_PACKAGE, reason)
    with pytest.raises(NotMade, match="is not installed"):
        prepare("tiny")


@pytest.mark.parametrize(
    ("changed", "words"),
    [
        ({"tiny@1.0.0": "tiny"}, "expected a dependency pinned with @, got 'tiny'"),
        ({"tiny@1.0.0": "tiny@^1.0.0"}, r"expected a dependency pinned with @, got 'tiny@\^1.0.0'"),
        ({"// /// script": "# /// script"}, "expected one block of script metadata, got 0"),
    ],
)
def test_metadata_that_is_wrong_is_refused(
    changed: dict[str, str], words: str, script: Script
) -> None:
    """A block is written in comments of JavaScript, and pins one version of a package."""
    text = TINY
    for old, new in changed.items():
        text = text.replace(old, new, 1)
    with pytest.raises(ValueError, match=f"{words} @ with_tiny.mjs"):
        read_script(script(text))


# The scripts that are shipped.


def shipped() -> list[Path]:
    return sorted(SCRIPTS.glob("with_*.mjs"))


@pytest.mark.parametrize("file", shipped(), ids=lambda file: file.stem)
def test_a_script_has_a_lock_of_what_it_pins(file: Path) -> None:
    """Each lock has the versions of its script, a hash for every package, and no address."""
    script, text = read_script(file), lock_of(file).read_text()
    packages = json.loads(text)["packages"]
    assert packages.pop("")["dependencies"] == dict(p.rsplit("@", 1) for p in script.requirements)
    assert all(package["integrity"].startswith("sha512-") for package in packages.values())
    assert "resolved" not in text
    assert "://" not in text


@pytest.mark.parametrize("file", shipped(), ids=lambda file: file.stem)
def test_a_script_loads_no_library_to_begin_with(file: Path) -> None:
    """Imports before a script runs are of node and of the shared file: no fault lacks a sentence."""
    text = file.read_text()
    imported = set(re.findall(r'^import .*? from "(.*)";$', text, re.MULTILINE))
    assert imported - {"node:fs"} == {"./free_body.mjs"}
    (library,) = (pin.rsplit("@", 1)[0] for pin in read_script(file).requirements)
    assert f'"{library}"' in text.partition("\nimport ")[2]


def test_every_lock_has_its_script() -> None:
    """No lock is left behind, and the list knows every script."""
    assert shipped()
    assert {lock_of(file) for file in shipped()} == set(SCRIPTS.glob("*.lock.json"))
    libraries = {one.script.path for one in engines().values()}
    assert libraries >= set(shipped())
