"""A folder takes one run at a time, and only a checkout is published from."""

from __future__ import annotations

import multiprocessing
import os
import subprocess
import sys
import time
from pathlib import Path

import pytest
from builders.processes import PATIENCE
from builders.scenes import scene_file
from hypothesis import example, given
from hypothesis import strategies as st

from taylor_verify.batch.lock import LOCK, Occupied, alone_in
from taylor_verify.cli import main
from taylor_verify.records.file_names import of_scene, of_solver
from taylor_verify.scenes import library
from taylor_verify_reports.studies.registry import STUDIES

Captured = pytest.CaptureFixture[str]


@pytest.fixture
def short(tmp_path: Path) -> Path:
    return scene_file(tmp_path)


# The lock.


def test_a_folder_that_was_made_for_a_lock_goes_with_it(tmp_path: Path) -> None:
    """A folder that was there before stays, and so does one that is no longer empty."""
    with alone_in(tmp_path / "new" / "nested"):
        assert (tmp_path / "new" / "nested" / LOCK).exists()
    assert list(tmp_path.iterdir()) == []
    (tmp_path / "old").mkdir()
    with alone_in(tmp_path / "old"):
        pass
    assert list((tmp_path / "old").iterdir()) == []
    with alone_in(tmp_path / "new"):
        (tmp_path / "new" / "result").write_text("42")
    assert [file.name for file in (tmp_path / "new").iterdir()] == ["result"]


def test_a_second_holder_is_refused_and_the_next_is_not(tmp_path: Path) -> None:
    """The text names the folder and the process; a folder let go of can be taken again."""
    for _ in range(2):
        with alone_in(tmp_path):
            words = f"in use by process {os.getpid()} @ {tmp_path}"
            with pytest.raises(Occupied, match=words), alone_in(tmp_path):
                pass
            # The refusal has not removed the lock of the first.
            with pytest.raises(Occupied), alone_in(tmp_path):
                pass


def test_the_lock_of_a_killed_process_is_free(tmp_path: Path) -> None:
    """Its file is left behind, and is in nobody's way."""
    script = (
        "import sys, time\nfrom pathlib import Path\nfrom taylor_verify.batch.lock import alone_in\n"
        "with alone_in(Path(sys.argv[1])):\n    print(flush=True)\n    time.sleep(600)\n"
    )
    command = [sys.executable, "-c", script, str(tmp_path)]
    with subprocess.Popen(command, stdout=subprocess.PIPE) as holder:
        holder.stdout.readline()
        with pytest.raises(Occupied, match=f"process {holder.pid} "), alone_in(tmp_path):
            pass
        holder.kill()
    assert (tmp_path / LOCK).exists()
    with alone_in(tmp_path):
        pass
    assert not (tmp_path / LOCK).exists()


def _increase(folder: Path, times: int) -> None:
    file = folder / "count"
    for _ in range(times):
        while True:
            try:
                with alone_in(folder):
                    count = int(file.read_text())
                    time.sleep(0.001)
                    file.write_text(str(count + 1))
                break
            except Occupied:
                time.sleep(0.0005)


def test_a_lock_that_comes_and_goes_is_held_by_one(tmp_path: Path) -> None:
    """Processes that take it in turns, its file removed every time, never hold it together."""
    (tmp_path / "count").write_text("0")
    context = multiprocessing.get_context("spawn")
    workers = [context.Process(target=_increase, args=(tmp_path, 8)) for _ in range(2)]
    for worker in workers:
        worker.start()
    for worker in workers:
        worker.join(PATIENCE)
    assert (tmp_path / "count").read_text() == "16"


# --out


