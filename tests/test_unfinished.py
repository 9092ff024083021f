"""A run of several scenes that was interrupted goes on where it was, with the same verdicts."""

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from verify import standard, unfinished
from verify.job import Job, jobs
from verify.run import run

SCENES = ("euler/rest", "euler/generic", "kirchhoff/whole-motion", "kirchhoff/swimmer-vehicle")


@pytest.fixture
def cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A user's cache of the test's own; heyoka's compiled code stays where it is."""
    monkeypatch.setattr(unfinished, "user_cache_path", lambda name: tmp_path / name)
    return tmp_path


def test_what_is_kept_is_what_was_judged(cache: Path) -> None:
    """Of the same scene, solver and rungs, and of these alone."""
    (job,) = jobs(["euler/rest"], "taylor", ["f64"])
    assert unfinished.kept(job) is None
    found = [run("euler/rest")]
    unfinished.keep(job, found)
    again = unfinished.kept(job)
    assert again is not None
    assert [one.verdicts for one in again] == [one.verdicts for one in found]
    for other in (
        Job("euler/generic", job.solver, job.rungs),
        Job(job.scene, "taylor?tol=1e-9", job.rungs),
        Job(job.scene, job.solver, ("f32",)),
    ):
        assert unfinished.kept(other) is None


def test_other_code_takes_up_nothing(cache: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A judgement by another text of this package is not this one's."""
    (job,) = jobs(["euler/rest"], "taylor", ["f64"])
    unfinished.keep(job, [run("euler/rest")])
    monkeypatch.setattr(unfinished, "_package", lambda: "another")
    assert unfinished.kept(job) is None


def test_a_cache_that_cannot_be_written_keeps_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The run goes on without."""
    (tmp_path / "taylor-verify").write_text("in the way")
    monkeypatch.setattr(unfinished, "user_cache_path", lambda name: tmp_path / name)
    (job,) = jobs(["euler/rest"], "taylor", ["f64"])
    unfinished.keep(job, [])
    assert unfinished.kept(job) is None
    unfinished.forget()


def test_what_is_kept_is_not_run_again(cache: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """It is recalled, until it is forgotten."""
    asked = jobs(["euler/rest", "euler/spherical"], "taylor", ["f64"])
    first = standard._run_or_recall(asked[0])
    monkeypatch.setattr(standard, "_run", lambda job: pytest.fail(f"{job.scene} was run again"))
    assert [one.verdicts for one in standard._run_or_recall(asked[0])] == [
        one.verdicts for one in first
    ]
    unfinished.forget()
    assert not unfinished.folder().exists()


# A result so long that its worker is still writing it when the run is interrupted.
_IN_THE_MIDDLE = """
import sys, time
from pathlib import Path
from verify.parallel import on_all_cores

MARK = Path(sys.argv[1])


def work(size):
    if size:
        MARK.touch()
    return bytes(size)


def finished(size):
    while not MARK.exists():
        time.sleep(0.001)
    time.sleep(float(sys.argv[2]))
    raise KeyboardInterrupt


if __name__ == "__main__":
    try:
        on_all_cores(work, [0, 200_000_000], lambda size: size, finished, 2)
    except KeyboardInterrupt:
        print("interrupted")
"""


@pytest.mark.parametrize("later", ["0.02", "0.1", "0.2"])
def test_an_interrupt_within_a_result_is_no_deadlock(tmp_path: Path, later: str) -> None:
    """A worker that is ended while it hands over its result leaves nobody waiting for the rest."""
    script = tmp_path / "interrupted.py"
    script.write_text(_IN_THE_MIDDLE)
    command = [sys.executable, str(script), str(tmp_path / "mark"), later]
    done = subprocess.run(command, capture_output=True, text=True, timeout=30, check=False)
    assert done.stdout == "interrupted\n", done.stderr


@pytest.mark.skipif(not Path("/proc").exists(), reason="needs Linux's signals to a process group")
def test_an_interrupted_run_goes_on_where_it_was(tmp_path: Path) -> None:
    """It says so and how; what follows has every verdict of a run that was not interrupted."""
    environment = {**os.environ, "XDG_CACHE_HOME": str(tmp_path)}
    command = [sys.executable, "-m", "verify", "run", *SCENES, "--rung", "f64", "--json"]
    place = tmp_path / "taylor-verify" / "unfinished"
    with subprocess.Popen(
        command,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env=environment,
        start_new_session=True,
    ) as working:
        deadline = time.monotonic() + 60
        while not list(place.glob("*.pickle")) and time.monotonic() < deadline:
            time.sleep(0.01)
        os.killpg(working.pid, signal.SIGINT)
        try:
            out, error = working.communicate(timeout=10)
        except subprocess.TimeoutExpired:
            os.killpg(working.pid, signal.SIGKILL)
            raise
    if working.returncode == 0:
        pytest.skip("the run was over before it could be interrupted")
    assert working.returncode == 130
    assert out == ""
    assert "of 4 scenes are finished and kept, nothing is written" in error or (
        error == "taylor-verify: interrupted\n"
    )
    kept = len(list(place.glob("*.pickle")))
    assert kept >= 1
    done = subprocess.run([*command, "--resume"], capture_output=True, text=True, env=environment)
    assert done.returncode == 0, done.stderr
    found = {row["scene"] for row in json.loads(done.stdout)["verdicts"]}
    assert found == set(SCENES)
    assert not place.exists()
