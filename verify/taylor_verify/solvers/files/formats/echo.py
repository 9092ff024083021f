"""Messages as `ros2 topic echo` and `rostopic echo` print them: documents of YAML between lines of `---`.

A line is a key and perhaps its value, or an item of a list; what is inside another object is indented.
`gz topic -e` prints protobuf's text: objects in braces, and a blank line between messages.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Final

from taylor_verify.records.faults import cut, refusal
from taylor_verify.solvers.files.formats.column import KEYS, Table
from taylor_verify.solvers.files.formats.content import Content
from taylor_verify.solvers.files.formats.entries import Entries, table

_START: Final = re.compile(
    rb"(?:\xef\xbb\xbf)?\s*(?:---\s+)?\w+(?::[ \t]*| \{)\r?\n[ \t]+\w+(?::| \{)"
)
_BEGINNING: Final = 4096
_BETWEEN: Final = "---"
_OPENS, _CLOSES = " {", "}"
_KEY: Final = re.compile(r"([^\s:#\[\]{}'\"]+):(?:\s+(.*))?")


def is_one(file: Content) -> bool:
    """Return True for a text that begins with an object in a key."""
    return _START.match(file.beginning(_BEGINNING)) is not None


def read(file: Content, path: Path) -> Table:
    """Return a column for each number in the messages, by its path."""
    return table(_messages(file, path), path)


def _messages(file: Content, path: Path) -> Iterator[Entries]:
    message, has_braces, first = _Message(), False, set[str]()
    for number, text in enumerate(file.lines(), start=1):
        line = text.rstrip()
        has_braces |= line.endswith(_OPENS)
        if line.startswith(_BETWEEN) or (has_braces and not line):
            if message.entries.values:
                first = first or {*message.entries.values}
                yield message.entries
            message = _Message()
        elif line and not line.lstrip().startswith(("#", _CLOSES)):
            opened = f"{line.removesuffix(_OPENS)}:" if line.endswith(_OPENS) else line
            message.take(opened, f"{path}, line {number}")
            KEYS.check(len(message.entries.values), path)
    if not has_braces and set() < {*message.entries.values} < first:
        # protobuf leaves out what is zero; ROS prints it.
        got = f"one that ends with `{cut(line.strip())}`"
        raise refusal("whole messages", got, f"{path}, line {number}", "remove the last one")
    if message.entries.values:
        yield message.entries


class _Message:
    """The numbers of a message so far, and the objects that are open: their indents and their paths."""

    def __init__(self) -> None:
        self.entries = Entries()
        self._open: list[tuple[int, str]] = []
        self._items: Counter[str] = Counter()

    def take(self, line: str, place: str) -> None:
        """Take a line. Raises Refused for one that is neither a key nor an item."""
        text = line.lstrip(" ")
        indent = len(line) - len(text)
        if text.startswith("- "):
            # The items of a list stand as far to the right as its key, or further.
            path = self._inside(indent + 1)
            item, text = f"{path}[{self._items[path]}]", text[2:].strip()
            self._items[path] += 1
            self._open.append((indent + 1, item))
            indent += 2
            if not _KEY.fullmatch(text):
                self._put(item, text)
                return
        match = _KEY.fullmatch(text)
        if match is None:
            raise refusal("`key: value` or `- value`", repr(cut(text)), place)
        parent = self._inside(indent)
        path = f"{parent}.{match[1]}" if parent else match[1]
        self.entries.inner.add(parent)
        if match[2]:
            self._put(path, match[2])
        else:
            self._open.append((indent, path))

    def _inside(self, indent: int) -> str:
        """Return the path of the object that a line of this indent is in."""
        while self._open and self._open[-1][0] >= indent:
            self._open.pop()
        return self._open[-1][1] if self._open else ""

    def _put(self, path: str, text: str) -> None:
        if text.startswith("[") and text.endswith("]"):
            for k, each in enumerate(text[1:-1].split(",")):
                self.entries.values[f"{path}[{k}]"] = each.strip()
        else:
            self.entries.values[path] = text.strip("'\"")
