"""Files that a clone lacks are made again as they were, and so are the numbers that pages quote."""

from __future__ import annotations

import gzip
import hashlib
import json
import shutil
import tarfile
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from builders import reports
from builders.processes import on_one_core
from builders.verdicts import passed

from taylor_verify.cli import main
from taylor_verify.records import store
from taylor_verify.records.sums import line
from taylor_verify.scenes.reading.reader import load
from taylor_verify_reports.studies import archive, bulk
from taylor_verify_reports.studies.accuracy import quoted
from taylor_verify_reports.studies.accuracy.quoted import BEGIN, END
from taylor_verify_reports.studies.study import Progress

SCENES = ("euler/rest", "euler/generic")
Captured = pytest.CaptureFixture[str]


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A whole report of two scenes on two rungs."""
    place = tmp_path_factory.mktemp("whole") / "report"
    reports.write_runs(place, [(scene, rung) for scene in SCENES for rung in ("f32", "f64")])
    reports.write_portraits(place, SCENES)
    reports.report.publish(place)
    return place


@pytest.fixture
def report(whole: Path, tmp_path: Path) -> Path:
    """A copy of that report."""
    return Path(shutil.copytree(whole, tmp_path / "report"))


def missing(place: Path) -> bulk.Missing:
    return bulk.missing(place)


def lacking(place: Path, what: str) -> Sequence[Any]:
    """Return what is missing of one kind of files."""
    lacks = {kind.what: lacking for kind, lacking in missing(place).lacking}
    return lacks.get(what, ())


def without_bulk(place: Path) -> dict[str, bytes]:
    """Remove the files that no clone has, and return them by their paths."""
    files = [
        f for pattern in bulk.patterns() for f in place.glob(pattern + "*" * pattern.endswith("/"))
    ]
    removed = {file.relative_to(place).as_posix(): file.read_bytes() for file in files}
    for file in files:
        file.unlink()
    return removed


def test_what_a_clone_lacks_is_made_as_it_was(report: Path, capsys: Captured) -> None:
    """Records, portraits, JSON and tables come back byte for byte, and nothing else changes."""
    removed = without_bulk(report)
    assert missing(report).data == (
        "2 tables for searching, 4 records of runs, 2 portraits of scenes, 2 exact trajectories as JSON"
    )
    committed = {file: file.read_bytes() for file in report.rglob("*") if file.is_file()}
    with on_one_core():
        assert main(["publish", "--missing", "--from", str(report), "--json"]) == 0
    out, messages = capsys.readouterr()
    assert (
        "2 tables for searching, 4 records of runs, 2 portraits of scenes, 2 exact trajectories as JSON"
        in messages
    )
    assert {Path(name) for name in json.loads(out)["written"]} == {report / n for n in removed}
    assert {name: (report / name).read_bytes() for name in removed} == removed
    assert {file: file.read_bytes() for file in committed} == committed
    assert missing(report).data == ""


def test_what_was_made_before_an_interrupt_stays(
    report: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A finished scene of each kind stays, and only the other one is lacking afterwards."""
    without_bulk(report)

    def interrupted(work: Any, asked: Sequence[Any], *, ended: Any, **_: Any) -> None:
        ended(asked[0], work(asked[0]))
        raise KeyboardInterrupt

    monkeypatch.setattr("taylor_verify.batch.work.run_all", interrupted)
    for kind, lacks in missing(report).lacking[1:]:
        with pytest.raises(KeyboardInterrupt):
            list(kind.make(report, lacks, Progress()))
    assert missing(report).data == (
        "2 tables for searching, 2 records of runs, 1 portraits of scenes, 1 exact trajectories as JSON"
    )


def test_records_of_other_verdicts_are_made_again(report: Path) -> None:
    """Records are missing if they belong to other verdicts.

    Records of an earlier version, which do not name their verdicts, are accepted."""
    stamp = report / "data" / store.STAMP
    content = stamp.read_bytes()
    assert lacking(report, "records of runs") == ()
    stamp.unlink()
    assert lacking(report, "records of runs") == ()
    stamp.write_bytes(content)
    file = report / "data" / store.VERDICTS
    stored = json.loads(file.read_text(encoding="utf-8"))
    stored["verdicts"][0] |= {"max": 0.5, "bound": 1.0}
    file.write_text(store.laid_out(stored), encoding="utf-8")
    assert len(lacking(report, "records of runs")) == 4
    mine, obsolete = (report / "data" / store.RECORDS / f"{n}.json" for n in ("mine", "gone"))
    mine.write_text("{}\n", encoding="utf-8")
    shutil.copy(next(file.parent.glob("records/euler-rest*")), obsolete)
    store.add_records(report, [])
    assert [f.name for f in mine.parent.glob("*.json")] == ["mine.json"]
    assert len(lacking(report, "records of runs")) == 4


