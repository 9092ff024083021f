"""A session with a running program, which answers line by line until it is closed."""

from __future__ import annotations

import atexit
import json
from collections.abc import Mapping, Sequence
from time import monotonic
from typing import Any, Final

from taylor_verify.solvers.process.conversation import Talk
from taylor_verify.solvers.trajectory import Outcome

# Bytes of an answer: a million states take less.
_LONGEST: Final = 2**30
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
        self._talk = Talk(command)

    def ask(self, request: Mapping[str, Any], limit: float) -> dict[str, Any]:
        """Return the answer to a request within ``limit`` seconds; Broken where there is none."""
        self._talk.unsaid = memoryview(json.dumps(request).encode() + b"\n")
        outcome, _ = self._talk.listen(monotonic() + limit, _LONGEST, mark=b"\n")
        line, end, rest = self._talk.answer.partition(b"\n")
        if not end:
            is_late = outcome is Outcome.TIMED_OUT
            raise Broken(outcome if is_late else Outcome.CRASHED, self.last_words)
        self._talk.answer = rest
        try:
            answer = json.loads(line)
        except ValueError as error:
            raise Broken(Outcome.MISANSWERED, f"expected a line of JSON, got {error}") from error
        if not isinstance(answer, dict):
            raise Broken(Outcome.MISANSWERED, "expected a JSON object in a line")
        return answer

    def close(self) -> None:
        """End the program and wait for its end."""
        self._talk.end()

    @property
    def last_words(self) -> str:
        """The end of what the program has written to stderr."""
        words = self._talk.stderr.decode(errors="replace").split()
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
