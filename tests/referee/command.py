"""The command `taylor-verify exact`, asked many questions by way of one child process."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from types import TracebackType
from typing import Any, Final, NamedTuple

# The child alone imports the package, and what it imports for one answer serves for the next.
_CHILD: Final = """
import contextlib, io, json, sys
from taylor_verify.cli import main

for line in sys.stdin:
    out, error = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(error):
        try:
            status = main(json.loads(line))
        except SystemExit as stop:
            status = stop.code
    print(json.dumps([status, out.getvalue(), error.getvalue()]), flush=True)
"""


class Answer(NamedTuple):
    """Exit status, document and messages of one call."""

    status: int
    document: dict[str, Any]
    messages: str

    @property
    def refusal(self) -> str | None:
        """Reason for which there is no full answer; None if there is one."""
        if self.status == 0:
            return None
        return f"exit {self.status}: {self.messages.strip() or self.document.get('because')}"


class Command:
    """A child process that runs the command once for each question."""

    def __init__(self, folder: Path) -> None:
        self._file = folder / "scene.toml"
        arguments = [sys.executable, "-c", _CHILD]
        self._child = subprocess.Popen(
            arguments, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, encoding="utf-8"
        )

    def __enter__(self) -> Command:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._child.kill()
        # Both pipes are closed with it.
        self._child.communicate()

    def exact(self, text: str, times: Sequence[str], digits: int) -> Answer:
        """Return what the command answers about a scene of this text."""
        self._file.write_text(text, encoding="utf-8")
        asked = f"--at={','.join(times)}", f"--digits={digits}", "--json"
        return self._call("exact", str(self._file), *asked)

    def _call(self, *arguments: str) -> Answer:
        assert self._child.stdin is not None
        assert self._child.stdout is not None
        print(json.dumps(arguments), file=self._child.stdin, flush=True)
        status, out, messages = json.loads(self._child.stdout.readline())
        return Answer(status, json.loads(out) if out else {}, messages)
