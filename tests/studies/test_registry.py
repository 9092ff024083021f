"""A study that is registered is measured, listed, told, drawn and packed by what goes through the list."""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from math import log
from pathlib import Path
from typing import TYPE_CHECKING

import pytest
from builders.verdicts import row

from taylor_verify import run
from taylor_verify.cli import main
from taylor_verify.plotting.picture import Picture
from taylor_verify.records import store
from taylor_verify.records.replacement import replace_files
from taylor_verify.words.page_parts import MADE_BY
from taylor_verify_reports.studies import bulk, registry
from taylor_verify_reports.studies.engines.board_studies import STUDY as ENGINES
from taylor_verify_reports.studies.engines.entry import BOARDS
from taylor_verify_reports.studies.registry import STUDIES
from taylor_verify_reports.studies.stored import Stored
from taylor_verify_reports.studies.study import (
    Bulk,
    Measured,
    NotMeasured,
    Option,
    Progress,
    Published,
    Study,
)

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Captured = pytest.CaptureFixture[str]


# The smallest study: a document of one number, a page, a picture and a file that is not committed.


@dataclass(frozen=True)
class Sum:
    terms: int
    value: float


SUM = Stored(Sum, "smallest")


def measure(folder: Path, progress: Progress, terms: int = 3) -> Measured:
    if terms == 13:
        raise NotMeasured("expected another number than 13, got it")
    finished = progress.counting(terms)
    for k in range(terms):
        finished(f"term {k}")
    odd = terms % 2
    return Measured(SUM.write(folder, Sum(terms, 0.5 * terms)), ["it is odd"] * odd, odd)


def page(document: Sum, folder: Path) -> str:
    assert folder.is_dir()
    return f"{MADE_BY}\n# {document.value}\n"


def sheet(document: Sum) -> str:
    return f"terms,logarithm\n{document.terms},{log(document.terms)}\n"


def draw(document: Sum) -> list[Picture]:
    def figure() -> Figure:
        from matplotlib.figure import Figure

        return Figure()

    return [Picture(f"smallest-{document.terms}", "a sum", "nothing is seen", figure)]


def lacking(report: Published) -> list[str]:
    name = "data/smallest/big.txt"
    return [] if (report.folder / name).exists() else [name]


def make(folder: Path, names: list[str], progress: Progress) -> tuple[Path, ...]:
    del progress
    return replace_files(folder, dict.fromkeys(names, "big\n"))


SMALLEST = Study(
    name="smallest",
    title="the smallest study there can be",
    duration="no time",
    measure=measure,
    find=SUM.find,
    page=page,
    sheet=sheet,
    draw=draw,
    needs_heyoka=False,
    options=(Option("terms", "so many terms", int),),
    bulk=(Bulk("big files", ("data/smallest/",), lacking, make),),
)


