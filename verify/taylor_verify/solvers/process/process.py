"""A solver that is a program of one's own, in any language: `--solver "process:./my_simulator"`.

The program is asked and answers as solvers/protocol.py says. It is stopped when its time is up
or when it says more than any answer needs; whatever it does, the run ends with an outcome. With it
end all the processes it started, also those that left its session: solvers/supervisor.py stands
between, and does so even if this process is killed. Where the system cannot do that (Linux can), a
process that left the session goes on, and the detail of the outcome says that it may.
"""

from __future__ import annotations

import json
import logging
import os
import selectors
import shlex
import signal
import socket
import subprocess
import sys
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from math import inf
from pathlib import Path
from time import monotonic, perf_counter
from typing import Any, Final, NamedTuple, final

from taylor_verify.models.problem import Problem
from taylor_verify.scenes.precision import Rung
from taylor_verify.solvers.process import protocol
from taylor_verify.solvers.solver import Callback, Solver
from taylor_verify.solvers.trajectory import Outcome, Trajectory

PREFIX: Final = "process:"
LIMIT_VARIABLE: Final = "TAYLOR_VERIFY_TIME_LIMIT"
# Seconds for one scene: a hundred times what rk4.py takes for any shipped one at a step of 0.02.
DEFAULT_LIMIT: Final = 300.0

_SUPERVISOR: Final = Path(__file__).with_name("supervisor.py")
_log = logging.getLogger(__name__)
# How long output is listened to after the last word of the supervisor: until then all of it was there.
_GLANCE = 0.05
# Seconds for the supervisor to end what is left, which it gives up after five itself.
_PATIENCE = 10.0
_CHUNK = 2**16
_KEPT_OF_STDERR = 2**13
_LINES_SHOWN, _LINE_SHOWN = 5, 300
# A step of any method is many operations, and no processor does one in a tenth of a nanosecond. To
# claim more steps than that is false, and would widen the bound of the judge.
_STEPS_PER_SECOND = 1e10


@final
@dataclass(frozen=True)
class Process(Solver):
    """The program behind ``process:COMMAND``; COMMAND is split as a shell would, and no shell runs.

    It may take ``time_limit`` seconds for a problem, its start included.
    """

    name: str
    time_limit: float = DEFAULT_LIMIT
    setting: str = ""

    @property
    def command(self) -> list[str]:
        return shlex.split(self.name.removeprefix(PREFIX))

    def unavailable(self, rung: Rung) -> str:
        del rung
        return unavailable()

    def solve(self, problem: Problem) -> Trajectory:
        asked = json.dumps(protocol.question(problem)).encode()
        began = perf_counter()
        ended = _converse(self.command, asked, self.time_limit, protocol.longest_answer(problem))
        seconds = perf_counter() - began
        if ended.outcome is not Outcome.FINISHED:
            return Trajectory(ended.outcome, detail=ended.detail(), seconds=seconds)
        try:
            found = _trajectory(ended.answer, problem, ended.seconds)
            return replace(found, detail=ended.left)
        except protocol.Misanswer as fault:
            outcome, what = Outcome.MISANSWERED, str(fault)
        except protocol.NotFinite as fault:
            outcome, what = Outcome.NON_FINITE, str(fault)
        detail = replace(ended, what=what).detail()
        return Trajectory(outcome, detail=detail, seconds=seconds)


def unavailable() -> str:
    """Return the reason why this system can run no program of a user; empty where it can."""
    if hasattr(os, "posix_spawnp"):
        return ""
    return (
        "programs are run on Linux and macOS alone: elsewhere nothing ends the processes they start"
    )


def named(name: str) -> Process:
    """The solver `process:COMMAND`, its time limit from the environment variable if that is set.

    Raises ValueError for a command that is empty or not closed, and for a limit that is no number.
    """
    try:
        command = shlex.split(name.removeprefix(PREFIX))
    except ValueError as error:
        raise ValueError(
            f"expected a command as a shell reads it, got {name!r} ({error})"
        ) from None
    if not command:
        raise ValueError(f"expected a command after {PREFIX}, got none")
    return Process(name, time_limit())


def time_limit() -> float:
    """Seconds for a problem, as the environment variable says; ValueError where it is no number."""
    text = os.environ.get(LIMIT_VARIABLE)
    if text is None or not text.strip():
        return DEFAULT_LIMIT
    with suppress(ValueError):
        if 0 < float(text) < inf:
            return float(text)
    raise ValueError(f"expected a positive number of seconds, got {text!r} @ {LIMIT_VARIABLE}")


