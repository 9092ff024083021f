"""Help where people are: a greeting, the near word, the usage of the verb, patterns."""

from __future__ import annotations

import re
import shlex
import sys
from pathlib import Path

import pytest
from builders.scenes import LISTED_INSTANTS

from taylor_verify.cli import main
from taylor_verify.cli.arguments import parse
from taylor_verify.records.version import __version__
from taylor_verify.scenes import library

ROOT = Path(__file__).resolve().parents[2]

Captured = pytest.CaptureFixture[str]


def refusal(capsys: Captured, *arguments: str) -> str:
    """What a call that cannot be read prints on stderr; it ends with status 2 and an empty stdout."""
    with pytest.raises(SystemExit) as ended:
        main(arguments)
    out, error = capsys.readouterr()
    assert (ended.value.code, out) == (2, "")
    return error


def test_a_call_without_a_verb_greets_with_three_commands(
    capsys: Captured, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Calls of the greeting on a terminal can be typed, and are of a use that the README has too."""
    monkeypatch.delenv("CI", raising=False)
    monkeypatch.setattr(sys.stdout, "isatty", lambda: True)
    assert main([]) == 0
    out, error = capsys.readouterr()
    commands = [line.strip() for line in out.splitlines() if line.startswith("    taylor-verify ")]
    verbs = [shlex.split(command)[1] for command in commands]
    assert verbs == ["check", "run", "exact"]
    for command in commands:
        assert callable(parse(shlex.split(command)[1:]).act)
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    assert all(re.search(rf"^(\$ )?taylor-verify {verb} ", readme, re.MULTILINE) for verb in verbs)
    assert __version__ in out
    assert error == ""


def test_a_call_without_a_verb_in_a_pipe_is_an_error_of_usage(capsys: Captured) -> None:
    """A forgotten verb in a script or a CI is no success; the verbs are named."""
    assert "expected a verb, got none (list, scene, question, run" in refusal(capsys)


def test_the_version_is_printed(capsys: Captured) -> None:
    """`--version` prints name and version, and ends with status 0."""
    with pytest.raises(SystemExit) as ended:
        main(["--version"])
    assert ended.value.code == 0
    assert capsys.readouterr().out == f"taylor-verify {__version__}\n"


@pytest.mark.parametrize(
    ("word", "meant"),
    [("rnu", "run"), ("chekc", "check"), ("exactly", "exact"), ("sweeps", "sweep")],
)
def test_a_wrong_verb_suggests_the_near_one(capsys: Captured, word: str, meant: str) -> None:
    """The message names the word and the verb that is like it."""
    assert f"expected a verb, got {word} (did you mean {meant}" in refusal(capsys, word, "x")


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["run", "euler/rest", "--jbos", "3"], "got --jbos (did you mean --jobs"),
        (
            ["exact", "euler/rest", "--at", "1", "--digit=5"],
            "got --digit=5 (did you mean --digits?)",
        ),
        (["list", "--zzz"], "got --zzz (there is none like it)"),
        (["exact", "euler/rest", "euler/apollo", "--at", "1"], "got euler/apollo"),
        (["run", "euler/rest", "--jobs", "x"], "expected a whole number, got 'x' @ --jobs"),
        (["run", "euler/rest", "--gate", "x"], "got 'x' @ --gate"),
        (["exact", "euler/rest", "--at=--"], "expected a value, got -- @ --at"),
        (["run", "euler/rest", "--tolerance=--"], "expected a value, got -- @ --tolerance"),
        (["check", "mine.csv"], "expected --scene, got none"),
        (["run", "euler/rest", "--color", "red"], "'always', 'never', got 'red' @ --color"),
        (["run", "euler/rest", "--resume=3"], "expected no value, got '3' @ --resume"),
        (["exact", "euler/rest", "--at", "1", "--dig", "5"], "got --dig"),
        (["draw"], "expected SCENE, got none"),
    ],
)
def test_an_error_of_an_option_shows_the_usage_of_its_verb(
    capsys: Captured, arguments: list[str], message: str
) -> None:
    """The usage is that of the verb, with its options, and the message names the fault."""
    error = refusal(capsys, *arguments)
    assert error.startswith(f"usage: taylor-verify {arguments[0]} [-h]")
    assert message in error


# Patterns.


def test_a_pattern_is_the_scenes_that_it_fits() -> None:
    """A star stands for any letters; a pattern that nothing fits stays what it was."""
    middle = library.named("euler/*middle*")
    assert len(middle) > 1
    assert set(middle) == {name for name in library.names("euler") if "middle" in name}
    assert library.named("extremes/worst/*") == library.names(library.WORST)
    assert library.named("euler/ap?ll[o]") == ("euler/apollo",)
    assert library.named("zz*") == ("zz*",)


def test_a_pattern_of_files_is_those_files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A shell that expands nothing passes it on as it is; a file that is named like a pattern is a file."""
    monkeypatch.chdir(tmp_path)
    for name in ("b.toml", "a.toml", "[c].toml"):
        Path(name).write_text(LISTED_INSTANTS)
    assert library.named("?.toml") == ("a.toml", "b.toml")
    assert library.named("[c].toml") == ("[c].toml",)


@pytest.mark.parametrize(
    "call",
    ["exact {} --at 0", "question {}", "explain {}", "run {}", "draw {} --only time", "sweep {}"],
)
def test_every_verb_takes_a_pattern(
    call: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """One that fits a single scene is that scene."""
    monkeypatch.chdir(tmp_path)
    assert main(call.format("euler/spherical*").split()) == 0


@pytest.mark.parametrize("call", ["exact {} --at 1", "question {}", "explain {}", "draw {}"])
def test_a_verb_of_one_scene_refuses_several(call: str, capsys: Captured) -> None:
    """The scenes that a pattern or a folder stands for are named, the first of them."""
    for word in ("euler/*middle*", "euler"):
        assert main(call.format(word).split()) == 2
        first = library.named(word)[0]
        error = capsys.readouterr().err
        assert f"expected one scene, got {first}, " in error
        assert error.endswith(f"@ {word}\n")


def test_a_pattern_that_nothing_fits_is_refused(capsys: Captured) -> None:
    """No run passes for want of scenes."""
    for verb in ("run", "tradeoff", "explain"):
        assert main([verb, "euler/zz*"]) == 2
        assert "got euler/zz* (no scene fits the pattern" in capsys.readouterr().err


@pytest.mark.parametrize("call", ["run {}", "exact {} --at 0", "draw {}"])
def test_a_folder_of_one_s_own_is_no_scene(
    call: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Captured
) -> None:
    """It is refused with the pattern of the scenes in it."""
    monkeypatch.chdir(tmp_path)
    Path("mine").mkdir()
    assert main(call.format("mine").split()) == 2
    assert "got mine (it is a folder: name the scenes in it, 'mine/*.toml')" in (
        capsys.readouterr().err
    )
