"""A sweep: the same rows however it is cut, ended and taken up again, on any executor."""

from __future__ import annotations

import json
import os
import shutil
from concurrent.futures import Executor, Future, ThreadPoolExecutor
from pathlib import Path
from typing import Any

import pytest
from builders.processes import Backwards
from builders.sweeps import FAILING, SOLVER, TEMPLATE, parts, rows, swept

from taylor_verify.batch.failure import Failed
from taylor_verify.batch.judging import Interrupted
from taylor_verify.batch.sweeps import chunk as chunks
from taylor_verify.batch.sweeps import sweep as sweeping
from taylor_verify.batch.sweeps.chunk import COLUMNS
from taylor_verify.batch.sweeps.sweep import sweep
from taylor_verify.cli import main
from taylor_verify.judge.judgement import Judgement
from taylor_verify.records.faults import Refused
from taylor_verify.records.status import Status
from taylor_verify.records.verdict import Verdict
from taylor_verify.run import run
from taylor_verify.scenes.scene import Scene


def invented(scene: Scene, solver: str, rung: str, *_: Any, **__: Any) -> Judgement:
    """A judgement of a scene that follows from its first moment, and takes no time."""
    moment = float(scene.body.parts()["inertia"][0][0])
    verdicts = (
        Verdict(
            *(scene.name, solver, rung, "", quantity, Status.PASS, "reached"),
            max=moment,
            ratio=moment,
        )
        for quantity in ("omega", "T")
    )
    return Judgement(tuple(verdicts), None)


@pytest.fixture
def quick(monkeypatch: pytest.MonkeyPatch) -> None:
    """Rows that are invented, for what is asked of the cuts and not of the numbers."""
    monkeypatch.setattr(chunks, "judge_scene", invented)


class Later(Executor):
    """An executor of somebody's own, whose work ends at once, or never."""

    def __init__(self, most: int) -> None:
        self.most, self.submitted = most, 0

    def submit(self, fn: Any, /, *args: Any, **kwargs: Any) -> Future[Any]:
        future: Future[Any] = Future()
        self.submitted += 1
        if self.submitted > self.most:
            raise KeyboardInterrupt
        future.set_result(fn(*args, **kwargs))
        return future


# What a sweep leaves.


def test_a_sweep_leaves_rows_a_summary_and_the_worst_cases(template: str, tmp_path: Path) -> None:
    """A grid of two is gone through for each of ten points; what is written is what was judged."""
    out = tmp_path / "out"
    result = swept(template, out, worst=3)
    assert result.total == 20
    table = rows(out)
    assert [row["point"] for row in table] == sorted(row["point"] for row in table)
    assert {row["point"] for row in table} == set(range(20))
    assert set(table[0]) == {*COLUMNS, "drawn.g", "drawn.body.inertia[0]", "drawn.initial.omega[2]"}
    assert [row["drawn.g"] for row in table if row["quantity"] == "T"] == [0.5, 1.0] * 10
    (omega,) = (each for each in result.quantities if each.quantity == "omega")
    ratios = sorted(row["ratio"] for row in table if row["quantity"] == "omega")
    assert omega.ratio.largest == ratios[-1]
    assert ratios[9] <= omega.ratio.median <= ratios[9] * 1.001
    assert {file.name for file in out.iterdir()} >= {"summary.md", "summary.json"}
    assert json.loads((out / "summary.json").read_text())["total"] == 20
    assert [case.ratio for case in result.worst] == sorted(
        (case.ratio for case in result.worst), reverse=True
    )


def test_no_worst_case_may_be_kept(template: str, tmp_path: Path) -> None:
    """A sweep of which none is asked for ends with its summary."""
    result = swept(template, tmp_path / "out", count=2, worst=0)
    assert (result.exit_status, list(result.worst)) == (0, [])
    assert (tmp_path / "out" / "summary.md").exists()


def test_a_worst_case_is_a_scene_that_runs(template: str, tmp_path: Path) -> None:
    """Run alone, the scene of a worst case has the numbers that the sweep has; a failure fails both."""
    result = swept(template, tmp_path / "out", solver=FAILING, count=1, worst=1)
    (case,) = result.worst
    assert (result.exit_status, case.verdict) == (1, Status.FAIL)
    mine = [row for row in rows(tmp_path / "out") if row["point"] == case.point]
    verdicts = run(tmp_path / "out" / case.file, FAILING).verdicts
    for name in ("max", "ratio", "bound", "steps", "quantity", "because"):
        expected = [getattr(verdict, name) for verdict in verdicts]
        if name == "because":
            expected = [
                text if v.verdict is not Status.PASS else ""
                for v, text in zip(verdicts, expected, strict=True)
            ]
        assert [row[name] for row in mine] == expected
    assert {v.quantity: v.ratio for v in verdicts}[case.quantity] == case.ratio


