"""Verbs of other packages: entry points, with one line for each that is broken."""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from taylor_verify.cli import main

GOOD = """
from taylor_verify.cli.answer import Answer
help = "say a word"
example = "echo word"
def add(parser):
    parser.add_argument("word")
def run(arguments):
    return Answer(0, {"word": arguments.word}, lambda: arguments.word)
"""
RAISING = """
def add(parser):
    parser.add_argument("word")
def run(arguments):
    raise KeyError(arguments.word)
"""
RAISING_EARLY = """
def add(parser):
    raise ZeroDivisionError("no arguments")
def run(arguments):
    return 0
"""
ENTRIES = """[taylor_verify.verbs]
early = plugged_early
late = plugged_late
echo = plugged_echo
broken = plugged_broken
half = plugged_half
run = plugged_echo
"""


@pytest.fixture
def plugged(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """A distribution with a verb, one that cannot be imported, half a verb, and one of our names."""
    (tmp_path / "plugged_echo.py").write_text(GOOD, encoding="utf-8")
    (tmp_path / "plugged_broken.py").write_text("import no_such_module\n", encoding="utf-8")
    (tmp_path / "plugged_half.py").write_text("def add(parser): pass\n", encoding="utf-8")
    (tmp_path / "plugged_late.py").write_text(RAISING, encoding="utf-8")
    (tmp_path / "plugged_early.py").write_text(RAISING_EARLY, encoding="utf-8")
    info = tmp_path / "plugged-1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: plugged\nVersion: 1.0\n")
    (info / "entry_points.txt").write_text(ENTRIES)
    monkeypatch.syspath_prepend(str(tmp_path))
    yield
    for name in ("echo", "broken", "half", "late", "early"):
        sys.modules.pop(f"plugged_{name}", None)


@pytest.mark.usefixtures("plugged")
def test_a_verb_of_another_package_answers(capsys: pytest.CaptureFixture[str]) -> None:
    """It has arguments, --json and help of its own, and is listed with its package."""
    assert main(["echo", "hello"]) == 0
    assert capsys.readouterr().out == "hello\n"
    assert main(["echo", "hello", "--json"]) == 0
    assert '"word": "hello"' in capsys.readouterr().out
    with pytest.raises(SystemExit):
        main(["--help"])
    assert "a verb of the package plugged" in capsys.readouterr().out


@pytest.mark.usefixtures("plugged")
@pytest.mark.parametrize(
    ("verb", "why"), [("broken", "ModuleNotFoundError"), ("half", "to have run")]
)
def test_a_broken_verb_is_named_in_one_line(
    verb: str, why: str, capsys: pytest.CaptureFixture[str]
) -> None:
    """Exit status 2, with the verb, its package and the fault."""
    assert main([verb]) == 2
    (line,) = capsys.readouterr().err.splitlines()[-1:]
    assert f"the verb {verb} of plugged" in line
    assert why in line


@pytest.mark.usefixtures("plugged")
@pytest.mark.parametrize(
    ("words", "why"),
    [
        (
            ["late", "hello"],
            "expected an answer of the verb late of plugged, got KeyError: 'hello'",
        ),
        (["early"], "expected arguments of the verb early of plugged, got ZeroDivisionError: no"),
    ],
)
def test_a_verb_that_raises_is_named_in_one_line(
    words: list[str], why: str, capsys: pytest.CaptureFixture[str]
) -> None:
    """Exit status 2, with the verb, its package and the error; a word of another verb loads none."""
    assert main(words) == 2
    *_, line = capsys.readouterr().err.splitlines()
    assert why in line
    assert main(["echo", words[0]]) == 0
    assert capsys.readouterr().out == f"{words[0]}\n"


@pytest.mark.usefixtures("plugged")
def test_nobody_takes_our_verbs(capsys: pytest.CaptureFixture[str]) -> None:
    """A verb of a name that is taken is left out, help says so in a line, and ours answers."""
    assert main(["run", "euler/rest"]) == 0
    with pytest.raises(SystemExit):
        main(["--help"])
    assert "the verb run of plugged is left out" in capsys.readouterr().err
    assert main(["list", "--json"]) == 0
    out, error = capsys.readouterr()
    assert "the verb run of plugged is left out" in error
    assert "run" not in json.loads(out)["plugins"]["verbs"]
