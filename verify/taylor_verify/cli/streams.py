"""The streams of the process: the answer alone goes to stdout, messages to stderr."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager, redirect_stdout
from typing import Any, Final, TextIO

from taylor_verify.records.escapes import escaped, one_line, without_commands


class Manner:
    """Manner of talking: ``quiet`` without messages, in ``colour`` auto, always or never."""

    quiet: bool = False
    colour: str = "auto"


MANNER: Final = Manner()


def say(*lines: str) -> None:
    """Print a message, each of its lines in one line, unless the caller asked for none."""
    if not MANNER.quiet:
        tell(*lines)


def tell(*lines: str) -> None:
    """Print a message in any case."""
    tell_runner(without_commands("taylor-verify: " + "\n".join(map(one_line, lines))))


def tell_runner(line: str) -> None:
    """Print a line for the runner of a CI, which reads stderr too, and commands only at a line's start."""
    try:
        print(escaped(line), file=sys.stderr, flush=True)
    except OSError:
        _abandon(sys.stderr)


def as_json_text(document: Any) -> str:
    """Return a document as JSON, which escapes most of what commands a terminal or a runner by itself."""
    import json

    text = json.dumps(document, indent=1, allow_nan=False)
    return text.replace("\x7f", "\\u007f").replace("##[", "#\\u0023[")


def print_out(text: str = "") -> None:
    """Print the answer, if there is one; a reader that went away (`| head`) is no error."""
    try:
        if text:
            print(without_commands(text))
        sys.stdout.flush()
    except BrokenPipeError:
        _abandon(sys.stdout)
    except OSError as error:
        # Such as a full disk. The rest of the buffer must not be written again at the exit.
        _abandon(sys.stdout)
        raise OSError(error.errno, error.strerror, "stdout") from error


def _abandon(stream: TextIO) -> None:
    os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())


def have_streams() -> None:
    """Open a closed stream to nowhere, and let stdout escape characters that it cannot encode."""
    if sys.stdout is None:
        sys.stdout = open(os.devnull, "w")  # noqa: SIM115 (it is the stream of the process)
    if sys.stderr is None:
        sys.stderr = open(os.devnull, "w")  # noqa: SIM115
    reconfigure = getattr(sys.stdout, "reconfigure", None)
    if reconfigure is not None:
        reconfigure(errors="backslashreplace")


@contextmanager
def stdout_reserved() -> Iterator[None]:
    """Send to stderr whatever a library prints on stdout while a verb works, in workers too.

    heyoka has warnings of its own, which it writes below Python.
    """
    sys.stdout.flush()
    try:
        stdout = os.dup(1)
        os.dup2(2, 1)
    except OSError:  # one of them is closed: there is nothing to keep clean
        yield
        return
    try:
        with redirect_stdout(sys.stderr):
            yield
    finally:
        os.dup2(stdout, 1)
        os.close(stdout)