def test_a_second_run_into_one_folder_is_refused(
    capsys: Captured, short: Path, tmp_path: Path
) -> None:
    """Exit status 2 and a sentence with the folder, before anything is run or written."""
    folder = tmp_path / "out"
    with alone_in(folder):
        assert main(["run", str(short), "--out", str(folder)]) == 2
        out, error = capsys.readouterr()
        assert out == ""
        assert error == (
            "taylor-verify: expected a folder that no other run writes to, got one in use by "
            f"process {os.getpid()} @ {folder} (--out)\n"
        )
        assert [file.name for file in folder.iterdir()] == [LOCK]
    assert main(["run", str(short), "--out", str(folder)]) == 0
    assert LOCK not in {file.name for file in folder.iterdir()}
    with alone_in(folder):
        assert main(["publish", "--from", str(folder)]) == 2
        assert main(["publish", "reference", "--from", str(folder)]) == 2
        assert "(--from)" in capsys.readouterr().err


# --junit


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no such files")
def test_a_pipe_is_not_replaced_by_a_report(
    capsys: Captured, short: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Exit status 2 and one line, before anything is run; the same holds for a device."""
    monkeypatch.chdir(tmp_path)
    os.mkfifo("pipe")
    assert main(["run", str(short), "--junit", "pipe"]) == 2
    out, error = capsys.readouterr()
    expected = "expected a file that can be written, got 'pipe' (a device or a pipe) @ --junit"
    assert (out, error) == ("", f"taylor-verify: {expected}\n")
    assert Path("pipe").is_fifo()


@pytest.mark.skipif(sys.platform == "win32", reason="Windows makes links for some users alone")
def test_a_link_leads_to_the_report(short: Path, tmp_path: Path) -> None:
    """The file behind a link is written, and the link stays."""
    file, link = tmp_path / "results.xml", tmp_path / "latest.xml"
    link.symlink_to(file)
    for _ in range(2):
        assert main(["run", str(short), "--junit", str(link)]) == 0
        assert link.is_symlink()
        assert "<testsuites" in file.read_text()
        file.write_text("old")


# A full disk


def test_a_full_disk_is_told_with_its_folder_and_leaves_nothing(tmp_path: Path) -> None:
    """Neither file is there where the second one is too long, nor the folders that were made for them."""
    pytest.importorskip("resource")
    script = (
        "import resource\nfrom pathlib import Path\n"
        "from taylor_verify.records.replacement import replace_files\n"
        "resource.setrlimit(resource.RLIMIT_FSIZE, (10, 10))\n"
        "try:\n    replace_files(Path('new/below'), {'a': 'short', 'b': 'long ' * 10})\n"
        "except OSError as error:\n    print(error.strerror, error.filename)\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, cwd=tmp_path, check=True
    )
    assert done.stdout == "File too large new/below\n"
    assert list(tmp_path.iterdir()) == []


def test_a_trade_off_that_cannot_be_written_is_shown(
    short: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Captured
) -> None:
    """The measurement is printed, with one message and exit status 2."""

    def full(*_: object) -> None:
        raise OSError(28, "No space left on device", "out")

    pytest.importorskip("matplotlib")
    monkeypatch.setattr("taylor_verify.cli.tradeoff._draw", full)
    call = ["tradeoff", str(short), "--rung", "f64", "--solver", "geometric:lie-rk4?step=0.1"]
    assert main([*call, "--repeats", "1", "--out", str(tmp_path / "out")]) == 2
    out, error = capsys.readouterr()
    assert "geometric:lie-rk4" in out
    assert "expected to write, got No space left on device @ out (--out)" in error


@pytest.mark.skipif(sys.platform != "linux", reason="other systems have no such names")
def test_a_name_that_is_no_utf_8_is_refused_before_the_work(
    short: Path, tmp_path: Path, capsys: Captured
) -> None:
    """A report cannot mention such a scene, and no report lies in such a folder."""
    scene, folder = (str(tmp_path / f"mine\udcff{ending}") for ending in (".toml", ""))
    Path(scene).write_bytes(short.read_bytes())
    for call in (
        ["run", scene, "--out", str(tmp_path / "out")],
        ["run", str(short), "--out", folder],
    ):
        assert main(call) == 2
        assert r"mine\udcff" in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


# publish


MADE = ["pages", "paper", "missing"]
MEASURED = [study.name for study in STUDIES]


@pytest.mark.parametrize(
    "options",
    [
        *([], ["--site", "pages"], ["--archive", "dist"], ["growth", "hard"]),
        *([f"--{name}"] for name in MADE),
        *([name] for name in MEASURED),
        # A folder that is named is no checkout either.
        [MEASURED[0], "--from", "reports"],
    ],
    ids=str,
)
def test_publish_outside_a_checkout_is_refused(
    capsys: Captured, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, options: list[str]
) -> None:
    """Exit status 2 and a sentence that says where to go; no folder is made."""
    monkeypatch.chdir(tmp_path)
    assert main(["publish", *options]) == 2
    assert capsys.readouterr().err == (
        f"taylor-verify: expected a checkout of taylor-verify, got {tmp_path}; what is published "
        "belongs to a checkout of the project, and no package has it: go to one, or name a folder "
        "that `run --out` has written\n"
    )
    assert list(tmp_path.iterdir()) == []


def test_the_reports_of_the_checkout_are_meant_below_it_too(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """`publish` finds the reports of the checkout from any folder of it."""
    from taylor_verify_reports.verbs.checkout import reports_folder

    (tmp_path / "pyproject.toml").write_text('[project]\nname = "taylor-verify"\n')
    (tmp_path / "cases").mkdir()
    (tmp_path / "docs").mkdir()
    monkeypatch.chdir(tmp_path)
    assert reports_folder(None, measures=True) == "reports"
    monkeypatch.chdir(tmp_path / "docs")
    assert reports_folder(None, measures=True) == "../reports"
    (tmp_path / "pyproject.toml").write_text('[project]\nname = "mine"\n')
    assert main(["publish"]) == 2


@pytest.mark.parametrize("call", ["run {short} --against {file}", "publish --from {file}"])
def test_a_file_in_place_of_a_folder_of_reports_is_refused(
    capsys: Captured, short: Path, tmp_path: Path, call: str
) -> None:
    """The message says what the folder should be, as for one that is not there."""
    file = tmp_path / "plain"
    file.write_text("mine")
    assert main(call.format(short=short, file=file).split()) == 2
    error = capsys.readouterr().err
    assert "`run --out" in error
    assert f"{file}/data/verdicts.json" in error


# Names of the files of scenes and solvers: what was published keeps its name, and none is shared.


NAMES = st.text(alphabet="ab-_/.%", min_size=1, max_size=6)


@pytest.mark.parametrize(
    "name", library.names(*library.STANDARD_SET, library.EXTREMES, library.WORST)
)
def test_a_shipped_scene_keeps_its_name(name: str) -> None:
    """The stroke is a hyphen, as in every file that was published so far."""
    assert of_scene(name) == name.replace("/", "-")


@given(NAMES)
@example("./s.toml")
def test_no_file_is_hidden(name: str) -> None:
    """No file's name begins with a dot: `ls`, `cp O/*` and uploads leave such files out."""
    assert not of_scene(name).startswith(".")


@given(NAMES, NAMES)
@example("a/b", "a-b")
@example("a/b/c", "a-b/c")
@example("a/worst/b", "a/worst-b")
def test_no_two_scenes_share_a_name(one: str, other: str) -> None:
    """Two names lead to one file only if they are the same name, and no file lies in a folder."""
    assert (of_scene(one) == of_scene(other)) == (one == other)
    assert "/" not in of_scene(one)


@given(NAMES, NAMES, NAMES, NAMES)
def test_scene_and_solver_are_told_apart(a: str, b: str, c: str, d: str) -> None:
    """The dot between them is the last but one of a record's name, wherever other dots stand."""
    one, other = (f"{of_scene(s)}.{of_solver(t)}.f64.json" for s, t in ((a, b), (c, d)))
    assert (one == other) == ((a, b) == (c, d))
