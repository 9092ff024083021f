"""A published page taken apart: the tokens of its Markdown, with mathematics as tokens of their own.

The pages are the one source. What stands in LaTeX and in HTML is made of their tokens, so that no number
is written down in two places.
"""

from __future__ import annotations

import posixpath
from collections.abc import Collection
from dataclasses import dataclass
from functools import cached_property, lru_cache
from pathlib import PurePosixPath
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from markdown_it import MarkdownIt
    from markdown_it.rules_inline import StateInline
    from markdown_it.token import Token

# GitHub's signs for mathematics inside a line.
_OPEN, _CLOSE = "$`", "`$"
MATH: Final = "math_inline"

# What stands in the head of every rendering.
MADE_BY: Final = "made by taylor-verify publish --paper; do not edit"
FOLDER: Final = "tables"


@dataclass(frozen=True)
class Page:
    """A page by its path below the report's folder, with its Markdown."""

    path: str
    text: str

    @property
    def stem(self) -> str:
        """The name of its renderings: those of the ledger stand among the tables, too."""
        return PurePosixPath(self.path).stem

    @cached_property
    def tokens(self) -> tuple[Token, ...]:
        """Its blocks, for all renderings: none may change them.

        Raises ValueError for HTML in it other than comments, which would be lost.
        """
        found = _reader().parse(self.text)
        for block in found:
            for token in (block, *(block.children or ())):
                if token.type in ("html_block", "html_inline") and not _is_comment(token.content):
                    raise ValueError(f"expected no HTML, got {token.content!r} @ {self.path}")
        return tuple(token for token in found if token.type != "html_block")

    @property
    def title(self) -> str:
        """The words of its first heading."""
        place = next(i for i, token in enumerate(self.tokens) if token.type == "heading_open")
        return "".join(token.content for token in self.tokens[place + 1].children or ())

    def leads_to(self, address: str, pages: Collection[str], suffix: str) -> str:
        """Where a link of the page leads to, seen from its rendering in ``tables``.

        A link to one of ``pages`` leads to the rendering with this suffix.
        """
        if ":" in address or address.startswith("#"):
            return address
        path, mark, anchor = address.partition("#")
        target = posixpath.normpath(posixpath.join(posixpath.dirname(self.path), path))
        if target in pages:
            return f"{PurePosixPath(target).stem}{suffix}{mark}{anchor}"
        return f"{posixpath.relpath(target, FOLDER)}{mark}{anchor}"


def _is_comment(text: str) -> bool:
    return text.strip().startswith("<!--") and text.strip().endswith("-->")


@lru_cache(maxsize=1)
def _reader() -> MarkdownIt:
    from markdown_it import MarkdownIt

    reader = MarkdownIt("commonmark").enable("table")
    # Before a backtick can begin a code span, and a backslash escape.
    reader.inline.ruler.before("escape", MATH, _mathematics)
    return reader


def _mathematics(state: StateInline, silent: bool) -> bool:
    """One formula, its LaTeX as it stands."""
    if not state.src.startswith(_OPEN, state.pos):
        return False
    end = state.src.find(_CLOSE, state.pos + len(_OPEN))
    if end < 0:
        return False
    if not silent:
        token = state.push(MATH, "", 0)
        token.content = state.src[state.pos + len(_OPEN) : end]
    state.pos = end + len(_CLOSE)
    return True
