"""Names that mean harm: no terminal is steered, no runner commanded and no spreadsheet made to compute."""

from __future__ import annotations

import csv
import io
import json
import re
from contextlib import suppress
from pathlib import Path

import pytest
from builders.scenes import LISTED_INSTANTS
from rich.table import Table
from rich.text import Text

from taylor_verify.cli import main
from taylor_verify.cli.console import EscapingConsole, Page
from taylor_verify.records.escapes import escaped
from taylor_verify.report import csv_tables as sheets

# Clear the screen, ring, a title for the window, the same in C1, and a turn of the direction.
STEERING = "\x1b[2J\x07\x1b]0;x\x07\x9b31m\u202e"
CONTROL = re.compile("[\x00-\x08\x0b-\x1f\x7f-\x9f\u202a-\u202e\u2028\u2029]")

Captured = pytest.CaptureFixture[str]


def printed(capsys: Captured) -> str:
    streams = capsys.readouterr()
    return streams.out + streams.err


@pytest.fixture
def steering_scene(tmp_path: Path) -> Path:
    """A scene whose file, title and source are hostile."""
    file = tmp_path / f"a{STEERING}b.toml"
    title = json.dumps(f"title {STEERING}")
    text = re.sub(r"title = .*", lambda _: f"title = {title}\nsource = {title}", LISTED_INSTANTS)
    file.write_text(text)
    return file


@pytest.mark.parametrize("verb", ["run", "explain", "exact"])
def test_no_name_reaches_the_terminal_raw(
    verb: str, steering_scene: Path, capsys: Captured
) -> None:
    """Scene, title and source are shown, with an escape for each control character."""
    main([verb, str(steering_scene), *(["--at", "1"] if verb == "exact" else [])])
    shown = printed(capsys)
    assert r"\x1b[2J" in shown
    assert not CONTROL.search(shown)


def test_no_file_or_column_reaches_the_terminal_raw(tmp_path: Path, capsys: Captured) -> None:
    """So are the name of a file and of its columns, judged or refused."""
    file = tmp_path / f"a{STEERING}.csv"
    for content in ("t,w1,w2,w3\n0,1,2,3\n", f"t,w1,w2,w3,{STEERING}\n0,1,2,3,4\n"):
        file.write_text(content)
        main(["check", str(file), "--scene", "euler/generic"])
        shown = printed(capsys)
        assert r"\x1b[2J" in shown
        assert not CONTROL.search(shown)


def test_json_holds_no_control_character(steering_scene: Path, capsys: Captured) -> None:
    """The document has the name as it is shown everywhere."""
    named = steering_scene.rename(steering_scene.with_name("a\x7f\x1bb.toml"))
    main(["exact", str(named), "--at", "1", "--json"])
    document = capsys.readouterr().out
    assert not CONTROL.search(document)
    assert json.loads(document)["scene"] == escaped(str(named))


def test_words_of_the_call_are_escaped_when_repeated(capsys: Captured) -> None:
    """The message of argparse on a word that it does not know is harmless too."""
    with pytest.raises(SystemExit):
        main(["run", "euler/generic", "--bogus", STEERING])
    assert not CONTROL.search(printed(capsys))


# What a runner of GitHub obeys, at the beginning of a line or anywhere.
COMMANDS = "a\n::error::b\n  ::add-mask::c ##[add-mask]d"
COMMAND = re.compile(r"^\s*::|##\[", re.MULTILINE)


@pytest.fixture
def commanding_scene(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> str:
    """A scene whose file and title are commands to a runner, in the current folder."""
    monkeypatch.chdir(tmp_path)
    text = LISTED_INSTANTS.replace('title = "', f"title = {json.dumps(COMMANDS)} # ")
    Path(f"{COMMANDS}.toml").write_text(text)
    return f"{COMMANDS}.toml"


@pytest.mark.parametrize(
    ("verb", "options"),
    [
        ("run", ["--rung", "f64", "--out", f"{COMMANDS}.out", "--junit", f"{COMMANDS}.xml"]),
        ("run", [COMMANDS]),
        ("run", ["--solver", COMMANDS]),
        ("explain", []),
        ("exact", ["--at", "1"]),
        ("exact", ["--at", COMMANDS]),
        ("exact", ["--at", "1", "--json"]),
        ("question", []),
        ("draw", ["--out", f"{COMMANDS}.svg", "--only", "momentum"]),
    ],
)
def test_no_name_commands_a_runner(
    verb: str, options: list[str], commanding_scene: str, capsys: Captured
) -> None:
    """A line feed in a name, an option or a title is shown as its escape, and begins no line of ours."""
    with suppress(SystemExit):
        main([verb, commanding_scene, *options])
    shown = printed(capsys)
    assert re.search(r"a\\+n", shown)
    assert not COMMAND.search(shown)


def test_only_our_own_lines_command_a_runner(
    commanding_scene: str, tmp_path: Path, capsys: Captured
) -> None:
    """The annotations of --github are ours alone, and the names in them and in JUnit are escaped."""
    file = tmp_path / f"{COMMANDS}.csv"
    file.write_text("t,w1,w2,w3\n0,1,2,3\n")
    junit = tmp_path / "junit.xml"
    main(
        ["check", str(file), "--scene", commanding_scene, "--github", "--junit", str(junit)],
    )
    shown = printed(capsys)
    lines = [line for line in shown.splitlines() if COMMAND.search(line)]
    assert lines
    assert all(re.match(r"::(error|warning) (file|title)=", line) for line in lines)
    assert not COMMAND.search(junit.read_text())


def test_styles_are_the_consoles_own() -> None:
    """The console colours its own words, and escapes those of a text, a table and a status alike."""
    table = Table(STEERING)
    table.add_row(Text(STEERING))
    stream = io.StringIO()
    console = EscapingConsole(
        file=stream, force_terminal=True, color_system="standard", markup=False
    )
    console.print(Text(STEERING, "bold red"), table, STEERING)
    own = re.sub(r"\x1b\[[0-9;]*m", "", stream.getvalue())
    assert "\x1b[1;31m" in stream.getvalue()
    assert not CONTROL.search(own)


def test_text_without_control_characters_is_left_alone() -> None:
    """Tabs, line breaks, accents and mathematics stay as they are."""
    text = "ω = 1\tε\nfin d'été"
    assert escaped(text) == text
    page = Page()
    page.line(text)
    assert page.text().startswith("ω = 1")


# Spreadsheets.


@pytest.mark.parametrize(
    "name", ["=1+1", "+1+1", "-1+1", "@SUM(A1)", "\t=1+1", "=cmd|' /C calc'!A0"]
)
def test_no_cell_begins_a_formula(name: str) -> None:
    """A name that a spreadsheet would compute has an apostrophe before it."""
    (heading, cells) = csv.reader(io.StringIO(sheets.sheet(["scene"], [{"scene": name}])))
    assert heading == ["scene"]
    assert cells == ["'" + name.strip()]
