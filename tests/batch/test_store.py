"""A run of several scenes that was interrupted goes on where it was, with the same verdicts."""

import hashlib
import json
import os
import pickle
import signal
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from builders.processes import PATIENCE, interruptible, wait_until

from taylor_verify.batch import finished_jobs as module
from taylor_verify.batch import judging
from taylor_verify.batch.chosen_scenes import select
from taylor_verify.batch.finished_jobs import unfinished
from taylor_verify.batch.job import Job
from taylor_verify.judge.tolerances import Tolerances
from taylor_verify.run import run
from taylor_verify.solvers.callback import Callback

SCENES = ("euler/rest", "euler/generic", "kirchhoff/whole-motion", "euler/with-attitude")


@pytest.fixture
def cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A user's cache of the test's own; heyoka's compiled code stays where it is."""
    monkeypatch.setattr(module, "user_cache_path", lambda name: tmp_path / name)
    return tmp_path


def files(cache: Path) -> list[Path]:
    # What is still being written is in a directory that begins with a dot.
    return sorted(cache.rglob("[!.]*/*.judged"))


ASKED = select(["euler/rest", "euler/generic"], ["f64", "f80"]).jobs("taylor")


def test_what_is_kept_is_what_was_judged(cache: Path) -> None:
    """Verdicts and records come back as they were, of this job and no other."""
    job = ASKED[1]
    verdicts = [
        run("euler/generic"),
        run("kirchhoff/whole-motion"),
        run("euler/generic", "scipy:RK45?rtol=1e-3"),
        run("euler/generic", Callback(lambda problem: [[float("nan")] * 3] * len(problem.times))),
        run("euler/generic", Callback(lambda problem: 1 / 0)),
    ]
    with unfinished(ASKED, None, resume=False) as store:
        assert store.recall(job) is None
        store.keep(job, verdicts)
        again = store.recall(job)
        # Equal, NaN included: repr shows every digit of a double.
        assert list(map(repr, map(vars, again))) == list(map(repr, map(vars, verdicts)))
        for other in (
            Job("euler/rest", job.solver, job.rungs),
            Job(job.scene, "taylor?tol=1e-9", job.rungs),
            Job(job.scene, job.solver, ("f32",)),
            Job(job.scene, job.solver, job.rungs, Tolerances(every=1e-8)),
            Job(job.scene, job.solver, job.rungs, Tolerances(each=(("omega", 1e-8),))),
        ):
            assert store.recall(other) is None


def count_finished(resume: bool, asked: list[Job] = ASKED, out: Path | None = None) -> int:
    """Count the jobs that a run would find finished."""
    with unfinished(asked, out, resume) as store:
        return sum(store.recall(job) is not None for job in asked) if store else 0


def keep(out: Path | None = None) -> None:
    with unfinished(ASKED, out, resume=False) as store:
        for job in ASKED:
            store.keep(job, [run(job.scene)])


def test_a_run_begins_anew_unless_it_is_resumed(cache: Path) -> None:
    """The same run with --resume finds everything; a run without removes it."""
    keep()
    assert count_finished(resume=True) == count_finished(resume=True) == 2
    assert count_finished(resume=False) == 0
    assert count_finished(resume=True) == 0


