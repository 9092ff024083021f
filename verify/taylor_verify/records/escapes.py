"""Names of files as they are shown: what would steer a terminal or command a runner is escaped."""

from __future__ import annotations

import re
from typing import Final

# The C0 and C1 control characters but tab and line feed, separators of lines, and marks that change
# the direction of text; and the beginning of a command that GitHub's runner obeys anywhere in a line.
_CONTROL: Final = re.compile(
    "[\x00-\x08\x0b-\x1f\x7f-\x9f\u200e\u200f\u2028\u2029\u202a-\u202e\u2066-\u2069]|##(?=\\[)"
)
# The runner obeys a line that begins so, behind blanks too.
_COMMAND: Final = re.compile(r"^(\s*):(?=:)", re.MULTILINE)
_ESCAPES: Final = {"##": r"#\x23"}


def escaped(text: str) -> str:
    """Return the text with an escape for each character that would steer a terminal."""
    return _CONTROL.sub(_escape, text)


def _escape(character: re.Match[str]) -> str:
    return _ESCAPES.get(character[0]) or ascii(character[0])[1:-1]


def one_line(text: str) -> str:
    """Return the text escaped, its line feeds too: a name never begins a line."""
    return _CONTROL.sub(_escape, text).replace("\n", r"\n")


def without_commands(text: str) -> str:
    """Return a text of many lines of which none is a command for a runner."""
    return _COMMAND.sub(r"\1\\x3a", text)
