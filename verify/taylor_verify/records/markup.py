"""The events of an XML document in their order, with limits on elements, their depth and their tags.

A document type is refused where it begins, in any encoding: it could name other files, and entities that
grow a thousandfold. Nothing but the one file is ever opened.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from pathlib import Path
from typing import BinaryIO, Final
from xml.parsers import expat

from taylor_verify.records.faults import Refused, refusal
from taylor_verify.records.limit import Limit

DEEPEST: Final = Limit(200, "elements inside each other", "the longest chain of bodies is shorter")
TAG: Final = Limit(2**24, "bytes in a tag or a comment", "a mesh in one attribute is shorter")
_AT_ONCE: Final = 2**20
_NO_TYPE: Final = (
    "XML without a document type, which could name other files and entities without end"
)


class Markup(ABC):
    """A reader of an XML document: what it makes of the events is the reader's own.

    Names are those that the document writes, prefixes included.
    """

    def __init__(self, path: Path, elements: Limit) -> None:
        self.path = path
        self._most, self._elements, self._depth = elements, 0, 0
        self._parser = parser = expat.ParserCreate()
        parser.buffer_text = True
        parser.StartDoctypeDeclHandler = self._refuse_doctype
        parser.StartElementHandler = self._begin
        parser.EndElementHandler = self._end
        parser.CharacterDataHandler = self.text

    @abstractmethod
    def begin(self, name: str, attributes: Mapping[str, str]) -> None:
        """Take the beginning of an element."""

    @abstractmethod
    def text(self, text: str) -> None:
        """Take a piece of the text of the element that began last and has not ended."""

    @abstractmethod
    def end(self, name: str) -> None:
        """Take the end of an element."""

    @property
    def line(self) -> int:
        """The line of the event."""
        return self._parser.CurrentLineNumber

    @property
    def place(self) -> str:
        """The file and the line of the event."""
        return f"{self.path}:{self.line}"

    def read(self, file: BinaryIO) -> None:
        """Read a document to its end. Raises Refused for what is no XML, and at a limit."""
        size = 0
        try:
            while piece := file.read(_AT_ONCE):
                size += len(piece)
                self._parser.Parse(piece, False)  # noqa: FBT003 (Parse has no names)
                TAG.check(size - max(self._parser.CurrentByteIndex, 0), self.place)
            self._parser.Parse(b"", True)  # noqa: FBT003
        except Refused:
            raise
        except (expat.ExpatError, LookupError, ValueError) as error:
            raise refusal("an XML document", f"a fault in it: {error}", self.path) from None

    def _refuse_doctype(self, name: str, *rest: object) -> None:
        raise refusal(_NO_TYPE, f"<!DOCTYPE {name:.60}>", self.place)

    def _begin(self, name: str, attributes: dict[str, str]) -> None:
        self._elements += 1
        self._depth += 1
        if self._elements > self._most.most:
            raise self._most.refusal("more", self.place)
        if self._depth > DEEPEST.most:
            raise DEEPEST.refusal("more", self.place)
        self.begin(name, attributes)

    def _end(self, name: str) -> None:
        self._depth -= 1
        self.end(name)