def _trajectory(answer: bytes, problem: Problem, waited: float) -> Trajectory:
    """``waited``: the seconds of the whole run, start of the program and both pipes included."""
    found = protocol.read(answer, problem)
    if not found.steps <= _STEPS_PER_SECOND * waited:
        raise protocol.Misanswer(f"{found.steps} steps in {waited:.3g} seconds @ steps")
    seconds = waited if found.seconds is None else found.seconds
    if not seconds + found.compile_seconds <= waited:
        claimed = f"{seconds:.3g} + {found.compile_seconds:.3g}"
        raise protocol.Misanswer(
            f"expected seconds + compile_seconds within the {waited:.3g} that the whole run took, "
            f"got {claimed} @ seconds"
        )
    # The rows are from here on those of any solver of one's own.
    trajectory = Callback(lambda _: found.states).solve(problem)
    return replace(
        trajectory,
        steps=found.steps,
        evaluations=found.evaluations,
        seconds=seconds,
        compile_seconds=found.compile_seconds,
    )


# Running a program that may do anything.


@dataclass(frozen=True)
class _Ended:
    """The end of a program: its outcome, its answer, and the last of its words on stderr.

    ``seconds`` it ran; ``left`` says which of its processes are not known to have ended.
    """

    outcome: Outcome
    what: str = ""
    answer: bytes = b""
    stderr: bytes = b""
    seconds: float = 0.0
    left: str = ""

    def detail(self) -> str:
        said = _last_lines(self.stderr)
        parts = (self.what, self.left, said and f"stderr: {said}")
        return "; ".join(part for part in parts if part)


def _last_lines(stderr: bytes) -> str:
    lines = [line.rstrip() for line in stderr.decode(errors="replace").splitlines()]
    shown = [line[:_LINE_SHOWN] for line in lines if line][-_LINES_SHOWN:]
    # Escape sequences of a stranger are not for our terminal.
    return " / ".join("".join(c if c.isprintable() else " " for c in line) for line in shown)


def _converse(command: Sequence[str], asked: bytes, limit: float, longest: int) -> _Ended:
    """Start a program, ask it, and have its answer or the outcome; it never outlives the call."""
    # Isolated and without site: no variable meant for the program has an effect on the supervisor.
    supervisor = [sys.executable, "-I", "-S", str(_SUPERVISOR)]
    ours, theirs = socket.socketpair()
    try:
        process = subprocess.Popen(
            [*supervisor, str(theirs.fileno()), *command],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            pass_fds=[theirs.fileno()],
            start_new_session=True,
            bufsize=0,
        )
    except (OSError, ValueError) as error:
        ours.close()
        reason = getattr(error, "strerror", None) or str(error)
        return _Ended(Outcome.NOT_STARTED, f"{command[0]}: {reason}")
    finally:
        theirs.close()
    talk = _Talk(process, ours, asked)
    try:
        outcome, what = talk.listen(monotonic() + limit, longest)
    finally:
        report = talk.end()
    if outcome is Outcome.TIMED_OUT:
        what = f"{limit:g} seconds, settable by {LIMIT_VARIABLE}"
    elif outcome is Outcome.FINISHED:
        if report.refused:
            return _Ended(Outcome.NOT_STARTED, f"{command[0]}: {report.refused}")
        if report.status:
            outcome, what = Outcome.CRASHED, _status(report.status)
    if report.is_certain:
        _log.warning("taylor-verify: warning: %s @ %s", report.left, shlex.join(command))
    return _Ended(
        outcome, what, bytes(talk.answer), bytes(talk.stderr), report.seconds, report.left
    )


class _Report(NamedTuple):
    """The words of the supervisor, read: see there."""

    refused: str = ""
    program: int = 0
    status: int = 0
    seconds: float = 0.0
    left: str = ""
    is_certain: bool = False
    is_lost: bool = False

    @classmethod
    def read(cls, text: bytes) -> _Report:
        words = [line.split(" ", 1) for line in text.decode(errors="replace").splitlines()]
        said = {word: rest[0] for word, *rest in words if rest}
        if "refused" in said:
            return cls(refused=said["refused"])
        program = int(said.get("started", 0))
        if "ended" not in said:
            # The program, or somebody else, has killed it.
            return cls(program=program, status=-signal.SIGKILL, left=_UNKNOWN, is_lost=True)
        status, seconds, left = said["ended"].split()
        return cls("", program, int(status), float(seconds), *_left(left))


