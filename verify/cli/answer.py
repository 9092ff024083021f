"""What a verb answers: an exit status, a JSON document and a way to show it to a person."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

PASS, FAIL, WRONG_CALL, UNDECIDED, INTERRUPTED = 0, 1, 2, 3, 130


class WrongCall(Exception):  # noqa: N818 (it names what was done)
    """The call or its input was wrong; the text is the message."""


@dataclass(frozen=True)
class Answer:
    """``messages`` go to stderr, then ``document`` or what ``show`` prints to stdout."""

    status: int
    document: dict[str, Any]
    show: Callable[[], None]
    messages: Sequence[str] = ()
