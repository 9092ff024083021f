"""A run of an arbitrary program: question, answer, and the end of all processes that it started.

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
# Seconds to read remaining output after the last report of the supervisor.
_GLANCE = 0.05
# Seconds for the supervisor to end remaining processes; it gives up after five itself.
_PATIENCE = 10.0
_CHUNK = 2**16
_KEPT_OF_STDERR = 2**13
_LINES_SHOWN, _LINE_SHOWN = 5, 300


@dataclass(frozen=True)
class Ended:
    """The end of a program: its outcome, its answer, and its last lines on stderr.

    ``seconds`` it ran; ``left`` says which of its processes are not known to have ended.
    """

    outcome: Outcome
    what: str = ""
    answer: bytes = b""
    stderr: bytes = b""
    seconds: float = 0.0
    left: str = ""

    def detail(self) -> str:
        """Return what happened, what is left, and the last lines on stderr."""
        last_lines = _last_lines(self.stderr)
        parts = (self.what, self.left, last_lines and f"stderr: {last_lines}")
        return "; ".join(part for part in parts if part)


def _last_lines(stderr: bytes) -> str:
    lines = [line.rstrip() for line in stderr.decode(errors="replace").splitlines()]
    shown = [line[:_LINE_SHOWN] for line in lines if line][-_LINES_SHOWN:]
    # Escape sequences of a stranger are not for our terminal.
    return " / ".join("".join(c if c.isprintable() else " " for c in line) for line in shown)


def converse(
    command: Sequence[str], asked: bytes, limit: float, longest: int, folder: str | None = None
) -> Ended:
    """Start a program, send the question, and return its answer or outcome; it never outlives the call.

    It runs in ``folder``, or in the working folder of this process.
    """
    try:
        process, link = supervised(command, subprocess.PIPE, folder)
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        return Ended(Outcome.NOT_STARTED, f"{command[0]}: {reason}")
    talk = Talk(process, link)
    talk.unsaid = memoryview(asked)
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


def supervised(
    command: Sequence[str], stderr: Any, folder: str | None = None
) -> tuple[subprocess.Popen[bytes], socket.socket]:
    """Start a program under its supervisor, and return it with the link to the supervisor."""
    # Isolated and without site: no variable meant for the program has an effect on the supervisor.
    supervisor = [sys.executable, "-I", "-S", str(_SUPERVISOR)]
    ours, theirs = socket.socketpair()
    try:
        process = subprocess.Popen(
            [*supervisor, str(theirs.fileno()), *command],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=stderr,
            pass_fds=[theirs.fileno()],
            start_new_session=True,
            cwd=folder,
            bufsize=0,
        )
    except BaseException:
        ours.close()
        raise
    finally:
        theirs.close()
    return process, ours


_UNKNOWN: Final = "processes that have left its session, if any, could not be ended"


class _Report(NamedTuple):
    """The parsed reports of the supervisor (see supervisor.py).

    ``left`` is a sentence on the processes that are left; it ``is_certain`` where they are known.
    """

    refused: str = ""
    program: int = 0
    status: int = 0
    seconds: float = 0.0
    left: str = ""
    is_certain: bool = False
    is_lost: bool = False

    @classmethod
    def read(cls, text: bytes) -> _Report:
        words = (line.partition(" ") for line in text.decode(errors="replace").splitlines())
        reports = {word: rest for word, space, rest in words if space}
        if "refused" in reports:
            return cls(refused=reports["refused"])
        program = int(reports.get("started", 0))
        if "ended" not in reports:
            # The supervisor itself was killed.
            return cls(program=program, status=-signal.SIGKILL, left=_UNKNOWN, is_lost=True)
        status, seconds, numbers = reports["ended"].split()
        is_certain = numbers not in ("none", "unknown")
        left = {"none": "", "unknown": _UNKNOWN}.get(
            numbers, f"processes that could not be ended: {numbers}"
        )
        return cls("", program, int(status), float(seconds), left, is_certain)


class Talk:
    """The pipes of a running program and the link to its supervisor, all watched together.

    ``unsaid`` is what the program has yet to be told, and ``answer`` what it has said.
    """

    def __init__(self, process: subprocess.Popen[bytes], link: socket.socket) -> None:
        self.process, self.link = process, link
        self.unsaid = memoryview(b"")
        self.answer, self.stderr, self.report = bytearray(), bytearray(), bytearray()

    def listen(self, deadline: float, longest: int, mark: bytes = b"") -> tuple[Outcome, str]:
        """Exchange question and answer until the program ends, time is up, or the answer is too long.

        With a ``mark`` the answer is whole where it has that, and the program may be asked again.
        """
        has_ended = False
        with selectors.DefaultSelector() as waiting:
            self._register(waiting)
            while waiting.get_map():
                left = deadline - monotonic()
                if left <= 0:
                    return Outcome.TIMED_OUT, ""
                ready = waiting.select(min(left, _GLANCE) if has_ended else left)
                for key, _ in ready:
                    pipe: Any = key.fileobj
                    if self._say() if key.data is None else _hear(pipe, key.data):
                        continue
                    waiting.unregister(pipe)
                    if pipe is self.link:
                        has_ended = True
                    elif not (mark and key.data is None):
                        pipe.close()
                del self.stderr[:-_KEPT_OF_STDERR]
                if len(self.answer) > longest:
                    return Outcome.MISANSWERED, f"more than {longest} bytes on standard output"
                if (not ready and has_ended) or (mark and mark in self.answer):
                    break
        return Outcome.FINISHED, ""

    def end(self) -> _Report:
        """Have the supervisor end what is left of the program and of all it started."""
        try:
            self.link.settimeout(_PATIENCE)
            with suppress(OSError):
                # Closing the link tells the supervisor to end everything.
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
        """Register all pipes: the question to be written, and the buffers to be read."""
        for pipe, buffer in (
            (self.process.stdin, None),
            (self.process.stdout, self.answer),
            (self.process.stderr, self.stderr),
            (self.link, self.report),
        ):
            assert pipe is not None
            os.set_blocking(pipe.fileno(), False)
            event = selectors.EVENT_WRITE if buffer is None else selectors.EVENT_READ
            waiting.register(pipe, event, buffer)

    def _say(self) -> bool:
        """Write as much as the pipe accepts; return True if more remains."""
        assert self.process.stdin
        try:
            count = os.write(self.process.stdin.fileno(), self.unsaid[:_CHUNK])
        except BlockingIOError:
            return True
        except OSError:
            # A program may answer without reading to the end.
            return False
        self.unsaid = self.unsaid[count:]
        return bool(self.unsaid)


def _hear(pipe: Any, buffer: bytearray) -> bool:
    """Put what there is into the buffer; False at the end of the pipe."""
    try:
        read = os.read(pipe.fileno(), _CHUNK)
    except BlockingIOError:
        return True
    buffer += read
    return bool(read)


def _status(returncode: int) -> str:
    if returncode > 0:
        return f"exit status {returncode}"
    try:
        return f"signal {signal.Signals(-returncode).name}"
    except ValueError:
        return f"signal {-returncode}"
