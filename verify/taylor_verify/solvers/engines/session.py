"""A session with a running program, which answers line by line and ends with this process at the latest.

The same supervisor as for single questions stands between the program and this process. It ends the
program, and all processes that the program started, as soon as the session is closed.
"""

from __future__ import annotations

import atexit
import json
import selectors
import socket
import subprocess
import tempfile
from collections.abc import Mapping, Sequence
from contextlib import suppress
from time import monotonic
from typing import Any, Final

from taylor_verify.solvers.process.conversation import supervised
from taylor_verify.solvers.trajectory import Outcome

_CHUNK: Final = 2**16
# Seconds for the supervisor to end what is left.
_PATIENCE: Final = 10.0
_LAST_WORDS: Final = 300

_open: dict[tuple[str, ...], Session] = {}


class Broken(Exception):
    """The error for a program that no longer answers; ``outcome`` is its end, and the text the reason."""

    def __init__(self, outcome: Outcome, detail: str) -> None:
        super().__init__(detail)
        self.outcome = outcome


class Session:
    """A running program."""

    def __init__(self, command: Sequence[str]) -> None:
        self._stderr = tempfile.TemporaryFile()  # noqa: SIM115 (open as long as the program runs)
        self._rest = b""
        self._process, self._link = supervised(command, self._stderr)

    def ask(self, request: Mapping[str, Any], limit: float) -> dict[str, Any]:
        """Return the answer to a request within ``limit`` seconds; Broken where there is none."""
        assert self._process.stdin
        with suppress(BrokenPipeError):
            self._process.stdin.write(json.dumps(request).encode() + b"\n")
        try:
            answer = json.loads(self._line(monotonic() + limit))
        except ValueError as error:
            raise Broken(Outcome.MISANSWERED, f"expected a line of JSON, got {error}") from error
        if not isinstance(answer, dict):
            raise Broken(Outcome.MISANSWERED, "expected a JSON object in a line")
        return answer

    def close(self) -> None:
        """End the program and wait for its end."""
        with suppress(OSError):
            self._link.shutdown(socket.SHUT_WR)
        with suppress(subprocess.TimeoutExpired):
            self._process.wait(_PATIENCE)
        self._process.kill()
        self._process.wait()
        for stream in (self._process.stdin, self._process.stdout, self._link, self._stderr):
            if stream is not None:
                stream.close()

    def _line(self, deadline: float) -> bytes:
        """Return the next line of the program."""
        assert self._process.stdout
        with selectors.DefaultSelector() as waiting:
            waiting.register(self._process.stdout, selectors.EVENT_READ)
            while b"\n" not in self._rest:
                if not waiting.select(max(0.0, deadline - monotonic())):
                    raise Broken(Outcome.TIMED_OUT, self._last_words())
                if not (read := self._process.stdout.read(_CHUNK)):
                    raise Broken(Outcome.CRASHED, self._last_words())
                self._rest += read
        line, _, self._rest = self._rest.partition(b"\n")
        return line

    def _last_words(self) -> str:
        self._stderr.seek(0)
        words = self._stderr.read().decode(errors="replace").split()
        return "".join(c for c in " ".join(words) if c.isprintable())[-_LAST_WORDS:]


def session(command: Sequence[str]) -> Session:
    """Return the session of a command, which is started if it does not run."""
    key = tuple(command)
    if key not in _open:
        _open[key] = Session(command)
    return _open[key]


def end_sessions(command: Sequence[str] | None = None) -> None:
    """End the session of a command, or all there are."""
    for key in [tuple(command)] if command is not None else list(_open):
        if key in _open:
            _open.pop(key).close()


atexit.register(end_sessions)