@pytest.fixture(autouse=True)
def registered() -> Iterator[None]:
    STUDIES.append(SMALLEST)
    yield
    STUDIES.remove(SMALLEST)


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The reports of something that is taken for a checkout."""
    monkeypatch.setattr("taylor_verify_reports.verbs.checkout._checkout", lambda place: place)
    return tmp_path / "reports"


def call(folder: Path, *words: str) -> int:
    return main(["publish", *words, "--from", str(folder)])


# What goes through the list.


def test_a_study_is_listed(capsys: Captured) -> None:
    """The list has title, duration and need of heyoka of each study; as JSON too."""
    assert main(["publish", "--list"]) == 0
    text = capsys.readouterr().out
    assert "smallest    the smallest study there can be\n" in text
    assert "no time; works without heyoka" in text
    assert main(["publish", "--list", "--json"]) == 0
    rows = json.loads(capsys.readouterr().out)["studies"]
    assert [row["name"] for row in rows] == [study.name for study in STUDIES]
    assert rows[-1] == {
        "name": "smallest",
        "title": "the smallest study there can be",
        "duration": "no time",
        "needs_heyoka": False,
        "options": {"terms": "so many terms"},
    }


def test_a_study_is_measured_drawn_and_told(folder: Path, capsys: Captured) -> None:
    """Document, page, sheet and picture are written and named; each step is reported on stderr."""
    assert call(folder, "smallest", "--terms", "4", "--json") == 0
    out, err = capsys.readouterr()
    names = [Path(name).relative_to(folder).as_posix() for name in json.loads(out)["written"]]
    assert names == [
        "data/smallest.json",
        "figures/smallest-4.svg",
        "figures/smallest-4.pdf",
        "tables/smallest.md",
        "tables/smallest.csv",
    ]
    assert "4/4 term 3" in err
    stored = json.loads((folder / SUM.name).read_text(encoding="utf-8"))
    assert stored["made_by"] == "taylor-verify publish smallest; do not edit"
    assert SUM.load(folder) == Sum(4, 2.0)


def test_what_a_study_says_is_the_answer(folder: Path, capsys: Captured) -> None:
    """The messages of a study are on stderr; the exit status is the gravest of all studies."""
    assert call(folder, "smallest") == 1
    assert "it is odd" in capsys.readouterr().err
    assert call(folder, "smallest", "--terms", "13") == 2
    assert "expected another number than 13, got it @ publish smallest" in capsys.readouterr().err


def test_pages_are_made_of_what_is_stored(folder: Path) -> None:
    """`--pages`, like no option at all, makes its page anew without a measurement, and links to it."""
    assert call(folder, "smallest", "--terms", "2") == 0
    SUM.write(folder, Sum(2, 7.0))
    store.write(folder, [row()], [])
    assert call(folder, "--pages") == 0
    assert (folder / SMALLEST.path).read_text(encoding="utf-8") == f"{MADE_BY}\n# 7.0\n"
    index = (folder / "README.md").read_text(encoding="utf-8")
    assert "| [tables/smallest.md](tables/smallest.md) | `smallest.csv` |" in " ".join(
        index.split()
    )
    (folder / SUM.name).unlink()
    assert call(folder) == 0
    assert not (folder / SMALLEST.path).exists()


def test_files_that_are_not_committed_are_made_when_they_are_missing(
    folder: Path, capsys: Captured
) -> None:
    """They are counted in words, and their pattern is one of those that git leaves out."""
    store.write(folder, list(run("euler/generic", rung="f64").verdicts), [])
    assert "data/smallest/" in bulk.patterns()
    assert "1 big files" in bulk.missing(folder, {}).data
    assert call(folder, "--missing") == 0
    assert "1 big files" in capsys.readouterr().err
    assert bulk.missing(folder, {}).data == ""


def test_a_document_that_no_page_can_tell_is_named(folder: Path) -> None:
    """The fault has the command that writes the document, and the file."""
    SUM.write(folder, Sum(0, 1.0))
    with pytest.raises(
        ValueError, match=r"expected what `publish smallest` writes, .* @ .*smallest\.json"
    ):
        SMALLEST.pages(folder)


def test_without_matplotlib_the_page_is_made_all_the_same(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A message says that nothing was drawn, and what to install."""
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    SUM.write(folder, Sum(2, 1.0))
    made = SMALLEST.publish(folder)
    assert [path.name for path in made.written] == ["smallest.md", "smallest.csv"]
    (message,) = made.messages
    assert "pictures of smallest are not drawn: expected matplotlib" in message


# Calls that are wrong.


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["smalest"], "expected a study, got 'smalest'; did you mean smallest?"),
        (["--growth"], "expected `publish growth`, got --growth"),
        (
            ["--smallest", "--hard"],
            "expected `publish smallest`, got --smallest\nexpected `publish hard`",
        ),
        (["zzz"], "known: accuracy, controls"),
        (
            ["--terms", "3"],
            "expected --terms with `publish smallest`, got it with no study @ publish",
        ),
        (
            ["claims", "--seed", "3"],
            "expected --seed with `publish hard`, got it with claims @ publish",
        ),
        (["smallest", "--terms", "x"], "@ --terms"),
        (["smallest", "--paper"], "expected studies or --paper, got both @ publish"),
        (["smallest", "--list"], "expected studies or --list, got both @ publish"),
    ],
    ids=str,
)
def test_a_wrong_call_is_told_in_a_sentence(
    folder: Path, capsys: Captured, words: list[str], message: str
) -> None:
    """A wrong call ends with exit status 2 and writes no file."""
    assert call(folder, *words) == 2
    captured = capsys.readouterr()
    assert captured.out == ""
    assert message in captured.err
    assert not folder.exists()


# The list itself.


def test_every_study_has_a_name_of_its_own() -> None:
    """Each file with a study is in the list, and no two write or link to one page or share an option; the
    boards are one file with one set of options."""
    others = [study for study in STUDIES if study.name not in BOARDS[1:]]
    assert {study.options for study in STUDIES if study.name in BOARDS} == {ENGINES.options}
    paths = [study.path for study in STUDIES if study.path]
    assert len(set(paths)) == len(paths)
    names = [study.name for study in others]
    assert len(set(names)) == len(names)
    place = Path(registry.__file__).parent
    texts = [file.read_text(encoding="utf-8") for file in place.rglob("*.py")]
    files = [text for text in texts if "\nSTUDY: Final" in text]
    assert len(files) == len({*names} - {"smallest"})
    values = [study.options for study in others if study.options]
    assert len(set(values)) == len(values)