def test_another_run_touches_nothing(
    cache: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Other scenes, another solver, another --out, another folder: each is a run of its own."""
    keep()
    keep(tmp_path / "out")
    content = {file: file.read_bytes() for file in files(cache)}
    assert len(content) == 4
    others = [ASKED[:1], select(SCENES).jobs("taylor"), select(SCENES[:2]).jobs("scipy:RK45")]
    for asked in others:
        assert (
            count_finished(resume=False, asked=asked)
            == count_finished(resume=True, asked=asked)
            == 0
        )
    assert count_finished(resume=True, out=tmp_path / "elsewhere") == 0
    assert count_finished(resume=False, out=tmp_path / "elsewhere") == 0
    (tmp_path / "below").mkdir()
    with monkeypatch.context() as moved:
        moved.chdir(tmp_path / "below")
        assert count_finished(resume=True) == count_finished(resume=False) == 0
    assert {file: file.read_bytes() for file in files(cache)} == content
    assert count_finished(resume=True) == count_finished(resume=True, out=tmp_path / "out") == 2


def test_the_same_run_twice_at_once_keeps_apart(cache: Path) -> None:
    """The second has no store, and leaves that of the first as it is."""
    with unfinished(ASKED, None, resume=False) as first:
        first.keep(ASKED[0], [run("euler/rest")])
        for resume in (True, False):
            with unfinished(ASKED, None, resume) as second:
                assert second is None
        assert first.recall(ASKED[0]) is not None


def test_other_code_takes_up_nothing(cache: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A judgement by another text of this package is not this one's."""
    keep()
    monkeypatch.setattr(module, "package_digest", lambda: "another")
    assert count_finished(resume=True) == 0


def test_another_program_takes_up_nothing(cache: Path, tmp_path: Path) -> None:
    """A program that has changed since is another solver, though its name is the same."""
    program = tmp_path / "simulator"
    program.write_text("#!/bin/sh\nexit 1\n")
    program.chmod(0o755)
    asked = select(SCENES[:2]).jobs(f"process:sh {program} --fast")
    with unfinished(asked, None, resume=False) as store:
        store.keep(asked[0], [run(asked[0].scene, asked[0].solver)])
    assert count_finished(resume=True, asked=asked) == 1
    program.write_text("#!/bin/sh\nexit 2\n")
    assert count_finished(resume=True, asked=asked) == 0


def _truncated(content: bytes) -> bytes:
    return content[: len(content) // 2]


def _one_digit(content: bytes) -> bytes:
    """Still JSON, and another number."""
    before, mark, after = content.partition(b'"max": ')
    assert mark
    return before + mark + b"1" + after


def _pickled(content: bytes) -> bytes:
    """A pickle that fails the test if it is loaded."""
    return pickle.dumps(_Trap())


def _pickled_with_digest(content: bytes) -> bytes:
    data = pickle.dumps(_Trap())
    return hashlib.sha256(data).hexdigest().encode() + b"\n" + data


class _Trap:
    def __reduce__(self) -> Any:
        return pytest.fail, ("it was unpickled",)


def _misshapen(content: bytes) -> bytes:
    data = b'[{"verdicts": [{"scene": 1}], "record": null}]'
    return hashlib.sha256(data).hexdigest().encode() + b"\n" + data


DAMAGES = [
    lambda content: b"",
    _truncated,
    _one_digit,
    _pickled,
    _pickled_with_digest,
    _misshapen,
    lambda content: bytes(len(content)),
]


@pytest.mark.parametrize("damage", DAMAGES, ids=range(len(DAMAGES)))
def test_a_damaged_entry_is_run_again_with_a_warning(
    cache: Path,
    damage: Any,
    monkeypatch: pytest.MonkeyPatch,
    caplog: pytest.LogCaptureFixture,
) -> None:
    """It is no judgement, runs nothing, and does not stop the run."""
    keep()
    with unfinished(ASKED, None, resume=True) as store:
        file = store._file(ASKED[1])
        file.write_bytes(damage(file.read_bytes()))
    judged: list[str] = []

    def run_all(work: Any, asked: list[Job], *_: Any, **__: Any) -> list[Any]:
        judged.extend(job.name for job in asked)
        return [[] for job in asked]

    monkeypatch.setattr(judging, "run_all", run_all)
    judgements = judging.judge_all(ASKED, resume=True)
    assert [each.verdicts[0].scene for each in judgements] == ["euler/rest"]
    assert judged == ["euler/generic"]
    (warning,) = caplog.messages
    assert warning == f"taylor-verify: warning: damaged, and run again: euler/generic @ {file}"
    assert not file.exists()


def test_a_cache_that_cannot_be_written_keeps_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The run goes on without."""
    (tmp_path / "taylor-verify").write_text("in the way")
    monkeypatch.setattr(module, "user_cache_path", lambda name: tmp_path / name)
    with unfinished(ASKED, None, resume=True) as store:
        assert store is None


def test_a_finished_run_leaves_nothing(cache: Path) -> None:
    """Neither its entries nor its folder nor its lock."""
    asked = select(["euler/rest", "euler/spherical"]).jobs("taylor")
    judging.judge_all(asked, workers=1)
    assert [file for file in cache.rglob("*") if file.is_file()] == []


@pytest.mark.skipif(not Path("/proc").exists(), reason="needs Linux's signals to a process group")
def test_an_interrupted_run_goes_on_where_it_was(tmp_path: Path) -> None:
    """It says so and how; what follows has every verdict of a run that was not interrupted."""
    environment = {**os.environ, "XDG_CACHE_HOME": str(tmp_path)}
    command = [sys.executable, "-m", "taylor_verify", "run", *SCENES, "--rung", "f64", "--json"]
    command += ["--jobs", "1"]
    place = tmp_path / "taylor-verify" / "unfinished"
    with interruptible():
        working = subprocess.Popen(
            command,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            env=environment,
            start_new_session=True,
        )
    with working:
        wait_until(lambda: files(place) or working.poll() is not None)
        os.killpg(working.pid, signal.SIGINT)
        try:
            out, error = working.communicate(timeout=PATIENCE)
        except subprocess.TimeoutExpired:
            os.killpg(working.pid, signal.SIGKILL)
            raise
    if working.returncode == 0:
        pytest.skip("the run was over before it could be interrupted")
    assert working.returncode == 130, error
    assert out == ""
    assert "of 4 scenes are finished and kept, no report is written" in error or (
        error == "taylor-verify: interrupted\n"
    )
    stored = len(files(place))
    assert stored >= 1
    done = subprocess.run([*command, "--resume"], capture_output=True, text=True, env=environment)
    assert done.returncode == 0, done.stderr
    scenes = {row["scene"] for row in json.loads(done.stdout)["verdicts"]}
    assert scenes == set(SCENES)
    assert files(place) == []
    assert list(place.iterdir()) == []
