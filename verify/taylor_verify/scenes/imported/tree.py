"""An XML document as a tree of nodes, of bounded size and depth."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final, NamedTuple

from taylor_verify.records.limit import Limit
from taylor_verify.records.markup import Markup
from taylor_verify.records.regular_file import regular_file

MOST_BYTES: Final = Limit(2**24, "bytes", "a description of a robot has its meshes in other files")
MOST_ELEMENTS: Final = Limit(200_000, "elements", "a robot of a thousand links has a fifth of them")


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

    def written(self, name: str) -> str:
        """Return the text of the first child of this name; empty where there is none."""
        child = self.child(name)
        return "" if child is None else child.text.strip()


class Scoped(NamedTuple):
    """A node of a model, with the names of the models that it is in."""

    scope: str
    node: Node

    @property
    def name(self) -> str:
        """The name of the node behind those of its models."""
        return self.scope + self.node.attributes.get("name", "")


def scoped(part: Node, scope: str = "") -> Iterator[Scoped]:
    """Yield every link, joint and plugin with the models around it, and the gravity of a world."""
    for node in part.children:
        item = Scoped(scope, node)
        if node.name in ("model", "world", "gazebo"):
            yield from scoped(node, f"{item.name}::" if node.name == "model" else scope)
        elif node.name in ("link", "joint", "plugin", "gravity"):
            yield item


def read_document(path: Path) -> Node:
    """Return the root element.

    Raises Refused for a text that is no XML, has a document type, or is too large or too deep.
    """
    tree = _Tree(path)
    with regular_file(path, "a readable URDF, SDF or MJCF file", MOST_BYTES) as file:
        tree.read(file)
    # A document without an element is no XML.
    return tree.open[0].children[0]


class _Tree(Markup):
    """Builder of nodes; ``open`` are the open nodes, below a node that holds the root."""

    def __init__(self, path: Path) -> None:
        super().__init__(path, MOST_ELEMENTS)
        self.open = [Node("", {}, 0)]

    def begin(self, name: str, attributes: Mapping[str, str]) -> None:
        node = Node(name, dict(attributes), self.line)
        self.open[-1].children.append(node)
        self.open.append(node)

    def text(self, text: str) -> None:
        self.open[-1].pieces.append(text)

    def end(self, name: str) -> None:
        self.open.pop()
