"""A run of an arbitrary program: question, answer, and the end of its session.

What a program starts in its own session ends with it. A process that leaves the session goes on.
"""

from __future__ import annotations

import os
import selectors
import signal
import subprocess
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass
from time import monotonic
from typing import Any, Final

from taylor_verify.solvers.trajectory import Outcome

LIMIT_VARIABLE: Final = "TAYLOR_VERIFY_TIME_LIMIT"

# Seconds after which it is seen that a program has ended whose pipes another process holds.
_GLANCE = 0.05
_CHUNK = 2**16
_KEPT_OF_STDERR = 2**13
_LINES_SHOWN, _LINE_SHOWN = 5, 300


@dataclass(frozen=True)
class Ended:
    """The end of a program: its outcome, its answer, its last lines on stderr, and the seconds it ran."""

    outcome: Outcome
    what: str = ""
    answer: bytes = b""
    stderr: bytes = b""
    seconds: float = 0.0

    def detail(self) -> str:
        """Return what happened, and the last lines on stderr."""
        last_lines = _last_lines(self.stderr)
        parts = (self.what, last_lines and f"stderr: {last_lines}")
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
    began = monotonic()
    try:
        talk = Talk(command, folder)
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        return Ended(Outcome.NOT_STARTED, f"{command[0]}: {reason}")
    talk.unsaid = memoryview(asked)
    try:
        outcome, what = talk.listen(began + limit, longest)
        status, seconds = talk.process.returncode, monotonic() - began
    finally:
        talk.end()
    if outcome is Outcome.TIMED_OUT:
        what = f"{limit:g} seconds, settable by {LIMIT_VARIABLE}"
    elif outcome is Outcome.FINISHED and status:
        outcome, what = Outcome.CRASHED, _status(status)
    return Ended(outcome, what, bytes(talk.answer), bytes(talk.stderr), seconds)


class Talk:
    """The pipes of a program in a session of its own, all watched together.

    ``unsaid`` is what the program has yet to be told, and ``answer`` what it has said.
    """

    def __init__(self, command: Sequence[str], folder: str | None = None) -> None:
        pipe = subprocess.PIPE
        self.process = subprocess.Popen(
            command,
            stdin=pipe,
            stdout=pipe,
            stderr=pipe,
            start_new_session=True,
            cwd=folder,
            bufsize=0,
        )
        self.unsaid = memoryview(b"")
        self.answer, self.stderr = bytearray(), bytearray()

    def listen(self, deadline: float, longest: int, mark: bytes = b"") -> tuple[Outcome, str]:
        """Exchange question and answer until the program ends, time is up, or the answer is too long.

        With a ``mark`` the answer is whole where it has that, and the program may be asked again.
        """
        with selectors.DefaultSelector() as waiting:
            self._register(waiting)
            while waiting.get_map():
                left = deadline - monotonic()
                if left <= 0:
                    return Outcome.TIMED_OUT, ""
                ready = waiting.select(min(left, _GLANCE))
                for key, _ in ready:
                    pipe: Any = key.fileobj
                    if self._say() if key.data is None else _hear(pipe, key.data):
                        continue
                    waiting.unregister(pipe)
                    if not (mark and key.data is None):
                        pipe.close()
                del self.stderr[:-_KEPT_OF_STDERR]
                if len(self.answer) > longest:
                    return Outcome.MISANSWERED, f"more than {longest} bytes on standard output"
                if mark and mark in self.answer:
                    return Outcome.FINISHED, ""
                if not ready and self.process.poll() is not None:
                    break
        try:
            self.process.wait(max(deadline - monotonic(), 0.0))
        except subprocess.TimeoutExpired:
            return Outcome.TIMED_OUT, ""
        return Outcome.FINISHED, ""

    def end(self) -> None:
        """End the program and what else is in its session."""
        with suppress(ProcessLookupError, PermissionError):
            os.killpg(self.process.pid, signal.SIGKILL)
        self.process.wait()
        for pipe in (self.process.stdin, self.process.stdout, self.process.stderr):
            if pipe is not None:
                with suppress(OSError):
                    pipe.close()

    def _register(self, waiting: selectors.BaseSelector) -> None:
        """Register all pipes: the question to be written, and the buffers to be read."""
        for pipe, buffer in (
            (self.process.stdin, None),
            (self.process.stdout, self.answer),
            (self.process.stderr, self.stderr),
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