def test_numbers_that_make_no_body_are_refused_rows(tmp_path: Path) -> None:
    """They are counted, undecided as a whole, and their reason is told; they are no worst case."""
    file = tmp_path / "some.toml"
    file.write_text(TEMPLATE.replace("uniform = [1, 2]", "uniform = [-1, 2]"))
    result = swept(str(file), tmp_path / "out")
    refused = [row for row in rows(tmp_path / "out") if row["quantity"] == "scene"]
    assert result.bodies["refused"] == len(refused) > 0
    assert result.exit_status == (1 if result.bodies["fail"] else 3)
    assert "positive moment" in result.refusals[0]
    assert not {row["point"] for row in refused} & {case.point for case in result.worst}


def test_a_scene_that_breaks_the_code_stops_no_other(
    template: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Its row is undecided and says what broke; the others of its chunk are judged."""

    def broken(scene: Scene, *given: Any, **options: Any) -> Judgement:
        if scene.name == "small#3":
            raise ArithmeticError("on purpose")
        return run(scene, *given, **options)

    monkeypatch.setattr(chunks, "judge_scene", broken)
    result = swept(template, tmp_path / "out")
    assert result.bodies["undecided"] == 1
    (row,) = (row for row in rows(tmp_path / "out") if row["point"] == 3)
    assert (row["quantity"], row["verdict"]) == ("scene", "undecided")
    assert "ArithmeticError: on purpose" in row["because"]
    assert result.total == 20


# Executors, interrupts.


@pytest.mark.usefixtures("quick")
def test_every_executor_leaves_the_same_bytes(template: str, tmp_path: Path) -> None:
    """In this process, in threads, and by an executor that begins with the last chunk."""
    swept(template, tmp_path / "here")
    with ThreadPoolExecutor(2) as threads:
        for name, executor in (("threads", threads), ("backwards", Backwards(5))):
            swept(template, tmp_path / name, jobs=None, executor=executor)
            assert parts(tmp_path / name) == parts(tmp_path / "here")


@pytest.mark.usefixtures("quick")
def test_no_more_chunks_are_under_way_than_were_asked_for(template: str, tmp_path: Path) -> None:
    """With two ahead, an executor that waits for its third waits for ever; here it is given two."""
    swept(template, tmp_path / "out", jobs=None, executor=Later(5), ahead=2)
    assert len(parts(tmp_path / "out")) == 5


@pytest.mark.usefixtures("quick")
def test_an_interrupted_sweep_goes_on(
    template: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Finished parts are not judged again, a damaged part is, and the bytes are those of one go."""
    swept(template, tmp_path / "whole")
    out = tmp_path / "out"
    with pytest.raises(Interrupted) as interrupted:
        swept(template, out, jobs=None, executor=Later(3), ahead=1)
    assert (interrupted.value.finished, interrupted.value.jobs) == (12, 20)
    (out / "verdicts" / "part-000001.parquet").write_bytes(b"PAR1 damaged")
    judged: list[int] = []
    judge = sweeping.judge
    monkeypatch.setattr(sweeping, "judge", lambda one: judged.append(one.number) or judge(one))
    swept(template, out, resume=True)
    assert judged == [1, 3, 4]
    assert parts(out) == parts(tmp_path / "whole")
    judged.clear()
    swept(template, out, resume=True)
    assert judged == []


@pytest.mark.usefixtures("quick")
def test_a_part_that_is_not_what_was_written_is_judged_again(
    template: str, tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    """A copy of another part, flipped bits and a FIFO are told, and change no byte of the answer."""
    out = tmp_path / "out"
    swept(template, out)
    sound = rows(out)
    names = sorted((out / "verdicts").iterdir())
    content = names[1].read_bytes()
    shutil.copy(names[0], names[2])
    names[3].unlink()
    os.mkfifo(names[3])
    for bit in range(7, 8 * len(content), 12007):
        flipped = bytearray(content)
        flipped[bit // 8] ^= 1 << bit % 8
        names[1].write_bytes(flipped)
        swept(template, out, resume=True)
        assert rows(out) == sound
    assert "damaged, and run again: part-000002.parquet" in caplog.text
    assert "damaged, and run again: part-000003.parquet" in caplog.text


@pytest.mark.usefixtures("quick")
def test_rows_of_other_code_are_refused(
    template: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A worker with another version of the package is told, and nothing of it is written."""
    monkeypatch.setattr(chunks, "package_digest", lambda: "another")
    with pytest.raises(Failed, match="same version of taylor-verify on every worker"):
        swept(template, tmp_path / "out")
    assert not list((tmp_path / "out").glob("verdicts/part*"))


# Calls.


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (["--count", "0"], "expected a whole number from 1 to 1000000000, got 0 @ count"),
        (["--jobs", "0", "--seed", "-1"], "got 0 @ jobs\nexpected a whole number from 0 to 2^63"),
        (["--resume"], "expected the folder of the sweep to go on with (--out), got none @ resume"),
        (["--resume", "--out", "gone"], "expected a folder with a sweep to go on with"),
        (["--executor", "slurm"], "HOST:8786, got 'slurm' @ executor"),
        (["--executor", "dask:x:1", "--jobs", "2"], "expected --jobs or --executor"),
        (["--solver", "nobody"], "got 'nobody' @ solver\n"),
        (["--rung", "f65"], "@ --rung"),
    ],
)
def test_a_wrong_call_is_refused(
    template: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    words: list[str],
    sentence: str,
) -> None:
    """Exit status 2, all faults of the arguments, and no folder is left."""
    monkeypatch.chdir(tmp_path)
    assert main(["sweep", template, *words]) == 2
    assert sentence in capsys.readouterr().err
    assert [file.name for file in tmp_path.iterdir()] == ["small.toml"]


@pytest.mark.usefixtures("quick")
def test_a_folder_with_another_sweep_is_refused(template: str, tmp_path: Path) -> None:
    """Without resume any sweep in the folder; with resume one that differs, which options is said."""
    swept(template, tmp_path / "out")
    with pytest.raises(Refused, match=r"a folder without a sweep, got one .*--resume"):
        swept(template, tmp_path / "out")
    with pytest.raises(
        Refused, match=r"seed 5 as in the sweep that is there, got 6 @ resume .*repeat"
    ):
        swept(template, tmp_path / "out", resume=True, seed=6)
    Path(template).write_text(TEMPLATE.replace("[1, 2]", "[1, 3]"))
    with pytest.raises(
        Refused, match=r"expected the text of the template.* got another one @ resume"
    ):
        swept(template, tmp_path / "out", resume=True)


@pytest.mark.usefixtures("quick")
@pytest.mark.parametrize(
    "name", ["template.toml", "summary.json", "verdicts/mine", "worst/mine.toml"]
)
def test_files_of_the_user_are_never_overwritten(template: str, tmp_path: Path, name: str) -> None:
    """A folder in which a name of a sweep is taken is refused, and stays as it is."""
    mine = tmp_path / "out" / name
    mine.parent.mkdir(parents=True)
    mine.write_text("mine\n")
    with pytest.raises(
        Refused, match=r"expected a folder without files of these names, got .* another"
    ):
        swept(template, tmp_path / "out")
    assert mine.read_text() == "mine\n"
    assert not (tmp_path / "out" / "sweep.json").exists()


@pytest.mark.usefixtures("quick")
def test_scenes_of_the_user_beside_the_worst_cases_stay(template: str, tmp_path: Path) -> None:
    """A sweep that goes on removes the worst cases that it wrote before, and no other scene."""
    swept(template, tmp_path / "out")
    mine = tmp_path / "out" / "worst" / "mine.toml"
    mine.write_text("title = 'mine'\n")
    swept(template, tmp_path / "out", resume=True, worst=1)
    assert {file.name for file in mine.parent.iterdir()} > {"mine.toml"}
    assert len([*mine.parent.iterdir()]) == 2


def test_a_grid_beyond_the_largest_sweep_is_refused_at_once(tmp_path: Path) -> None:
    """The bodies are counted before anything is drawn or written."""
    axis = f"{{ grid = {[*range(1, 5001)]} }}"
    text = TEMPLATE.replace("{ uniform = [1, 2] }, 2, 3", ", ".join([axis] * 3))
    file = tmp_path / "grid.toml"
    file.write_text(text)
    with pytest.raises(ValueError, match="expected at most 1000000000 bodies, got"):
        sweep(str(file), solver=SOLVER, out=tmp_path / "out")
    assert not (tmp_path / "out").exists()


def test_a_folder_of_scenes_is_swept(template: str, tmp_path: Path) -> None:
    """Each file is a scene; what is drawn, and all faults of all files, are refused."""
    folder = tmp_path / "scenes"
    folder.mkdir()
    swept(template, tmp_path / "out", worst=4)
    for file in (tmp_path / "out" / "worst").iterdir():
        (folder / file.name).write_bytes(file.read_bytes())
    result = sweep(str(folder), solver=SOLVER, jobs=1)
    assert (result.total, result.seed, result.exit_status) == (4, None, 0)
    with pytest.raises(ValueError, match="expected no count for a folder of scenes, got 3 @ count"):
        sweep(str(folder), count=3)
    (folder / "wrong.toml").write_text("x = 1\n")
    with pytest.raises(Refused, match=r"wrong\.toml is refused:\n.*title"):
        sweep(str(folder), solver=SOLVER)