def test_a_run_that_departs_from_what_is_published_is_named(report: Path, capsys: Captured) -> None:
    """A published error that a run made again does not have fails, and its scene gets no records."""
    file = report / "data" / store.VERDICTS
    stored = json.loads(file.read_text(encoding="utf-8"))
    asked = {"scene": "euler/generic", "rung": "f64", "quantity": "omega"}
    (row,) = (row for row in stored["verdicts"] if asked.items() <= row.items())
    row |= {"max": 0.5, "bound": 1.0}
    text = store.laid_out(stored)
    file.write_text(text, encoding="utf-8")
    file.with_name(store.SUM).write_text(line(text.encode(), store.VERDICTS), encoding="utf-8")
    shutil.rmtree(report / "data" / store.RECORDS)
    with on_one_core():
        assert main(["publish", "--missing", "--from", str(report)]) == 1
    assert "euler/generic" in capsys.readouterr().err
    assert {run.scene for run in lacking(report, "records of runs")} == {"euler/generic"}


def test_documents_of_another_text_of_a_scene_are_made_again(report: Path) -> None:
    """Portraits and exact trajectories are missing if their digest is that of another scene."""
    digests = {name: load(name).digest for name in SCENES} | {"euler/rest": "another"}
    scenes_lacking = [scenes for _, scenes in bulk.missing(report, digests).lacking]
    assert scenes_lacking == [("euler/rest",), ("euler/rest",)]


def test_a_run_that_was_never_judged_has_no_record(report: Path) -> None:
    """A refused scene and a missing rung have no record, and are not run again."""
    file = report / "data" / store.VERDICTS
    stored = json.loads(file.read_text(encoding="utf-8"))
    for row in stored["verdicts"]:
        row["verdict"] = "refused" if row["rung"] == "f32" else row["verdict"]
    file.write_text(store.laid_out(stored), encoding="utf-8")
    assert {run.rung for run in lacking(report, "records of runs")} == {"f64"}


def test_a_report_is_packed_the_same_every_time(report: Path, tmp_path: Path) -> None:
    """Two archives have the same bytes, and do not contain a user's own runs."""
    (report / "local").mkdir()
    for place in (report / "local" / "mine.csv", report / ".hidden"):
        place.write_text("mine", encoding="utf-8")
    first, sums = archive.pack(report, tmp_path / "a", "name")
    (report / "README.md").touch()
    second, _ = archive.pack(report, tmp_path / "b", "name")
    content = first.read_bytes()
    assert content == second.read_bytes()
    assert sums.read_text("utf-8") == f"{hashlib.sha256(content).hexdigest()}  name.tar.gz\n"
    with tarfile.open(first) as packed:
        members = {m.name: packed.extractfile(m) for m in packed.getmembers()}
        contents = {name: file.read() for name, file in members.items() if file}
    listed = dict(
        reversed(line.split("  "))
        for line in contents.pop(f"name/{archive.SUMS}").decode().splitlines()
    )
    assert {f"name/{path}" for path in listed} == set(contents)
    assert all(hashlib.sha256(contents[f"name/{p}"]).hexdigest() == s for p, s in listed.items())
    assert not [path for path in listed if "mine" in path or "hidden" in path]
    assert {"data/records/euler-rest.taylor.f64.json", "tables/accuracy.md"} <= set(listed)
    # The header of the stream has neither a time nor a name.
    assert content[4:8] == bytes(4)
    assert gzip.decompress(content)


def test_a_report_that_lacks_something_is_not_packed(
    report: Path, tmp_path: Path, capsys: Captured
) -> None:
    """Packing a report without records is a wrong call that names the command to make them."""
    call = ["publish", "--from", str(report), "--archive", str(tmp_path / "dist")]
    assert main(call) == 0
    shutil.rmtree(report / "data" / store.RECORDS)
    assert main(call) == 2
    assert "without 4 records of runs @ --archive" in capsys.readouterr().err


# Quoted numbers

RUNGS = ("f32", "f64", "f80", "f128", "mp237")
VERDICTS = [
    replace(passed(scene, "f64", quantity), rung=rung)
    for scene, quantity in (("euler/generic", "omega"), ("kirchhoff/whole-motion", "centre"))
    for rung in RUNGS
]
PAGE = f"before\n\n{BEGIN}\n\nstale\n\n{END}\n\nafter\n"


def test_a_quoted_block_is_made_again(tmp_path: Path) -> None:
    """The block between its marks is made again from the verdicts; other text stays."""
    (tmp_path / "README.md").write_text(PAGE)
    (text,) = quoted.requoted(tmp_path / "reports", VERDICTS).values()
    assert text == PAGE.replace(f"{BEGIN}\n\nstale\n\n{END}", quoted.accuracy(VERDICTS))
    assert text.count("3 u (0.5)") == len(VERDICTS)
    assert "stale" not in text


def test_a_page_without_marks_is_left_alone(tmp_path: Path) -> None:
    """Somebody's own README beside a report is not touched."""
    (tmp_path / "README.md").write_text("mine")
    assert quoted.requoted(tmp_path / "reports", VERDICTS) == {}


def test_another_folder_is_not_quoted(tmp_path: Path) -> None:
    """A run written beside the published folder changes no page."""
    (tmp_path / "README.md").write_text(PAGE)
    assert quoted.requoted(tmp_path / "local", VERDICTS) == {}


def test_a_block_without_its_end_is_refused(tmp_path: Path) -> None:
    """A page that lost the second mark would lose all that follows."""
    (tmp_path / "README.md").write_text(PAGE.replace(END, ""))
    with pytest.raises(ValueError, match="expected <!-- end of accuracy -->"):
        quoted.requoted(tmp_path / "reports", VERDICTS)
