"""The verb `board`: what it shows, and one's own engine on a local copy of a board."""

from __future__ import annotations

import argparse
import json
import shutil
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from typing import Any

import pytest

from taylor_verify import check
from taylor_verify.cli.answer import WrongCall
from taylor_verify_reports.studies.engines import measure, own, replay
from taylor_verify_reports.verbs import board

ADD = ["add", "mine", "--board", "engines", "--scene", "engines/oblique"]
SOLVER = ["--solver", "geometric:lie-rk4?step={step}", "--steps", "0.5,0.25"]


@pytest.fixture(scope="module", autouse=True)
def _in_this_process() -> Iterator[None]:
    """Runs are made in this process, and no cause is looked for."""

    def run_all(work: Callable[..., Any], asked: list[Any], **options: Any) -> list[Any]:
        results = [work(some) for some in asked]
        for some, result in zip(asked, results, strict=True):
            options["ended"](some, result)
        return results

    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(measure, "run_all", run_all)
        patched.setattr(own, "check", partial(check, tolerance=0.9))
        patched.setattr(replay, "with_causes", lambda result, *others: result)
        yield


@pytest.fixture(scope="module")
def added(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Any]:
    """A report folder with one's own engine, and the answer of the call."""
    folder = tmp_path_factory.mktemp("reports")
    return folder, called(folder, *ADD, *SOLVER)


@pytest.fixture
def folder(added: tuple[Path, Any], tmp_path: Path) -> Path:
    """A copy of that folder."""
    return Path(shutil.copytree(added[0], tmp_path / "copy"))


def called(folder: Path, *words: str) -> Any:
    parser = argparse.ArgumentParser()
    board.add(parser)
    return board.run(parser.parse_args([*words, "--from", str(folder)]))


def rows_of(folder: Path) -> list[dict[str, Any]]:
    rows: list[dict[str, Any]] = called(folder, "--board", "engines").document["boards"][0]["rows"]
    return rows


def test_an_engine_of_ones_own_stands_on_a_copy(added: tuple[Path, Any]) -> None:
    """The page and the sheet below reports/local have its rows, and the message says how to send them."""
    folder, answer = added
    assert answer.status == 0
    assert [row["value"] for row in answer.document["rows"]] == ["0.5", "0.25"]
    (page,) = answer.document["pages"]
    assert Path(page) == folder / own.LOCAL / "engines.md"
    text = Path(page).read_text(encoding="utf-8")
    assert "take **mine** with geometric:lie-rk4?step=h and a step of 0.25: omega" in text
    assert (folder / own.LOCAL / "engines.csv").read_text(encoding="utf-8").count(",mine,") == 2
    assert "To send it" in answer.messages[0]
    assert not (folder / "data").exists()


def test_each_row_leads_to_a_file_that_check_judges(folder: Path) -> None:
    """The file of a row is judged to the error of the row."""
    for row in rows_of(folder):
        verdicts = check("engines/oblique", folder / row["file"], tolerance=0.9).verdicts
        errors = {verdict.quantity: verdict.max for verdict in verdicts}
        assert errors["attitude"] == pytest.approx(row["errors"]["attitude"], rel=1e-3)
        written = folder / "one.json"
        called(folder, "--board", "engines", "--row", str(row["row"]), "--out", str(written))
        columns = json.loads(written.read_text(encoding="utf-8"))
        assert columns["w1"] == json.loads((folder / row["file"]).read_text())["w1"]


def test_what_is_stored_is_not_run_again(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A second call runs nothing; with another step it runs that one."""
    messages: list[str] = []
    monkeypatch.setattr(board, "say", messages.append)
    called(folder, *ADD, *SOLVER)
    assert messages == []
    called(folder, *ADD, *SOLVER[:-1], "0.25,0.125")
    assert [words.partition(" ")[0] for words in messages] == ["1/1", "1"]
    assert len(rows_of(folder)) == 3


def test_files_take_the_place_of_an_engine(folder: Path) -> None:
    """A file for a scene is judged with its conventions and copied beside its row; a folder is a step."""
    row = rows_of(folder)[0]
    place = folder / "results" / "0.5"
    place.mkdir(parents=True)
    (place / "oblique.json").write_bytes((folder / row["file"]).read_bytes())
    files = ["--files", str(folder / "results"), "--steps", "0.5"]
    answer = called(folder, "add", "filed", *ADD[2:], *files)
    (filed,) = answer.document["rows"]
    assert filed["errors"]["omega"] == row["errors"]["omega"]
    assert "the file oblique.json" in filed["detail"]
    stored = next(row for row in rows_of(folder) if row["engine"] == "filed")
    assert (folder / stored["file"]).read_bytes() == (place / "oblique.json").read_bytes()
    with pytest.raises(WrongCall, match="expected a row that an engine makes, got the file"):
        called(folder, "--board", "engines", "--row", str(stored["row"]))


def test_all_faults_of_a_call_are_named() -> None:
    """Name, solver, steps, scene and folder are each named with what was expected."""
    words = "add MuJoCo --board engines --steps 0,x --solver nobody --scene a"
    with pytest.raises(WrongCall) as error:
        called(Path(), *words.split())
    messages = "\n".join(error.value.faults)
    for part in (
        "expected a name of small letters, digits, - and _, got 'MuJoCo'",
        "expected {step} in the solver of several steps",
        "expected a positive step, got '0'",
        "expected a positive step, got 'x'",
        "expected a solver",
        "expected a scene of the board, got 'a'",
    ):
        assert part in messages


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        (["add", "mujoco", "--solver", "taylor"], "a name that no board has"),
        (["add", "mine"], "--solver or --files, got neither"),
        (["--solver", "taylor"], "--solver with `board add NAME`"),
        (["--board", "planes"], "one of engines, satellite, underwater"),
        (["--row", "0"], "--board with --row"),
        (["show"], "`board` or `board add NAME`"),
    ],
    ids=str,
)
def test_a_wrong_call_is_refused(words: list[str], expected: str, tmp_path: Path) -> None:
    """The error says what was expected."""
    with pytest.raises(WrongCall, match=f"expected {expected}"):
        called(tmp_path, *words)