_UNKNOWN: Final = "processes that have left its session, if any, could not be ended"


def _left(numbers: str) -> tuple[str, bool]:
    """A sentence about the processes that are left, and whether it is known that there are any."""
    if numbers == "none":
        return "", False
    if numbers == "unknown":
        return _UNKNOWN, False
    return f"processes that could not be ended: {numbers}", True


class _Talk:
    """The pipes of a running program and the link to its supervisor; none is waited for alone."""

    def __init__(self, process: subprocess.Popen[bytes], link: socket.socket, asked: bytes) -> None:
        self.process, self.link = process, link
        self.unsaid = memoryview(asked)
        self.answer, self.stderr, self.report = bytearray(), bytearray(), bytearray()
        self.has_ended = False

    def listen(self, deadline: float, longest: int) -> tuple[Outcome, str]:
        """Exchange question and answer until the program ends, its time is up, or it says too much."""
        with selectors.DefaultSelector() as waiting:
            self._register(waiting)
            while waiting.get_map():
                left = deadline - monotonic()
                if left <= 0:
                    return Outcome.TIMED_OUT, ""
                ready = waiting.select(min(left, _GLANCE) if self.has_ended else left)
                for key, _ in ready:
                    if not key.data():
                        waiting.unregister(key.fileobj)
                        if key.fileobj is not self.link:
                            key.fileobj.close()  # type: ignore[union-attr]
                if len(self.answer) > longest:
                    return Outcome.MISANSWERED, f"more than {longest} bytes on standard output"
                if not ready and self.has_ended:
                    break
        return Outcome.FINISHED, ""

    def end(self) -> _Report:
        """Have the supervisor end what is left of the program and of all it started."""
        try:
            self.link.settimeout(_PATIENCE)
            with suppress(OSError):
                # The sign to end everything; after its own end nobody hears it.
                self.link.shutdown(socket.SHUT_WR)
                while read := self.link.recv(_CHUNK):
                    self.report += read
        finally:
            self.link.close()
        report = _Report.read(bytes(self.report))
        if report.is_lost and report.program:
            # Without its supervisor the program would go on.
            with suppress(ProcessLookupError, PermissionError):
                os.killpg(report.program, signal.SIGKILL)
        self.process.kill()
        self.process.wait()
        for pipe in (self.process.stdin, self.process.stdout, self.process.stderr):
            if pipe is not None:
                with suppress(OSError):
                    pipe.close()
        return report

    def _register(self, waiting: selectors.BaseSelector) -> None:
        for pipe, event, act in (
            (self.process.stdin, selectors.EVENT_WRITE, self._say),
            (self.process.stdout, selectors.EVENT_READ, self._hear),
            (self.process.stderr, selectors.EVENT_READ, self._overhear),
        ):
            assert pipe is not None
            os.set_blocking(pipe.fileno(), False)
            waiting.register(pipe, event, act)
        self.link.setblocking(False)
        waiting.register(self.link, selectors.EVENT_READ, self._supervise)

    # Each of these returns whether its pipe is still of use.

    def _say(self) -> bool:
        assert self.process.stdin
        try:
            said = os.write(self.process.stdin.fileno(), self.unsaid[:_CHUNK])
        except BlockingIOError:
            return True
        except OSError:
            # A program may answer without reading to the end.
            return False
        self.unsaid = self.unsaid[said:]
        return bool(self.unsaid)

    def _hear(self) -> bool:
        read = _read(self.process.stdout)
        self.answer += read or b""
        return read != b""

    def _supervise(self) -> bool:
        read = _read(self.link)
        self.report += read or b""
        self.has_ended = read == b""
        return not self.has_ended

    def _overhear(self) -> bool:
        read = _read(self.process.stderr)
        self.stderr += read or b""
        del self.stderr[:-_KEPT_OF_STDERR]
        return read != b""


def _read(pipe: Any) -> bytes | None:
    """What there is: nothing at the end, None where there is nothing yet."""
    try:
        return os.read(pipe.fileno(), _CHUNK)
    except BlockingIOError:
        return None


def _status(returncode: int) -> str:
    if returncode > 0:
        return f"exit status {returncode}"
    try:
        return f"signal {signal.Signals(-returncode).name}"
    except ValueError:
        return f"signal {-returncode}"
