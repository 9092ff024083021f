"""No process of a program outlives its run, wherever it hides and however the run ends."""

from __future__ import annotations

import os
import shlex
import signal
import subprocess
import sys
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest
from builders.processes import PATIENCE, interruptible, wait_until
from builders.programs import is_alive
from builders.scenes import three_instants

from taylor_verify.solvers.process import conversation, process, supervisor
from taylor_verify.solvers.trajectory import Outcome, Trajectory

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="orphans are adopted on Linux")

# A child that has left the session, has lost its parent and its environment, and holds no pipe; and one
# that holds them all.
QUESTION = """\
import json, os, signal, sys, time
scene = json.load(sys.stdin)
"""
HIDING = """\
marker = os.path.abspath(sys.argv[0]) + ".pids"


def hide(close):
    if os.fork() == 0:
        os.setsid()
        if os.fork() == 0:
            if close:
                os.closerange(0, 3)
            with open(marker, "a") as file:
                file.write(f"{os.getpid()}\\n")
            code = "import signal, time; signal.signal(signal.SIGTERM, signal.SIG_IGN); time.sleep(600)"
            os.execve(sys.executable, [sys.executable, "-S", "-c", code], {})
        os._exit(0)
    os.wait()


hide(True)
hide(False)
while not (os.path.exists(marker) and open(marker).read().count("\\n") == 2):
    time.sleep(0.01)
"""
TELL = """\
found = {"t": scene["time"]["times"]["hex"]}
for i, name in enumerate(("w1", "w2", "w3")):
    found[name] = [scene["initial"]["omega"]["hex"][i]] * len(found["t"])
json.dump(found, sys.stdout)
"""
HIDES = QUESTION + HIDING
HANG = "time.sleep(600)\n"
ENDINGS = [
    (TELL, Outcome.FINISHED),
    pytest.param(HANG, Outcome.TIMED_OUT, marks=pytest.mark.slow),
    ("os.abort()\n", Outcome.CRASHED),
    ("print('x' * 10**7)\n", Outcome.MISANSWERED),
]


@pytest.fixture
def program(tmp_path: Path) -> Path:
    return tmp_path / "a program.py"


@pytest.fixture
def hidden(program: Path) -> Iterator[Path]:
    """The file that names the hidden processes; what a failed test leaves of them is ended."""
    marker = Path(f"{program}.pids")
    yield marker
    for pid in numbers(marker):
        if is_alive(pid):
            os.kill(pid, signal.SIGKILL)


def numbers(marker: Path) -> list[int]:
    return [int(line) for line in marker.read_text().split()] if marker.exists() else []


def name(program: Path) -> str:
    return f"process:{shlex.join([sys.executable, '-S', str(program)])}"


def solve(program: Path, text: str, limit: float = 60) -> Trajectory:
    program.write_text(text)
    return process.Process(name(program), time_limit=limit).solve(three_instants())


@pytest.mark.parametrize(("ending", "outcome"), ENDINGS)
def test_processes_that_left_the_session_end_with_the_run(
    program: Path, hidden: Path, ending: str, outcome: Outcome
) -> None:
    """When the answer is there, nothing of the program is running any more."""
    trajectory = solve(program, HIDES + ending, limit=10 if ending == HANG else PATIENCE)
    assert trajectory.outcome is outcome
    assert "could not be ended" not in trajectory.detail
    assert len(numbers(hidden)) == 2
    assert not any(map(is_alive, numbers(hidden)))


def test_an_interrupt_ends_them(program: Path, hidden: Path) -> None:
    """Ctrl-C is heard at once, and nothing is left when it has been."""

    def interrupt() -> None:
        wait_until(lambda: len(numbers(hidden)) == 2)
        os.kill(os.getpid(), signal.SIGINT)

    with interruptible():
        threading.Thread(target=interrupt, daemon=True).start()
        with pytest.raises(KeyboardInterrupt):
            solve(program, HIDES + HANG)
    assert len(numbers(hidden)) == 2
    assert not any(map(is_alive, numbers(hidden)))


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGKILL])
def test_the_death_of_the_caller_ends_them(
    program: Path, hidden: Path, number: signal.Signals
) -> None:
    """A caller that is killed has no time for anything, and its program ends all the same."""
    program.write_text(HIDES + HANG)
    script = f"from taylor_verify.run import run\nrun('euler/rest', {name(program)!r})\n"
    with subprocess.Popen([sys.executable, "-c", script]) as caller:
        wait_until(lambda: len(numbers(hidden)) == 2 or caller.poll() is not None)
        caller.send_signal(number)
        assert caller.wait(PATIENCE) == -number
    assert len(numbers(hidden)) == 2
    wait_until(lambda: not any(map(is_alive, numbers(hidden))))


