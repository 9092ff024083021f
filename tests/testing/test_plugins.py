"""Plug-ins of other packages: one of each kind is shown and used, a broken one harms nobody."""

from __future__ import annotations

import json
import subprocess
import sys
import tomllib
from collections.abc import Callable, Iterator
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

import taylor_verify
from taylor_verify.cli import main
from taylor_verify.records import plugins
from taylor_verify.scenes.library import named
from taylor_verify.scenes.reading.reader import load
from taylor_verify.solvers.engines.engine import engines
from taylor_verify.solvers.registry import remarks, solver_named
from taylor_verify.testing.contract import BrokenContract, check_reader, keeps_contract

EXAMPLE = Path(__file__).parent / "example"
# Files of a package with a fault in each plug-in, and the words that name it.
BROKEN = {
    "solvers": ("gone = no_such_module:solve", "No module named 'no_such_module'"),
    "readers": ("csv = tv_broken:Csv", "the reader .csv of tv-broken is left out: there is one"),
    "scenes": ("mine = tv_broken:Csv", "to be the path of a folder"),
    "engines": ("none = tv_broken:missing", "to be the path of a script (.py, .mjs, .cpp)"),
    "causes": ("half = tv_broken", "to have candidates, got none"),
}
# Modules whose import, and a reader whose call, ends the program or writes lines of its own.
ENDING = """
import sys
class Log:
    suffixes = (".zzz",)
    def read(self, path):
        sys.exit(0)
log = Log()
def add(parser):
    sys.exit(0)
def run(arguments):
    return "x"
"""
# Verbs: one that answers, one that raises when it is asked, and one that raises before.
VERBS = {
    "echo": """
from taylor_verify.cli.answer import Answer
help = "say a word"
def add(parser):
    parser.add_argument("word")
def run(arguments):
    return Answer(0, {"word": arguments.word}, lambda: arguments.word)
""",
    "late": """
def add(parser):
    parser.add_argument("word")
def run(arguments):
    raise KeyError(arguments.word)
""",
    "early": """
def add(parser):
    raise ZeroDivisionError("no arguments")
def run(arguments):
    return 0
""",
    "broken": "import no_such_module",
    "half": "def add(parser): pass",
}
SOURCE = """
missing = "/nowhere/with_none.py"
class Csv:
    suffixes = (".csv",)
    read = print
"""

Captured = pytest.CaptureFixture[str]
Install = Callable[[str, dict[str, str]], None]


def forget() -> None:
    for cached in (plugins.plugins, plugins.say_once, engines):
        cached.cache_clear()
    for name in [name for name in sys.modules if name.startswith("tv_")]:
        del sys.modules[name]


