"""One run of a program that may do anything: it is asked, heard, and ended with all that it started.

supervisor.py stands between the program and this process. psutil could not do its work: it finds a
process by its parent, and an orphan that has left the session has another one.
"""

from __future__ import annotations

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
from dataclasses import dataclass
from pathlib import Path
from time import monotonic
from typing import Any, Final, NamedTuple

from taylor_verify.solvers.trajectory import Outcome

LIMIT_VARIABLE: Final = "TAYLOR_VERIFY_TIME_LIMIT"

_SUPERVISOR: Final = Path(__file__).with_name("supervisor.py")
_log = logging.getLogger(__name__)
# How long output is listened to after the last word of the supervisor: until then all of it was there.
_GLANCE = 0.05
# Seconds for the supervisor to end what is left, which it gives up after five itself.
_PATIENCE = 10.0
_CHUNK = 2**16
_KEPT_OF_STDERR = 2**13
_LINES_SHOWN, _LINE_SHOWN = 5, 300


@dataclass(frozen=True)
class Ended:
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


def converse(command: Sequence[str], asked: bytes, limit: float, longest: int) -> Ended:
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
        return Ended(Outcome.NOT_STARTED, f"{command[0]}: {reason}")
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
            return Ended(Outcome.NOT_STARTED, f"{command[0]}: {report.refused}")
        if report.status:
            outcome, what = Outcome.CRASHED, _status(report.status)
    if report.is_certain:
        _log.warning("taylor-verify: warning: %s @ %s", report.left, shlex.join(command))
    return Ended(outcome, what, bytes(talk.answer), bytes(talk.stderr), report.seconds, report.left)


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
