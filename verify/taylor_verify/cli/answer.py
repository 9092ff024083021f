"""Answer of a verb: an exit status, a JSON document and a text for a person."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any, NamedTuple

from taylor_verify.records.faults import Refused

PASS, FAIL, WRONG_CALL, UNDECIDED, INTERRUPTED = 0, 1, 2, 3, 130
# The graver first: a call that went wrong has shown nothing at all.
_GRAVITY = (WRONG_CALL, FAIL, UNDECIDED, PASS)


class WrongCall(Exception):  # noqa: N818 (it names what was done)
    """The call or its input was wrong; ``faults`` are the lines of the message."""

    def __init__(self, *faults: str) -> None:
        self.faults = faults
        super().__init__("\n".join(faults))


class CallParts:
    """Parts of a call that are read one after another before any work begins, and their ``faults``."""

    def __init__(self) -> None:
        self.faults: list[str] = []

    def read(self, read: Callable[..., Any], *given: Any) -> Any:
        """Return what is read; None after a wrong call or a refusal, whose lines are noted."""
        try:
            return read(*given)
        except (WrongCall, Refused) as error:
            self.faults += error.faults

    def end(self) -> None:
        """Raise WrongCall with the faults of all parts, if there are any."""
        if self.faults:
            raise WrongCall(*self.faults)


@contextmanager
def wrong_calls(
    place: str = "", kinds: type[Exception] | tuple[type[Exception], ...] = ValueError
) -> Iterator[None]:
    """Report exceptions of some kinds as wrong calls, the place behind their text."""
    try:
        yield
    except kinds as error:
        *lines, last = lines_of(error)
        raise WrongCall(*lines, f"{last}{place}") from error


def lines_of(error: Exception) -> Sequence[str]:
    """Return the faults that an exception tells, each in a line."""
    return getattr(error, "faults", None) or str(error).split("\n")


class Answer(NamedTuple):
    """``document`` as JSON or else ``text()`` is for stdout; ``messages`` follow on stderr.

    ``failing`` are the lines on what is no pass, for a caller who wants no more.
    """

    status: int
    document: dict[str, Any] | list[dict[str, Any]]
    text: Callable[[], str]
    messages: Sequence[str] = ()
    failing: Sequence[str] = ()

    @property
    def short_text(self) -> str:
        """The lines on what is no pass, and the last line of the text that is no hint."""
        lines = self.text().rstrip().split("\n")
        if not self.failing:
            return lines[-1]
        end = next((line for line in reversed(lines) if not line.startswith(" ")), "")
        return "\n".join(dict.fromkeys([*self.failing, end]))


def graver(*statuses: int) -> int:
    """Return the gravest of some exit statuses."""
    return min(statuses, key=_GRAVITY.index)
