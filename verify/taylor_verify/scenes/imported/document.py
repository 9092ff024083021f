"""An XML document as a tree of nodes, of bounded size and depth.

A document type is refused where it begins: it could name other files, and entities that grow a
thousandfold. Nothing but the one file is ever opened.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final
from xml.parsers import expat

from taylor_verify.records.faults import Refused
from taylor_verify.records.limit import Limit
from taylor_verify.scenes.reading.regular_file import read_bytes

MOST_BYTES: Final = Limit(2**24, "bytes", "a description of a robot has its meshes in other files")
MOST_ELEMENTS: Final = Limit(200_000, "elements", "a robot of a thousand links has a fifth of them")
DEEPEST: Final = Limit(200, "elements inside each other", "the longest chain of bodies is shorter")


@dataclass
class Node:
    """An element: its name with prefix, attributes, the line where it begins, children, text in pieces."""

    name: str
    attributes: dict[str, str]
    line: int
    children: list[Node] = field(default_factory=list)
    # They are joined once: time would grow as the square of the length of a text that grows.
    pieces: list[str] = field(default_factory=list)

    @property
    def text(self) -> str:
        return "".join(self.pieces)

    def all(self) -> Iterator[Node]:
        """Yield this node and everything below it, in the order of the file."""
        yield self
        for child in self.children:
            yield from child.all()

    def named(self, *names: str) -> list[Node]:
        """Return the children of these names, in the order of the file."""
        return [child for child in self.children if child.name in names]

    def child(self, name: str) -> Node | None:
        """Return the first child of this name."""
        return next(iter(self.named(name)), None)


def read_document(path: Path) -> Node:
    """Return the root element.

    Raises Refused for a text that is no XML, has a document type, or is too large or too deep.
    """
    content = read_bytes(path, "a readable URDF, SDF or MJCF file", MOST_BYTES)
    return _Builder(path).root(content)


class _Builder:
    """Builder of nodes from the events of the parser."""

    def __init__(self, path: Path) -> None:
        self._path = path
        # The open nodes, below a node that holds the root.
        self._open = [Node("", {}, 0)]
        self._elements = 0
        self._parser = expat.ParserCreate()
        self._parser.buffer_text = True
        self._parser.StartDoctypeDeclHandler = self._refuse_doctype
        self._parser.StartElementHandler = self._begin
        self._parser.EndElementHandler = lambda name: self._open.pop()
        self._parser.CharacterDataHandler = lambda text: self._open[-1].pieces.append(text)

    def root(self, content: bytes) -> Node:
        try:
            self._parser.Parse(content, True)  # noqa: FBT003 (Parse has no names)
        except Refused:
            raise
        except (expat.ExpatError, LookupError, ValueError) as error:
            line = f"expected an XML document, got a fault in it: {error} @ {self._path}"
            raise Refused([line]) from None
        # expat refuses a document without an element.
        return self._open[0].children[0]

    def _refuse_doctype(self, name: str, *rest: object) -> None:
        line = self._parser.CurrentLineNumber
        expected = (
            "XML without a document type, which could name other files and entities without end"
        )
        raise Refused([f"expected {expected}, got <!DOCTYPE {name:.60}> @ {self._path}:{line}"])

    def _begin(self, name: str, attributes: dict[str, str]) -> None:
        self._elements += 1
        line = self._parser.CurrentLineNumber
        DEEPEST.check(len(self._open), f"{self._path}:{line}")
        MOST_ELEMENTS.check(self._elements, f"{self._path}:{line}")
        node = Node(name, attributes, line)
        self._open[-1].children.append(node)
        self._open.append(node)