@pytest.fixture
def install(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Install]:
    """Put a distribution on the path: its name, and the lines of its entry points by kind."""

    def installed(name: str, points: dict[str, str]) -> None:
        info = tmp_path / f"{name.replace('-', '_')}-1.0.dist-info"
        info.mkdir()
        (info / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {name}\nVersion: 1.0\n")
        groups = (f"[taylor_verify.{kind}]\n{lines}\n" for kind, lines in points.items())
        (info / "entry_points.txt").write_text("".join(groups))
        forget()

    monkeypatch.syspath_prepend(str(tmp_path))
    yield installed
    forget()


@pytest.fixture
def verbs(install: Install, tmp_path: Path) -> None:
    """A package with these verbs, and with one of a name of ours."""
    for name, source in VERBS.items():
        (tmp_path / f"tv_{name}.py").write_text(source)
    lines = [*(f"{name} = tv_{name}" for name in VERBS), "run = tv_echo"]
    install("tv-verbs", {"verbs": "\n".join(lines)})


@pytest.fixture
def example(install: Install, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(str(EXAMPLE))
    project = tomllib.loads((EXAMPLE / "pyproject.toml").read_text())["project"]
    points = {
        group.removeprefix("taylor_verify."): "\n".join(f"{k} = {v}" for k, v in entry.items())
        for group, entry in project["entry-points"].items()
    }
    install(project["name"], points)


def test_the_example_is_short() -> None:
    """A package with a plug-in of each kind takes at most 80 lines."""
    files = (file for file in EXAMPLE.rglob("*") if file.suffix in (".py", ".toml"))
    assert sum(len(file.read_text().splitlines()) for file in files) <= 80


@pytest.mark.usefixtures("example")
def test_each_plugin_keeps_its_contract() -> None:
    """The author's own call uses each of them once, and a distribution without plug-ins is a fault."""
    uses = "solvers tops, readers rows, scenes mine, engines still, causes jet, verbs hello"
    assert keeps_contract("tv-example") == uses.split(", ")
    with pytest.raises(BrokenContract, match="got none"):
        keeps_contract("no-such-distribution")


@pytest.mark.usefixtures("example")
def test_list_names_what_is_installed_and_its_package(capsys: Captured) -> None:
    """Each plug-in stands beside ours, with its package; --json has both."""
    assert main(["list"]) == 0
    lines = capsys.readouterr().out.splitlines()
    for name in ("tops", ".rows", "mine/top", "outside:still"):
        assert any(line.split()[:1] == [name] for line in lines), name
    assert sum("of the package tv-example" in line for line in lines) >= 9
    assert main(["list", "--json"]) == 0
    document = json.loads(capsys.readouterr().out)
    assert document["plugins"]["readers"] == {"rows": "tv-example"}
    assert document["added"] == ["mine/top"]
    assert not {"mine/top"} & {*document["scenes"]}


@pytest.mark.usefixtures("example")
def test_its_solver_answers_its_scene(capsys: Captured) -> None:
    """`run NAME/stem --solver NAME` judges it; a folder stands for its scenes."""
    assert named("mine") == ("mine/top",)
    assert main(["run", "mine/top", "--solver", "tops", "--tolerance", "1e-9"]) == 0
    assert main(["hello", "you"]) == 0
    assert capsys.readouterr().out.endswith("hello you\n")


@pytest.mark.usefixtures("example")
def test_its_reader_reads_a_file_and_its_cause_is_proven(tmp_path: Path) -> None:
    """Rows that move as the changed scene does are explained by its title, and by no other of its."""
    scene = load("mine/top")
    jet = (Fraction(0), Fraction(0), Fraction(1, 64))
    motion = taylor_verify.exact(replace(scene, body=replace(scene.body, moment=jet)), range(3), 20)
    rows = np.column_stack([range(3), motion["omega"].astype(float)])
    file = tmp_path / "mine.rows"
    file.write_text("t w1 w2 w3\n" + "\n".join(" ".join(map(repr, row)) for row in rows.tolist()))
    import tv_example

    check_reader(tv_example, file)
    judged = taylor_verify.check("mine/top", file, tolerance=1e-9)
    assert not judged.passed
    assert "read by rows of the package tv-example" in judged.notes
    assert "the jet was on" in [cause.name for cause in judged.causes]


@pytest.mark.usefixtures("example")
def test_its_engine_and_its_files_stand_on_the_board(tmp_path: Path, capsys: Captured) -> None:
    """`board add` judges the engine of a package, and files that its reader reads, on a local copy."""
    scene = load("engines/oblique")
    omega = taylor_verify.exact(scene, scene.clock.instants, 20)["omega"].astype(float)
    rows = np.column_stack([[float(t) for t in scene.clock.instants], omega])
    lines = (" ".join(map(repr, row)) for row in rows.tolist())
    (tmp_path / "oblique.rows").write_text("\n".join(["t w1 w2 w3", *lines]))
    place = ["--board", "engines", "--scene", "engines/oblique", "--from", str(tmp_path), "--json"]
    for name, source in (
        ("plugged", ["--solver", "outside:still"]),
        ("filed", ["--files", str(tmp_path)]),
    ):
        assert main(["board", "add", name, *source, *place]) == 0
        (row,) = json.loads(capsys.readouterr().out)["rows"]
        assert (row["engine"], row["standing"]) == (name, "judged")
    assert row["errors"]["omega"] < 1e-15


def test_a_broken_plugin_is_named_in_one_line_and_harms_nobody(
    install: Install, tmp_path: Path, capsys: Captured, caplog: pytest.LogCaptureFixture
) -> None:
    """Each fault is one line with the package, once, and `list` goes on with all of ours."""
    (tmp_path / "tv_broken.py").write_text(SOURCE)
    install("tv-broken", {kind: line for kind, (line, _) in BROKEN.items()})
    assert main(["list", "--json"]) == 0
    assert "taylor" in json.loads(capsys.readouterr().out)["solvers"]
    remarks()
    messages = [record.getMessage() for record in caplog.records]
    for _, words in BROKEN.values():
        (line,) = (message for message in messages if words in message)
        assert "tv-broken" in line
        assert "\n" not in line
    with pytest.raises(BrokenContract, match="No module named"):
        keeps_contract("tv-broken")


def test_a_scene_that_cannot_be_read_is_left_out(
    install: Install, tmp_path: Path, capsys: Captured, caplog: pytest.LogCaptureFixture
) -> None:
    """`list` names it in one line, and goes on with the others of its folder."""
    folder = tmp_path / "scenes"
    folder.mkdir()
    (folder / "broken.toml").write_text("no document")
    (folder / "rest.toml").write_bytes(Path("cases/euler/rest.toml").read_bytes())
    (tmp_path / "tv_scenes.py").write_text(f"folder = {str(folder)!r}")
    install("tv-scenes", {"scenes": "mine = tv_scenes:folder"})
    assert main(["list", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["added"] == ["mine/rest"]
    assert any("mine/broken is left out" in record.getMessage() for record in caplog.records)


def test_what_ends_the_program_is_no_pass(
    install: Install, tmp_path: Path, capsys: Captured
) -> None:
    """sys.exit(0) in a plug-in, in a module or in a function gives status 2 and a line."""
    (tmp_path / "tv_ending.py").write_text(ENDING)
    (tmp_path / "tv_exits.py").write_text("import sys\nsys.exit(0)\n")
    (tmp_path / "tv_ends.py").write_text("import os\ndef solve(problem):\n    os._exit(0)\n")
    (tmp_path / "mine.zzz").write_text("")
    install("tv-ending", {"readers": "log = tv_ending:log", "verbs": "fly = tv_ending"})
    for call in (
        ["check", str(tmp_path / "mine.zzz"), "--scene", "euler/spherical"],
        ["run", "euler/spherical", "--solver", "python:tv_exits:f"],
        ["run", "euler/spherical", "--solver", "python:tv_ends:solve"],
        ["fly"],
    ):
        assert main(call) == 2, call
        assert capsys.readouterr().err.startswith("taylor-verify: ")


def test_a_garbled_list_of_entry_points_harms_nobody(
    install: Install, tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    """The package is named, in one line also where its words have more, and the others are there."""
    (tmp_path / "tv_loud.py").write_text('raise RuntimeError("x\\n::error::boo")\n')
    install("tv-garbled", {"solvers": "mine\n = x\n:::"})
    install("tv-sound", {"solvers": "same = math:sin\nloud = tv_loud:f\nstrange = math:y z"})
    assert "same" in [plugin.name for plugin in plugins.plugins("solvers")]
    assert "the entry points of tv-garbled cannot be read" in caplog.text
    messages = [record.getMessage() for record in caplog.records]
    assert any(r"RuntimeError: x\n::error::boo" in message for message in messages)
    assert any("to be module:object, got 'math:y z'" in message for message in messages)


def test_of_two_packages_with_one_name_the_first_counts(
    install: Install, caplog: pytest.LogCaptureFixture
) -> None:
    """Packages come in the order of their names; a name of ours is never taken."""
    install("tv-one", {"solvers": "same = math:sin\ntaylor = math:cos"})
    install("tv-two", {"solvers": "same = math:cos"})
    (same,) = (plugin for plugin in plugins.plugins("solvers") if plugin.name == "same")
    assert same.package == "tv-one"
    assert "the solver same of tv-two is left out" in caplog.text
    assert "same" in remarks()
    assert type(solver_named("taylor")).__name__ == "Taylor"
    assert "the solver taylor of tv-one is left out" in caplog.text


@pytest.mark.usefixtures("verbs")
@pytest.mark.parametrize(
    ("words", "why"),
    [
        ("broken", "expected the verb broken of tv-verbs, got ModuleNotFoundError: No module"),
        ("half", "expected the verb half of tv-verbs to have run, got none"),
        ("late x", "expected an answer of the verb late of tv-verbs, got KeyError: 'x'"),
        ("early", "expected arguments of the verb early of tv-verbs, got ZeroDivisionError: no"),
    ],
)
def test_a_verb_that_is_broken_is_named_in_one_line(words: str, why: str, capsys: Captured) -> None:
    """Exit status 2, with the verb, its package and the fault; another verb answers all the same."""
    assert main(words.split()) == 2
    *_, line = capsys.readouterr().err.splitlines()
    assert why in line
    assert main(["echo", "hello"]) == 0
    assert capsys.readouterr().out == "hello\n"


@pytest.mark.usefixtures("verbs")
def test_nobody_takes_our_verbs(capsys: Captured) -> None:
    """A verb of a name that is taken is left out, help and `list` say so in a line, and ours answers."""
    assert main(["run", "euler/rest"]) == 0
    with pytest.raises(SystemExit):
        main(["--help"])
    out, error = capsys.readouterr()
    assert "a verb of the package tv-verbs" in out
    assert "the verb run of tv-verbs is left out" in error
    assert main(["list", "--json"]) == 0
    out, error = capsys.readouterr()
    assert "the verb run of tv-verbs is left out" in error
    assert "run" not in json.loads(out)["plugins"]["verbs"]


@pytest.mark.slow
def test_the_example_is_installed_by_pip(tmp_path: Path) -> None:
    """An environment of its own has the package, and `list` there names it."""
    folder = tmp_path / "site"
    command = ["uv", "pip", "install", "--no-deps", "--target", str(folder), str(EXAMPLE)]
    subprocess.run([sys.executable, "-m", *command], check=True, capture_output=True)
    paths = f"import sys; sys.path[:0] = [{str(folder)!r}]; "
    call = "from taylor_verify.testing.contract import keeps_contract; print(keeps_contract('tv-example'))"
    shown = subprocess.run(
        [sys.executable, "-c", paths + call], check=True, capture_output=True, text=True
    )
    assert shown.stdout.count("'") == 12