def test_other_children_of_the_caller_are_left_alone(program: Path, hidden: Path) -> None:
    """A process that the caller has started itself is no process of the program."""
    with subprocess.Popen(["sleep", "600"], start_new_session=True) as own:
        try:
            assert solve(program, HIDES + TELL).outcome is Outcome.FINISHED
            assert own.poll() is None
        finally:
            own.kill()


def supervised_by(folder: Path, changes: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Another system, as far as the supervisor can see."""
    file = folder / "supervisor.py"
    source = Path(supervisor.__file__).read_text()
    main = 'if __name__ == "__main__":'
    assert main in source
    file.write_text(source.replace(main, f"{changes}\n\n{main}"))
    monkeypatch.setattr(conversation, "_SUPERVISOR", file)


SLOW_REPORT = """
def _tell(link, line, tell=_tell):
    select.select([], [], [], 0.3)
    tell(link, line)
"""


@pytest.mark.parametrize("changes", ["", SLOW_REPORT], ids=["at once", "before it is told"])
def test_a_program_that_kills_its_supervisor_is_ended_and_told(
    program: Path, changes: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It is no answer, and the outcome says what is then unknown, however late the supervisor reports."""
    supervised_by(program.parent, changes, monkeypatch)
    kills = f"import os\nopen({str(program) + '.pids'!r}, 'w').write(str(os.getpid()))\n"
    trajectory = solve(program, f"{kills}import time; os.kill(os.getppid(), 9)\n{HANG}")
    assert trajectory.outcome is Outcome.CRASHED
    assert conversation._UNKNOWN in trajectory.detail
    (pid,) = numbers(Path(f"{program}.pids"))
    wait_until(lambda: not is_alive(pid))


def test_a_system_that_cannot_says_so(
    program: Path, hidden: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The session ends where nobody adopts orphans, and the detail says what may be left."""
    supervised_by(program.parent, "sys.platform = 'other'", monkeypatch)
    trajectory = solve(program, HIDES + TELL)
    assert trajectory.outcome is Outcome.FINISHED
    assert conversation._UNKNOWN in trajectory.detail
    assert all(map(is_alive, numbers(hidden)))


def test_a_process_that_cannot_be_ended_is_named(
    program: Path,
    hidden: Path,
    monkeypatch: pytest.MonkeyPatch,
    caplog: pytest.LogCaptureFixture,
) -> None:
    """The run does not wait for ever for a process of another user; a warning has its number."""
    changes = "_kill = lambda pid: None\n_PATIENCE = 0.5"
    supervised_by(program.parent, changes, monkeypatch)
    trajectory = solve(program, HIDES + TELL)
    assert trajectory.outcome is Outcome.FINISHED
    left = ",".join(map(str, sorted(numbers(hidden))))
    assert trajectory.detail == f"processes that could not be ended: {left}"
    (warning,) = caplog.messages
    assert trajectory.detail in warning


def test_the_program_has_the_signals_and_variables_of_a_shell(
    program: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A program cannot see that a supervisor stands between it and its caller."""
    monkeypatch.setenv("PYTHONPATH", "of the user's own")
    sees = """\
assert signal.getsignal(signal.SIGTERM) is signal.SIG_DFL
assert signal.getsignal(signal.SIGINT) is signal.default_int_handler
assert signal.pthread_sigmask(signal.SIG_BLOCK, ()) == set()
assert os.getsid(0) == os.getpid()
assert os.environ["PYTHONPATH"] == "of the user's own"
assert sorted(os.listdir("/proc/self/fd"))[:4] == ["0", "1", "2", "3"]  # the last is the list itself
assert not os.path.exists("/proc/self/fd/4")
"""
    with interruptible():
        trajectory = solve(program, QUESTION + sees + TELL)
    assert trajectory.outcome is Outcome.FINISHED, trajectory.detail
